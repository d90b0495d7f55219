//! From the tile of a picture to a textile that is felt: what every surface shares.
//!
//! ```text
//! Tile ─ brightness_of ─▶ Brightness ─ shape_of ─▶ Shape ─ textile_of ─▶ files of a textile
//! ```
//!
//! Pictures count rows from the top and angles clockwise; heights count rows from the lowest y and
//! angles counter-clockwise. A light is always said as it falls on the *picture*, y up; these
//! functions turn it to the axes of what was cut from it.

use super::analysis::Found;
use super::basis::{Basis, dot, length, whole};
use super::relief::ReliefOf;
use super::shading::{Light, LightEstimate, ShadingError, ShadingOptions, Shape};
use super::source::between;
use super::tile::Tile;
use crate::surface::WINDOW_LENGTH_MM;
use selvedge_foundation::numerics::{Grid, to_index};
use selvedge_foundation::progress::Progress;

/// Windows that synthesized textile holds, along and across, at least.
const N_WINDOWS: f64 = 1.5;
/// Samples a side of synthesized textile at most.
const MAX_SIDE: f64 = 1024.0;
/// How much further across than needed a better seam is looked for.
const LOOK_FURTHER: isize = 12;

/// What was cut from a lattice.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Extent {
    /// The smallest rectangle that repeats, sheared by this to close, radians.
    Repeat {
        /// The shear.
        shear_rad: f64,
    },
    /// Synthesized textile, for the lattice has no rectangle: it repeats along its rows, and at its
    /// upper edge jumps sideways by this, px of the picture.
    Patch {
        /// The jump.
        seam_px: f64,
    },
}

/// Brightness of textile that repeats, cut from a lattice.
#[derive(Debug, Clone, PartialEq)]
pub struct Brightness {
    /// Samples, 0…1; **row 0 is the lowest y**.
    pub values: Grid<f64>,
    /// Its size, px of the picture.
    pub size_px: [f64; 2],
    /// Direction of its rows in the picture, radians clockwise from x to the right.
    pub angle_rad: f64,
    /// What it is.
    pub(crate) extent: Extent,
    /// The same of further pictures, as bright on the mean, and by how much the cloth is turned in
    /// each, degrees counter-clockwise.
    pub(crate) turned: Vec<(Grid<f64>, f64)>,
}

impl Brightness {
    /// What heights are found on: the picture, whether it has a lattice or not, or the mean cell;
    /// `None` where there is no lattice and so no cell. Only a cell that is no rectangle needs the
    /// scale.
    pub fn ground(
        (relief_of, luminance): (ReliefOf, &Grid<f64>),
        found: Option<&Found>,
        px_per_mm: Option<f64>,
        n_threads: usize,
    ) -> Option<Self> {
        Some(match (relief_of, found) {
            (ReliefOf::Cell, found) => Self::of(&found?.tile, px_per_mm.unwrap_or(1.0), n_threads),
            (_, Some(found)) => Self::of_picture(found.laid(luminance), found.turn_rad()),
            (_, None) => Self::of_picture(luminance, 0.0),
        })
    }

    /// Cuts from a tile the rectangle that repeats, sampled at 1 px; where the lattice has none,
    /// synthesizes textile that holds a window of the finger or more at this scale.
    pub fn of(tile: &Tile, px_per_mm: f64, n_threads: usize) -> Self {
        match tile.rectangle(1.0, n_threads) {
            Some(rectangle) => Self {
                values: upright(&rectangle.values),
                size_px: rectangle.size_px,
                angle_rad: rectangle.angle_rad,
                extent: Extent::Repeat {
                    shear_rad: rectangle.shear_rad,
                },
                turned: Vec::new(),
            },
            None => synthesized(tile, px_per_mm, n_threads),
        }
    }
}

/// Samples a side of a picture that is felt as it is, at most; over this share of its size its
/// edges go over into each other, so that it repeats.
const MAX_WHOLE: usize = 384;
const FADE: f64 = 0.1;
/// Sides are multiples of this where they can be, so that transforms of them and of their halves
/// are quick: of 383 samples, a prime, one takes several times as long as of 384.
const MULTIPLE: usize = 16;

