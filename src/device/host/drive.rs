//! How the device is driven: the profile and its codes, the soft start, and what is asked for.

use std::time::Instant;

use super::reported::Reported;
use crate::codes::{ArrayProfile, Coder};
use crate::message::{ChannelMask, Config, LARGEST_CHANNELS};

/// Ticks of the linear soft start after ARM.
pub(crate) const SOFT_START_TICKS: u32 = 20;

/// What makes codes of amplitudes, and for which ticks it did.
#[derive(Debug)]
pub(super) struct Drive {
    pub(super) profile: ArrayProfile,
    pub(super) n_contactors: usize,
    pub(super) coder: Coder,
    pub(super) codes: Vec<[u16; 2]>,
    /// The first and the last tick that a frame was made for since ARM.
    pub(super) first_apply_tick: Option<u32>,
    pub(super) last_apply_tick: Option<u32>,
    /// When the answer to the last STATUS is due; taken by the frame that is it.
    pub(super) due: Option<Instant>,
}

impl Drive {
    pub(super) fn new(profile: ArrayProfile, n_contactors: usize) -> Self {
        Self {
            coder: Coder::new(&profile, n_contactors),
            codes: vec![[0; 2]; n_contactors.min(LARGEST_CHANNELS)],
            profile,
            n_contactors,
            first_apply_tick: None,
            last_apply_tick: None,
            due: None,
        }
    }

    /// ARM goes out: the soft start begins anew.
    pub(super) fn begin(&mut self) {
        self.first_apply_tick = None;
        self.last_apply_tick = None;
    }

    /// Whether a frame for this tick comes after all others: a tick has one frame.
    pub(super) fn is_new_tick(&self, apply_tick: u32) -> bool {
        self.last_apply_tick
            .is_none_or(|last| apply_tick.wrapping_sub(last).cast_signed() > 0)
    }

    /// Makes the codes of a frame for a tick; gives the soft-start gain that they contain.
    pub(super) fn encode(&mut self, apply_tick: u32, amplitudes_um: &[[f32; 2]]) -> f64 {
        let first = *self.first_apply_tick.get_or_insert(apply_tick);
        self.last_apply_tick = Some(apply_tick);
        let gain = soft_start_gain(first, apply_tick);
        self.coder.encode_into(amplitudes_um, gain, &mut self.codes);
        gain
    }

    /// What to ask of the device, within its CAPS.
    pub(super) fn wanted_config(&self, device: &Reported) -> Config {
        let caps = device.caps.unwrap_or_default();
        let wanted = self.coder.comp_limit(caps.fs_mv);
        Config {
            mode: Config::AMPLITUDES,
            flags: 0,
            hold_ms: self.profile.hold_ms,
            ramp_ms: self.profile.ramp_ms,
            slew: 0,
            hv_dv: self.profile.hv_dv.unwrap_or(u16::MAX).min(caps.hv_max_dv),
            comp_limit: [0, 1].map(|band| wanted[band].min(caps.comp_limit[band])),
            mask: ChannelMask::first(self.n_contactors),
        }
    }
}

/// `min(1, (ticks since the first FRAME after ARM + 1) / 20)`.
pub(super) fn soft_start_gain(first_apply_tick: u32, apply_tick: u32) -> f64 {
    let since = apply_tick.wrapping_sub(first_apply_tick);
    // A depth or clock correction may step back behind the first frame.
    let since = if since.cast_signed() < 0 { 0 } else { since };
    let ticks = since.saturating_add(1).min(SOFT_START_TICKS);
    f64::from(ticks) / f64::from(SOFT_START_TICKS)
}
