//! Filling tables: powers of all points of all spectra at every node.
//!
//! This is a product of two matrices, spectra × bins by bins × nodes, computed in f64: the
//! filter's gains at a few nodes serve every point of every textile before they are forgotten.

use super::segments::Node;
use crate::array::reference::bin_frequency_hz;
use crate::single;
use selvedge_textile::surface::LocalSpectra;
use selvedge_textile::tactile::{Band, Filters};

/// Points that are summed together.
const POINTS: usize = 4;
/// Nodes that are summed together.
const NODES: usize = 2;

/// Spectra laid out for the product: groups of [`POINTS`] points, bin by bin.
struct Grouped {
    n_points: usize,
    /// Bins beyond this are 0 at every point.
    n_bins: usize,
    groups: Vec<[f64; POINTS]>,
}

impl Grouped {
    /// Powers as shares of a unit, which is 0 only if all powers are.
    fn of(spectra: &LocalSpectra, unit_um2: f64) -> Self {
        let n_points = spectra.n_points();
        let is_silent = |bin: &usize| (0..n_points).all(|p| spectra.powers_um2(p)[*bin] == 0.0);
        let n_bins = (0..spectra.n_bins())
            .rev()
            .find(|bin| !is_silent(bin))
            .map_or(0, |bin| bin + 1);
        let mut groups = vec![[0.0; POINTS]; n_points.div_ceil(POINTS) * n_bins];
        for point in 0..n_points {
            let group = &mut groups[point / POINTS * n_bins..][..n_bins];
            for (slot, power) in group.iter_mut().zip(spectra.powers_um2(point)) {
                slot[point % POINTS] = power / unit_um2;
            }
        }
        Self {
            n_points,
            n_bins,
            groups,
        }
    }
}

/// The tables of spectra, each with the unit its powers are stored in, µm²: for every node a row
/// of points, for every point `[2 Σ P H_40², 2 Σ P H_320²]` in that unit.
pub(super) fn tables_of(
    nodes: &[Node],
    spectra: &[(&LocalSpectra, f64)],
    filters: &Filters,
) -> Vec<Vec<[f32; 2]>> {
    let grouped: Vec<Grouped> = spectra
        .iter()
        .map(|(s, unit)| Grouped::of(s, *unit))
        .collect();
    let table = |g: &Grouped| vec![[0.0; 2]; g.n_points * nodes.len()];
    let mut tables: Vec<Vec<[f32; 2]>> = grouped.iter().map(table).collect();
    let n_bins = grouped.iter().map(|g| g.n_bins).max().unwrap_or(0);
    let mut gains = vec![[[0.0; 2]; NODES]; n_bins];
    for (batch, pair) in nodes.chunks(NODES).enumerate() {
        let n_used = fill_gains(&mut gains, pair, filters);
        for (spectra, table) in grouped.iter().zip(&mut tables) {
            let n_bins = n_used.min(spectra.n_bins);
            let first = batch * NODES * spectra.n_points;
            let rows = &mut table[first..first + pair.len() * spectra.n_points];
            fill_rows(rows, spectra, &gains[..n_bins]);
        }
    }
    tables
}

/// The power gains of both bands for every bin at some nodes, 0 for bins that do not count there.
/// Returns how many bins count.
fn fill_gains(gains: &mut [[[f64; 2]; NODES]], nodes: &[Node], filters: &Filters) -> usize {
    let n_used = nodes
        .iter()
        .map(|node| node.n_bins)
        .max()
        .unwrap_or(0)
        .min(gains.len());
    for (slot, of_bin) in gains[..n_used].iter_mut().enumerate() {
        for (node, gain) in nodes.iter().zip(of_bin) {
            let frequency_hz = bin_frequency_hz(node.speed_mm_per_s, slot + 1);
            let is_counted = slot < node.n_bins;
            *gain = Band::ALL.map(|band| {
                if is_counted {
                    filters.power_gain(band, frequency_hz)
                } else {
                    0.0
                }
            });
        }
    }
    n_used
}

fn fill_rows(rows: &mut [[f32; 2]], spectra: &Grouped, gains: &[[[f64; 2]; NODES]]) {
    if spectra.n_bins == 0 {
        return;
    }
    for (group, powers) in spectra.groups.chunks_exact(spectra.n_bins).enumerate() {
        let sums = product(powers, gains);
        for (row, sums) in rows.chunks_exact_mut(spectra.n_points).zip(sums) {
            let points = row[group * POINTS..].iter_mut();
            for (stored, sums) in points.zip(sums) {
                *stored = sums.map(|sum| normal(2.0 * sum));
            }
        }
    }
}

/// The power gains of both bands for every bin that counts at every node: what the tables of areal
/// spectra are made with, node by node.
#[derive(Debug, Clone)]
pub(super) struct NodeGains {
    /// Where each node's gains begin, and after the last where they end.
    first: Vec<usize>,
    gains: Vec<[f64; 2]>,
}

impl NodeGains {
    pub(super) fn new(nodes: &[Node], filters: &Filters) -> Self {
        let (mut first, mut gains) = (vec![0], Vec::new());
        for node in nodes {
            let gain_of = |k: usize| {
                let frequency_hz = bin_frequency_hz(node.speed_mm_per_s, k);
                Band::ALL.map(|band| filters.power_gain(band, frequency_hz))
            };
            gains.extend((1..=node.n_bins).map(gain_of));
            first.push(gains.len());
        }
        Self { first, gains }
    }

    pub(super) fn n_nodes(&self) -> usize {
        self.first.len() - 1
    }

    pub(super) fn n_bytes(&self) -> usize {
        size_of_val(&self.gains[..]) + size_of_val(&self.first[..])
    }

    /// `Σ_k P_k H_b(f_k)²` at a node, µm², and over how many bins.
    pub(super) fn sums(&self, node: usize, powers_um2: &[f64]) -> ([f64; 2], usize) {
        let gains = &self.gains[self.first[node]..self.first[node + 1]];
        let mut sums = [0.0; 2];
        for (power, gains) in powers_um2.iter().zip(gains) {
            sums[0] += power * gains[0];
            sums[1] += power * gains[1];
        }
        (sums, gains.len().min(powers_um2.len()))
    }
}

/// `Σ_k P[k][point]·H²[k][node][band]`.
fn product(powers: &[[f64; POINTS]], gains: &[[[f64; 2]; NODES]]) -> [[[f64; 2]; POINTS]; NODES] {
    let mut sums = [[[0.0; 2]; POINTS]; NODES];
    for (powers, gains) in powers.iter().zip(gains) {
        for (sums, gains) in sums.iter_mut().zip(gains) {
            for (sum, power) in sums.iter_mut().zip(powers) {
                sum[0] += power * gains[0];
                sum[1] += power * gains[1];
            }
        }
    }
    sums
}

/// A power as it is stored; what f32 could hold with fewer digits only is silence.
pub(super) fn normal(power: f64) -> f32 {
    if power < f64::from(f32::MIN_POSITIVE) {
        0.0
    } else {
        single(power)
    }
}
