//! Meters of the tick: a histogram of lateness, a running median of cost. Fixed size, no clock.

use std::time::Duration;

use crate::bridge::Spread;

/// Buckets to an octave: a quantile is at most 9 % too high.
const PER_OCTAVE: usize = 8;
/// The first bucket ends at 1 µs, the last octave at 2 s.
const N_OCTAVES: usize = 21;
const N_BUCKETS: usize = PER_OCTAVE * N_OCTAVES + 1;
/// Ticks over which the median cost is taken: 1.6 s.
const RECENT: usize = 64;

/// How often each duration was met.
#[derive(Debug)]
pub(super) struct Histogram {
    counts: [u64; N_BUCKETS],
    n: u64,
    max: Duration,
}

impl Histogram {
    pub(super) fn new() -> Self {
        Self {
            counts: [0; N_BUCKETS],
            n: 0,
            max: Duration::ZERO,
        }
    }

    pub(super) fn add(&mut self, duration: Duration) {
        self.counts[bucket_of(duration)] += 1;
        self.n += 1;
        self.max = self.max.max(duration);
    }

    /// Median, 99th percentile and largest. Quantiles are the upper ends of their buckets, never
    /// above the largest.
    pub(super) fn spread(&self) -> Spread {
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
            seen += count;
            if seen >= rank && seen > 0 {
                return upper_end(bucket).min(self.max);
            }
        }
        self.max
    }
}

fn bucket_of(duration: Duration) -> usize {
    let us = duration.as_secs_f64() * 1e6;
    if us <= 1.0 {
        return 0;
    }
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a logarithm of a number above 1, below 1000"
    )]
    let bucket = (us.log2() * PER_OCTAVE as f64).ceil() as usize;
    bucket.min(N_BUCKETS - 1)
}

fn upper_end(bucket: usize) -> Duration {
    Duration::from_secs_f64((bucket as f64 / PER_OCTAVE as f64).exp2() * 1e-6)
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
        let mut histogram = Histogram::new();
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
        let mut histogram = Histogram::new();
        histogram.add(Duration::from_hours(1));
        histogram.add(Duration::ZERO);
        assert_eq!(histogram.spread().n, 2);
        assert_eq!(histogram.spread().max, Duration::from_hours(1));
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
