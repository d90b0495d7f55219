//! Tables as they are stored: powers of every point at every node, as shares of a unit.

use super::segments::Spot;
use crate::plan::ScenePlan;
use selvedge_textile::surface::Direction;

/// One set of spectra over all nodes.
#[derive(Debug, Clone)]
pub(super) struct Table {
    pub(super) n_points: usize,
    /// Node by node a row of points; a power is `[40 Hz, 320 Hz]` in units of the textile's.
    pub(super) powers: Vec<[f32; 2]>,
}

/// A direction at one speed: the rows before and after, and the share of the way between.
#[derive(Clone, Copy)]
pub(super) struct Rows<'a> {
    before: &'a [[f32; 2]],
    after: &'a [[f32; 2]],
    share: f32,
}

impl Table {
    pub(super) fn n_bytes(&self) -> usize {
        size_of_val(&self.powers[..])
    }

    pub(super) fn rows(&self, spot: Spot) -> Rows<'_> {
        let rows = &self.powers[spot.node * self.n_points..][..2 * self.n_points];
        let (before, after) = rows.split_at(self.n_points);
        Rows {
            before,
            after,
            share: spot.share,
        }
    }
}

impl Rows<'_> {
    #[inline]
    pub(super) fn at(self, point: usize) -> [f32; 2] {
        let ([a, b], [c, d]) = (self.before[point], self.after[point]);
        [a + (c - a) * self.share, b + (d - b) * self.share]
    }

    pub(super) fn blend(self, out: &mut [[f32; 2]]) {
        for (out, (before, after)) in out.iter_mut().zip(self.before.iter().zip(self.after)) {
            out[0] = before[0] + (after[0] - before[0]) * self.share;
            out[1] = before[1] + (after[1] - before[1]) * self.share;
        }
    }
}

/// What the powers of each set of spectra are stored as a share of, µm²: the largest power of any
/// point of the surfaces that use it, so that very low and very high surfaces keep all digits.
/// 0 for flat ones. `own` is the largest power of each set of spectra by itself.
pub(super) fn units_um2(plan: &ScenePlan, own: &[f64]) -> Vec<f64> {
    let mut units = own.to_vec();
    // A surface's four directions share a unit, because their powers are added.
    for textile in &plan.textiles {
        let unit = textile.spectra.iter().map(|&s| own[s]).fold(0.0, f64::max);
        for d in Direction::ALL {
            units[textile.spectra[d.index()]] = unit;
        }
    }
    units
}
