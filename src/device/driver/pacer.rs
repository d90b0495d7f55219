//! When to tick: once for every tick of the device while they come, at the moment that the link
//! asks for; by an own clock, where one is wanted, while they do not.
//!
//! The answer to a device tick may be due later than its announcement, so that what it tells is
//! young when it is felt. A tick that is put off so is done before anything else is.
//!
//! A device tick that is 12 ms overdue (37 ms after the last) is given up and the own clock ticks
//! in its stead, every 25 ms from there, until a device tick comes again. Which STATUS is a tick
//! that paces, and which tick the device is in, is the word of the session, which stamps frames
//! too: one that was ticked for, by whichever clock, is never ticked for again, and no clock that
//! runs away is followed. Pure: it is told what time it is.

use std::time::{Duration, Instant};

use super::TICK;
use crate::handle::Bridge;
use crate::host::{BridgeEvent, LONGEST_JUMP};

/// How long a device tick may be overdue.
const PATIENCE: Duration = Duration::from_millis(12);
/// No device ticks faster in the long run: 4 %. Ticks whose news was held up may come a whole tick
/// closer than that.
const FASTEST: Duration = Duration::from_millis(24);
/// News that are heard in one turn: a flood of them must not keep anything else waiting.
const MAX_NEWS: usize = 256;

/// Decides when to tick.
#[derive(Debug)]
pub struct Pacer {
    own: Option<OwnClock>,
    /// When the tick that answers the last device tick is due, until it is done.
    put_off: Option<Instant>,
    /// The device's tick at the last tick.
    answered: Option<u32>,
    /// When the next device tick comes at the earliest, if none before was held up.
    earliest: Option<Instant>,
    missed: u64,
}

#[derive(Debug, Clone, Copy)]
struct OwnClock {
    due: Instant,
    is_device_paced: bool,
    fallbacks: u64,
}

impl Pacer {
    /// A pacer that waits for its device.
    pub fn waiting() -> Self {
        Self {
            own: None,
            put_off: None,
            answered: None,
            earliest: None,
            missed: 0,
        }
    }

    /// A pacer whose own clock ticks from `start` on while no device does.
    pub fn with_own_clock(start: Instant) -> Self {
        Self {
            own: Some(OwnClock {
                due: start,
                is_device_paced: false,
                fallbacks: 0,
            }),
            ..Self::waiting()
        }
    }

    /// Takes the news of a device, if there is one, and says whether a tick is due, and since when.
    /// Ticks are not told to `hear`.
    pub fn turn(
        &mut self,
        bridge: Option<&mut Bridge>,
        now: Instant,
        hear: &mut dyn FnMut(BridgeEvent),
    ) -> Option<Instant> {
        let Some(bridge) = bridge else {
            return self.due(now, None);
        };
        for _ in 0..MAX_NEWS {
            match bridge.poll() {
                Some(BridgeEvent::Tick { received, due }) => self.announce(received, due),
                Some(event) => {
                    if matches!(event, BridgeEvent::Lost(_) | BridgeEvent::Refused(_)) {
                        self.forget_device();
                    }
                    hear(event);
                }
                None => break,
            }
        }
        self.due(now, bridge.session().present_tick(now))
    }

    /// A STATUS that paces arrived; its answer is `due` then or later.
    pub(super) fn announce(&mut self, received: Instant, due: Instant) {
        self.put_off = Some(due.max(received));
        if let Some(own) = &mut self.own {
            own.due = received + TICK + PATIENCE;
            own.is_device_paced = true;
        }
    }

    /// Whether a tick is due, and since when; the device, if its clock is known, is in the
    /// `present` tick.
    pub(super) fn due(&mut self, now: Instant, present: Option<u32>) -> Option<Instant> {
        if let Some(due) = self.put_off.take_if(|due| *due <= now) {
            let is_early = self.earliest.is_some_and(|earliest| now + TICK < earliest);
            if !is_early && self.is_new(present) {
                self.ticks(now, present);
                return Some(due);
            }
        }
        let own = self.own.as_mut().filter(|own| own.due <= now)?;
        // Ticks that were slept through are not caught up on: their time has passed.
        let n_slept = (now - own.due).as_nanos() / TICK.as_nanos();
        let n_slept = u32::try_from(n_slept).unwrap_or(u32::MAX);
        let due = own.due + TICK * n_slept;
        own.due = due + TICK;
        own.fallbacks += u64::from(own.is_device_paced);
        own.is_device_paced = false;
        self.put_off = None;
        if present.is_none() {
            self.missed += u64::from(n_slept);
        }
        self.ticks(now, present.filter(|_| self.is_new(present)));
        Some(due)
    }

    /// Whether no tick was done for this tick of the device. One from further away than a gap is of
    /// a clock that began anew, which comes by no tick a second time.
    fn is_new(&self, present: Option<u32>) -> bool {
        let span = present.zip(self.answered);
        span.is_none_or(|(present, answered)| {
            let step = present.wrapping_sub(answered).cast_signed();
            step > 0 || step.unsigned_abs() > LONGEST_JUMP
        })
    }

