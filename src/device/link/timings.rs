//! How long things take on a link, counted without locks where they happen and read by anyone.
//!
//! Durations fall into buckets of 1/64 octave from 1 µs, so a percentile is right within 1.1 %.

use selvedge_foundation::numerics::to_whole;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Duration;

const PER_OCTAVE: f64 = 64.0;
/// Up to 2²⁰ µs, about a second; longer ones share the last bucket.
const BUCKETS: usize = 1281;
/// Buckets to a bar of a [`Distribution`]: a quarter of an octave.
const PER_BAR: usize = 16;
const BARS: usize = BUCKETS.div_ceil(PER_BAR);

/// Median, 99th percentile and largest of some durations.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Spread {
    /// How many there were.
    pub n: u64,
    /// Half were at most this long.
    pub median: Duration,
    /// 99 % were at most this long.
    pub p99: Duration,
    /// The longest.
    pub max: Duration,
}

impl Spread {
    /// The spread of a list of durations, exact; all zero when it is empty.
    pub fn of(durations: &mut [Duration]) -> Self {
        durations.sort_unstable();
        let at = |share: f64| {
            let rank = rank(durations.len() as u64, share);
            usize::try_from(rank)
                .ok()
                .and_then(|rank| durations.get(rank.saturating_sub(1)))
        };
        Self {
            n: durations.len() as u64,
            median: at(0.5).copied().unwrap_or_default(),
            p99: at(0.99).copied().unwrap_or_default(),
            max: durations.last().copied().unwrap_or_default(),
        }
    }
}

/// Frame timings of a link.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Timings {
    /// From when the FRAME that answers a STATUS was due (never before that STATUS arrived) to the
    /// end of its write.
    pub due_to_write: Spread,
    /// From the stamp of the input that a frame is made of (a pointer event) to the end of its
    /// write.
    pub stamp_to_write: Spread,
    /// From a PING to its answer.
    pub round_trip: Distribution,
    /// From the end of one FRAME's write to the end of the next, while frames are sent.
    pub frame_interval: Distribution,
}

/// How often durations of each size were met: bars of a quarter of an octave, and their spread.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Distribution {
    /// Median, 99th percentile and longest.
    pub spread: Spread,
    bars: [u32; BARS],
}

/// One bar of a [`Distribution`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct DistributionBar {
    /// Its lower edge; zero for the first.
    pub from: Duration,
    /// Its upper edge.
    pub to: Duration,
    /// How many durations fell into it.
    pub count: u32,
}

impl Default for Distribution {
    fn default() -> Self {
        Self {
            spread: Spread::default(),
            bars: [0; BARS],
        }
    }
}

impl Distribution {
    /// The distribution of a list of durations.
    pub fn of(durations: &[Duration]) -> Self {
        let histogram = Histogram::new();
        for duration in durations {
            histogram.record(*duration);
        }
        histogram.distribution()
    }

    /// From the first bar that is not empty to the last, with the empty ones between.
    pub fn bars(&self) -> impl Iterator<Item = DistributionBar> {
        let first = self.bars.iter().position(|count| *count > 0);
        let last = self.bars.iter().rposition(|count| *count > 0);
        let places = first
            .zip(last)
            .map_or(0..0, |(first, last)| first..last + 1);
        places.map(|bar| DistributionBar {
            from: match bar {
                0 => Duration::ZERO,
                bar => upper_edge(bar * PER_BAR - 1),
            },
            to: upper_edge((bar + 1) * PER_BAR - 1),
            count: self.bars[bar],
        })
    }
}

/// A histogram that one thread fills and others read.
#[derive(Debug)]
pub(super) struct Histogram {
    counts: Vec<AtomicU64>,
    max_ns: AtomicU64,
}

impl Histogram {
    pub(super) fn new() -> Self {
        Self {
            counts: (0..BUCKETS).map(|_| AtomicU64::new(0)).collect(),
            max_ns: AtomicU64::new(0),
        }
    }

    pub(super) fn record(&self, duration: Duration) {
        if let Some(count) = self.counts.get(bucket(duration)) {
            count.fetch_add(1, Ordering::Relaxed);
        }
        let ns = u64::try_from(duration.as_nanos()).unwrap_or(u64::MAX);
        self.max_ns.fetch_max(ns, Ordering::Relaxed);
    }

