//! Making nodes: the power gains of the filters at a node's speed, and the powers that they leave
//! of points, when a tick first needs them.
//!
//! Memory for all nodes is set aside when preparing; nothing is computed then. What a node holds
//! depends on its speed and its spectra alone, so it is the same whenever and by whomever it is
//! made.

use std::sync::Arc;

use super::segments::Segments;
use crate::array::bin_gains::{self, BinGains};
use crate::plan::Counters;
use crate::single;
use selvedge_textile::tactile::Filters;

/// The power gains of both bands for every bin that counts at every node that was used.
#[derive(Debug, Clone)]
pub(super) struct NodeGains {
    segments: Arc<Segments>,
    making: BinGains,
    /// Where each node's gains begin, and after the last where they end.
    first: Vec<usize>,
    /// Zeros as the system hands them out where a node was not used yet.
    gains: Vec<[f64; 2]>,
    is_made: Vec<bool>,
}

/// What a node is made with, and who counts it.
pub(super) type Making<'a> = (&'a mut NodeGains, &'a mut Counters);

impl NodeGains {
    pub(super) fn new(segments: &Arc<Segments>, filters: &Filters) -> Self {
        let mut first = vec![0];
        for node in segments.nodes() {
            first.push(first[first.len() - 1] + node.n_bins);
        }
        Self {
            segments: Arc::clone(segments),
            making: BinGains::new(filters),
            gains: vec![[0.0; 2]; first[first.len() - 1]],
            is_made: vec![false; segments.nodes().len()],
            first,
        }
    }

    /// Bytes set aside.
    pub(super) fn n_bytes(&self) -> usize {
        size_of_val(&self.gains[..]) + size_of_val(&self.first[..])
    }

    /// The powers of some points at a node, `[2 Σ P H_40², 2 Σ P H_320²]` in this unit, µm², and
    /// over how many bins of each.
    pub(super) fn powers<const N: usize>(
        &mut self,
        node: usize,
        powers_um2: [&[f64]; N],
        unit_um2: f64,
    ) -> ([[f32; 2]; N], usize) {
        let gains = &mut self.gains[self.first[node]..self.first[node + 1]];
        if !self.is_made[node] {
            let speed_mm_per_s = self.segments.nodes()[node].speed_mm_per_s;
            self.making.fill(speed_mm_per_s, 0, gains);
            self.is_made[node] = true;
        }
        let sums = bin_gains::sums(powers_um2, gains);
        let shares = sums.map(|sums| sums.map(|sum| share_of(2.0 * sum, unit_um2)));
        (shares, gains.len().min(powers_um2[0].len()))
    }
}

/// A power in units of `unit_um2` as it is stored; what f32 could hold with fewer digits only is
/// silence, and so is all of a surface without a power.
fn share_of(power_um2: f64, unit_um2: f64) -> f32 {
    let share = power_um2 / unit_um2;
    if share >= f64::from(f32::MIN_POSITIVE) {
        single(share)
    } else {
        0.0
    }
}
