//! Meters of the tick: a histogram of lateness, a running median of cost. Fixed size, no clock.

use std::time::Duration;

use selvedge_device::Spread;
use selvedge_foundation::numerics::to_whole;

/// Buckets to an octave: a quantile is at most 9 % too high.
const PER_OCTAVE: usize = 8;
/// The first bucket ends at 2⁻⁴ µs, the last octave at 2 s.
const LOWEST_OCTAVE: f64 = -4.0;
const N_OCTAVES: usize = 25;
const N_BUCKETS: usize = PER_OCTAVE * N_OCTAVES + 1;
/// Ticks over which the median cost is taken: 1.6 s.
const RECENT: usize = 64;

/// How often each duration was met, in buckets of an eighth of an octave from 62.5 ns to 2 s.
/// Fixed size: it is copied into every snapshot.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct DurationHistogram {
    counts: [u32; N_BUCKETS],
    n: u64,
    max: Duration,
}

/// A bucket of a [`DurationHistogram`].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct DurationBucket {
    /// Its lower end; zero for the first.
    pub from: Duration,
    /// Its upper end, which belongs to it.
    pub to: Duration,
    /// How often.
    pub count: u32,
}

impl Default for DurationHistogram {
    fn default() -> Self {
        Self {
            counts: [0; N_BUCKETS],
            n: 0,
            max: Duration::ZERO,
        }
    }
}

impl DurationHistogram {
    /// Adds a duration. Allocates nothing.
    pub fn add(&mut self, duration: Duration) {
        let count = &mut self.counts[bucket_of(duration)];
        *count = count.saturating_add(1);
        self.n += 1;
        self.max = self.max.max(duration);
    }

    /// How many were added.
    pub fn n(&self) -> u64 {
        self.n
    }

    /// What was added since this histogram was as `earlier`; its largest is that of its highest
    /// bucket that is not empty, at most the largest of all.
    #[must_use]
    pub fn since(&self, earlier: &Self) -> Self {
        let mut counts = self.counts;
        for (count, before) in counts.iter_mut().zip(earlier.counts) {
            *count = count.saturating_sub(before);
        }
        let highest = counts.iter().rposition(|count| *count > 0);
        Self {
            counts,
            n: self.n.saturating_sub(earlier.n),
            max: highest.map_or(Duration::ZERO, |bucket| upper_end(bucket).min(self.max)),
        }
    }

    /// The buckets that are not empty, from short to long.
    pub fn buckets(&self) -> impl Iterator<Item = DurationBucket> {
        let filled = self.counts.iter().enumerate().filter(|(_, n)| **n > 0);
        filled.map(|(bucket, &count)| DurationBucket {
            from: bucket.checked_sub(1).map_or(Duration::ZERO, upper_end),
            to: upper_end(bucket),
            count,
        })
    }

    /// Median, 99th percentile and largest. Quantiles are the upper ends of their buckets, never
    /// above the largest.
    pub fn spread(&self) -> Spread {
        Spread {
            n: self.n,
            median: self.quantile(50),
            p99: self.quantile(99),
            max: self.max,
        }
    }

    fn quantile(&self, percent: u64) -> Duration {
        let rank = (self.n * percent).div_ceil(100);
        let mut seen = 0;
        for (bucket, count) in self.counts.iter().enumerate() {
            seen += u64::from(*count);
            if seen >= rank && seen > 0 {
                return upper_end(bucket).min(self.max);
            }
        }
        self.max
    }
}

fn bucket_of(duration: Duration) -> usize {
    let us = duration.as_secs_f64() * 1e6;
    if us <= LOWEST_OCTAVE.exp2() {
        return 0;
    }
    to_whole::<usize>(((us.log2() - LOWEST_OCTAVE) * PER_OCTAVE as f64).ceil()).min(N_BUCKETS - 1)
}

fn upper_end(bucket: usize) -> Duration {
    Duration::from_secs_f64((bucket as f64 / PER_OCTAVE as f64 + LOWEST_OCTAVE).exp2() * 1e-6)
}

/// The median of the last few costs.
#[derive(Debug)]
pub(super) struct RecentMedian {
    recent_ns: [u64; RECENT],
    n: usize,
}

impl RecentMedian {
    pub(super) fn new() -> Self {
        Self {
            recent_ns: [0; RECENT],
            n: 0,
        }
    }

    pub(super) fn add(&mut self, cost: Duration) {
        self.recent_ns[self.n % RECENT] = u64::try_from(cost.as_nanos()).unwrap_or(u64::MAX);
        self.n += 1;
    }

    /// The median, ns; 0 before the first.
    pub(super) fn median_ns(&self) -> u64 {
        let n = self.n.min(RECENT);
        if n == 0 {
            return 0;
        }
        let mut sorted = self.recent_ns;
        let (_, median, _) = sorted[..n].select_nth_unstable(n / 2);
        *median
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantiles_are_within_a_bucket_and_the_largest_is_exact() {
        let mut histogram = DurationHistogram::default();
        assert_eq!(histogram.spread().p99, Duration::ZERO);
        for us in 1..=1000 {
            histogram.add(Duration::from_micros(us));
        }
        let spread = histogram.spread();
        let within = |found: Duration, exact_us: f64| {
            let ratio = found.as_secs_f64() * 1e6 / exact_us;
            assert!((1.0..1.1).contains(&ratio), "{found:?} for {exact_us} µs");
        };
        within(spread.median, 500.0);
        within(spread.p99, 990.0);
        assert_eq!((spread.n, spread.max), (1000, Duration::from_millis(1)));
    }

    #[test]
    fn durations_beyond_the_last_bucket_count_as_the_largest() {
        let mut histogram = DurationHistogram::default();
        histogram.add(Duration::from_hours(1));
        histogram.add(Duration::ZERO);
        assert_eq!(histogram.spread().n, 2);
        assert_eq!(histogram.spread().max, Duration::from_hours(1));
    }

    #[test]
    fn what_came_since_is_told_apart_and_buckets_hold_their_durations() {
        let mut histogram = DurationHistogram::default();
        let us = |us: u64| Duration::from_nanos(us * 1000 + 1);
        (0..5).for_each(|_| histogram.add(us(900)));
        let before = histogram;
        (0..3).for_each(|_| histogram.add(us(7)));
        histogram.add(Duration::from_nanos(90));
        let since = histogram.since(&before);
        assert_eq!(since.n(), 4);
        let counts: Vec<u32> = since.buckets().map(|bucket| bucket.count).collect();
        assert_eq!(counts, [1, 3]);
        for (bucket, held) in since.buckets().zip([Duration::from_nanos(90), us(7)]) {
            assert!(bucket.from < held && held <= bucket.to, "{bucket:?}");
        }
        assert!(since.spread().max < us(8), "{:?}", since.spread());
        assert_eq!(before.since(&before).spread().max, Duration::ZERO);
    }

    #[test]
    fn the_median_cost_forgets_what_is_long_past() {
        let mut median = RecentMedian::new();
        assert_eq!(median.median_ns(), 0);
        for _ in 0..100 {
            median.add(Duration::from_micros(9));
        }
        for _ in 0..RECENT {
            median.add(Duration::from_nanos(70));
        }
        assert_eq!(median.median_ns(), 70);
    }
}
