//! What makes a profile's values wrong, and how to mend them: one list of rules for files and for
//! values that come from anywhere else.

use super::{ArrayProfile, Calibration};
use crate::message::LARGEST_CHANNELS;
use selvedge_foundation::files::Flaw;

/// The first thing that is wrong with a profile.
pub(super) fn flaw(profile: &ArrayProfile) -> Option<Flaw> {
    shape_flaw(profile)
        .or_else(|| places_flaw(profile))
        .or_else(|| scale_flaw(profile))
        .or_else(|| silencing_flaw(profile))
        .or_else(|| link_flaw(profile))
        .or_else(|| calibration_flaw(profile))
        .or_else(|| wiring_flaw(profile))
}

fn shape_flaw(profile: &ArrayProfile) -> Option<Flaw> {
    let n = profile.n_contactors();
    if profile.name.trim().is_empty() {
        let mend = "give the array a name";
        return Some(Flaw::new(("", 0, "name"), "the name is empty", mend));
    }
    if n == 0 || n > LARGEST_CHANNELS {
        let what = format!("{} rows × {} columns", profile.rows, profile.cols);
        let mend = format!("give 1 to {LARGEST_CHANNELS} contactors: a frame carries no more");
        return Some(Flaw::new(("", 0, "rows"), what, mend));
    }
    if profile.contactors_mm.is_empty() && profile.pitch_um == 0 {
        let mend = "give a pitch of 0.001 to 65.535 mm";
        return Some(Flaw::new(("", 0, "pitch_mm"), "the pitch is 0", mend));
    }
    None
}

fn places_flaw(profile: &ArrayProfile) -> Option<Flaw> {
    let places = &profile.contactors_mm;
    let flaw = |what: String, mend: &str| Some(Flaw::new(("", 0, "contactors_mm"), what, mend));
    if !places.is_empty() && places.len() != profile.n_contactors() {
        let n = profile.n_contactors();
        let what = format!("{} places for {n} contactors", places.len());
        return flaw(what, "give one place a contactor, or change rows and cols");
    }
    let is_near = |mm: &f64| mm.abs() <= 1000.0;
    if let Some(at) = places.iter().position(|xy| !xy.iter().all(is_near)) {
        let what = format!("contactor {at} is at {:?} mm", places[at]);
        return flaw(what, "give places within 1000 mm of the middle");
    }
    let is_taken = |(at, xy): (usize, &[f64; 2])| {
        let other = places[..at]
            .iter()
            .position(|other| same(*other) == same(*xy))?;
        Some((other, at))
    };
    let (other, at) = places.iter().enumerate().find_map(is_taken)?;
    let what = format!("contactors {other} and {at} are at the same place");
    flaw(what, "give every contactor a place of its own")
}

/// A place as bits; adding zero makes −0 the same place as 0.
fn same(place_mm: [f64; 2]) -> [u64; 2] {
    place_mm.map(|mm| (mm + 0.0).to_bits())
}

fn scale_flaw(profile: &ArrayProfile) -> Option<Flaw> {
    let [least, most] = [
        ArrayProfile::SMALLEST_SCALE_UM,
        ArrayProfile::LARGEST_SCALE_UM,
    ];
    for (full_um, limit_um) in profile.full_scale_um.into_iter().zip(profile.limit_um) {
        if !(least..=most).contains(&full_um) {
            let what = format!("a full scale of {full_um} µm");
            let mend = format!("give {least} to {most} µm for each band");
            return Some(Flaw::new(("", 0, "full_scale_um"), what, mend));
        }
        if !(0.0..=full_um).contains(&limit_um) {
            let what = format!("a limit of {limit_um} µm where full scale is {full_um} µm");
            let mend = "give 0 to the full scale of that band";
            return Some(Flaw::new(("", 0, "limit_um"), what, mend));
        }
    }
    None
}

