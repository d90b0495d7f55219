//! Glimpses: what histories of the last seconds need of every tick, however seldom they are drawn.
//!
//! A snapshot shows only the latest tick; a spectrogram or a timeline needs all of them. Each tick
//! that moved or sounded, and the first that did not, leaves one glimpse in a bounded ring, if
//! somebody asked for them. When the ring is full the newest is lost and counted.

use crate::scene::Pose;

/// One tick, as histories keep it.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Glimpse {
    /// Ticks since the engine started.
    pub tick: u64,
    /// Where the display was, how it was turned and how it moved.
    pub pose: Pose,
    /// Whether the device played silence (stopped, or held).
    pub is_silent: bool,
    /// Mean amplitudes [A40, A320] over the contactors of the first display that lie on a textile,
    /// after gains and before output limits, µm; 0 when none does.
    pub mean_um: [f32; 2],
    /// The contactor that is watched.
    pub watched: u32,
    /// Its amplitudes [A40, A320] after gains and before output limits, µm.
    pub watched_um: [f32; 2],
}
