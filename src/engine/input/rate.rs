//! How steadily a source reports: its rate, its jitter, and gaps in the middle of a movement.
//!
//! Judged from the stamps of the last samples. A finger that rests may say nothing for as long as
//! it likes; a gap counts when the finger moved on across it.

use std::time::{Duration, Instant};

use selvedge_foundation::geometry::Point;

/// Intervals that are looked at: some seconds of a tablet.
const N_INTERVALS: usize = 256;
/// Intervals that are needed to say anything.
const FEWEST: usize = 16;
/// Intervals between two looks.
const LOOK_EVERY: usize = 32;
/// A gap is longer than so many usual intervals …
const GAP: f64 = 3.0;
/// … over which the finger moved by at least this much, mm.
const MOVED_MM: f64 = 0.5;
/// A longer silence is a pause.
const PAUSE: Duration = Duration::from_millis(250);

/// How steadily a source reports.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct InputRate {
    /// Reports a second: one over the median interval. 0 before anything is known.
    pub rate_hz: f64,
    /// How far intervals lie from the median: the 95th percentile of the distance, ms.
    pub jitter_ms: f64,
    /// Gaps in the middle of a movement.
    pub dropouts: u64,
}

/// Measures the rate of a source. Allocates nothing.
#[derive(Debug)]
pub(crate) struct RateMeter {
    intervals_s: [f64; N_INTERVALS],
    n_seen: usize,
    last: Option<(Instant, Point)>,
    rate: InputRate,
}

impl Default for RateMeter {
    fn default() -> Self {
        Self {
            intervals_s: [0.0; N_INTERVALS],
            n_seen: 0,
            last: None,
            rate: InputRate::default(),
        }
    }
}

impl RateMeter {
    /// Takes a sample whose stamp follows that of the last.
    pub(crate) fn add(&mut self, stamp: Instant, position: Point) {
        let Some((last, from)) = self.last.replace((stamp, position)) else {
            return;
        };
        let interval = stamp.saturating_duration_since(last);
        if interval > PAUSE {
            return;
        }
        let interval_s = interval.as_secs_f64();
        let usual_s = if self.rate.rate_hz > 0.0 {
            1.0 / self.rate.rate_hz
        } else {
            f64::INFINITY
        };
        let moved_mm = (position.x_mm - from.x_mm).hypot(position.y_mm - from.y_mm);
        if interval_s > GAP * usual_s && moved_mm >= MOVED_MM {
            self.rate.dropouts += 1;
        }
        self.intervals_s[self.n_seen % N_INTERVALS] = interval_s;
        self.n_seen += 1;
        if self.n_seen >= FEWEST && self.n_seen.is_multiple_of(LOOK_EVERY.min(self.n_seen)) {
            self.look();
        }
    }

    /// What comes next does not follow what came last.
    pub(crate) fn pause(&mut self) {
        self.last = None;
    }

    /// What is known so far.
    pub(crate) fn rate(&self) -> InputRate {
        self.rate
    }

    fn look(&mut self) {
        let mut sorted = self.intervals_s;
        let known = &mut sorted[..self.n_seen.min(N_INTERVALS)];
        known.sort_unstable_by(f64::total_cmp);
        let median_s = known[known.len() / 2];
        for interval_s in known.iter_mut() {
            *interval_s = (*interval_s - median_s).abs();
        }
        known.sort_unstable_by(f64::total_cmp);
        let jitter_s = known[(known.len() * 19 / 20).min(known.len() - 1)];
        self.rate.rate_hz = if median_s > 0.0 { 1.0 / median_s } else { 0.0 };
        self.rate.jitter_ms = 1e3 * jitter_s;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A meter after samples at these times, ms, of a finger at 100 mm/s.
    fn after(times_ms: impl IntoIterator<Item = f64>) -> InputRate {
        let (start, mut meter) = (Instant::now(), RateMeter::default());
        for t_ms in times_ms {
            let stamp = start + Duration::from_secs_f64(t_ms / 1e3);
            meter.add(stamp, Point::new(0.1 * t_ms, 0.0));
        }
        meter.rate()
    }

    #[test]
    fn a_steady_tablet_has_its_rate_and_no_jitter() {
        let rate = after((0..200).map(|n| f64::from(n) * 5.0));
        assert!((rate.rate_hz - 200.0).abs() < 0.01, "{rate:?}");
        assert!(rate.jitter_ms < 1e-3 && rate.dropouts == 0, "{rate:?}");
        assert_eq!(
            after([0.0, 5.0, 10.0]),
            InputRate::default(),
            "too few to tell"
        );
    }

    #[test]
    fn jitter_is_how_far_intervals_lie_from_the_usual() {
        let times = (0..300).map(|n| f64::from(n) * 5.0 + if n % 2 == 0 { 0.0 } else { 1.0 });
        let rate = after(times);
        // Intervals alternate between 4 and 6 ms.
        assert!((rate.jitter_ms - 2.0).abs() < 0.01, "{rate:?}");
    }

    #[test]
    fn a_gap_counts_in_a_movement_and_not_at_rest() {
        let steady = (0..100).map(|n| f64::from(n) * 5.0);
        let late = (0..50).map(|n| 540.0 + f64::from(n) * 5.0);
        assert_eq!(after(steady.clone().chain(late)).dropouts, 1);
        let pause = (0..50).map(|n| 2000.0 + f64::from(n) * 5.0);
        assert_eq!(after(steady.chain(pause)).dropouts, 0, "a pause is no gap");
        let (start, mut meter) = (Instant::now(), RateMeter::default());
        for n in 0..100_u64 {
            let t_ms = if n < 60 { 5 * n } else { 5 * n + 100 };
            meter.add(start + Duration::from_millis(t_ms), Point::new(1.0, 1.0));
        }
        assert_eq!(meter.rate().dropouts, 0, "it did not move");
    }
}
