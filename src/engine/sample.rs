//! Pointer samples, and the rules that keep bad ones out.
//!
//! Knows nothing of velocity: what passes here is a series of places whose stamps rise.

use std::time::{Duration, Instant};

use selvedge_foundation::geometry::Point;

/// Where the pointer was, and when.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PointerSample {
    /// When the event arrived (or, from a stream with its own clock, when it says it happened).
    pub stamp: Instant,
    /// The place in the workspace, mm.
    pub position: Point,
}

/// What became of pointer samples since the source was chosen.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct SampleCounters {
    /// Samples that were used.
    pub accepted: u64,
    /// Samples whose time equalled the one before, which they replaced.
    pub replaced: u64,
    /// Samples dropped because their time went back by up to a second.
    pub went_back: u64,
    /// Times that the clock jumped: the estimator forgot everything.
    pub clock_jumps: u64,
    /// Samples dropped because a coordinate was NaN or infinite.
    pub not_finite: u64,
    /// Samples that the full ring had no room for.
    pub overflowed: u64,
    /// Lines of a stream that were not `x,y` or `t,x,y`.
    pub bad_lines: u64,
    /// Times that the system dropped reports of a device before they were read.
    pub lost_in_system: u64,
}

impl SampleCounters {
    /// Adds what became of the samples of another finger; what is lost before anybody looks is of
    /// all fingers already.
    pub(super) fn add(&mut self, other: Self) {
        self.accepted += other.accepted;
        self.replaced += other.replaced;
        self.went_back += other.went_back;
        self.clock_jumps += other.clock_jumps;
        self.not_finite += other.not_finite;
    }
}

/// How far a clock may go back, or run ahead, before it counts as having jumped.
const JUMP: Duration = Duration::from_secs(1);

/// What a sample is to the series.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Verdict {
    /// The next one.
    Append(PointerSample),
    /// A better value of the one before: same time.
    Replace(PointerSample),
    /// The first of a new series: the clock jumped, or nothing came before.
    Restart(PointerSample),
    /// Not usable.
    Drop,
}

/// Lets samples through in rising time, on the engine's clock.
#[derive(Debug, Default)]
pub(super) struct SampleGate {
    last_raw: Option<Instant>,
    /// The source's clock plus `ahead` less `behind` is the engine's.
    ahead: Duration,
    behind: Duration,
    counters: SampleCounters,
}

impl SampleGate {
    /// Judges a sample that is looked at `now`. The stamp of what passes is on the engine's clock.
    pub(super) fn admit(&mut self, sample: PointerSample, now: Instant) -> Verdict {
        if !sample.position.is_finite() {
            self.counters.not_finite += 1;
            return Verdict::Drop;
        }
        let raw = sample.stamp;
        let Some(last) = self.last_raw else {
            return self.restart(sample, now);
        };
        if raw == last {
            self.counters.replaced += 1;
            return Verdict::Replace(self.on_engine_clock(sample, now));
        }
        if raw < last && last - raw <= JUMP {
            self.counters.went_back += 1;
            return Verdict::Drop;
        }
        let shifted = self.on_engine_clock(sample, now);
        if raw < last || shifted.stamp.saturating_duration_since(now) > JUMP {
            self.counters.clock_jumps += 1;
            return self.restart(sample, now);
        }
        self.last_raw = Some(raw);
        self.counters.accepted += 1;
        Verdict::Append(shifted)
    }

    /// Whatever comes next begins a new series.
    pub(super) fn lift(&mut self) {
        self.last_raw = None;
    }

    /// What became of the samples so far.
    pub(super) fn counters(&self) -> SampleCounters {
        self.counters
    }

    /// A stamp that is near the engine's clock is kept; another is taken to mean now.
    fn restart(&mut self, sample: PointerSample, now: Instant) -> Verdict {
        self.last_raw = Some(sample.stamp);
        self.counters.accepted += 1;
        let ahead = now.saturating_duration_since(sample.stamp);
        let behind = sample.stamp.saturating_duration_since(now);
        let is_near = ahead <= JUMP && behind <= JUMP;
        (self.ahead, self.behind) = if is_near {
            Default::default()
        } else {
            (ahead, behind)
        };
        Verdict::Restart(self.on_engine_clock(sample, now))
    }

    fn on_engine_clock(&self, sample: PointerSample, now: Instant) -> PointerSample {
        let shifted = sample.stamp.checked_add(self.ahead);
        let stamp = shifted
            .and_then(|stamp| stamp.checked_sub(self.behind))
            .unwrap_or(now);
        PointerSample { stamp, ..sample }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const HOUR: Duration = Duration::from_hours(1);
    const MS: Duration = Duration::from_millis(1);

    fn sample(stamp: Instant, x_mm: f64) -> PointerSample {
        PointerSample {
            stamp,
            position: Point::new(x_mm, 0.0),
        }
    }

    #[test]
    fn equal_time_replaces_and_going_back_is_dropped() {
        let (start, mut gate) = (Instant::now() + HOUR, SampleGate::default());
        let now = start + 10 * MS;
        let first = sample(start, 1.0);
        assert_eq!(gate.admit(first, now), Verdict::Restart(first));
        let second = sample(start + MS, 2.0);
        assert_eq!(gate.admit(second, now), Verdict::Append(second));
        let better = sample(start + MS, 3.0);
        assert_eq!(gate.admit(better, now), Verdict::Replace(better));
        assert_eq!(gate.admit(sample(start, 4.0), now), Verdict::Drop);
        let third = sample(start + 2 * MS, 5.0);
        assert_eq!(gate.admit(third, now), Verdict::Append(third));
        let counters = gate.counters();
        assert_eq!(
            (counters.accepted, counters.replaced, counters.went_back),
            (3, 1, 1)
        );
    }

    #[test]
    fn a_clock_that_jumps_either_way_restarts_at_the_present_and_goes_on() {
        let start = Instant::now() + 3 * HOUR;
        for jumped in [start + HOUR, start.checked_sub(HOUR).unwrap()] {
            let mut gate = SampleGate::default();
            gate.admit(sample(start, 0.0), start);
            let now = start + 8 * MS;
            assert_eq!(
                gate.admit(sample(jumped, 1.0), now),
                Verdict::Restart(sample(now, 1.0))
            );
            let next = gate.admit(sample(jumped + 8 * MS, 2.0), now + 8 * MS);
            assert_eq!(next, Verdict::Append(sample(now + 8 * MS, 2.0)));
            assert_eq!(gate.counters().clock_jumps, 1);
        }
    }

    #[test]
    fn a_pointer_that_rested_an_hour_did_not_jump() {
        let (start, mut gate) = (Instant::now(), SampleGate::default());
        gate.admit(sample(start, 0.0), start);
        let later = sample(start + HOUR, 1.0);
        assert_eq!(gate.admit(later, start + HOUR), Verdict::Append(later));
        assert_eq!(gate.counters().clock_jumps, 0);
    }

    #[test]
    fn numbers_that_are_none_are_dropped_and_counted() {
        let (start, mut gate) = (Instant::now(), SampleGate::default());
        for x_mm in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            assert_eq!(gate.admit(sample(start, x_mm), start), Verdict::Drop);
        }
        assert_eq!(gate.counters().not_finite, 3);
    }
}
