//! What pieces of bent cloth are matched with, and where they match.

use super::super::basis::{Basis, Place, length, mix};
use super::super::lattice::Lattice;
use super::super::tile::{Tile, between};
use selvedge_foundation::numerics::{Grid, to_index};

/// Side of the piece around a knot, in cells of threads, and px at least.
const N_CELLS: f64 = 3.0;
const MIN_SIDE_PX: f64 = 24.0;
/// Pixels of a piece each way that are looked at.
const N_PIXELS: f64 = 24.0;
/// Steps of least squares, and how far one goes at most, px.
const N_STEPS: usize = 8;
const MAX_STEP_PX: f64 = 1.0;
/// A piece that lies farther from where its neighbours point to, in cells of threads, or matches
/// worse is not believed.
const MAX_OFF: f64 = 0.35;
const MIN_MATCH: f64 = 0.25;
/// A pixel's value, the pattern's there with its slope, and how much it counts.
type Seen = (f64, f64, Place, f64);

/// What a piece that is not believed counts beside others.
const DOUBT: f64 = 1e-3;

/// What pieces are matched with: a mean cell whose first sample lies at a place of the picture.
pub(super) struct Pattern {
    /// Values, and how they change along x and along y.
    cell: Grid<[f64; 3]>,
    basis: Basis,
    origin: Place,
    /// From thread to thread at most, px.
    cell_px: f64,
}

impl Pattern {
    pub(super) fn new(tile: &Tile, origin: Place, lattice: &Lattice) -> Self {
        let basis = tile.basis();
        let n = [tile.values.width(), tile.values.height()];
        let half = [[0.5, 0.0], [0.0, 0.5]].map(|px| basis.coordinates(px));
        let cell = Grid::from_fn(n[0], n[1], |i, j| {
            let at = [i as f64 / n[0] as f64, j as f64 / n[1] as f64];
            let change =
                half.map(|px| tile.at(mix(at, 1.0, px, 1.0)) - tile.at(mix(at, 1.0, px, -1.0)));
            [tile.values.row(j)[i], change[0], change[1]]
        });
        let cell_px = lattice
            .thread_grid
            .map_or_else(|| basis.longer(), |grid| grid.longer());
        Self {
            cell,
            basis,
            origin,
            cell_px,
        }
    }

    /// Side of the piece around a knot, px.
    pub(super) fn side_px(&self) -> f64 {
        (N_CELLS * self.cell_px).max(MIN_SIDE_PX)
    }

    /// The lattice.
    pub(super) fn basis(&self) -> Basis {
        self.basis
    }

    /// Value and slope at a place.
    fn with_slope(&self, place: Place) -> (f64, Place) {
        let at = self.basis.coordinates(mix(place, 1.0, self.origin, -1.0));
        let blend =
            |a: [f64; 3], b: [f64; 3], share: f64| [0, 1, 2].map(|k| a[k] + share * (b[k] - a[k]));
        let [value, along, down] = between(&self.cell, at, blend);
        (value, [along, down])
    }
}

/// A displacement and how it changes along x and along y.
#[derive(Clone, Copy, Default)]
pub(super) struct Local {
    pub(super) off: Place,
    pub(super) slopes: [Place; 2],
}

impl Pattern {
    /// The displacement at which a piece matches best near a guess, and how far it is believed.
    pub(super) fn matched(
        &self,
        luminance: &Grid<f64>,
        (middle, near): (Place, Local),
    ) -> (Place, f64) {
        let pixels = piece(luminance, middle, self.side_px());
        let mut off = near.off;
        let mut sure = 0.0;
        for _ in 0..=N_STEPS {
            // One weighted line of brightness over the pattern, and its slopes.
            let seen = pixels.iter().map(|&(at, value, weight)| {
                let from = mix(at, 1.0, middle, -1.0);
                let bent = mix(near.slopes[0], from[0], near.slopes[1], from[1]);
                let (cell, slope) = self.with_slope(mix(mix(at, 1.0, off, 1.0), 1.0, bent, 1.0));
                (value, cell, slope, weight)
            });
            let seen: Vec<Seen> = seen.collect();
            let mean = |of: &dyn Fn(&Seen) -> f64| {
                let sum = |of: &dyn Fn(&Seen) -> f64| -> f64 {
                    seen.iter().map(|one| one.3 * of(one)).sum()
                };
                sum(of) / sum(&|_| 1.0).max(f64::MIN_POSITIVE)
            };
            let (value, cell) = (mean(&|one| one.0), mean(&|one| one.1));
            let both = mean(&|one| (one.0 - value) * (one.1 - cell));
            let of_cell = mean(&|one| (one.1 - cell).powi(2));
            let of_value = mean(&|one| (one.0 - value).powi(2));
            let all = (of_cell * of_value).sqrt();
            sure = if all > 0.0 { both / all } else { 0.0 };
            let gain = if of_cell > 0.0 { both / of_cell } else { 0.0 };
            if gain <= 0.0 {
                break;
            }
            let left = |one: &Seen| one.0 - value - gain * (one.1 - cell);
            let pull = [0, 1].map(|axis| mean(&|one| gain * one.2[axis] * left(one)));
            let square = |a: usize, b: usize| mean(&|one| gain * gain * one.2[a] * one.2[b]);
            let (xx, xy, yy) = (square(0, 0), square(0, 1), square(1, 1));
            let damped = 1e-3 * (xx + yy) + f64::MIN_POSITIVE;
            let matrix = Basis::new([xx + damped, xy], [xy, yy + damped]);
            let go = matrix.coordinates(pull);
            let long = length(go);
            let share = if long > MAX_STEP_PX {
                MAX_STEP_PX / long
            } else {
                1.0
            };
            if long <= 1e-3 || !long.is_finite() {
                break;
            }
            off = mix(off, 1.0, go, share);
        }
        let is_off = length(mix(off, 1.0, near.off, -1.0)) > MAX_OFF * self.cell_px;
        if is_off || sure < MIN_MATCH {
            return (near.off, DOUBT);
        }
        (off, sure * sure)
    }
}

/// Pixels of a picture around a place: where, how bright, and how much they count.
fn piece(luminance: &Grid<f64>, middle: Place, side_px: f64) -> Vec<(Place, f64, f64)> {
    let every = to_index((side_px / N_PIXELS).ceil()).max(1);
    let ends = |axis: usize, n: usize| {
        let [from, to] = [-0.5, 0.5].map(|half| middle[axis] + half * side_px);
        to_index(from.max(0.0))..to_index(to.max(0.0)).min(n)
    };
    let (columns, rows) = (ends(0, luminance.width()), ends(1, luminance.height()));
    let hann = |px: f64| (std::f64::consts::PI * px / side_px).cos().max(0.0).powi(2);
    let mut pixels = Vec::new();
    for row in rows.step_by(every) {
        let of_row = hann(row as f64 - middle[1]);
        for column in columns.clone().step_by(every) {
            let weight = of_row * hann(column as f64 - middle[0]);
            let at = [column as f64, row as f64];
            pixels.push((at, luminance.row(row)[column], weight));
        }
    }
    pixels
}
