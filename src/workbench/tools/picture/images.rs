//! Stages as pixels, made on the worker's thread.

use std::sync::Arc;

use eframe::egui::{Color32, ColorImage};

use selvedge_foundation::files::Rgb8Image;
use selvedge_foundation::numerics::{Grid, n_threads, to_byte, to_index};
use selvedge_textile::picture::shading::picture_of;
use selvedge_textile::picture::{Autocorrelation, Lattice, Relief, Tile, overlay, range};
use selvedge_textile::surface::HeightMap;

/// Pixels along the longer side of a picture that is shown at most.
const MOST_SIDE: usize = 640;
/// Cells of the lattice that a part is shown with, and its least size, px.
const N_CELLS: f64 = 7.0;
const LEAST_PART: f64 = 80.0;
/// Pixels along a piece of cloth that is offered, and longer vectors of its lattice.
const FOLDED_SIDE: usize = 96;
const N_FOLDED: f64 = 2.5;
/// Lattice vectors that the autocorrelation is shown with.
const N_VECTORS: f64 = 4.0;

/// A shared picture.
pub(crate) type Image = Arc<ColorImage>;

fn byte(share: f64) -> u8 {
    to_byte((share.clamp(0.0, 1.0) * 255.0).round())
}

/// Values as grey.
fn grey(values: &Grid<f64>, (low, high): (f64, f64)) -> Image {
    let pixel = |value: &f64| Color32::from_gray(byte((value - low) / (high - low)));
    let pixels = values.values().iter().map(pixel).collect();
    Arc::new(ColorImage::new([values.width(), values.height()], pixels))
}

/// A whole picture, at most as large as it is shown; dark to bright is 0 to 1.
pub(crate) fn thumbnail(luminance: &Grid<f64>) -> Image {
    let size = [luminance.width(), luminance.height()];
    let times = size[0].max(size[1]).div_ceil(MOST_SIDE).max(1);
    let [w, h] = size.map(|n| (n / times).max(1));
    let mut small = Grid::filled(w, h, 0.0);
    for row in 0..h {
        for (column, value) in small.row_mut(row).iter_mut().enumerate() {
            let across = (column * times)..((column + 1) * times).min(size[0]);
            let down = (row * times)..((row + 1) * times).min(size[1]);
            let n = (across.len() * down.len()).max(1);
            let sums = down.map(|y| luminance.row(y)[across.clone()].iter().sum::<f64>());
            *value = sums.sum::<f64>() / n as f64;
        }
    }
    grey(&small, (0.0, 1.0))
}

/// The brightness that a relief was found on, and as much of the map that is felt under its light.
pub(crate) fn compared(relief: &Relief, map: &HeightMap) -> [Image; 2] {
    let seen = &relief.brightness.values;
    let um_a_px = 1000.0 * map.step_mm()[0];
    let heights_px = map.heights_um().map(|um| um / um_a_px);
    let lit = picture_of(&heights_px, relief.brightness.light(relief.light));
    let lit = lit.part([0, 0, seen.width(), seen.height()]).unwrap_or(lit);
    [seen, &lit].map(|one| grey(&one.turned_over(), range(one)))
}

fn pixels_of(image: Rgb8Image) -> Image {
    let pixels = image
        .pixels
        .into_iter()
        .map(|[r, g, b]| Color32::from_rgb(r, g, b));
    Arc::new(ColorImage::new(
        [image.width, image.height],
        pixels.collect(),
    ))
}

/// Whole pixels of a length.
fn px(length: f64) -> usize {
    to_index(length.ceil())
}

/// The part of a picture in which some cells can be told apart, from a corner on.
pub(crate) fn part(luminance: &Grid<f64>, lattice: &Lattice, [x, y]: [usize; 2]) -> Grid<f64> {
    let side = px((N_CELLS * lattice.basis().longer()).max(LEAST_PART));
    let most = [luminance.width() - x, luminance.height() - y];
    let size = most.map(|n| n.min(side));
    let part = luminance.part([x, y, size[0], size[1]]);
    part.unwrap_or_else(|| luminance.clone())
}

/// A part with the lattice over it.
pub(crate) fn with_lattice(part: &Grid<f64>, lattice: &Lattice) -> Image {
    pixels_of(overlay(part, Some(lattice.basis())))
}

/// Cloth made of a tile as large as a part, and what it does not explain, on one scale of grey.
pub(crate) fn synthesized(part: &Grid<f64>, tile: &Tile, n_threads: usize) -> [Image; 2] {
    let ends = range(part);
    let again = tile.patch(part.width(), part.height(), 1.0, 0.0, n_threads);
    let mut rest = part.clone();
    for (value, made) in rest.values_mut().iter_mut().zip(again.values()) {
        *value += 0.5 * (ends.0 + ends.1) - made;
    }
    [grey(&again, ends), grey(&rest, ends)]
}

/// A piece of the cloth that a picture becomes by a lattice, so large that its repeat is seen.
pub(crate) fn folded(luminance: &Grid<f64>, lattice: &Lattice) -> Image {
    let basis = lattice.basis();
    let step_px = N_FOLDED * basis.longer() / FOLDED_SIDE as f64;
    let tile = Tile::fold(luminance, basis, n_threads());
    let piece = tile.patch(FOLDED_SIDE, FOLDED_SIDE, step_px, 0.0, n_threads());
    grey(&piece, range(luminance))
}

/// The autocorrelation up to a few vectors, or all of it; and the shift at its edge, px.
pub(crate) fn correlation(rho: &Autocorrelation, lattice: Option<&Lattice>) -> (Image, usize) {
    let [across, down] = rho.reach();
    let all = across.min(down).min(MOST_SIDE / 2);
    let wanted = lattice.map(|lattice| px(N_VECTORS * lattice.basis().longer()));
    let radius = wanted
        .map_or(all, |wanted| wanted.clamp(4, all.max(4)))
        .min(all);
    let shifts = || -radius.cast_signed()..=radius.cast_signed();
    let values = shifts().flat_map(|dy| shifts().map(move |dx| (dx, dy)));
    let values = values.map(|(dx, dy)| rho.at(dx, dy).unwrap_or(0.0));
    let side = 2 * radius + 1;
    let grid = Grid::from_rows(side, values.collect());
    let grid = grid.unwrap_or_else(|| Grid::filled(1, 1, 0.0));
    // The peak at no shift would leave the others dark.
    let others = grid.values().iter().filter(|rho| **rho < 0.999);
    let ends = others.fold((0.0_f64, 0.0_f64), |(low, high), rho| {
        (low.min(*rho), high.max(*rho))
    });
    let ends = if ends.1 > ends.0 { ends } else { (-1.0, 1.0) };
    (grey(&grid, ends), radius)
}
