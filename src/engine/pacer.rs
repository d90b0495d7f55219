//! When to tick: once for every tick of the device while they come, at the moment that the link
//! asks for; by an own clock while they do not.
//!
//! The answer to a device tick may be due later than its announcement, so that what it tells is
//! young when it is felt. A tick that is put off so is done before anything else is.
//!
//! A device tick that is 12 ms overdue (37 ms after the last) is given up and the own clock ticks
//! in its stead, every 25 ms from there, until a device tick comes again. One that comes within
//! 12 ms of an own tick is the one that this tick stood in for: it is answered, not ticked twice.
//! Pure: it is told what time it is.

use std::time::{Duration, Instant};

use super::TICK;

/// How long a device tick may be overdue.
pub const PATIENCE: Duration = Duration::from_millis(12);

/// A jump of the device's tick number beyond this is a restart, not a gap: one second.
const LONGEST_GAP: u32 = 40;

/// What to do now.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Due {
    /// Nothing yet.
    Nothing,
    /// Tick; it was due at this time.
    Tick(Instant),
    /// Send the last tick's frame again: it stood in for this device tick.
    Answer,
}

/// Decides when to tick.
#[derive(Debug)]
pub(crate) struct Pacer {
    /// When the next tick is due by the own clock.
    own_due: Instant,
    last_own: Option<Instant>,
    last_device: Option<DeviceTick>,
    /// When the tick that answers the last device tick is due, if it was put off.
    put_off: Option<Instant>,
    is_device_paced: bool,
    missed: u64,
    fallbacks: u64,
}

#[derive(Debug, Clone, Copy)]
struct DeviceTick {
    number: u32,
    /// Own ticks since.
    stand_ins: u32,
}

impl Pacer {
    /// A pacer whose own clock ticks from `start` on.
    pub(crate) fn new(start: Instant) -> Self {
        Self {
            own_due: start,
            last_own: None,
            last_device: None,
            put_off: None,
            is_device_paced: false,
            missed: 0,
            fallbacks: 0,
        }
    }

    /// A STATUS with this tick number arrived; its answer is `due` then or later.
    pub(crate) fn device_tick(&mut self, number: u32, received: Instant, due: Instant) -> Due {
        if let Some(last) = self.last_device {
            let step = number.wrapping_sub(last.number);
            if step == 0 {
                return Due::Nothing;
            }
            if step <= LONGEST_GAP {
                self.missed += u64::from((step - 1).saturating_sub(last.stand_ins));
            }
        }
        // A tick that was put off and not done by now never will be.
        self.missed += u64::from(self.put_off.take().is_some());
        self.last_device = Some(DeviceTick {
            number,
            stand_ins: 0,
        });
        self.own_due = received + TICK + PATIENCE;
        self.is_device_paced = true;
        let stood_in = self
            .last_own
            .take()
            .is_some_and(|own| received < own + PATIENCE);
        if stood_in {
            return Due::Answer;
        }
        if due <= received {
            return Due::Tick(received);
        }
        self.put_off = Some(due);
        Due::Nothing
    }

    /// Time passed and no STATUS arrived.
    pub(crate) fn own_tick(&mut self, now: Instant) -> Due {
        if let Some(due) = self.put_off.take_if(|due| *due <= now) {
            return Due::Tick(due);
        }
        if now < self.own_due {
            return Due::Nothing;
        }
        if self.is_device_paced {
            self.is_device_paced = false;
            self.fallbacks += 1;
        }
        let mut due = self.own_due;
        // Ticks that were slept through are not caught up on: their time has passed.
        let n_slept = (now - due).as_nanos() / TICK.as_nanos();
        let n_slept = u32::try_from(n_slept).unwrap_or(u32::MAX);
        due += TICK * n_slept;
        self.missed += u64::from(n_slept);
        self.own_due = due + TICK;
        self.last_own = Some(due);
        if let Some(last) = &mut self.last_device {
            last.stand_ins = last.stand_ins.saturating_add(n_slept).saturating_add(1);
        }
        Due::Tick(due)
    }

    /// The device is gone: the own clock goes on one tick after the last.
    pub(crate) fn forget_device(&mut self) {
        if self.is_device_paced {
            self.own_due -= PATIENCE;
        }
        self.is_device_paced = false;
        self.last_device = None;
        self.put_off = None;
    }

    /// When [`own_tick`](Self::own_tick) has something to do.
    pub(crate) fn deadline(&self) -> Instant {
        self.put_off
            .map_or(self.own_due, |due| due.min(self.own_due))
    }

    /// Whether the device paces.
    pub(crate) fn is_device_paced(&self) -> bool {
        self.is_device_paced
    }

    /// Ticks that never were because the engine came a whole tick too late.
    pub(crate) fn missed(&self) -> u64 {
        self.missed
    }

