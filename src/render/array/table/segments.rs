//! Where powers are tabulated: nodes over log speed, in segments that end where a bin
//! crosses 1 kHz.
//!
//! Between the speeds 1000/(0.23 (k+1)) and 1000/(0.23 k) mm/s exactly k bins sound and powers are
//! smooth; at the ends they jump, so both segments keep a value of their own there. Segments
//! longer than 1/n octave are cut into equal parts.

use crate::plan::whole_part;
use selvedge_foundation::numerics::to_whole;
use selvedge_textile::surface::{BIN_SPACING_PER_MM, N_BINS};
use selvedge_textile::tactile::{MAX_FREQUENCY_HZ, MIN_SPEED_MM_PER_S};

/// The segment in which k bins sound.
#[derive(Debug, Clone, Copy, Default)]
struct Segment {
    /// log₂ of its lowest speed.
    start: f64,
    /// Parts per octave, so that parts are one unit long.
    parts_per_octave: f64,
    n_parts: u32,
    first_node: u32,
}

/// A node: its speed, and how many bins count there.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Node {
    pub(super) speed_mm_per_s: f64,
    pub(super) n_bins: usize,
    /// The node ends its segment: the last bin sounds at 1 kHz here and still counts.
    pub(super) is_upper_end: bool,
}

/// Where a speed lies: between a node and the next, a share of the way.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Spot {
    pub(super) node: usize,
    pub(super) share: f32,
}

/// All segments, by the number of bins that sound; slot 0 is not used.
#[derive(Debug, Clone)]
pub(super) struct Segments {
    segments: Box<[Segment; N_BINS + 1]>,
    nodes: Vec<Node>,
}

impl Segments {
    /// Segments with parts of at most 1/`per_octave` octave. Nodes are listed with rising speed,
    /// each segment's first and last included.
    pub(super) fn new(per_octave: u32) -> Self {
        let mut segments = Box::new([Segment::default(); N_BINS + 1]);
        let mut nodes = Vec::new();
        for n_bins in (1..=N_BINS).rev() {
            let ends = [lowest_speed(n_bins), speed_at_1_khz(n_bins)];
            let start = ends[0].log2();
            let octaves = (ends[1] / ends[0]).log2();
            let n_parts = n_parts(octaves, per_octave);
            segments[n_bins] = Segment {
                start,
                parts_per_octave: f64::from(n_parts) / octaves,
                n_parts,
                first_node: u32::try_from(nodes.len()).unwrap_or(u32::MAX),
            };
            for part in 0..=n_parts {
                let share = f64::from(part) / f64::from(n_parts);
                let is_upper_end = part == n_parts;
                nodes.push(Node {
                    speed_mm_per_s: if is_upper_end {
                        ends[1]
                    } else {
                        ends[0] * (octaves * share).exp2()
                    },
                    n_bins,
                    is_upper_end,
                });
            }
        }
        Self { segments, nodes }
    }

    pub(super) fn nodes(&self) -> &[Node] {
        &self.nodes
    }

