//! What a right device does with what it was sent: settings that hold, sums, ramps.
//!
//! Written from the protocol's text, not from the emulator's code, so that the two can disagree.

use super::verdict::Trouble;
use crate::message::{Caps, ChannelMask, Config, DeviceState, TICK_US};

const MS_US: u64 = 1000;

/// The settings that hold when `wish` is asked of a device with these CAPS.
pub(super) fn clamped(caps: &Caps, wish: &Config) -> Config {
    let hold_ms = wish.hold_ms.min(100);
    let can_interpolate = caps.modes & Caps::INTERPOLATES != 0;
    Config {
        mode: 0,
        flags: wish.flags & u8::from(can_interpolate),
        hold_ms,
        ramp_ms: wish.ramp_ms.min(100 - hold_ms),
        slew: match wish.slew {
            0 => caps.slew_max,
            slew => slew.min(caps.slew_max),
        },
        hv_dv: wish.hv_dv.min(caps.hv_max_dv),
        comp_limit: [0, 1].map(|band| wish.comp_limit[band].min(caps.comp_limit[band])),
        mask: wish.mask.and(&ChannelMask::first(usize::from(caps.n_ch))),
    }
}

/// What a frame comes to after mask, limit and sum guard.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(super) struct Allowed {
    pub(super) codes: Vec<[u16; 2]>,
    pub(super) clipped: u16,
    /// Channels that were scaled down, each of which may be rounded by one a component.
    pub(super) n_scaled: u32,
}

impl Allowed {
    pub(super) fn of(codes: &[[u16; 2]], config: &Config) -> Self {
        let mut allowed = Self::default();
        for (channel, code) in codes.iter().enumerate() {
            let mut out = [0; 2];
            if config.mask.contains(channel) {
                for band in 0..2 {
                    let limit = config.comp_limit[band];
                    allowed.clipped += u16::from(code[band] > limit);
                    out[band] = code[band].min(limit);
                }
            }
            let sum = u32::from(out[0]) + u32::from(out[1]);
            if let Some(over) = sum.checked_sub(65_536) {
                allowed.clipped += 1;
                allowed.n_scaled += 1;
                out = out.map(|code| code - share(code, over + 1, sum));
            }
            allowed.codes.push(out);
        }
        allowed
    }

    /// A40 + A320 of all channels.
    pub(super) fn sum(&self) -> u32 {
        let codes = self.codes.iter().flatten();
        codes.map(|code| u32::from(*code)).sum()
    }

    /// One tick's movement towards this from `from`.
    pub(super) fn slewed(&self, from: &[[u16; 2]], largest: u16) -> Vec<[u16; 2]> {
        let towards = |(from, to): (&[u16; 2], &[u16; 2])| {
            [0, 1].map(|band| {
                let low = from[band].saturating_sub(largest);
                to[band].clamp(low, from[band].saturating_add(largest))
            })
        };
        from.iter().zip(&self.codes).map(towards).collect()
    }
}

/// How much a component loses when a channel is `over` full drive, rounded up.
fn share(code: u16, over: u32, sum: u32) -> u16 {
    let lost = (u64::from(code) * u64::from(over)).div_ceil(u64::from(sum));
    u16::try_from(lost).unwrap_or(code)
}

/// Device times between which something happened, µs since boot.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Between {
    pub(super) from_us: u64,
    pub(super) to_us: u64,
}

impl Between {
    /// It, if all of it lies in this tick.
    pub(super) fn within(self, tick: u32) -> Result<Self, Trouble> {
        let ticks = [self.from_us, self.to_us].map(|us| us / u64::from(TICK_US));
        (ticks == [u64::from(tick); 2])
            .then_some(self)
            .ok_or(Trouble::Late)
    }

    /// Whole steps of the 1 ms clock that lie more than `delay_ms` after it, up to `at_us`.
    pub(super) fn steps_until(self, delay_ms: u16, at_us: u64) -> [u64; 2] {
        let delay_us = u64::from(delay_ms) * MS_US;
        [self.to_us, self.from_us].map(|us| (at_us / MS_US).saturating_sub((us + delay_us) / MS_US))
    }

    /// Its age at `at_us` in whole ms.
    pub(super) fn ages_ms(self, at_us: u64) -> [u64; 2] {
        [self.to_us, self.from_us].map(|us| at_us.saturating_sub(us) / MS_US)
    }
}

/// A sum on its way down: which sums and states are right so many steps after full gain.
pub(super) fn ramped(sum: u32, ramp_ms: u16, n_steps: [u64; 2]) -> [u32; 2] {
    let [fewest, most] = n_steps;
    let after = |n: u64| {
        let full = u64::from(ramp_ms.max(1));
        let left = if ramp_ms == 0 && n > 0 {
            0
        } else {
            full.saturating_sub(n)
        };
        u32::try_from(u64::from(sum) * left / full).unwrap_or(u32::MAX)
    };
    [after(most), after(fewest)]
}

/// Whether a state fits so many steps into a ramp of `ramp_ms`; `before` holds without any step.
pub(super) fn fits_ramp(
    state: DeviceState,
    before: DeviceState,
    ramp_ms: u16,
    n_steps: [u64; 2],
) -> bool {
    let [fewest, most] = n_steps;
    let end = u64::from(ramp_ms.max(1));
    match state {
        DeviceState::Ramp => most >= 1 && fewest < end,
        DeviceState::Ready => most >= end,
        state => state == before && fewest == 0,
    }
}
