//! Tables of spectra along a profile of usual length: a node of all points is made when a tick
//! first needs it of one.
//!
//! Contactors that share a velocity read many points at one speed, so that the points of a node
//! stand beside each other and are made together: of at most [`MAX_POINTS`] points, which bounds
//! what a first touch costs.

use std::sync::Arc;

use super::nodes::Making;
use super::segments::Spot;
use selvedge_textile::surface::LocalSpectra;

/// Most points of a profile whose nodes are made for all of them: 64 mm.
const MAX_POINTS: usize = 64;
/// Points that are summed together.
const POINTS: usize = 4;

/// One set of spectra over all nodes.
#[derive(Debug, Clone)]
pub(crate) struct RowTable {
    spectra: Arc<LocalSpectra>,
    unit_um2: f64,
    pub(super) n_points: usize,
    /// Bins beyond this are 0 at every point.
    n_bins: usize,
    /// Node by node a row of points; a power is `[40 Hz, 320 Hz]` in units of the textile's. Zeros
    /// as the system hands them out where a node is not made.
    powers: Vec<[f32; 2]>,
    is_made: Vec<bool>,
    /// Whether a node and the next are made.
    has_both: Vec<bool>,
}

/// A direction at one speed: the rows before and after, and the share of the way between.
#[derive(Clone, Copy)]
pub(super) struct Rows<'a> {
    before: &'a [[f32; 2]],
    after: &'a [[f32; 2]],
    share: f32,
}

impl RowTable {
    /// Whether spectra are tabulated this way.
    pub(crate) fn suits(spectra: &LocalSpectra) -> bool {
        !spectra.is_areal() && spectra.n_points() <= MAX_POINTS
    }

    /// Nothing made yet, with room for all.
    pub(super) fn new(spectra: &Arc<LocalSpectra>, unit_um2: f64, n_nodes: usize) -> Self {
        let n_points = spectra.n_points();
        let n_heard = |point: usize| {
            let powers_um2 = spectra.powers_um2(point);
            let last = powers_um2.iter().rposition(|power| *power != 0.0);
            last.map_or(0, |last| last + 1)
        };
        Self {
            spectra: Arc::clone(spectra),
            unit_um2,
            n_points,
            n_bins: (0..n_points).map(n_heard).max().unwrap_or(0),
            powers: vec![[0.0; 2]; n_points * n_nodes],
            is_made: vec![false; n_nodes],
            has_both: vec![false; n_nodes],
        }
    }

    /// Bytes set aside.
    pub(super) fn n_bytes(&self) -> usize {
        size_of_val(&self.powers[..])
    }