    /// A tick is done, for this tick of the device.
    fn ticks(&mut self, now: Instant, present: Option<u32>) {
        let earliest = self.earliest.map_or(now, |earliest| earliest.max(now));
        self.earliest = Some(earliest + FASTEST);
        if let Some((present, answered)) = present.zip(self.answered) {
            let n_steps = present.wrapping_sub(answered);
            if n_steps <= LONGEST_JUMP {
                self.missed += u64::from(n_steps.saturating_sub(1));
            }
        }
        self.answered = present.or(self.answered);
    }

    /// The device is gone: the own clock goes on one tick after the last.
    pub fn forget_device(&mut self) {
        if let Some(own) = &mut self.own {
            if own.is_device_paced {
                own.due -= PATIENCE;
            }
            own.is_device_paced = false;
        }
        self.put_off = None;
        self.answered = None;
    }

    /// When there is something to do if nothing is heard before; `None` without an own clock and
    /// without a tick that is to be answered.
    pub fn deadline(&self) -> Option<Instant> {
        let own = self.own.map(|own| own.due);
        self.put_off.into_iter().chain(own).min()
    }

    /// Whether the device paces, and not the own clock.
    pub fn is_device_paced(&self) -> bool {
        self.own.is_none_or(|own| own.is_device_paced)
    }

    /// Ticks of the device, or of the own clock, that never were because it was too late for them.
    pub fn missed(&self) -> u64 {
        self.missed
    }