impl Brightness {
    /// The middle of a picture as it is, no cell and no mean: what varies from yarn to yarn stays.
    /// Rows run at an angle (radians clockwise from x to the right), along a yarn.
    pub fn of_picture(luminance: &Grid<f64>, angle_rad: f64) -> Self {
        let (s, c) = angle_rad.sin_cos();
        let [w, h] = [luminance.width() as f64, luminance.height() as f64];
        // The largest rectangle of the picture's own sides that fits.
        let share = (w / (w * c.abs() + h * s.abs())).min(h / (w * s.abs() + h * c.abs()));
        let kept = [w, h].map(|side| {
            let n = to_index(side * share / (1.0 + FADE)).clamp(1, MAX_WHOLE);
            if n < 4 * MULTIPLE {
                n
            } else {
                n - n % MULTIPLE
            }
        });
        let n = kept.map(|n| to_index(n as f64 * (1.0 + FADE)));
        let middle = [0.5 * (w - 1.0), 0.5 * (h - 1.0)];
        let at = |column: usize, row: usize| {
            let x = column as f64 - 0.5 * (n[0] - 1) as f64;
            let y = row as f64 - 0.5 * (n[1] - 1) as f64;
            let place = [middle[0] + x * c - y * s, middle[1] + x * s + y * c];
            between(luminance, place, |a, b, t| a + (b - a) * t)
        };
        let cut = faded(&Grid::from_fn(n[0], n[1], at), kept[0]);
        let cut = faded(&cut.transposed(), kept[1]).transposed();
        Self {
            size_px: [cut.width() as f64, cut.height() as f64],
            values: upright(&cut),
            angle_rad,
            extent: Extent::Repeat { shear_rad: 0.0 },
            turned: Vec::new(),
        }
    }
}

/// Rows of n samples, the last of longer ones gone over into their first.
fn faded(grid: &Grid<f64>, n: usize) -> Grid<f64> {
    let over = grid.width() - n;
    Grid::from_fn(n, grid.height(), |column, row| {
        let row = grid.row(row);
        if column >= over {
            return row[column];
        }
        let share = (column as f64 + 0.5) / over as f64;
        row[n + column] + (row[column] - row[n + column]) * share
    })
}

/// Rows from the lowest y. Divided light may pass white by a little: 0…1 is kept.
fn upright(values: &Grid<f64>) -> Grid<f64> {
    values.turned_over().map(|value| value.clamp(0.0, 1.0))
}

/// Textile along p1, whole periods wide, as high as closes best.
fn synthesized(tile: &Tile, px_per_mm: f64, n_threads: usize) -> Brightness {
    let basis = tile.basis();
    let min_px = N_WINDOWS * WINDOW_LENGTH_MM * px_per_mm.max(1.0);
    let period = length(basis.p1);
    let width_px = (min_px / period).ceil() * period;
    let (height_px, seam_px) = best_height(&basis, min_px);
    let angle_rad = basis.p1[1].atan2(basis.p1[0]);
    let step_px = (width_px.max(height_px) / MAX_SIDE).max(1.0);
    let n = [width_px, height_px].map(|side| whole(side / step_px).max(1).cast_unsigned());
    let patch = tile.patch(n[0], n[1], step_px, angle_rad, n_threads);
    Brightness {
        values: upright(&patch),
        size_px: n.map(|n| n as f64 * step_px),
        angle_rad,
        extent: Extent::Patch { seam_px },
        turned: Vec::new(),
    }
}

/// Height of a patch, and how far its upper edge is from continuing its lower one, px.
fn best_height(basis: &Basis, min_px: f64) -> (f64, f64) {
    let period = length(basis.p1);
    let (rise, lean) = (basis.area() / period, dot(basis.p1, basis.p2) / period);
    let first = whole((min_px / rise).ceil()).max(1);
    let candidates = (first..=first + LOOK_FURTHER).map(|n| {
        let n = n as f64;
        let turns = n * lean / period;
        (n * rise, (turns - turns.round()).abs() * period)
    });
    candidates.fold((rise, f64::INFINITY), |best, next| {
        if next.1 < best.1 { next } else { best }
    })
}

impl Brightness {
    /// A light on the picture as it falls on this.
    #[must_use]
    pub fn light(&self, on_picture: Light) -> Light {
        on_picture.turned(self.angle_rad.to_degrees())
    }

    /// A light on this as it falls on the picture.
    #[must_use]
    pub(crate) fn light_on_picture(&self, here: Light) -> Light {
        here.turned(-self.angle_rad.to_degrees())
    }

    /// Estimates the light on the picture, from this; its tilt from turned pictures, if there are.
    ///
    /// # Errors
    /// All is black.
    pub fn estimated_light(&self) -> Result<LightEstimate, ShadingError> {
        let mut estimate = LightEstimate::of(&self.values)?;
        if let Some(turns) = self.turns() {
            estimate.light.tilt_deg = turns.light().tilt_deg;
            estimate.words = turns.words();
        }
        estimate.light = self.light_on_picture(estimate.light);
        Ok(estimate)
    }
}

