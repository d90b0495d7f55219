//! The samples of a live source: judged, remembered, and what follows from them at a tick.

use std::time::{Duration, Instant};

use super::input::{InputLosses, RateMeter};
use super::sample::{SampleCounters, SampleGate, Verdict};
use super::velocity::{Estimate, REST, VelocityEstimator};
use super::{InputRate, PointerSample, PointerView, TICK, VelocityMethod};
use selvedge_foundation::geometry::Point;

/// The samples of a source and what follows from them.
#[derive(Debug)]
pub(super) struct Track {
    gate: SampleGate,
    estimator: VelocityEstimator,
    newest: Option<PointerSample>,
    /// The stamp of the newest sample, if it came for this tick.
    fresh: Option<Instant>,
    estimate: Estimate,
    age: Option<Duration>,
    rate: RateMeter,
    is_lifted: bool,
}

impl Track {
    /// A track without samples. Nothing here allocates.
    pub(super) fn new(method: VelocityMethod) -> Self {
        Self {
            gate: SampleGate::default(),
            estimator: VelocityEstimator::new(method),
            newest: None,
            fresh: None,
            estimate: Estimate::REST,
            age: None,
            rate: RateMeter::default(),
            is_lifted: false,
        }
    }

    /// Begins anew with the same method.
    pub(super) fn forget(&mut self) {
        *self = Self::new(self.estimator.method());
    }

    /// The finger left the surface: at rest, and what comes next is a new series.
    pub(super) fn lift(&mut self) {
        self.gate.lift();
        self.estimator.reset();
        self.estimate = Estimate::REST;
        self.age = None;
        self.rate.pause();
        self.is_lifted = true;
    }

    /// What comes from here on is fresh.
    pub(super) fn begin_tick(&mut self) {
        self.fresh = None;
    }

    /// Takes a sample; true if it began a new series.
    pub(super) fn take(&mut self, sample: PointerSample, now: Instant) -> bool {
        let verdict = self.gate.admit(sample, now);
        let (sample, restarted) = match verdict {
            Verdict::Drop => return false,
            Verdict::Append(sample) | Verdict::Replace(sample) => (sample, false),
            Verdict::Restart(sample) => (sample, true),
        };
        self.is_lifted = false;
        if restarted {
            self.estimator.reset();
            self.rate.pause();
        }
        if matches!(verdict, Verdict::Replace(_)) {
            self.estimator.replace(sample);
        } else {
            self.estimator.push(sample);
            self.rate.add(sample.stamp, sample.position);
        }
        self.newest = Some(sample);
        self.fresh = Some(sample.stamp);
        restarted
    }

    /// Estimates at a tick. One in which the series began anew is silent, whatever followed.
    pub(super) fn look(&mut self, now: Instant, restarted: bool) {
        self.estimate = if restarted {
            Estimate::REST
        } else {
            self.estimator.estimate(now)
        };
        let age = (self.newest.filter(|_| !self.is_lifted))
            .map(|newest| now.saturating_duration_since(newest.stamp));
        self.age = age.filter(|age| *age <= REST);
    }

    /// Whether the finger is off the surface.
    pub(super) fn is_lifted(&self) -> bool {
        self.is_lifted
    }

    /// What became of the samples.
    pub(super) fn samples(&self) -> SampleCounters {
        self.gate.counters()
    }

    /// Where the newest sample is.
    pub(super) fn position(&self) -> Option<Point> {
        self.newest.map(|newest| newest.position)
    }

    /// The velocity at the last tick.
    pub(super) fn estimate(&self) -> Estimate {
        self.estimate
    }

    /// The stamp of the newest sample, if it came for the last tick.
    pub(super) fn fresh_stamp(&self) -> Option<Instant> {
        self.fresh
    }

    /// How steadily samples come.
    pub(super) fn rate(&self) -> InputRate {
        self.rate.rate()
    }

    /// What a snapshot shows. `until_felt` is how long after a tick the middle of that comes in
    /// which a device plays it; without a device that is half a tick.
    pub(super) fn view(&self, losses: InputLosses, until_felt: Option<Duration>) -> PointerView {
        let mut samples = self.samples();
        samples.overflowed = losses.overflowed;
        samples.bad_lines = losses.bad_lines;
        samples.lost_in_system = losses.lost_in_system;
        let until_felt = until_felt.unwrap_or(TICK / 2);
        PointerView {
            is_known: self.newest.is_some(),
            age: self.age,
            felt_age: self.age.map(|age| age + until_felt),
            method: self.estimator.method(),
            velocity_lag_s: self.estimate.lag_s,
            is_lifted: self.is_lifted,
            rate: self.rate.rate(),
            samples,
        }
    }
}