fn silencing_flaw(profile: &ArrayProfile) -> Option<Flaw> {
    let max_ms = ArrayProfile::LONGEST_SILENCING_MS;
    let (hold_ms, ramp_ms) = (profile.hold_ms, profile.ramp_ms);
    if hold_ms > max_ms {
        let what = format!("hold_ms is {hold_ms}");
        return Some(Flaw::new(
            ("", 0, "hold_ms"),
            what,
            format!("give 0 to {max_ms} ms"),
        ));
    }
    if ramp_ms > max_ms - hold_ms {
        let what = format!(
            "hold and ramp take {} ms",
            u32::from(hold_ms) + u32::from(ramp_ms)
        );
        let mend = format!("the array must be silent within {max_ms} ms: shorten one");
        return Some(Flaw::new(("", 0, "ramp_ms"), what, mend));
    }
    if let Some(hv_dv) = profile.hv_dv.filter(|dv| *dv > ArrayProfile::LARGEST_HV_DV) {
        let most_v = f64::from(ArrayProfile::LARGEST_HV_DV) / 10.0;
        let what = format!("a high voltage of {} V", f64::from(hv_dv) / 10.0);
        return Some(Flaw::new(
            ("", 0, "hv_v"),
            what,
            format!("give 0 to {most_v} V"),
        ));
    }
    None
}

fn link_flaw(profile: &ArrayProfile) -> Option<Flaw> {
    let most_mv = ArrayProfile::LARGEST_FULL_SCALE_MV;
    if !(1..=most_mv).contains(&profile.full_scale_mv) {
        let what = format!("full_scale_mv is {}", profile.full_scale_mv);
        let mend = format!("give 1 to {most_mv} mV: the drive peak at full_scale_um");
        return Some(Flaw::new(("", 0, "full_scale_mv"), what, mend));
    }
    if let Some([low, high]) = profile.temperature_c
        && !(low.is_finite() && high.is_finite() && low < high)
    {
        let what = format!("temperature_c is [{low}, {high}]");
        let mend = "give the lowest and the highest temperature, °C";
        return Some(Flaw::new(("", 0, "temperature_c"), what, mend));
    }
    let [least, most] = ArrayProfile::BAUD;
    if !(least..=most).contains(&profile.baud) {
        let what = format!("baud is {}", profile.baud);
        let mend = format!("give {least} to {most} symbols a second");
        return Some(Flaw::new(("", 0, "baud"), what, mend));
    }
    None
}

fn calibration_flaw(profile: &ArrayProfile) -> Option<Flaw> {
    let (n, given) = (profile.n_contactors(), profile.calibration.len());
    let keys = ["drive_gain_40", "drive_gain_320"];
    if given != 0 && given != n {
        let what = format!("{given} gains for {n} contactors");
        return Some(Flaw::new(
            ("calibration", 0, keys[0]),
            what,
            "give one a contactor",
        ));
    }
    let [least, most] = Calibration::DRIVE_GAIN;
    for (contactor, calibration) in profile.calibration.iter().enumerate() {
        for (gain, key) in calibration.drive_gain.into_iter().zip(keys) {
            if !(least..=most).contains(&gain) {
                let what = format!("contactor {contactor} has a drive gain of {gain}");
                let mend =
                    format!("give {least} to {most}; a contactor that is dead stands in off");
                return Some(Flaw::new(("calibration", 0, key), what, mend));
            }
        }
    }
    None
}

fn wiring_flaw(profile: &ArrayProfile) -> Option<Flaw> {
    let wiring = profile.wiring.as_ref()?;
    let n = profile.n_contactors();
    let flaw = |what: String, mend: String| Some(Flaw::new(("wiring", 0, "channels"), what, mend));
    let whole = format!(
        "give every channel from 0 to {} once, in contactor order",
        n - 1
    );
    if wiring.channels.len() != n {
        let what = format!("{} channels for {n} contactors", wiring.channels.len());
        return flaw(what, whole);
    }
    let mut user: Vec<Option<usize>> = vec![None; n];
    for (contactor, channel) in wiring.channels.iter().enumerate() {
        let Some(slot) = user.get_mut(usize::from(*channel)) else {
            return flaw(
                format!("contactor {contactor} is on channel {channel}"),
                whole,
            );
        };
        if let Some(other) = slot.replace(contactor) {
            let what = format!("contactors {other} and {contactor} are both on channel {channel}");
            return flaw(what, whole);
        }
    }
    None
}
