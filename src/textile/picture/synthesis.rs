//! Cloth of any extent from a piece of it: its mean cell over and over, and on it what varies from
//! cell to cell, drawn anew so that it repeats nowhere.
//!
//! `z = mean cell + residual`. Of the residual the power is kept, by wavelength and direction, and
//! phases are drawn by chance (random phase noise; Galerne, Gousseau and Morel 2011). What lies
//! farther apart than the piece is long is not alike.

use super::basis::{Basis, Place, length, mix};
use super::tile::Tile;
use selvedge_foundation::numerics::{Complex, Grid, PlaneTransform, Random, n_threads, to_index};

/// A piece holds this many cells or more, so that the mean of them is not each of them.
const MIN_CELLS: f64 = 4.0;

/// Cloth of about `wanted` samples of a piece that is the same at its opposite edges, as the cloth
/// is; the pattern of the piece repeats by `cell`, in its samples. A piece of too few cells, or
/// without any, is all residual.
pub(crate) fn synthesized(
    piece: &Grid<f64>,
    cell: Option<Basis>,
    wanted: [usize; 2],
    random: &mut Random,
) -> Grid<f64> {
    let n_samples = piece.values().len() as f64;
    let side = piece.width().max(piece.height()) as f64;
    let cell = cell.filter(|cell| {
        (1.0..n_samples / MIN_CELLS).contains(&cell.area()) && cell.longer() <= side
    });
    let tile = cell.map(|cell| Tile::fold(piece, cell, n_threads()));
    let level = piece.values().iter().sum::<f64>() / n_samples;
    let mean = |place: Place| tile.as_ref().map_or(level, |tile| tile.at(place));
    let cell = cell.unwrap_or(Basis::new([1.0, 0.0], [0.0, 1.0]));
    let residual = Grid::from_fn(piece.width(), piece.height(), |i, j| {
        piece.row(j)[i] - mean(cell.coordinates([i as f64, j as f64]))
    });
    let [(n_u, along), (n_w, across)] = [0, 1].map(|axis| closing(&cell, axis, wanted[axis]));
    let closed = Basis::new(along, across);
    let mut cloth = drawn(&residual, [n_u, n_w], random);
    for row in 0..n_w {
        for (column, height) in cloth.row_mut(row).iter_mut().enumerate() {
            let shares = [column as f64 / n_u as f64, row as f64 / n_w as f64];
            *height += mean(closed.place(shares));
        }
    }
    cloth
}

/// The extent of about so many samples along an axis after which a lattice comes back nearest to
/// itself, and the whole cells that are then passed.
fn closing(cell: &Basis, axis: usize, wanted: usize) -> (usize, [f64; 2]) {
    let off = |n: &usize| {
        let mut end = [0.0; 2];
        end[axis] = *n as f64;
        let point = cell.coordinates(end).map(f64::round);
        (length(mix(end, 1.0, cell.place(point), -1.0)), point)
    };
    let further = wanted / 4 + to_index(cell.longer());
    let best = (wanted..=wanted + further).min_by(|a, b| off(a).0.total_cmp(&off(b).0));
    let n = best.unwrap_or(wanted);
    (n, off(&n).1)
}

/// A field of n samples with the power spectrum of another, its phases by chance.
fn drawn(field: &Grid<f64>, n: [usize; 2], random: &mut Random) -> Grid<f64> {
    let size = [field.width(), field.height()];
    let powers = PlaneTransform::new(size[0], size[1])
        .forward(field)
        .map(|wave| wave.norm_sqr());
    let white = Grid::from_fn(n[0], n[1], |_, _| random.normal());
    let plane = PlaneTransform::new(n[0], n[1]);
    let mut waves = plane.forward(&white);
    for row in 0..n[1] {
        // The upper half of the rows are waves that run the other way.
        let before = if 2 * row > n[1] { n[1] as f64 } else { 0.0 };
        let across = (row as f64 - before) * size[1] as f64 / n[1] as f64;
        for (column, wave) in waves.row_mut(row).iter_mut().enumerate() {
            let along = column as f64 * size[0] as f64 / n[0] as f64;
            let power = between(&powers, [along, across]);
            let length = wave.norm();
            *wave = if length > 0.0 {
                *wave * (power.sqrt() / length)
            } else {
                Complex::default()
            };
        }
    }
    let mut cloth = plane.inverse(waves);
    let mean_square = |grid: &Grid<f64>| {
        let sum: f64 = grid.values().iter().map(|z| z * z).sum();
        sum / grid.values().len() as f64
    };
    let scale = (mean_square(field) / mean_square(&cloth)).sqrt();
    let scale = if scale.is_finite() { scale } else { 0.0 };
    cloth.values_mut().iter_mut().for_each(|z| *z *= scale);
    cloth
}

/// The power of a wave between those of a transform: columns of half the plane, rows of all of it.
fn between(powers: &Grid<f64>, [along, across]: [f64; 2]) -> f64 {
    let rows = powers.height();
    let row = across.rem_euclid(rows as f64);
    let (i, j) = (
        to_index(along).min(powers.width() - 1),
        to_index(row) % rows,
    );
    let (next_i, next_j) = ((i + 1).min(powers.width() - 1), (j + 1) % rows);
    let (s, t) = (along.fract(), row.fract());
    let on = |row: usize| powers.row(row)[i] * (1.0 - s) + powers.row(row)[next_i] * s;
    on(j) * (1.0 - t) + on(next_j) * t
}

