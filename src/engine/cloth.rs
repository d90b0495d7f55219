//! Amplitudes that are made elsewhere, of fingers on a cloth that hangs: whoever steps the cloth
//! gives them, and the engine's ticks take the newest.
//!
//! What is no longer given falls silent by itself: a cloth that is not stepped is not felt.

use triple_buffer::{Input, Output};

/// Ticks after which what was given last is felt no more.
const STALE_TICKS: u32 = 4;

/// Amplitudes [A40, A320] of the contactors of two displays, before gains, µm peak.
pub type ClothTick = [[[f64; 2]; 24]; 2];

/// The end of whoever steps the cloth.
pub struct ClothFeed(Input<ClothTick>);

impl std::fmt::Debug for ClothFeed {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("ClothFeed").finish_non_exhaustive()
    }
}

impl ClothFeed {
    /// Gives the amplitudes of now. Never waits. What is not finite or negative counts as silence.
    pub fn give(&mut self, tick: &ClothTick) {
        let sound = |um: f64| if um.is_finite() { um.max(0.0) } else { 0.0 };
        let sound = |contactor: [f64; 2]| contactor.map(sound);
        self.0.write(tick.map(|display| display.map(sound)));
    }
}

/// The engine's end.
pub struct ClothDrive {
    ticks: Output<ClothTick>,
    age: u32,
}

impl ClothDrive {
    /// Both ends; silent until something is given.
    pub fn new() -> (ClothFeed, Self) {
        let (feed, ticks) = triple_buffer::triple_buffer(&[[[0.0; 2]; 24]; 2]);
        let age = STALE_TICKS;
        (ClothFeed(feed), Self { ticks, age })
    }

    /// Looks for what was given since the tick before.
    pub(super) fn next_tick(&mut self) {
        self.age = if self.ticks.update() {
            0
        } else {
            self.age.saturating_add(1)
        };
    }

    /// What is felt, by display.
    pub(super) fn felt(&self) -> ClothTick {
        if self.age < STALE_TICKS {
            *self.ticks.output_buffer()
        } else {
            ClothTick::default()
        }
    }
}

impl std::fmt::Debug for ClothDrive {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("ClothDrive")
            .field("age", &self.age)
            .finish_non_exhaustive()
    }
}
