//! From the newest frame to output codes: mask, limit, sum guard, slew, and the hold/ramp gain on a
//! 1 ms clock.
//!
//! The gain is a whole number of ramp steps, so that silence is reached exactly and never by
//! rounding.

use super::lie::Rule;
use crate::message::{Config, TICK_US};

/// A tick of the device, µs.
pub(super) const TICK: u64 = TICK_US as u64;

/// One contactor driven on its own.
#[derive(Clone, Copy, Debug)]
pub(super) struct IdentDrive {
    pub(super) channel: usize,
    pub(super) amp: u16,
    pub(super) until_us: u64,
    /// 0 for A40, 1 for A320.
    pub(super) band: usize,
}

impl IdentDrive {
    fn codes(self) -> [u16; 2] {
        [0, 1].map(|band| if band == self.band { self.amp } else { 0 })
    }
}

/// Output before and after the gain.
#[derive(Clone, Debug)]
pub(super) struct OutputStage {
    target: Vec<[u16; 2]>,
    slewed: Vec<[u16; 2]>,
    /// Where every component was at the start of the tick.
    before: Vec<[u16; 2]>,
    /// Whether components move linearly inside the tick, and how much of it is over, µs.
    pub(super) is_interpolated: bool,
    pub(super) phase_us: u64,
    /// Present gain in steps of `1 / steps_full`.
    steps: u16,
    steps_full: u16,
    pub(super) ident: Option<IdentDrive>,
}

impl OutputStage {
    pub(super) fn new(n_channels: usize) -> Self {
        Self {
            target: vec![[0; 2]; n_channels],
            slewed: vec![[0; 2]; n_channels],
            before: vec![[0; 2]; n_channels],
            is_interpolated: false,
            phase_us: 0,
            steps: 1,
            steps_full: 1,
            ident: None,
        }
    }

    /// Zero output with full gain, ready for the first frame; `ramp_ms` steps make a ramp.
    pub(super) fn reset(&mut self, ramp_ms: u16) {
        self.target.fill([0; 2]);
        self.slewed.fill([0; 2]);
        self.before.fill([0; 2]);
        self.steps_full = ramp_ms.max(1);
        self.steps = self.steps_full;
        self.ident = None;
    }

    pub(super) fn set_target(&mut self, codes: &[[u16; 2]]) {
        self.target.copy_from_slice(codes);
    }

    /// A tick begins: what was reached is where the next movement starts.
    pub(super) fn settle(&mut self) {
        self.before.copy_from_slice(&self.slewed);
        self.phase_us = 0;
    }

    /// One tick's movement of every component towards the target.
    pub(super) fn slew(&mut self, largest: u16) {
        for (now, target) in self
            .slewed
            .iter_mut()
            .flatten()
            .zip(self.target.iter().flatten().copied())
        {
            *now = target.clamp(now.saturating_sub(largest), now.saturating_add(largest));
        }
    }

    /// One ms of ramp; `at_once` for a ramp of 0 ms. True when the gain is zero.
    pub(super) fn fall(&mut self, at_once: bool) -> bool {
        self.steps = if at_once {
            0
        } else {
            self.steps.saturating_sub(1)
        };
        self.steps == 0
    }

    /// One ms back up after a ramp.
    pub(super) fn rise(&mut self) {
        self.steps = (self.steps + 1).min(self.steps_full);
    }

    /// Full gain at once.
    pub(super) fn fill_gain(&mut self) {
        self.steps = self.steps_full;
    }

    pub(super) fn is_gain_full(&self) -> bool {
        self.steps == self.steps_full
    }

    pub(super) fn gain(&self) -> f64 {
        f64::from(self.steps) / f64::from(self.steps_full)
    }

    /// Sum of all codes after gain, rounded down once.
    pub(super) fn amp_sum(&self) -> u32 {
        if let Some(ident) = self.ident {
            return u32::from(ident.amp);
        }
        let after_gain = sum(&self.slewed) * u64::from(self.steps) / u64::from(self.steps_full);
        u32::try_from(after_gain).unwrap_or(u32::MAX)
    }

    /// The same without the gain.
    pub(super) fn sum_before_gain(&self) -> u32 {
        u32::try_from(sum(&self.slewed)).unwrap_or(u32::MAX)
    }

    /// The same of what it moves to.
    pub(super) fn target_sum(&self) -> u32 {
        u32::try_from(sum(&self.target)).unwrap_or(u32::MAX)
    }

    /// Output codes after gain, each rounded down.
    pub(super) fn write_to(&self, codes: &mut [[u16; 2]]) {
        for (channel, out) in codes.iter_mut().enumerate().take(self.slewed.len()) {
            *out = self.code(channel);
        }
    }

    /// A channel's codes after gain, each rounded down.
    pub(super) fn code(&self, channel: usize) -> [u16; 2] {
        match self.ident {
            Some(ident) if ident.channel == channel => ident.codes(),
            Some(_) => [0, 0],
            None => self.moved(channel).map(|code| self.scaled(code)),
        }
    }

    /// A channel's codes at this moment of the tick, before the gain.
    fn moved(&self, channel: usize) -> [u16; 2] {
        let (from, to) = (self.before[channel], self.slewed[channel]);
        if !self.is_interpolated {
            return to;
        }
        let over = self.phase_us.min(TICK);
        [0, 1].map(|band| {
            let [from, to] = [from, to].map(|codes| u64::from(codes[band]));
            u16::try_from((from * (TICK - over) + to * over) / TICK).unwrap_or(u16::MAX)
        })
    }

    fn scaled(&self, code: u16) -> u16 {
        let scaled = u32::from(code) * u32::from(self.steps) / u32::from(self.steps_full);
        u16::try_from(scaled).unwrap_or(u16::MAX)
    }
}

fn sum(codes: &[[u16; 2]]) -> u64 {
    codes.iter().flatten().map(|code| u64::from(*code)).sum()
}

/// Mask, component limit and sum guard of a received frame. Gives the number of values and channels
/// that were clipped.
pub(super) fn allow(
    received: &[[u16; 2]],
    config: &Config,
    breaks: impl Fn(Rule) -> bool,
    allowed: &mut [[u16; 2]],
) -> u16 {
    let mut clipped = 0u16;
    for (channel, (code, out)) in received.iter().zip(allowed).enumerate() {
        let is_on = config.mask.contains(channel);
        if !is_on && !breaks(Rule::MaskClips) {
            *out = [0, 0];
            continue;
        }
        for band in 0..2 {
            clipped = clipped.wrapping_add(u16::from(code[band] > config.comp_limit[band]));
            out[band] = code[band].min(config.comp_limit[band]);
        }
        let sum = u32::from(out[0]) + u32::from(out[1]);
        if sum > u32::from(u16::MAX) && !breaks(Rule::NoSumGuard) {
            clipped = clipped.wrapping_add(u16::from(!breaks(Rule::SumGuardUncounted)));
            *out = if breaks(Rule::SumGuardCuts) {
                [out[0], u16::MAX - out[0]]
            } else {
                out.map(|code| share(code, sum))
            };
        }
        if !is_on {
            *out = [0, 0];
        }
    }
    if breaks(Rule::ClippedOnce) {
        clipped.min(1)
    } else {
        clipped
    }
}

/// `code · 65535 / sum`, rounded down: two shares never exceed full drive.
fn share(code: u16, sum: u32) -> u16 {
    let scaled = u64::from(code) * u64::from(u16::MAX) / u64::from(sum);
    u16::try_from(scaled).unwrap_or(u16::MAX)
}
