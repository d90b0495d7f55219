//! Bent cloth laid straight: where the cells of a lattice lie is tracked from the flattest part
//! outward as a smooth field of displacements, and the picture is drawn as if they lay straight.
//!
//! A place x of the picture is matched with the cell at x + d(x). The field d is known on a grid of
//! knots; each is found by least squares on the cells around it, beginning where its neighbours
//! point to (Lucas and Kanade 1981), and bending costs (squared second differences).

mod field;
mod pattern;

#[cfg(test)]
mod tests;

use super::basis::Basis;
use super::lattice::Lattice;
use super::part::FlatPart;
use super::tile::Tile;
use field::Field;
use pattern::Pattern;
use selvedge_foundation::numerics::{Grid, in_pieces};
use selvedge_foundation::quantity::with_unit;

/// What is laid straight must explain this much more of what was not looked at.
const MIN_GAIN: f64 = 0.03;
/// Rounds: by the tile of the flat part, then by that of the whole.
const N_ROUNDS: usize = 2;

/// A picture of bent cloth as if it lay straight.
#[derive(Debug, Clone, PartialEq)]
pub struct Unwarped {
    /// The picture, without the margin that the bend takes.
    pub luminance: Grid<f64>,
    /// How far the cloth lies from straight at most, px.
    pub bend_px: f64,
    /// The largest local stretch, as a share.
    pub stretch: f64,
}

impl Unwarped {
    /// How far it was bent, in words.
    pub fn words(&self) -> String {
        let bend = with_unit(self.bend_px, 1, "px");
        let stretch = with_unit(100.0 * self.stretch, 1, "%");
        format!("{bend} from straight at most, local stretch {stretch}")
    }
}

/// What was laid straight, its mean cell, and the share of its variance that this explains.
pub(super) struct Straight {
    pub(super) unwarped: Unwarped,
    pub(super) tile: Tile,
    pub(super) explained_variance: f64,
}

/// Lays a picture straight whose lattice over all of it is `whole`, from its flattest part outward;
/// `None` where that explains what was not looked at no better than the picture as it is. `step`
/// may stop it.
pub(super) fn straight<E>(
    luminance: &Grid<f64>,
    (lattice, whole): (&Lattice, Basis),
    flat: &FlatPart,
    n_threads: usize,
    mut step: impl FnMut(f64) -> Result<(), E>,
) -> Result<Option<Straight>, E> {
    let [left, top, ..] = flat.place.map(|px| px as f64);
    let mut pattern = Pattern::new(&flat.tile, [left, top], lattice);
    let mut field = Field::level(luminance, &pattern);
    let mut best: Option<Straight> = None;
    for round in 0..N_ROUNDS {
        step(round as f64 / N_ROUNDS as f64)?;
        let mut found = match round {
            0 => field.grown(luminance, &pattern, flat.place),
            _ => field.tracked(luminance, &pattern, n_threads),
        };
        found.smooth();
        field = found.field;
        let basis = field.take_mean_off(pattern.basis());
        // One picture at a time: large ones fill the memory.
        drop(best.take());
        let Some((unwarped, origin)) = field.unwarped(luminance, n_threads) else {
            return Ok(None);
        };
        let (tile, explained_variance) =
            Tile::refine(&unwarped.luminance, basis, n_threads, |_| Ok(()))?;
        pattern = Pattern::new(&tile, origin, lattice);
        best = Some(Straight {
            unwarped,
            tile,
            explained_variance,
        });
    }
    step(1.0)?;
    let before = held_out(luminance, whole, n_threads);
    Ok(best.filter(|straight| {
        let basis = straight.tile.basis();
        let after = held_out(&straight.unwarped.luminance, basis, n_threads);
        after > before + MIN_GAIN
    }))
}

/// Share of the variance of either half of a picture that the mean cell of the other half explains:
/// the mean of left by right, right by left, upper by lower and lower by upper.
fn held_out(luminance: &Grid<f64>, basis: Basis, n_threads: usize) -> f64 {
    let [w, h] = [luminance.width(), luminance.height()];
    let halves = [
        [[0, 0, w / 2, h], [w / 2, 0, w - w / 2, h]],
        [[0, 0, w, h / 2], [0, h / 2, w, h - h / 2]],
    ];
    let share = |seen: [usize; 4], other: [usize; 4]| {
        let tile = Tile::fold_part(luminance, seen, basis, n_threads);
        let [x, y, width, height] = other;
        let origin = [0, 1].map(|axis| other[axis] as f64 - seen[axis] as f64);
        // Of every row the number, the sum, the sum of squares and what the tile leaves of them.
        let mut rows = vec![[0.0; 4]; height];
        let work = |(): &mut (), row: usize, sums: &mut [[f64; 4]]| {
            for (column, value) in (0_u32..).zip(&luminance.row(y + row)[x..x + width]) {
                let at = [origin[0] + f64::from(column), origin[1] + row as f64];
                let left = value - tile.at(basis.coordinates(at));
                for (sum, term) in sums[0]
                    .iter_mut()
                    .zip([1.0, *value, value * value, left * left])
                {
                    *sum += term;
                }
            }
        };
        in_pieces(&mut rows, 1, n_threads, || (), work);
        let [n, sum, squares, left] =
            [0, 1, 2, 3].map(|k| rows.iter().map(|row| row[k]).sum::<f64>());
        let all = squares - sum * sum / n;
        // Also what is no number, of a half without a pixel.
        if all > 0.0 { 1.0 - left / all } else { 0.0 }
    };
    let both = halves.iter().flat_map(|&[a, b]| [share(a, b), share(b, a)]);
    both.sum::<f64>() / 4.0
}