    /// The rows around a speed; those that are missing are made, and counted.
    #[inline]
    pub(super) fn rows(&mut self, spot: Spot, making: Making<'_>) -> Rows<'_> {
        if !self.has_both[spot.node] {
            self.make(spot.node, making);
        }
        let rows = &self.powers[spot.node * self.n_points..][..2 * self.n_points];
        let (before, after) = rows.split_at(self.n_points);
        Rows {
            before,
            after,
            share: spot.share,
        }
    }

    /// Adds the powers of a point at a speed; nodes that are missing are made, and counted.
    #[inline(always)]
    #[expect(
        clippy::inline_always,
        reason = "a turning display does this for every contactor"
    )]
    pub(super) fn add_at(
        &mut self,
        point: usize,
        spot: Spot,
        making: Making<'_>,
        power: &mut [f32; 2],
    ) {
        if !self.has_both[spot.node] {
            self.make(spot.node, making);
        }
        let first = spot.node * self.n_points + point;
        let nodes = [first, first + self.n_points].map(|at| self.powers.get(at));
        if let [Some([a, b]), Some([c, d])] = nodes {
            power[0] += a + (c - a) * spot.share;
            power[1] += b + (d - b) * spot.share;
        }
    }

    /// Makes a node and the next, as far as they are missing.
    #[cold]
    #[inline(never)]
    fn make(&mut self, first: usize, (gains, counters): Making<'_>) {
        self.has_both[first] = true;
        for node in first..first + 2 {
            if std::mem::replace(&mut self.is_made[node], true) {
                continue;
            }
            let row = &mut self.powers[node * self.n_points..][..self.n_points];
            let of_point = |point: usize| &self.spectra.powers_um2(point)[..self.n_bins];
            let (together, alone) = row.as_chunks_mut::<POINTS>();
            let n_together = together.len() * POINTS;
            for (first, slots) in (0..).step_by(POINTS).zip(together) {
                let points = std::array::from_fn(|i| of_point(first + i));
                let (powers, n_bins) = gains.powers(node, points, self.unit_um2);
                *slots = powers;
                counters.bins_evaluated += (2 * POINTS * n_bins) as u64;
            }
            for (point, slot) in (n_together..).zip(alone) {
                let ([power], n_bins) = gains.powers(node, [of_point(point)], self.unit_um2);
                *slot = power;
                counters.bins_evaluated += 2 * n_bins as u64;
            }
            counters.nodes_made += self.n_points as u64;
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::array::bin_gains::BinGains;
    use crate::array::table::Grid;
    use crate::array::table::nodes::NodeGains;
    use crate::plan::Counters;
    use selvedge_foundation::numerics::Random;
    use selvedge_textile::surface::{Direction, Profile, ProfileSet, Surface};
    use selvedge_textile::tactile::Filters;

    /// Spectra of a rough profile with so many points.
    fn spectra(n_points: usize) -> Arc<LocalSpectra> {
        let mut random = Random::new(4);
        let heights = (0..1000 + 230 * (n_points - 1)).map(|_| random.normal());
        let mut profiles = ProfileSet::default();
        profiles[0] = Some(Profile::new(1.0 / 230.0, heights.collect()).unwrap());
        let surface = Surface::from_profiles(profiles, 0.0).unwrap();
        Arc::clone(surface.spectra(Direction::WarpForward))
    }

    #[test]
    fn nodes_are_the_bits_of_a_table_made_at_once_in_whatever_order_they_are_touched() {
        let spectra = spectra(18);
        assert_eq!(spectra.n_points(), 18, "four groups, and two alone");
        let unit_um2 = spectra.largest_um2();
        for filters in [Filters::default(), Filters::Receptor] {
            let grid = Grid::new(&filters, 0.05);
            let nodes = grid.segments.nodes();
            let (mut table, mut gains) = (
                RowTable::new(&spectra, unit_um2, nodes.len()),
                NodeGains::new(&grid.segments, &filters),
            );
            let (mut random, mut counters) = (Random::new(5), Counters::default());
            for _ in 0..60 {
                let node = random.index(nodes.len() - 1);
                let spot = Spot { node, share: 0.0 };
                let rows = table.rows(spot, (&mut gains, &mut counters));
                let found = [rows.before, rows.after].concat();
                // Every power by itself, from gains of its own.
                let expected = [node, node + 1].into_iter().flat_map(|node| {
                    let mut own = vec![[0.0; 2]; nodes[node].n_bins];
                    BinGains::new(&filters).fill(nodes[node].speed_mm_per_s, 0, &mut own);
                    let spectra = &spectra;
                    (0..18).map(move |point| {
                        let mut sums = [0.0; 2];
                        for (power, gain) in spectra.powers_um2(point).iter().zip(&own) {
                            (0..2).for_each(|band| sums[band] += power * gain[band]);
                        }
                        sums.map(|sum| {
                            let share = 2.0 * sum / unit_um2;
                            let is_told = share >= f64::from(f32::MIN_POSITIVE);
                            if is_told { crate::single(share) } else { 0.0 }
                        })
                    })
                });
                let bits = |power: [f32; 2]| power.map(f32::to_bits);
                assert!(found.into_iter().map(bits).eq(expected.map(bits)), "{node}");
            }
            let n_made = counters.nodes_made;
            assert!(n_made > 18 * 60 && n_made <= 18 * 120, "{n_made}");
            let nothing = table.is_made.iter().filter(|is_made| !**is_made).count();
            assert!(
                nothing > nodes.len() - 121,
                "what nobody touched is not made"
            );
        }
    }

    #[test]
    fn profiles_of_usual_length_have_rows_and_longer_ones_do_not() {
        assert!(RowTable::suits(&spectra(1)) && RowTable::suits(&spectra(MAX_POINTS)));
        assert!(!RowTable::suits(&spectra(MAX_POINTS + 1)));
    }
}