#[cfg(test)]
mod tests {
    use super::super::Autocorrelation;
    use super::*;

    /// Cells of 12 × 10 samples whose yarns differ, and noise; the same at opposite edges.
    fn piece() -> Grid<f64> {
        let mut random = Random::new(3);
        let yarns: Vec<f64> = (0..60).map(|_| 0.4 * random.normal()).collect();
        let wave = |at: usize, n: usize| (std::f64::consts::TAU * at as f64 / n as f64).cos();
        Grid::from_fn(240, 200, |x, y| {
            let ends = (1.0 + yarns[x / 12]) * wave(x, 12);
            ends + (1.0 + yarns[20 + y / 10]) * wave(y, 10) + 0.1 * random.normal()
        })
    }

    const CELL: Basis = Basis::new([12.0, 0.0], [0.0, 10.0]);

    fn cloth(wanted: [usize; 2], seed: u64) -> Grid<f64> {
        synthesized(&piece(), Some(CELL), wanted, &mut Random::new(seed))
    }

    /// The largest ρ beyond one cell, and within half of the smaller size.
    fn most_alike(cloth: &Grid<f64>) -> f64 {
        let part = cloth.part([0, 0, 240, 200]).unwrap();
        let rho = Autocorrelation::of(&part, 1);
        let places = (0..=100_isize).flat_map(|y| (-120..=120_isize).map(move |x| [x, y]));
        let beyond = places.filter(|[x, y]| x.abs() > 13 || *y > 11);
        let all = beyond.filter_map(|[x, y]| rho.at(x, y));
        all.fold(f64::NEG_INFINITY, f64::max)
    }

    #[test]
    fn synthesized_cloth_varies_as_much_as_its_piece_and_repeats_less() {
        let (piece, cloth) = (piece(), cloth([700, 650], 1));
        assert!(
            cloth.width() >= 700 && cloth.height() >= 650,
            "as large as asked"
        );
        assert_eq!(
            [cloth.width() % 12, cloth.height() % 10],
            [0, 0],
            "whole cells"
        );
        let variance = |grid: &Grid<f64>| super::super::light::mean_and_variance(grid).1;
        let share = variance(&cloth) / variance(&piece);
        assert!((share - 1.0).abs() < 0.05, "{share}");
        let [here, there] = [&piece, &cloth].map(most_alike);
        assert!(there < here + 0.02, "{there} in cloth, {here} in its piece");
        let over_and_over = synthesized(&piece, None, [240, 200], &mut Random::new(1));
        assert!(most_alike(&over_and_over) < here, "phases by chance");
    }

    #[test]
    fn another_seed_is_other_cloth_and_the_same_is_the_same() {
        assert_eq!(cloth([300, 260], 1), cloth([300, 260], 1));
        assert_ne!(cloth([300, 260], 1), cloth([300, 260], 2));
    }

    #[test]
    fn an_oblique_lattice_goes_on_at_the_other_side() {
        let cell = Basis::new([11.3, 1.7], [-3.1, 9.6]);
        let value = |x: f64, y: f64| {
            let turns = cell
                .coordinates([x, y])
                .map(|t| (std::f64::consts::TAU * t).cos());
            turns[0] + turns[1]
        };
        let piece = Grid::from_fn(260, 240, |x, y| value(x as f64, y as f64));
        let cloth = synthesized(&piece, Some(cell), [500, 500], &mut Random::new(1));
        let (w, h) = (cloth.width(), cloth.height());
        let steps =
            |pairs: Vec<[f64; 2]>| pairs.iter().fold(0.0_f64, |m, [a, b]| m.max((a - b).abs()));
        let column = |x: usize| (0..h).map(move |y| (x, y));
        let at = |(x, y): (usize, usize)| cloth.row(y)[x];
        let inside = steps(
            column(0)
                .zip(column(1))
                .map(|(a, b)| [at(a), at(b)])
                .collect(),
        );
        let seam = steps(
            column(w - 1)
                .zip(column(0))
                .map(|(a, b)| [at(a), at(b)])
                .collect(),
        );
        assert!(seam < 1.3 * inside, "{seam} over the seam, {inside} inside");
    }

    #[test]
    fn what_is_level_and_what_is_tiny_stay_finite() {
        for piece in [Grid::filled(40, 30, 2.0), Grid::filled(1, 1, 0.5)] {
            let thin = Basis::new([1e9, 0.0], [0.0, 1e-8]);
            for cell in [
                None,
                Some(CELL),
                Some(Basis::new([0.0; 2], [0.0; 2])),
                Some(thin),
            ] {
                let cloth = synthesized(&piece, cell, [64, 48], &mut Random::new(1));
                let off = |z: &f64| (z - piece.values()[0]).abs();
                assert!(cloth.values().iter().all(|z| off(z) < 1e-9), "{cell:?}");
            }
        }
    }
}
