//! The cloths' motion as the window knows it: what was asked for, what came of it lately, and how
//! fast that goes beside life.
//!
//! They are stepped in the background while the window goes on. One thing is asked for at a time:
//! who cannot keep up runs slower than life.

use std::collections::VecDeque;
use std::sync::Arc;

use crate::bench::background::{Task, finished};
use crate::bench::{Bench, FRAME};
use crate::tools::drape::hung::{Ask, Chosen, Facts, Frame, Lead, Sample};
use crate::tools::drape::stepper::Hanging;
use selvedge_foundation::progress::Progress;

/// The most time that is asked for at once, s: who is slower is slower than life.
const MAX_ASK_S: f64 = 0.05;
/// What is remembered, s.
const KEPT_S: f64 = 20.0;
/// Over what time the pace is told, s, and below which share of life it is.
const PACE_S: f64 = 1.0;
const SLOW: f64 = 0.95;

/// The motion.
#[derive(Default)]
pub(crate) struct Motion {
    /// All that hangs, while it is not being stepped.
    hanging: Box<Hanging>,
    stepping: Option<Task<(Box<Hanging>, Vec<Sample>)>>,
    pub(crate) facts: Arc<Facts>,
    /// The last seconds.
    pub(crate) frames: VecDeque<Arc<Frame>>,
    pub(crate) samples: VecDeque<Sample>,
    pub(crate) n_restarts: u64,
    /// Those of what came last.
    n_restarted: u64,
    /// What was asked for last, while nothing more comes of it.
    rests_with: Option<(Arc<Chosen>, Vec<selvedge_drape::Hand>)>,
    is_resting: bool,
    pub(crate) is_over: bool,
    pace: Pace,
}

/// How much time passed in the window and in the scene.
#[derive(Debug, Default)]
struct Pace {
    asked_at_s: Option<f64>,
    /// Of each ask: when, how long after the one before, for how much.
    asks: VecDeque<[f64; 3]>,
}

impl Motion {
    /// Hangs everything anew: at rest, fingers where they are led first.
    pub(crate) fn restart(&mut self) {
        self.n_restarts += 1;
        self.is_over = false;
    }

    /// Takes what came.
    pub(crate) fn poll(&mut self) {
        match finished(&mut self.stepping) {
            Some(Ok((hanging, samples))) => {
                self.hanging = hanging;
                self.take(samples);
            }
            // What broke off is lost: it is hung anew.
            Some(Err(why)) => {
                self.facts = Arc::new(Facts {
                    refused: Some(why),
                    ..Facts::default()
                });
            }
            None => {}
        }
    }

    /// Lets the scene go on by the time since it was last asked to, if anything comes of that.
    pub(crate) fn follow(&mut self, bench: &Bench, wanted: &Arc<Chosen>, lead: Lead) {
        let ctx = &bench.ctx;
        let hands = match &lead {
            Lead::Towards(hands) => hands.clone(),
            Lead::Along(_) => Vec::new(),
        };
        let is_same = self.rests_with.as_ref() == Some(&(Arc::clone(wanted), hands.clone()));
        let is_still = self.is_resting || self.is_over && hands.is_empty();
        if is_same && is_still && !self.is_under_way() && self.n_restarts == self.n_restarted {
            self.pace = Pace::default();
            return;
        }
        ctx.request_repaint_after(FRAME);
        if self.is_under_way() {
            return;
        }
        let for_s = self.pace.grant(ctx.input(|input| input.time));
        self.rests_with = Some((Arc::clone(wanted), hands));
        let ask = Ask {
            wanted: Arc::clone(wanted),
            lead,
            for_s,
            n_restarts: self.n_restarts,
        };
        let mut hanging = std::mem::take(&mut self.hanging);
        let step = move |_: &mut Progress<'_>| {
            let samples = hanging.go_on(&ask);
            Ok((hanging, samples))
        };
        self.stepping = Some(bench.executor.start("selvedge-drape", step));
    }

    fn take(&mut self, samples: Vec<Sample>) {
        let (hanging, frame) = (&self.hanging, self.hanging.frame());
        let begins_anew = self.frames.back().is_some_and(|last| frame.t_s < last.t_s);
        if self.n_restarted != hanging.n_restarts || begins_anew {
            self.n_restarted = hanging.n_restarts;
            self.frames.clear();
            self.samples.clear();
        }
        let from_s = frame.t_s - KEPT_S;
        self.facts = Arc::clone(&hanging.facts);
        self.is_resting = hanging.is_asleep();
        self.is_over = hanging.is_over;
        self.frames.push_back(Arc::new(frame));
        self.samples.extend(samples);
        let old = self.frames.partition_point(|frame| frame.t_s < from_s);
        self.frames.drain(..old);
        let old = self.samples.partition_point(|sample| sample.t_s < from_s);
        self.samples.drain(..old);
    }

    /// Whether something is still to come.
    pub(crate) fn is_under_way(&self) -> bool {
        self.stepping.is_some()
    }

    /// The instant at a time, or the last one.
    pub(crate) fn frame_at(&self, t_s: Option<f64>) -> Option<&Arc<Frame>> {
        let Some(t_s) = t_s else {
            return self.frames.back();
        };
        let after = self.frames.partition_point(|frame| frame.t_s <= t_s);
        self.frames.get(after.saturating_sub(1))
    }

    /// How fast it goes beside life, if slower.
    pub(crate) fn slower_than_life(&self) -> Option<f64> {
        let asks = self.pace.asks.iter();
        let [passed_s, granted_s] =
            asks.fold([0.0; 2], |sum, ask| [sum[0] + ask[1], sum[1] + ask[2]]);
        let share = granted_s / passed_s;
        (passed_s > 0.5 * PACE_S && share < SLOW).then_some(share)
    }
}

impl Pace {
    /// How much time passes in the scene by now.
    fn grant(&mut self, now_s: f64) -> f64 {
        let passed_s = self.asked_at_s.map_or(0.0, |asked_s| now_s - asked_s);
        self.asked_at_s = Some(now_s);
        let for_s = passed_s.clamp(0.0, MAX_ASK_S);
        self.asks.push_back([now_s, passed_s, for_s]);
        while self.asks.front().is_some_and(|ask| ask[0] < now_s - PACE_S) {
            self.asks.pop_front();
        }
        for_s
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn who_is_asked_seldom_is_slower_than_life_and_told_so() {
        let mut motion = Motion::default();
        for nth in 0..40 {
            motion.pace.grant(f64::from(nth) * 0.033);
        }
        assert_eq!(motion.slower_than_life(), None);
        for nth in 1..20 {
            let for_s = motion.pace.grant(1.3 + f64::from(nth) * 0.1);
            assert!(for_s <= MAX_ASK_S);
        }
        let share = motion.slower_than_life().unwrap();
        assert!((share - 0.5).abs() < 0.01, "{share}");
    }
}