    /// Where a speed that is felt lies.
    #[inline]
    pub(super) fn find(&self, speed_mm_per_s: f64) -> Spot {
        let segment = &self.segments[n_audible(speed_mm_per_s)];
        let at = (log2(speed_mm_per_s) - segment.start) * segment.parts_per_octave;
        let part = whole_part(at.max(0.0)).min(segment.n_parts - 1);
        let share = (at - f64::from(part)).clamp(0.0, 1.0);
        Spot {
            node: (segment.first_node + part) as usize,
            share: crate::single(share),
        }
    }
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

/// How many bins sound at a speed that is felt: [`selvedge_textile::tactile::n_audible_bins`]
/// without a loop.
#[inline]
fn n_audible(speed_mm_per_s: f64) -> usize {
    let spacing_hz = speed_mm_per_s * BIN_SPACING_PER_MM;
    let quotient = whole_part((MAX_FREQUENCY_HZ / spacing_hz).min(N_BINS as f64));
    // The quotient may be one off either way: the comparison that defines the limit decides.
    let is_audible = |k: u32| spacing_hz * f64::from(k) < MAX_FREQUENCY_HZ;
    let more = u32::from(is_audible(quotient + 1));
    let less = u32::from(!is_audible(quotient));
    ((quotient + more - less) as usize).clamp(1, N_BINS)
}

/// log₂ of a positive normal number, within 1e-10: the exponent, and
/// `ln((1 + s)/(1 − s)) = 2 (s + s³/3 + s⁵/5 + …)` for the mantissa in √½…√2.
#[inline]
pub(super) fn log2(x: f64) -> f64 {
    const SQRT_HALF_BITS: u64 = std::f64::consts::FRAC_1_SQRT_2.to_bits();
    const SCALE: f64 = 2.0 * std::f64::consts::LOG2_E;
    let exponent = x.to_bits().wrapping_sub(SQRT_HALF_BITS).cast_signed() >> 52;
    let mantissa = f64::from_bits(x.to_bits().wrapping_sub((exponent << 52).cast_unsigned()));
    let s = (mantissa - 1.0) / (mantissa + 1.0);
    let q = s * s;
    let q2 = q * q;
    // Pairs instead of a chain: half of the waiting for one product after another.
    let pairs = [
        1.0 + q * (1.0 / 3.0),
        1.0 / 5.0 + q * (1.0 / 7.0),
        1.0 / 9.0 + q * (1.0 / 11.0),
    ];
    let even = pairs[0] + q2 * (pairs[1] + q2 * pairs[2]);
    exponent as f64 + SCALE * s * even
}

/// Whether a speed is one that a table covers.
#[cfg(test)]
fn is_felt(speed_mm_per_s: f64) -> bool {
    (MIN_SPEED_MM_PER_S..selvedge_textile::tactile::MAX_SPEED_MM_PER_S).contains(&speed_mm_per_s)
}

#[cfg(test)]
mod tests {
    use super::*;
    use selvedge_textile::tactile::n_audible_bins;

    fn speeds_around_every_end() -> Vec<f64> {
        let ends = (1..=N_BINS).map(speed_at_1_khz).chain([MIN_SPEED_MM_PER_S]);
        let around = ends.flat_map(|v| [v.next_down(), v, v.next_up(), v * 0.9999, v * 1.0001]);
        around.filter(|&v| is_felt(v)).collect()
    }

    #[test]
    fn the_fast_logarithm_is_within_a_ten_billionth() {
        let mut x = 1e-300;
        while x < 1e300 {
            assert!(
                (log2(x) - x.log2()).abs() < 1e-10 * (1.0 + 1e-3 * x.log2().abs()),
                "{x}"
            );
            x *= 1.000_7;
        }
        assert_eq!([log2(1.0), log2(2.0), log2(0.25)], [0.0, 1.0, -2.0]);
    }

    #[test]
    fn the_segment_is_that_of_the_bins_that_sound() {
        let mut v = MIN_SPEED_MM_PER_S;
        while is_felt(v) {
            assert_eq!(n_audible(v), n_audible_bins(v), "{v}");
            v *= 1.000_31;
        }
        for v in speeds_around_every_end() {
            assert_eq!(n_audible(v), n_audible_bins(v), "{v}");
        }
    }

    #[test]
    fn a_speed_lies_between_its_nodes() {
        for per_octave in [24, 48, 64] {
            let segments = Segments::new(per_octave);
            for v in speeds_around_every_end()
                .into_iter()
                .chain([0.3, 17.0, 100.0, 1999.9])
            {
                let spot = segments.find(v);
                let (low, high) = (segments.nodes[spot.node], segments.nodes[spot.node + 1]);
                assert_eq!(
                    (low.n_bins, high.n_bins),
                    (n_audible_bins(v), n_audible_bins(v))
                );
                let log = low.speed_mm_per_s.log2()
                    + f64::from(spot.share) * (high.speed_mm_per_s / low.speed_mm_per_s).log2();
                assert!((log - v.log2()).abs() < 2e-9, "{v} mm/s: {spot:?}");
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
