//! What a STATUS may say while the device is armed. The first contradiction ends the session.

use crate::codes::ArrayProfile;
use crate::message::{Config, DeviceState, Status, StopHow, fault_bit};

use super::claims::standing_faults;

/// A measured voltage may be this share and this much above the one in force, 0.1 V.
const HV_SHARE: f64 = 1.1;
const HV_SLACK_DV: f64 = 20.0;

/// Why a session ends, and how output is to end.
pub(super) type End = (StopHow, String);

/// The contradiction in a STATUS of an armed device, `amp_sum` left out, if there is one.
pub(super) fn contradiction(
    status: &Status,
    profile: &ArrayProfile,
    effective: &Config,
) -> Option<End> {
    let faults = standing_faults(status.faults);
    state_end(status.device_state(), status.state, faults)
        .or_else(|| (faults != 0).then(|| fault_end(faults)))
        .or_else(|| voltage_end(status, effective))
        .or_else(|| sensor_end(status, profile))
}

/// The end of a session by a fault.
pub(super) fn fault_end(faults: u16) -> End {
    let names = fault_bit::names(faults);
    (
        StopHow::Ramp,
        format!("the device reports a fault: {names}; mend it, then clear it (CLEAR)"),
    )
}

fn state_end(state: Option<DeviceState>, code: u8, faults: u16) -> Option<End> {
    let reason = match state {
        None => format!("the device is in a state ({code}) that protocol version 1 does not know"),
        Some(DeviceState::Fault) => return Some(fault_end(faults)),
        Some(DeviceState::Ready) => {
            String::from("the device disarmed itself: no frame reached it in time")
        }
        Some(DeviceState::Idle) => String::from("the device ended the session by itself"),
        Some(_) => return None,
    };
    Some((StopHow::Ramp, reason))
}

fn voltage_end(status: &Status, effective: &Config) -> Option<End> {
    let most_dv = HV_SHARE * f64::from(effective.hv_dv) + HV_SLACK_DV;
    (f64::from(status.hv_dv) > most_dv).then(|| {
        let [is_v, asked_v] = [status.hv_dv, effective.hv_dv].map(|dv| f64::from(dv) / 10.0);
        let reason = format!("the device measures {is_v} V where {asked_v} V are in force");
        (StopHow::Now, format!("{reason}: check its supply"))
    })
}

fn sensor_end(status: &Status, profile: &ArrayProfile) -> Option<End> {
    let celsius = f64::from(status.temp_cdeg) / 100.0;
    let [widest_low, widest_high] = ArrayProfile::TEMPERATURE_C;
    let [low, high] = profile.temperature_c.unwrap_or(ArrayProfile::TEMPERATURE_C);
    let (low, high) = (low.max(widest_low), high.min(widest_high));
    if !(low..=high).contains(&celsius) {
        let reason = format!("the device is at {celsius} °C, outside {low} to {high} °C");
        return Some((StopHow::Ramp, reason));
    }
    let most_ma = profile.i_ma_max.filter(|most_ma| status.i_ma > *most_ma)?;
    let reason = format!(
        "the device takes {} mA where the array \"{}\" allows {most_ma} mA",
        status.i_ma, profile.name
    );
    Some((StopHow::Ramp, reason))
}
