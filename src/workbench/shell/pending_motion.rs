//! Movements that waited while the window was being drawn.
//!
//! The thread that hears of movements also draws. While it draws, movements queue up, and all that
//! waited is heard at once afterwards: stamped then, it would seem that the pointer had jumped. A
//! pointer reports at an even pace, so what waited is spread evenly over the time during which it
//! must have happened: from when the queue was last seen empty to now.
//!
//! Pure: it is told what time it is.

use std::time::{Duration, Instant};

/// Whoever sleeps longer than this slept because the queue was empty.
const ASLEEP: Duration = Duration::from_millis(1);

/// Movements to pixels that were not passed on yet.
#[derive(Debug)]
pub(crate) struct PendingMotion {
    waiting: Vec<[f64; 2]>,
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

    /// The pointer is said to have moved.
    pub(crate) fn moved(&mut self, pixel: [f64; 2]) {
        self.waiting.push(pixel);
    }

    /// Whether something was heard that was not passed on.
    pub(crate) fn is_waiting(&self) -> bool {
        !self.waiting.is_empty()
    }

    /// The queue is empty, everything that waited in it has been heard: passes it on with the times
    /// at which it must have happened.
    pub(crate) fn pass_on(&mut self, now: Instant, mut take: impl FnMut(Instant, [f64; 2])) {
        let span = now.saturating_duration_since(self.clear_since);
        let n = u32::try_from(self.waiting.len()).unwrap_or(u32::MAX);
        for (pixel, later) in self.waiting.drain(..).zip((0..n).rev()) {
            let before_now = span.mul_f64(f64::from(later) / f64::from(n));
            take(now.checked_sub(before_now).unwrap_or(now), pixel);
        }
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
        pending_motion.pass_on(now, |stamp, pixel| {
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
        pending_motion.moved([3.0, 0.0]);
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
            pending_motion.moved([f64::from(x), 0.0]);
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
    fn stamps_never_go_back() {
        let start = Instant::now();
        let mut pending_motion = PendingMotion::new(start);
        let mut last = start;
        for step in 0..200_u32 {
            let now = start + MS * step / 3;
            pending_motion.wakes(now);
            for _ in 0..step % 4 {
                pending_motion.moved([0.0, 0.0]);
            }
            pending_motion.pass_on(now, |stamp, _| {
                assert!(stamp >= last, "step {step}");
                last = stamp;
            });
            pending_motion.falls_asleep(now);
        }
    }
}
