//! Lies about settings: what is granted against a device's limits, and what is in effect against
//! what was granted.

use super::rules::Rule;
use crate::message::{ChannelMask, Config};

/// What CFG grants of a wish, where the device should grant `clamped`.
pub(crate) fn granted(breaks: impl Fn(Rule) -> bool, wish: &Config, clamped: Config) -> Config {
    let mut config = clamped;
    let kept = [
        (Rule::HoldUnclamped, &mut config.hold_ms, wish.hold_ms),
        (Rule::RampUnclamped, &mut config.ramp_ms, wish.ramp_ms),
        (Rule::HvUnclamped, &mut config.hv_dv, wish.hv_dv),
        (Rule::SlewUnclamped, &mut config.slew, wish.slew),
    ];
    for (rule, granted, asked) in kept {
        if breaks(rule) && asked > *granted {
            *granted = asked;
        }
    }
    if breaks(Rule::SlewZeroKept) && wish.slew == 0 {
        config.slew = 0;
    }
    if breaks(Rule::LimitUnclamped) {
        config.comp_limit = wish.comp_limit;
    }
    if breaks(Rule::ModeKept) {
        config.mode = wish.mode;
    }
    if breaks(Rule::FlagsKept) {
        config.flags = wish.flags;
    }
    if breaks(Rule::MaskKept) {
        config.mask = wish.mask;
    }
    config
}

/// What is in effect on a device of `n_channels`, where CFG said `told`.
pub(crate) fn in_effect(
    value: impl Fn(Rule) -> Option<u64>,
    told: &Config,
    n_channels: usize,
) -> Config {
    let mut config = *told;
    let breaks = |rule| value(rule).is_some();
    let by = |rule| value(rule).map_or(0, |by| u16::try_from(by).unwrap_or(u16::MAX));
    config.hold_ms = config.hold_ms.saturating_add(by(Rule::HoldLonger));
    config.hold_ms = config.hold_ms.saturating_sub(by(Rule::HoldShorter));
    config.ramp_ms = config.ramp_ms.saturating_add(by(Rule::RampLonger));
    config.ramp_ms = config.ramp_ms.saturating_sub(by(Rule::RampShorter));
    config.hv_dv = config.hv_dv.saturating_add(by(Rule::HvHigher));
    if breaks(Rule::NoSlew) {
        config.slew = u16::MAX;
    }
    if breaks(Rule::SlewHalf) {
        config.slew /= 2;
    }
    if breaks(Rule::NoCompLimit) {
        config.comp_limit = [u16::MAX; 2];
    }
    if breaks(Rule::LimitZeroIsNone) {
        let none_if_zero = |limit| if limit == 0 { u16::MAX } else { limit };
        config.comp_limit = config.comp_limit.map(none_if_zero);
    }
    if breaks(Rule::LimitsSwapped) {
        config.comp_limit.reverse();
    }
    let is_empty = config.mask == ChannelMask::default();
    if breaks(Rule::NoMask) || breaks(Rule::MaskZeroIsAll) && is_empty {
        config.mask = ChannelMask::first(n_channels);
    }
    if breaks(Rule::MaskShifted) {
        let told = config.mask;
        config.mask = ChannelMask::of(n_channels, |channel| {
            channel > 0 && told.contains(channel - 1)
        });
    }
    config
}
