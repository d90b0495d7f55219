//! What a device says of itself before it is armed, compared with what was asked and with the
//! profile: each contradiction is one line for people.
//!
//! Everything a device says is a claim. Nothing here changes anything; the session refuses.

use crate::codes::ArrayProfile;
use crate::framing::{CRC_LEN, HEADER_LEN};
use crate::message::{Caps, Config, DeviceState, Status, TICK_US, VERSION, fault_bit, frame};

/// The smallest part of a device's drive peak that full scale may be: codes would be too coarse.
const SMALLEST_PART: f64 = 1.0 / 16.0;
/// Shorter than a tick a hold would end between two frames.
const SHORTEST_HOLD_MS: u16 = 25;

/// The reason against a device with these CAPS, if there is one.
pub(super) fn caps_refusal(
    caps: &Caps,
    profile: &ArrayProfile,
    n_contactors: usize,
) -> Option<String> {
    if caps.version != VERSION {
        return Some(match caps.version {
            0 => String::from("the device speaks no protocol version 1: update its firmware"),
            version => format!(
                "the device chose protocol version {version}, which was not offered: update its \
                 firmware"
            ),
        });
    }
    shape_refusal(caps, profile, n_contactors)
        .or_else(|| carrier_refusal(caps))
        .or_else(|| ability_refusal(caps, n_contactors))
        .or_else(|| voltage_refusal(caps, profile))
}

fn shape_refusal(caps: &Caps, profile: &ArrayProfile, n_contactors: usize) -> Option<String> {
    let (rows, cols, n_ch) = (caps.rows, caps.cols, usize::from(caps.n_ch));
    if usize::from(rows) * usize::from(cols) != n_ch {
        return Some(format!(
            "the device says {rows} rows × {cols} columns but {n_ch} channels: check its firmware"
        ));
    }
    if n_ch != n_contactors {
        return Some(format!(
            "the device has {n_ch} channels, the display {n_contactors} contactors: \
             choose a display that matches"
        ));
    }
    ((rows, cols) != (profile.rows, profile.cols)).then(|| {
        format!(
            "the device has {rows} rows × {cols} columns, the array \"{}\" {} × {}: choose the \
             array that is connected",
            profile.name, profile.rows, profile.cols
        )
    })
}

fn carrier_refusal(caps: &Caps) -> Option<String> {
    if caps.n_comp != 2 {
        return Some(format!(
            "the device has {} components per channel, not the 2 that 40 and 320 Hz need",
            caps.n_comp
        ));
    }
    if caps.tick_us != TICK_US {
        return Some(format!(
            "the device ticks every {} µs, not every {TICK_US} µs",
            caps.tick_us
        ));
    }
    (caps.freq_mhz != [40_000, 320_000]).then(|| {
        let [low, high] = caps.freq_mhz.map(|mhz| f64::from(mhz) / 1000.0);
        format!("the device's carriers are {low} and {high} Hz, not 40 and 320 Hz")
    })
}

fn ability_refusal(caps: &Caps, n_contactors: usize) -> Option<String> {
    let needed = HEADER_LEN + frame::payload_len(n_contactors) + CRC_LEN;
    if usize::from(caps.max_body) < needed {
        return Some(format!(
            "the device takes packets of at most {} bytes, \
             a frame of {n_contactors} channels needs {needed}",
            caps.max_body
        ));
    }
    if caps.modes & Caps::MODE_A == 0 {
        return Some(String::from("the device takes no amplitudes (mode A)"));
    }
    let nothing = [
        (caps.queue == 0, "has no room for a frame (queue 0)"),
        (caps.slew_max == 0, "lets no amplitude change (slew_max 0)"),
        (
            caps.comp_limit.contains(&0),
            "allows no amplitude (comp_limit 0)",
        ),
        (caps.hv_max_dv == 0, "has no high voltage (hv_max_dV 0)"),
        (caps.fs_mv == 0, "has no drive (fs_mV 0)"),
    ];
    let (_, what) = nothing.into_iter().find(|(is_so, _)| *is_so)?;
    Some(format!("the device {what}: check its firmware"))
}

fn voltage_refusal(caps: &Caps, profile: &ArrayProfile) -> Option<String> {
    let part = f64::from(profile.full_scale_mv) / f64::from(caps.fs_mv.max(1));
    let [device_v, profile_v] = [caps.fs_mv, profile.full_scale_mv].map(|mv| f64::from(mv) / 1e3);
    let what = if part > 1.0 {
        "it cannot reach full scale"
    } else if part < SMALLEST_PART {
        "full scale would be less than a sixteenth of its drive"
    } else {
        return None;
    };
    Some(format!(
        "the device drives {device_v} V at most, the array \"{}\" has its full scale at \
         {profile_v} V: {what}; give the array's own full_scale_mv",
        profile.name
    ))
}