    /// Times that the own clock took over.
    pub(crate) fn fallbacks(&self) -> u64 {
        self.fallbacks
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const MS: Duration = Duration::from_millis(1);

    /// A device tick that is answered at once.
    fn at(pacer: &mut Pacer, number: u32, received: Instant) -> Due {
        pacer.device_tick(number, received, received)
    }

    #[test]
    fn without_a_device_it_ticks_on_absolute_deadlines() {
        let start = Instant::now();
        let mut pacer = Pacer::new(start);
        for k in 0..100 {
            let due = start + TICK * k;
            let before = due.checked_sub(Duration::from_nanos(1)).unwrap();
            assert_eq!(pacer.own_tick(before), Due::Nothing);
            // However late it wakes, the next deadline does not drift.
            assert_eq!(pacer.own_tick(due + MS * (k % 20)), Due::Tick(due));
        }
        assert_eq!((pacer.missed(), pacer.fallbacks()), (0, 0));
    }

    #[test]
    fn ticks_slept_through_are_counted_and_not_caught_up_on() {
        let start = Instant::now();
        let mut pacer = Pacer::new(start);
        assert_eq!(pacer.own_tick(start), Due::Tick(start));
        let awake = start + 80 * MS;
        assert_eq!(pacer.own_tick(awake), Due::Tick(start + 75 * MS));
        assert_eq!(pacer.own_tick(awake), Due::Nothing);
        assert_eq!((pacer.missed(), pacer.deadline()), (2, start + 100 * MS));
    }

    #[test]
    fn device_ticks_pace_and_a_missing_one_is_given_up_after_37_ms() {
        let start = Instant::now();
        let mut pacer = Pacer::new(start);
        for number in 0..10 {
            let received = start + TICK * number + MS * (number % 3);
            assert_eq!(
                pacer.device_tick(7 + number, received, received),
                Due::Tick(received)
            );
            assert_eq!(pacer.own_tick(received + 36 * MS), Due::Nothing);
        }
        let last = start + TICK * 9;
        assert_eq!(pacer.deadline(), last + 37 * MS);
        assert_eq!(pacer.own_tick(last + 37 * MS), Due::Tick(last + 37 * MS));
        assert!(!pacer.is_device_paced());
        assert_eq!(pacer.own_tick(last + 62 * MS), Due::Tick(last + 62 * MS));
        assert_eq!((pacer.missed(), pacer.fallbacks()), (0, 1));
    }

    #[test]
    fn returning_device_ticks_pace_again_and_a_late_one_is_answered_not_ticked() {
        let start = Instant::now();
        let mut pacer = Pacer::new(start);
        pacer.device_tick(1, start, start);
        pacer.own_tick(start + 37 * MS);
        assert_eq!(
            at(&mut pacer, 2, start + 40 * MS),
            Due::Answer,
            "15 ms late"
        );
        assert!(pacer.is_device_paced());
        let third = start + 50 * MS;
        assert_eq!(at(&mut pacer, 3, third), Due::Tick(third));
        // Two lost: own ticks stand in, the third comes on time and is a tick of its own.
        assert_eq!(pacer.own_tick(third + 37 * MS), Due::Tick(third + 37 * MS));
        assert_eq!(pacer.own_tick(third + 62 * MS), Due::Tick(third + 62 * MS));
        let back = third + 75 * MS;
        assert_eq!(at(&mut pacer, 6, back), Due::Tick(back));
        assert_eq!((pacer.missed(), pacer.fallbacks()), (0, 2));
    }

    #[test]
    fn device_ticks_without_a_tick_are_missed_and_a_reboot_is_not() {
        let start = Instant::now();
        let mut pacer = Pacer::new(start);
        pacer.device_tick(u32::MAX, start, start);
        at(&mut pacer, 2, start + 75 * MS);
        assert_eq!(pacer.missed(), 2, "the number wraps");
        assert_eq!(
            at(&mut pacer, 2, start + 76 * MS),
            Due::Nothing,
            "the same tick again"
        );
        at(&mut pacer, 0, start + 100 * MS);
        assert_eq!(pacer.missed(), 2);
    }

    #[test]
    fn a_forgotten_device_leaves_no_longer_wait() {
        let start = Instant::now();
        let mut pacer = Pacer::new(start);
        pacer.device_tick(1, start, start);
        pacer.forget_device();
        assert_eq!(pacer.own_tick(start + TICK), Due::Tick(start + TICK));
        assert_eq!(
            pacer.fallbacks(),
            0,
            "the device was let go, it did not fall silent"
        );
    }

    #[test]
    fn a_tick_that_is_put_off_is_done_when_it_is_due() {
        let start = Instant::now();
        let mut pacer = Pacer::new(start);
        for number in 0..10 {
            let received = start + TICK * number;
            let due = received + 17 * MS;
            assert_eq!(pacer.device_tick(number, received, due), Due::Nothing);
            assert_eq!(pacer.deadline(), due);
            assert_eq!(pacer.own_tick(received + 16 * MS), Due::Nothing);
            assert_eq!(pacer.own_tick(due + MS), Due::Tick(due));
            assert_eq!(pacer.own_tick(received + 24 * MS), Due::Nothing);
        }
        // The eleventh never comes: 12 ms after it should have, the own clock ticks.
        let given_up = start + TICK * 9 + 37 * MS;
        assert_eq!(pacer.deadline(), given_up);
        assert_eq!(pacer.own_tick(given_up), Due::Tick(given_up));
        assert_eq!((pacer.missed(), pacer.fallbacks()), (0, 1));
    }

    #[test]
    fn a_tick_that_was_put_off_and_overtaken_by_the_next_is_missed() {
        let start = Instant::now();
        let mut pacer = Pacer::new(start);
        pacer.device_tick(1, start, start + 17 * MS);
        let next = start + TICK;
        assert_eq!(pacer.device_tick(2, next, next + 17 * MS), Due::Nothing);
        assert_eq!(pacer.missed(), 1);
        assert_eq!(pacer.own_tick(next + 17 * MS), Due::Tick(next + 17 * MS));
        pacer.device_tick(3, next + TICK, next + TICK + 17 * MS);
        pacer.forget_device();
        assert_eq!(
            pacer.deadline(),
            next + 2 * TICK,
            "nothing is answered any more"
        );
    }
}
