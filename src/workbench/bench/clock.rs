//! What time it is: for the engine, and for what waits.

use std::time::{Duration, Instant};

use eframe::egui::Context;

use selvedge_engine::TICK;

/// Between two looks at a window that nobody sees: what is armed is not forgotten.
pub(crate) const UNSEEN: Duration = Duration::from_millis(250);

/// The clock of the bench.
#[derive(Debug)]
pub(crate) struct Clock {
    /// The engine's time, where the toolkit's clock drives it.
    pub(crate) stepped_at: Option<Instant>,
    /// The toolkit's time in the last frame, s, and when that was.
    frame: (f64, Instant),
    /// Whether a frame was drawn since the last look, and before that look.
    was_drawn: bool,
    is_seen: bool,
    now_s: f64,
}

impl Clock {
    /// A clock that begins at `stepped_at`, where the toolkit's drives the engine.
    pub(crate) fn new(stepped_at: Option<Instant>) -> Self {
        Self {
            stepped_at,
            frame: (0.0, Instant::now()),
            was_drawn: true,
            is_seen: true,
            now_s: 0.0,
        }
    }

    /// Looks at the time, before every frame and, where the window is not shown, instead of one.
    ///
    /// A window that is not shown gets no frames, and the toolkit's clock stands still: then this
    /// one goes on from there.
    pub(crate) fn look(&mut self, ctx: &Context) {
        self.is_seen = std::mem::take(&mut self.was_drawn);
        if self.is_seen {
            self.frame = (ctx.input(|input| input.time), Instant::now());
        }
        let unseen = self.frame.1.elapsed();
        let since = if unseen < UNSEEN {
            Duration::ZERO
        } else {
            unseen
        };
        self.now_s = self.frame.0 + since.as_secs_f64();
    }

    /// A frame is drawn.
    pub(crate) fn draw(&mut self) {
        self.was_drawn = true;
    }

    /// The time at the last look, s.
    pub(crate) fn now_s(&self) -> f64 {
        self.now_s
    }

    /// Whether the window gets frames: one was drawn between the last two looks.
    pub(crate) fn is_seen(&self) -> bool {
        self.is_seen
    }

    /// The stamp of an event that arrives now.
    pub(crate) fn stamp(&self) -> Instant {
        match self.stepped_at {
            Some(now) => now + TICK / 2,
            None => Instant::now(),
        }
    }

    /// As if the last frame was drawn so long ago.
    #[cfg(test)]
    pub(crate) fn unseen_for(&mut self, unseen: Duration) {
        self.frame.1 = self.frame.1.checked_sub(unseen).unwrap();
    }
}
