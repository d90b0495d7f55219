//! Movements that waited while the window was being drawn.
//!
//! The thread that hears of movements also draws. While it draws, movements queue up, and all that
//! waited is heard at once afterwards: stamped then, it would seem that the pointer had jumped. A
//! pointer reports at an even pace, so what waited is spread evenly over the time during which it
//! must have happened: from when the queue was last seen empty to now. Every finger has a pace of
//! its own.
//!
//! Pure: it is told what time it is.

use std::time::{Duration, Instant};

/// Whoever sleeps longer than this slept because the queue was empty.
const ASLEEP: Duration = Duration::from_millis(1);

/// What moved, and to which pixel: the place in the scene's list of the display that it holds.
type Moved = (usize, [f64; 2]);

/// Movements to pixels that were not passed on yet.
#[derive(Debug)]
pub(crate) struct PendingMotion {
    waiting: Vec<Moved>,
    /// When the queue was last seen empty.
    clear_since: Instant,
    asleep_since: Instant,
}

impl PendingMotion {
    /// An empty queue.
    pub(crate) fn new(now: Instant) -> Self {
        Self {
            waiting: Vec::new(),
            clear_since: now,
            asleep_since: now,
        }
    }

    /// The thread is about to wait for events. Some may have queued up already.
    pub(crate) fn falls_asleep(&mut self, now: Instant) {
        self.asleep_since = now;
    }

    /// The thread has been woken.
    pub(crate) fn wakes(&mut self, now: Instant) {
        if now.saturating_duration_since(self.asleep_since) > ASLEEP {
            self.clear_since = self.clear_since.max(now.checked_sub(ASLEEP).unwrap_or(now));
        }
    }

    /// The pointer, or the finger that holds this display, is said to have moved.
    pub(crate) fn moved(&mut self, display: usize, pixel: [f64; 2]) {
        self.waiting.push((display, pixel));
    }

    /// Whether something was heard that was not passed on.
    pub(crate) fn is_waiting(&self) -> bool {
        !self.waiting.is_empty()
    }

    /// The queue is empty, everything that waited in it has been heard: passes it on with the times
    /// at which it must have happened.
    pub(crate) fn pass_on(&mut self, now: Instant, mut take: impl FnMut(Instant, Moved)) {
        let span = now.saturating_duration_since(self.clear_since);
        for (nth, &(display, pixel)) in self.waiting.iter().enumerate() {
            let is_of_it = |(other, _): &&Moved| *other == display;
            let count = |moved: &[Moved]| moved.iter().filter(is_of_it).count();
            let [n, later] = [0, nth + 1].map(|from| count(&self.waiting[from..]) as f64);
            let before_now = span.mul_f64(later / n);
            take(now.checked_sub(before_now).unwrap_or(now), (display, pixel));
        }
        self.waiting.clear();
        self.clear_since = now;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const MS: Duration = Duration::from_millis(1);

    fn passed_on(
        pending_motion: &mut PendingMotion,
        now: Instant,
        start: Instant,
    ) -> Vec<(u128, f64)> {
        let mut seen = Vec::new();
        pending_motion.pass_on(now, |stamp, (_, pixel)| {
            seen.push(((stamp - start).as_micros(), pixel[0]));
        });
        seen
    }

    #[test]
    fn a_movement_that_wakes_the_thread_is_stamped_now() {
        let start = Instant::now();
        let mut pending_motion = PendingMotion::new(start);
        pending_motion.falls_asleep(start);
        pending_motion.wakes(start + 500 * MS);
        pending_motion.moved(0, [3.0, 0.0]);
        let seen = passed_on(&mut pending_motion, start + 500 * MS, start);
        assert_eq!(seen, [(500_000, 3.0)]);
    }

    #[test]
    fn what_waited_while_a_frame_was_drawn_is_spread_over_that_time() {
        let start = Instant::now();
        let mut pending_motion = PendingMotion::new(start);
        // The queue is empty when drawing begins, 100 ms in; it takes 40 ms.
        assert!(
            passed_on(&mut pending_motion, start + 100 * MS, start).is_empty(),
            "nothing waited"
        );
        pending_motion.falls_asleep(start + 140 * MS);
        pending_motion.wakes(start + 140 * MS);
        for x in 1..=5_u8 {
            pending_motion.moved(0, [f64::from(x), 0.0]);
        }
        let seen = passed_on(&mut pending_motion, start + 140 * MS, start);
        let expected = [
            (108_000, 1.0),
            (116_000, 2.0),
            (124_000, 3.0),
            (132_000, 4.0),
            (140_000, 5.0),
        ];
        assert_eq!(seen, expected);
    }

    #[test]
    fn every_finger_has_a_pace_of_its_own() {
        let start = Instant::now();
        let mut pending_motion = PendingMotion::new(start);
        for (display, x) in [(0, 1.0), (1, 7.0), (0, 2.0), (0, 3.0), (1, 8.0), (0, 4.0)] {
            pending_motion.moved(display, [x, 0.0]);
        }
        let mut seen = [Vec::new(), Vec::new()];
        pending_motion.pass_on(start + 40 * MS, |stamp, (display, pixel)| {
            seen[display].push(((stamp - start).as_millis(), pixel[0]));
        });
        let first = [(10, 1.0), (20, 2.0), (30, 3.0), (40, 4.0)];
        assert_eq!(seen, [first.to_vec(), vec![(20, 7.0), (40, 8.0)]]);
    }

    #[test]
    fn stamps_never_go_back() {
        let start = Instant::now();
        let mut pending_motion = PendingMotion::new(start);
        let mut last = start;
        for step in 0..200_u32 {
            let now = start + MS * step / 3;
            pending_motion.wakes(now);
            for _ in 0..step % 4 {
                pending_motion.moved(0, [0.0, 0.0]);
            }
            pending_motion.pass_on(now, |stamp, _| {
                assert!(stamp >= last, "step {step}");
                last = stamp;
            });
            pending_motion.falls_asleep(now);
        }
    }
}