impl Brightness {
    /// Heights of what was cut, under a light on the picture.
    ///
    /// # Errors
    /// See [`Shape::from_shading`].
    pub fn shape(
        &self,
        on_picture: Light,
        options: &ShadingOptions,
        progress: &mut Progress<'_>,
    ) -> Result<Shape, ShadingError> {
        // A light that is out of range is refused in the user's own numbers.
        on_picture.check()?;
        Shape::from_views(&self.views(on_picture), options, progress)
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::super::{Analysis, AnalysisOptions, DirectionOptions, EvenLight, Picture};
    use super::*;
    use selvedge_foundation::numerics::Random;
    use selvedge_foundation::progress::Progress;

    /// Of the picture, px.
    const SIDE: usize = 300;
    const LIGHT: Light = Light {
        slant_deg: 40.0,
        tilt_deg: 60.0,
    };

    /// Waves of a textile: orders along its vectors, amplitude (px) and phase. None of its mirror
    /// images or turns is like it.
    const WAVES: [([f64; 2], f64, f64); 5] = [
        ([1.0, 0.0], 1.0, 0.3),
        ([0.0, 1.0], 0.8, 1.9),
        ([1.0, 1.0], 0.7, 0.8),
        ([2.0, 1.0], 0.35, 2.6),
        ([1.0, -2.0], 0.3, 4.0),
    ];

    /// Height and its slopes along x and y (down) at a place of the picture.
    fn cloth(basis: &Basis, place: [f64; 2]) -> [f64; 3] {
        let [u, v] = basis.coordinates(place);
        let (ex, ey) = (basis.coordinates([1.0, 0.0]), basis.coordinates([0.0, 1.0]));
        let mut sum = [0.0; 3];
        for (order, amplitude, phase) in WAVES {
            let turn = TAU * dot(order, [u, v]) + phase;
            sum[0] += amplitude * turn.cos();
            sum[1] -= amplitude * TAU * dot(order, ex) * turn.sin();
            sum[2] -= amplitude * TAU * dot(order, ey) * turn.sin();
        }
        sum
    }

    /// The textile under the light, with the noise of a camera.
    fn picture(basis: &Basis) -> Picture {
        let mut random = Random::new(4);
        let lean = LIGHT.lean();
        let values = (0..SIDE * SIDE).map(|i| {
            let [_, p, down] = cloth(basis, [(i % SIDE) as f64, (i / SIDE) as f64]);
            let q = -down;
            let facing = 1.0 - p * lean[0] - q * lean[1];
            let norm = (1.0 + p * p + q * q).sqrt() * (1.0 + dot(lean, lean)).sqrt();
            (0.8 * facing.max(0.0) / norm + 0.02 * random.normal()).clamp(0.0, 1.0)
        });
        let grid = Grid::from_rows(SIDE, values.collect()).unwrap();
        Picture::grey(grid)
    }

    fn tile_of(basis: &Basis) -> Tile {
        let options = AnalysisOptions {
            light: EvenLight::Auto,
            directions: DirectionOptions::default(),
            n_threads: 2,
        };
        let picture = picture(basis);
        let found =
            Progress::unheard(|progress| Analysis::of(picture, &options, progress)).unwrap();
        found.found.unwrap().tile
    }

    /// Correlation of heights with those of the textile, where `place` says a sample lies in what
    /// was cut (along, down; px).
    fn agreement(
        basis: &Basis,
        (cut, shape): (&Brightness, &Shape),
        place: impl Fn(f64, f64) -> [f64; 2],
    ) -> f64 {
        let (s, c) = cut.angle_rad.sin_cos();
        let heights = &shape.height_px;
        let n = [heights.width(), heights.height()];
        let step = [0, 1].map(|axis| cut.size_px[axis] / n[axis] as f64);
        let (mut sums, mut count) = ([0.0; 5], 0.0);
        for (j, row) in (0..n[1]).map(|j| (j, heights.row(n[1] - 1 - j))) {
            for (i, z) in row.iter().enumerate() {
                let [x, y] = place(i as f64 * step[0], j as f64 * step[1]);
                let truth = cloth(basis, [x * c - y * s, x * s + y * c])[0];
                let terms = [*z, truth, z * z, truth * truth, z * truth];
                sums.iter_mut().zip(terms).for_each(|(sum, x)| *sum += x);
                count += 1.0;
            }
        }
        let [a, b, aa, bb, ab] = sums.map(|sum| sum / count);
        (ab - a * b) / ((aa - a * a) * (bb - b * b)).sqrt()
    }

    fn turned_basis(angle_deg: f64, sides: [f64; 2], between_deg: f64) -> Basis {
        let vector = |length: f64, deg: f64| {
            let (s, c) = deg.to_radians().sin_cos();
            [length * c, length * s]
        };
        Basis::new(
            vector(sides[0], angle_deg),
            vector(sides[1], angle_deg + between_deg),
        )
    }

    fn shape(cut: &Brightness) -> Shape {
        let options = ShadingOptions::default();
        Progress::unheard(|progress| cut.shape(LIGHT, &options, progress)).unwrap()
    }

    #[test]
    fn a_picture_of_a_turned_cloth_gives_its_relief_the_right_way_round() {
        let basis = turned_basis(17.0, [22.0, 26.0], 90.0);
        let cut = Brightness::of(&tile_of(&basis), 20.0, 2);
        assert!(
            matches!(cut.extent, Extent::Repeat { .. }),
            "{:?}",
            cut.extent
        );
        let shape = shape(&cut);
        let [width, height] = cut.size_px;
        let right = agreement(&basis, (&cut, &shape), |x, y| [x, y]);
        // More than 0.999 when this was written: no wave of this textile lies across the light.
        assert!(right > 0.98, "{right}");
        for (name, wrong) in [
            (
                "mirrored",
                agreement(&basis, (&cut, &shape), |x, y| [width - x, y]),
            ),
            (
                "upside down",
                agreement(&basis, (&cut, &shape), |x, y| [x, height - y]),
            ),
            (
                "turned",
                agreement(&basis, (&cut, &shape), |x, y| [width - x, height - y]),
            ),
        ] {
            assert!(wrong < 0.7, "{name}: {wrong} beside {right}");
        }
    }

    #[test]
    fn synthesized_cloth_shows_the_relief_and_nearly_closes() {
        let basis = turned_basis(9.0, [21.3, 24.9], 71.3);
        let tile = tile_of(&basis);
        let cut = synthesized(&tile, 8.0, 2);
        let Extent::Patch { seam_px } = cut.extent else {
            panic!("{:?} at {:?}", cut.extent, tile.basis());
        };
        assert!(seam_px < 2.5, "seam {seam_px}");
        let min_px = N_WINDOWS * WINDOW_LENGTH_MM * 8.0;
        assert!(
            cut.size_px.iter().all(|side| *side > 0.95 * min_px),
            "{:?}",
            cut.size_px
        );
        let right = agreement(&basis, (&cut, &shape(&cut)), |x, y| [x, y]);
        assert!(right > 0.85, "{right}");
    }

    #[test]
    fn a_picture_as_it_is_goes_on_at_its_other_side_and_turns_with_its_yarns() {
        let value =
            |x: f64, y: f64| 0.5 + 0.2 * (0.31 * x).sin() + 0.1 * (0.17 * y + 0.02 * x).cos();
        let picture = Grid::from_fn(200, 150, |x, y| value(x as f64, y as f64));
        let cut = Brightness::of_picture(&picture, 0.0);
        let (w, h) = (cut.values.width(), cut.values.height());
        assert_eq!([w as f64, h as f64], cut.size_px);
        let largest = |pairs: &mut dyn Iterator<Item = (f64, f64)>| {
            pairs.fold(0.0_f64, |max, (a, b)| max.max((a - b).abs()))
        };
        let row = |j: usize| cut.values.row(j);
        let inside =
            largest(&mut (0..h).flat_map(|j| row(j).windows(2).map(|two| (two[0], two[1]))));
        let seam = largest(&mut (0..h).map(|j| (row(j)[w - 1], row(j)[0])));
        let upper = largest(&mut (0..w).map(|i| (row(h - 1)[i], row(0)[i])));
        assert!(
            seam < 1.5 * inside && upper < 1.5 * inside,
            "{seam} {upper} {inside}"
        );
        // Stripes along the yarns are level in a picture that is turned with them.
        let angle_rad = 0.2_f64;
        let (s, c) = angle_rad.sin_cos();
        let stripes = Grid::from_fn(200, 150, |x, y| {
            0.5 + 0.3 * (0.3 * (c * y as f64 - s * x as f64)).sin()
        });
        let turned = Brightness::of_picture(&stripes, angle_rad).values;
        let row = turned.row(turned.height() / 2);
        let along = largest(&mut row.iter().map(|value| (*value, row[0])));
        assert!(along < 0.02, "{along}");
    }

    #[test]
    fn a_light_is_turned_to_what_was_cut_and_back() {
        let cut = Brightness {
            values: Grid::filled(4, 4, 0.5),
            size_px: [4.0, 4.0],
            angle_rad: 0.5,
            extent: Extent::Repeat { shear_rad: 0.0 },
            turned: Vec::new(),
        };
        let here = cut.light(Light {
            slant_deg: 40.0,
            tilt_deg: 170.0,
        });
        assert!((here.tilt_deg - (170.0 + 0.5_f64.to_degrees() - 360.0)).abs() < 1e-9);
        let back = cut.light_on_picture(here);
        assert!((back.tilt_deg - 170.0).abs() < 1e-9 && back.slant_deg > 39.0);
    }
}