    /// Times that the own clock took over.
    pub fn fallbacks(&self) -> u64 {
        self.own.map_or(0, |own| own.fallbacks)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const MS: Duration = Duration::from_millis(1);

    /// A pacer with an own clock and a device whose ticks are whole 25 ms from `start` on.
    struct Bench {
        pacer: Pacer,
        start: Instant,
        first: u32,
    }

    impl Bench {
        fn new(first: u32) -> Self {
            let start = Instant::now();
            Self {
                pacer: Pacer::with_own_clock(start + TICK + PATIENCE),
                start,
                first,
            }
        }

        fn number(&self, at: Duration) -> u32 {
            let n = at.as_nanos() / TICK.as_nanos();
            self.first.wrapping_add(u32::try_from(n).unwrap())
        }

        /// News of the device's present tick arrive at this time, to be answered `held` later.
        fn news(&mut self, at: Duration, held: Duration) -> Option<Duration> {
            let received = self.start + at;
            self.pacer.announce(received, received + held);
            self.at(at)
        }

        /// What is due at this time.
        fn at(&mut self, at: Duration) -> Option<Duration> {
            let due = self.pacer.due(self.start + at, Some(self.number(at)))?;
            Some(due - self.start)
        }

        fn deadline(&self) -> Duration {
            self.pacer.deadline().unwrap() - self.start
        }
    }

    #[test]
    fn without_a_device_it_ticks_on_absolute_deadlines() {
        let start = Instant::now();
        let mut pacer = Pacer::with_own_clock(start);
        for k in 0..100 {
            let due = start + TICK * k;
            let before = due.checked_sub(Duration::from_nanos(1)).unwrap();
            assert_eq!(pacer.due(before, None), None);
            // However late it wakes, the next deadline does not drift.
            assert_eq!(pacer.due(due + MS * (k % 20), None), Some(due));
        }
        assert_eq!((pacer.missed(), pacer.fallbacks()), (0, 0));
    }

    #[test]
    fn ticks_slept_through_are_counted_and_not_caught_up_on() {
        let start = Instant::now();
        let mut pacer = Pacer::with_own_clock(start);
        assert_eq!(pacer.due(start, None), Some(start));
        let awake = start + 80 * MS;
        assert_eq!(pacer.due(awake, None), Some(start + 75 * MS));
        assert_eq!(pacer.due(awake, None), None);
        let next = Some(start + 100 * MS);
        assert_eq!((pacer.missed(), pacer.deadline()), (2, next));
    }

    #[test]
    fn device_ticks_pace_and_a_missing_one_is_given_up_after_37_ms() {
        let mut bench = Bench::new(7);
        for number in 0..10 {
            let received = TICK * number + MS * (number % 3);
            assert_eq!(bench.news(received, Duration::ZERO), Some(received));
            assert_eq!(bench.deadline(), received + 37 * MS);
            assert_eq!(bench.at(received + 24 * MS), None);
        }
        let last = TICK * 9;
        assert_eq!(bench.at(last + 36 * MS), None);
        assert_eq!(bench.at(last + 37 * MS), Some(last + 37 * MS));
        assert!(!bench.pacer.is_device_paced());
        assert_eq!(bench.at(last + 62 * MS), Some(last + 62 * MS));
        assert_eq!((bench.pacer.missed(), bench.pacer.fallbacks()), (0, 1));
    }

    #[test]
    fn a_device_tick_that_the_own_clock_stood_in_for_is_not_ticked_again() {
        let mut bench = Bench::new(1);
        assert!(bench.news(Duration::ZERO, Duration::ZERO).is_some());
        assert!(bench.at(37 * MS).is_some());
        assert_eq!(bench.news(40 * MS, Duration::ZERO), None, "15 ms late");
        assert!(bench.pacer.is_device_paced());
        assert!(bench.news(50 * MS, Duration::ZERO).is_some());
        // Two lost: own ticks stand in, and the third is a tick of its own.
        assert!(bench.at(87 * MS).is_some());
        assert!(bench.at(112 * MS).is_some());
        assert!(bench.news(125 * MS, Duration::ZERO).is_some());
        assert_eq!((bench.pacer.missed(), bench.pacer.fallbacks()), (0, 2));
    }

    #[test]
    fn device_ticks_without_a_tick_are_missed_and_a_reboot_is_not() {
        let mut bench = Bench::new(u32::MAX);
        bench.pacer.own = None;
        assert!(bench.news(Duration::ZERO, Duration::ZERO).is_some());
        assert!(bench.news(75 * MS, Duration::ZERO).is_some());
        assert_eq!(bench.pacer.missed(), 2, "the number wraps");
        assert_eq!(bench.news(76 * MS, Duration::ZERO), None, "again the same");
        for (first, number) in [(4_000_000, 4), (7, 5), (50, 7)] {
            bench.first = first;
            for number in number..number + 2 {
                let tick = bench.news(TICK * number, Duration::ZERO);
                assert!(tick.is_some(), "tick {number} of a clock at {first}");
            }
        }
        assert_eq!(bench.pacer.missed(), 2);
    }

    #[test]
    fn a_clock_that_runs_away_speeds_nothing_up() {
        let start = Instant::now();
        let mut pacer = Pacer::waiting();
        let mut n_ticks = 0;
        // Four ticks of the device in one of ours, for ten seconds.
        for number in 0..1600 {
            let now = start + TICK * number / 4;
            pacer.announce(now, now);
            n_ticks += u32::from(pacer.due(now, Some(number)).is_some());
        }
        assert!((400..=420).contains(&n_ticks), "{n_ticks} in 400 ticks");
    }

    #[test]
    fn news_that_were_held_up_and_come_at_once_are_one_tick() {
        let mut bench = Bench::new(10);
        bench.pacer.own = None;
        assert!(bench.news(Duration::ZERO, Duration::ZERO).is_some());
        let ticks = (11..15).filter_map(|number| {
            let at = 100 * MS + MS / 4 * (number - 11);
            bench.news(at, Duration::ZERO)
        });
        assert_eq!(ticks.count(), 1);
        assert_eq!(bench.pacer.missed(), 3);
        assert!(bench.news(125 * MS, Duration::ZERO).is_some());
    }

    #[test]
    fn a_forgotten_device_leaves_no_longer_wait() {
        let mut bench = Bench::new(1);
        assert!(bench.news(Duration::ZERO, Duration::ZERO).is_some());
        bench.pacer.forget_device();
        assert_eq!(bench.at(TICK), Some(TICK));
        let fallbacks = bench.pacer.fallbacks();
        assert_eq!(
            fallbacks, 0,
            "the device was let go, it did not fall silent"
        );
    }

    #[test]
    fn a_tick_that_is_put_off_is_done_when_it_is_due() {
        let mut bench = Bench::new(0);
        for number in 0..10 {
            let received = TICK * number;
            let due = received + 17 * MS;
            assert_eq!(bench.news(received, 17 * MS), None);
            assert_eq!(bench.deadline(), due);
            assert_eq!(bench.at(received + 16 * MS), None);
            assert_eq!(bench.at(due + MS), Some(due));
            assert_eq!(bench.at(received + 24 * MS), None);
        }
        // The eleventh never comes: 12 ms after it should have, the own clock ticks.
        let given_up = TICK * 9 + 37 * MS;
        assert_eq!(bench.deadline(), given_up);
        assert_eq!(bench.at(given_up), Some(given_up));
        assert_eq!((bench.pacer.missed(), bench.pacer.fallbacks()), (0, 1));
    }

    #[test]
    fn a_tick_that_was_put_off_and_overtaken_by_the_next_is_missed() {
        let mut bench = Bench::new(1);
        assert!(bench.news(Duration::ZERO, Duration::ZERO).is_some());
        assert_eq!(bench.news(TICK, 17 * MS), None);
        let next = 2 * TICK;
        assert_eq!(bench.news(next, 17 * MS), None);
        assert_eq!(bench.at(next + 17 * MS), Some(next + 17 * MS));
        assert_eq!(bench.pacer.missed(), 1);
        assert_eq!(bench.news(next + TICK, 17 * MS), None);
        bench.pacer.forget_device();
        assert_eq!(
            bench.deadline(),
            next + 2 * TICK,
            "nothing is to be answered"
        );
    }
}
