//! Pointer samples with equal times, with times that go back, and a clock that jumps.

use std::time::{Duration, Instant};

use super::case::{Case, Verdict, cases, failed, verdict};
use super::tuning::engine;
use selvedge_engine::{Engine, PointerSample, PointerSender, SampleCounters, TICK};
use selvedge_foundation::geometry::Point;

/// Between two samples.
const PACE: Duration = Duration::from_millis(5);

/// Samples of a pointer.
pub(super) fn cases() -> Vec<Case> {
    cases! { "pointer";
        "two samples with equal times" => "the later one replaces", equal_times;
        "a sample whose time goes back" => "dropped and counted", going_back;
        "a clock that jumps by an hour" =>
            "the estimator begins anew: one silent tick", jump_of_an_hour;
        "a place of NaN" => "dropped and counted", place_of_nan;
    }
}

/// An engine whose pointer moves at 100 mm/s.
struct Hand {
    engine: Engine,
    pointer: PointerSender,
    start: Instant,
    n_ticks: u32,
}

impl Hand {
    fn new() -> Result<Self, String> {
        let (mut engine, start) = engine()?;
        let pointer = engine.take_pointer().ok_or_else(|| failed("no pointer"))?;
        Ok(Self {
            engine,
            pointer,
            start,
            n_ticks: 0,
        })
    }

    /// Moves for some ticks, with a pointer whose clock is `ahead`; tells which ticks sounded.
    fn stroke(&mut self, n_ticks: u32, ahead: Duration) -> Vec<bool> {
        let mut sounded = Vec::new();
        for _ in 0..n_ticks {
            let from = TICK * self.n_ticks;
            for step in 0..5 {
                let since = from + PACE * step;
                let x_mm = 30.0 + 100.0 * since.as_secs_f64();
                self.push(self.start + ahead + since, x_mm);
            }
            self.n_ticks += 1;
            sounded.push(self.tick());
        }
        sounded
    }

    fn push(&mut self, stamp: Instant, x_mm: f64) {
        let position = Point::new(x_mm, 50.0);
        self.pointer.push(PointerSample { stamp, position });
    }

    /// Ticks; tells whether anything sounds.
    fn tick(&mut self) -> bool {
        self.engine.advance(self.start + TICK * self.n_ticks);
        let contactors = &self.engine.snapshot().displays[0].contactors;
        contactors
            .iter()
            .any(|contactor| contactor.amplitude_um != [0.0; 2])
    }

    fn counters(&mut self) -> SampleCounters {
        self.engine.snapshot().pointer.samples
    }
}

fn equal_times() -> Verdict {
    let mut hand = Hand::new()?;
    hand.stroke(4, Duration::ZERO);
    let stamp = hand.start + TICK * hand.n_ticks + PACE;
    hand.push(stamp, 41.0);
    hand.push(stamp, 42.0);
    hand.n_ticks += 1;
    hand.tick();
    let at_mm = hand.engine.snapshot().pose.position.x_mm;
    let n = hand.counters().replaced;
    let came_back = format!("the later one counts, {n} replaced");
    verdict(at_mm == 42.0 && n == 1, came_back)
}

fn going_back() -> Verdict {
    let mut hand = Hand::new()?;
    hand.stroke(4, Duration::ZERO);
    let before_mm = hand.engine.snapshot().pose.position.x_mm;
    hand.push(hand.start + TICK, 90.0);
    hand.n_ticks += 1;
    hand.tick();
    let after_mm = hand.engine.snapshot().pose.position.x_mm;
    let n = hand.counters().went_back;
    let came_back = format!("dropped, {n} counted");
    verdict(before_mm == after_mm && n == 1, came_back)
}

fn jump_of_an_hour() -> Verdict {
    let mut hand = Hand::new()?;
    hand.stroke(6, Duration::ZERO);
    let after = hand.stroke(6, Duration::from_hours(1));
    let n_silent = after.iter().filter(|sounded| !**sounded).count();
    let n_jumps = hand.counters().clock_jumps;
    let is_kept = n_jumps == 1 && n_silent == 1 && !after[0];
    let came_back = format!("{n_jumps} jump, {n_silent} silent tick, then it sounds again");
    verdict(is_kept, came_back)
}

fn place_of_nan() -> Verdict {
    let mut hand = Hand::new()?;
    hand.stroke(4, Duration::ZERO);
    hand.push(hand.start + TICK * hand.n_ticks, f64::NAN);
    hand.n_ticks += 1;
    hand.tick();
    let is_finite = hand.engine.snapshot().pose.position.is_finite();
    let n = hand.counters().not_finite;
    verdict(is_finite && n == 1, format!("dropped, {n} counted"))
}