/// The reason against settings that a device says hold, if there is one: they exceed what was
/// asked or what its CAPS say, or silence what was asked for.
pub(super) fn config_refusal(
    asked: &Config,
    effective: &Config,
    caps: &Caps,
    n_channels: usize,
) -> Option<String> {
    let slew = if asked.slew == 0 {
        caps.slew_max
    } else {
        asked.slew
    };
    let volts = |dv: u16| f64::from(dv) / 10.0;
    let limit = |band: usize| {
        let asked = asked.comp_limit[band].min(caps.comp_limit[band]);
        [effective.comp_limit[band], asked].map(f64::from)
    };
    let [hold_ms, ramp_ms] = [
        [effective.hold_ms, asked.hold_ms].map(f64::from),
        [effective.ramp_ms, asked.ramp_ms].map(f64::from),
    ];
    let figures = [
        ("hold of", hold_ms, " ms"),
        ("ramp of", ramp_ms, " ms"),
        ("slew of", [effective.slew, slew].map(f64::from), " a tick"),
        (
            "high voltage of",
            [effective.hv_dv, asked.hv_dv.min(caps.hv_max_dv)].map(volts),
            " V",
        ),
        ("limit at 40 Hz of", limit(0), ""),
        ("limit at 320 Hz of", limit(1), ""),
    ];
    for (what, [held, wanted], unit) in figures {
        if held > wanted || (held <= 0.0 && wanted > 0.0) {
            return Some(format!(
                "the device grants a {what} {held}{unit} where {wanted}{unit} was asked: check its \
                 firmware"
            ));
        }
    }
    if (effective.mode, effective.flags) != (asked.mode, asked.flags) {
        return Some(format!(
            "the device answers mode {} flags {} where mode {} flags {} was asked: check its \
             firmware",
            effective.mode, effective.flags, asked.mode, asked.flags
        ));
    }
    let odd = (0..n_channels)
        .find(|channel| effective.mask.contains(*channel) != asked.mask.contains(*channel));
    if let Some(channel) = odd {
        let word = if effective.mask.contains(channel) {
            "on"
        } else {
            "off"
        };
        return Some(format!(
            "the device says that channel {channel} is {word}, which was not asked: check its \
             firmware"
        ));
    }
    silencing_refusal(effective)
}

fn silencing_refusal(effective: &Config) -> Option<String> {
    let Config {
        hold_ms, ramp_ms, ..
    } = *effective;
    if hold_ms < SHORTEST_HOLD_MS {
        return Some(format!(
            "the device holds a frame for {hold_ms} ms only, less than a tick of \
             {SHORTEST_HOLD_MS} ms: give the array a longer hold_ms"
        ));
    }
    let silent_ms = u32::from(hold_ms) + u32::from(ramp_ms);
    (silent_ms > u32::from(ArrayProfile::LONGEST_SILENCING_MS)).then(|| {
        format!(
            "the device falls silent after {silent_ms} ms, not within {} ms: shorten hold_ms or \
             ramp_ms",
            ArrayProfile::LONGEST_SILENCING_MS
        )
    })
}

/// The reason against a device that is in this state before it was armed, if there is one. Once
/// nothing is on its way (`is_settled`) it is to be ready.
pub(super) fn live_refusal(status: &Status, is_settled: bool) -> Option<String> {
    match status.device_state() {
        None => Some(format!(
            "the device is in a state ({}) that protocol version 1 does not know: check its \
             firmware",
            status.state
        )),
        Some(DeviceState::Idle) if is_settled => Some(String::from(
            "the device ended the session by itself: switch it off and on, and check its firmware",
        )),
        Some(state) if state.is_live() => Some(format!(
            "the device is {state} before it was armed: stopped; switch it off and on, and check \
             its firmware"
        )),
        _ => None,
    }
}

/// The faults that stand against arming; that the lease was lost is no fault.
pub(super) fn standing_faults(faults: u16) -> u16 {
    faults & !fault_bit::LEASE_LOST
}

/// Whether a device may be armed from here.
pub(super) fn is_at_rest(status: &Status) -> bool {
    status.device_state() == Some(DeviceState::Ready) && standing_faults(status.faults) == 0
}
