//! Where powers are tabulated: nodes over log speed, in segments that end where a bin
//! crosses 1 kHz.
//!
//! Between the speeds 1000/(0.23 (k+1)) and 1000/(0.23 k) mm/s exactly k bins sound and powers are
//! smooth; at the ends they jump, so both segments keep a value of their own there. Segments
//! longer than 1/n octave are cut into equal parts.

use crate::single;
use selvedge_foundation::numerics::to_whole;
use selvedge_textile::surface::{BIN_SPACING_PER_MM, N_BINS};
use selvedge_textile::tactile::{
    MAX_FREQUENCY_HZ, MAX_SPEED_MM_PER_S, MIN_SPEED_MM_PER_S, n_audible_bins,
};

/// A node: its speed, and how many bins count there.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Node {
    pub(super) speed_mm_per_s: f64,
    pub(super) n_bins: usize,
    /// The node ends its segment: the last bin sounds at 1 kHz here and still counts.
    pub(super) is_upper_end: bool,
}

/// Where a speed lies: between a node and the next, a share of the way.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Spot {
    pub(super) node: usize,
    pub(super) share: f32,
}

/// From a node to the next of its segment.
#[derive(Debug, Clone, Copy)]
struct Part {
    /// The lowest speed in it, mm/s, and the lowest beyond it.
    start: f64,
    end: f64,
    /// How much of the way over log speed a speed lies along it, by the first, second and third
    /// power of how far it is from the start.
    share_by: [f32; 3],
    node: u32,
}

/// All segments.
#[derive(Debug, Clone)]
pub(super) struct Segments {
    nodes: Vec<Node>,
    /// With rising speed, each beginning where the one before ends.
    parts: Vec<Part>,
    /// For every speed of a few leading bits the part in which it lies; no more than one other
    /// begins before the next.
    leading: Vec<u16>,
    /// How many bits of a speed do not lead, and the leading ones of the lowest.
    n_trailing: u32,
    first: u64,
}

impl Segments {
    /// Segments with parts of at most 1/`per_octave` octave. Nodes are listed with rising speed,
    /// each segment's first and last included.
    pub(super) fn new(per_octave: u32) -> Self {
        let (mut nodes, mut parts) = (Vec::new(), Vec::new());
        for n_bins in (1..=N_BINS).rev() {
            let ends = [lowest_speed(n_bins), speed_at_1_khz(n_bins)];
            let octaves = (ends[1] / ends[0]).log2();
            let n_parts = n_parts(octaves, per_octave);
            for part in 0..=n_parts {
                let share = f64::from(part) / f64::from(n_parts);
                let is_upper_end = part == n_parts;
                let speed_mm_per_s = if is_upper_end {
                    ends[1]
                } else {
                    ends[0] * (octaves * share).exp2()
                };
                if !is_upper_end {
                    let first = first_of(n_bins).filter(|_| part == 0);
                    parts.push(Part {
                        start: first.unwrap_or(speed_mm_per_s),
                        end: f64::INFINITY,
                        share_by: [0.0; 3],
                        node: u32::try_from(nodes.len()).unwrap_or(u32::MAX),
                    });
                }
                nodes.push(Node {
                    speed_mm_per_s,
                    n_bins,
                    is_upper_end,
                });
            }
        }
        let starts: Vec<f64> = parts.iter().map(|part| part.start).collect();
        for (part, end) in parts.iter_mut().zip(&starts[1..]) {
            part.end = *end;
        }
        for part in &mut parts {
            part.bend(&nodes[part.node as usize..][..2]);
        }
        let (leading, n_trailing) = leading(&starts);
        // Every part has one beside it to be compared with.
        parts.extend(parts.last().copied());
        Self {
            nodes,
            parts,
            first: starts[0].to_bits() >> n_trailing,
            leading,
            n_trailing,
        }
    }

    pub(super) fn nodes(&self) -> &[Node] {
        &self.nodes
    }

    /// Where a speed that is felt lies: by its leading bits to within two parts, then by one
    /// comparison. No logarithm and no division.
    #[inline(always)]
    #[expect(
        clippy::inline_always,
        reason = "a turning display does this for every contactor"
    )]
    pub(super) fn find(&self, speed_mm_per_s: f64) -> Spot {
        let leading = (speed_mm_per_s.to_bits() >> self.n_trailing).wrapping_sub(self.first);
        let at = usize::try_from(leading).ok();
        let before = at.and_then(|at| self.leading.get(at));
        let parts = self.parts.get(before.copied().map_or(0, usize::from)..);
        let Some([part, next]) = parts.and_then(|parts| parts.first_chunk()) else {
            return Spot::default();
        };
        let part = if speed_mm_per_s >= part.end {
            next
        } else {
            part
        };
        Spot {
            node: part.node as usize,
            share: part.share(speed_mm_per_s),
        }
    }
}

impl Part {
    /// Fits a cubic to the logarithm between two nodes: right at both ends, in slope too.
    fn bend(&mut self, nodes: &[Node]) {
        let [start, end] = [nodes[0].speed_mm_per_s, nodes[1].speed_mm_per_s];
        let length = end - start;
        let slope = length / (end / start).ln();
        let slopes = [slope / start, slope / end];
        self.start = start.max(self.start);
        self.share_by = [
            slopes[0] / length,
            (3.0 - 2.0 * slopes[0] - slopes[1]) / length.powi(2),
            (slopes[0] + slopes[1] - 2.0) / length.powi(3),
        ]
        .map(single);
    }

