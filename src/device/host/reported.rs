//! What the device said of itself, and what follows from that.

use std::time::{Duration, Instant};

use super::clock::TICK;
use crate::array::DeviceUid;
use crate::message::{Caps, Config, DeviceCounters, Status};

/// Everything that is known of the device by its own word.
#[derive(Debug, Default)]
pub(super) struct Reported {
    pub(super) caps: Option<Caps>,
    pub(super) config: Option<Config>,
    pub(super) status: Option<Status>,
    /// Start of the last STATUS's tick, by our clock.
    pub(super) tick_start: Option<Instant>,
    pub(super) counters: DeviceCounters,
    /// The device that the link before this one had.
    pub(super) before: Option<DeviceUid>,
}

impl Reported {
    /// The device's tick now: that of the last STATUS plus whole ticks since it began.
    pub(super) fn present_tick(&self, now: Instant) -> u32 {
        let tick = self.status.map_or(0, |status| status.tick);
        let since = self
            .tick_start
            .map_or(Duration::ZERO, |at| now.saturating_duration_since(at));
        let whole = since.as_micros() / TICK.as_micros();
        tick.wrapping_add(u32::try_from(whole).unwrap_or(0))
    }

    /// From now to the start of a tick of the device that comes within `max_ticks`.
    pub(super) fn until_tick(&self, now: Instant, tick: u32, max_ticks: u32) -> Duration {
        let Some((status, start)) = self.status.zip(self.tick_start) else {
            return Duration::ZERO;
        };
        let start = start + TICK * tick.wrapping_sub(status.tick).min(max_ticks);
        start.saturating_duration_since(now)
    }

    /// How many ticks ahead may be sent.
    pub(super) fn deepest(&self) -> u8 {
        self.caps.map_or(1, |caps| caps.queue)
    }
}