    pub(super) fn spread(&self) -> Spread {
        self.distribution().spread
    }

    pub(super) fn distribution(&self) -> Distribution {
        // On the stack: an engine asks between two ticks, where nothing may allocate.
        let mut counts = [0_u64; BUCKETS];
        let mut bars = [0_u32; BARS];
        for (bucket, (count, shared)) in counts.iter_mut().zip(&self.counts).enumerate() {
            *count = shared.load(Ordering::Relaxed);
            let bar = &mut bars[bucket / PER_BAR];
            *bar = bar.saturating_add(u32::try_from(*count).unwrap_or(u32::MAX));
        }
        let n = counts.iter().sum();
        let max = Duration::from_nanos(self.max_ns.load(Ordering::Relaxed));
        let at = |share| {
            let mut left = rank(n, share);
            for (bucket, count) in counts.iter().enumerate().filter(|(_, n)| **n > 0) {
                if left <= *count {
                    // As if the durations in a bucket lay evenly in it.
                    return edge(bucket as f64 + left as f64 / *count as f64).min(max);
                }
                left -= count;
            }
            max
        };
        let spread = Spread {
            n,
            median: at(0.5),
            p99: at(0.99),
            max,
        };
        Distribution { spread, bars }
    }
}

/// The rank, from 1, of the smallest value that at least `share` of `n` values do not exceed.
fn rank(n: u64, share: f64) -> u64 {
    to_whole((n as f64 * share).ceil())
}

fn bucket(duration: Duration) -> usize {
    let us = (duration.as_secs_f64() * 1e6).max(1.0);
    to_whole((us.log2() * PER_OCTAVE).clamp(0.0, (BUCKETS - 1) as f64))
}

fn upper_edge(bucket: usize) -> Duration {
    edge(bucket as f64 + 1.0)
}

/// The duration so many buckets above 1 µs.
fn edge(buckets: f64) -> Duration {
    Duration::from_secs_f64((buckets / PER_OCTAVE).exp2() * 1e-6)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn percentiles_are_right_within_a_bucket() {
        let histogram = Histogram::new();
        let mut durations: Vec<Duration> = (1..=10_000)
            .map(|us| Duration::from_micros(us * 3))
            .collect();
        for &duration in &durations {
            histogram.record(duration);
        }
        let (exact, seen) = (Spread::of(&mut durations), histogram.spread());
        assert_eq!((seen.n, seen.max), (exact.n, exact.max));
        for (seen, exact) in [(seen.median, exact.median), (seen.p99, exact.p99)] {
            let ratio = seen.as_secs_f64() / exact.as_secs_f64();
            assert!((0.999..1.011).contains(&ratio), "{ratio}");
        }
    }

    #[test]
    fn no_durations_and_extreme_ones_are_defined() {
        assert_eq!(Histogram::new().spread(), Spread::default());
        assert_eq!(Spread::of(&mut []), Spread::default());
        let histogram = Histogram::new();
        histogram.record(Duration::ZERO);
        histogram.record(Duration::from_secs(9999));
        let spread = histogram.spread();
        assert_eq!((spread.n, spread.max), (2, Duration::from_secs(9999)));
        assert!(spread.median <= Duration::from_micros(2));
    }

    #[test]
    fn bars_hold_every_duration_between_their_edges() {
        let histogram = Histogram::new();
        let durations = [3, 3, 24_990, 25_010, 25_400].map(Duration::from_micros);
        for duration in durations {
            histogram.record(duration);
        }
        let distribution = histogram.distribution();
        let bars: Vec<_> = distribution.bars().collect();
        assert_eq!(bars.iter().map(|bar| bar.count).sum::<u32>(), 5);
        for bar in bars.iter().filter(|bar| bar.count > 0) {
            let within = |d: &&Duration| bar.from <= **d && **d < bar.to;
            let n = u32::try_from(durations.iter().filter(within).count()).unwrap();
            assert_eq!(n, bar.count, "{bar:?}");
        }
        assert!(bars.windows(2).all(|pair| pair[0].to == pair[1].from));
        assert_eq!(Distribution::default().bars().count(), 0);
    }
}