    /// How much of the way over log speed a speed lies along it.
    #[inline(always)]
    #[expect(clippy::inline_always, reason = "a part of finding a speed")]
    fn share(&self, speed_mm_per_s: f64) -> f32 {
        let along = single(speed_mm_per_s - self.start);
        let [first, second, third] = self.share_by;
        (along * (first + along * (second + along * third))).min(1.0)
    }
}

/// The lowest speed at which exactly so many bins sound, to the last bit; `None` of the slowest,
/// which begin where nothing is felt below.
fn first_of(n_bins: usize) -> Option<f64> {
    if n_bins >= N_BINS {
        return None;
    }
    let mut speed = speed_at_1_khz(n_bins + 1);
    let is_audible = |speed: f64| n_audible_bins(speed) > n_bins;
    while is_audible(speed) {
        speed = speed.next_up();
    }
    while !is_audible(speed.next_down()) {
        speed = speed.next_down();
    }
    Some(speed)
}

/// For every speed of a few leading bits the part in which it lies: of as few bits as leave no more
/// than one part to begin before the next. And how many bits trail.
fn leading(starts: &[f64]) -> (Vec<u16>, u32) {
    const EXPONENT_BITS: u32 = 11;
    let is_apart = |n_trailing: &u32| {
        let mut cells = starts.iter().map(|start| start.to_bits() >> n_trailing);
        let mut before = cells.next();
        cells.all(|cell| before.replace(cell) != Some(cell))
    };
    let n_trailing = (0..u64::BITS - EXPONENT_BITS)
        .rev()
        .find(is_apart)
        .unwrap_or(0);
    let first = starts[0].to_bits() >> n_trailing;
    let last = MAX_SPEED_MM_PER_S.to_bits() >> n_trailing;
    let mut part = 0;
    let lowest = |cell: u64| f64::from_bits(cell << n_trailing);
    let cells = (first..=last).map(|cell| {
        while starts
            .get(part + 1)
            .is_some_and(|next| *next <= lowest(cell))
        {
            part += 1;
        }
        u16::try_from(part).unwrap_or(u16::MAX)
    });
    (cells.collect(), n_trailing)
}

/// The speed at which bin k sounds at 1 kHz, mm/s.
fn speed_at_1_khz(k: usize) -> f64 {
    MAX_FREQUENCY_HZ / (BIN_SPACING_PER_MM * k as f64)
}

/// The lowest speed at which exactly so many bins sound.
fn lowest_speed(n_bins: usize) -> f64 {
    if n_bins == N_BINS {
        MIN_SPEED_MM_PER_S
    } else {
        speed_at_1_khz(n_bins + 1)
    }
}

fn n_parts(octaves: f64, per_octave: u32) -> u32 {
    // A hair less, so that a segment of just 1/n octave stays in one part.
    to_whole((octaves * f64::from(per_octave) - 1e-9).ceil().max(1.0))
}

/// Whether a speed is one that a table covers.
#[cfg(test)]
fn is_felt(speed_mm_per_s: f64) -> bool {
    (MIN_SPEED_MM_PER_S..MAX_SPEED_MM_PER_S).contains(&speed_mm_per_s)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn speeds_around_every_end() -> Vec<f64> {
        let ends = (1..=N_BINS).map(speed_at_1_khz).chain([MIN_SPEED_MM_PER_S]);
        let around = ends.flat_map(|v| [v.next_down(), v, v.next_up(), v * 0.9999, v * 1.0001]);
        around.filter(|&v| is_felt(v)).collect()
    }

    #[test]
    fn a_speed_lies_between_its_nodes() {
        for per_octave in [24, 48, 64, 384] {
            let segments = Segments::new(per_octave);
            let all_along = std::iter::successors(Some(MIN_SPEED_MM_PER_S), |v| Some(v * 1.000_31));
            for v in speeds_around_every_end()
                .into_iter()
                .chain(all_along.take_while(|v| is_felt(*v)))
            {
                let spot = segments.find(v);
                let (low, high) = (segments.nodes[spot.node], segments.nodes[spot.node + 1]);
                assert_eq!(
                    (low.n_bins, high.n_bins),
                    (n_audible_bins(v), n_audible_bins(v))
                );
                let log = low.speed_mm_per_s.log2()
                    + f64::from(spot.share) * (high.speed_mm_per_s / low.speed_mm_per_s).log2();
                assert!((log - v.log2()).abs() < 2e-8, "{v} mm/s: {spot:?}");
                let octaves = (high.speed_mm_per_s / low.speed_mm_per_s).log2();
                assert!(octaves < 1.000_001 / f64::from(per_octave), "{octaves}");
            }
        }
    }

    #[test]
    fn upper_ends_are_where_the_last_bin_reaches_a_kilohertz() {
        let segments = Segments::new(24);
        for pair in segments.nodes.windows(2) {
            if pair[0].is_upper_end {
                assert_eq!(pair[0].speed_mm_per_s, pair[1].speed_mm_per_s);
                assert_eq!(pair[0].n_bins, pair[1].n_bins + 1);
            } else {
                assert!(pair[0].speed_mm_per_s < pair[1].speed_mm_per_s, "{pair:?}");
            }
        }
        assert!(segments.nodes.len() < 1500, "{}", segments.nodes.len());
    }
}
