//! Array profiles as TOML text and back, strictly: an unknown key or a wrong value is refused with
//! its line.

use std::path::Path;

use serde::{Deserialize, Serialize};

use super::check::flaw;
use super::{ArrayProfile, Calibration, DeviceUid, Wiring};
use crate::BridgeError;
use selvedge_foundation::files::{self, FileError, Flaw, Place};
use selvedge_foundation::numerics::to_whole;

/// A file larger than this is no profile, bytes.
const MAX_BYTES: usize = 1 << 20;

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct ProfileKeys {
    name: String,
    rows: u8,
    cols: u8,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pitch_mm: Option<f64>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    contactors_mm: Option<Vec<[f64; 2]>>,
    full_scale_um: [f64; 2],
    #[serde(default, skip_serializing_if = "Option::is_none")]
    full_scale_mv: Option<u32>,
    limit_um: [f64; 2],
    hold_ms: u16,
    ramp_ms: u16,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    hv_v: Option<f64>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    i_ma_max: Option<u16>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    temperature_c: Option<[f64; 2]>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    baud: Option<u32>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    calibration: Option<CalibrationKeys>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    wiring: Option<WiringKeys>,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct CalibrationKeys {
    drive_gain_40: Vec<f64>,
    drive_gain_320: Vec<f64>,
    #[serde(default)]
    off: Vec<usize>,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct WiringKeys {
    device_uid: String,
    channels: Vec<u16>,
}

impl ArrayProfile {
    /// Reads the file of a profile.
    ///
    /// # Errors
    /// It cannot be read, or a key or value is wrong: one line with file and line.
    pub fn read(path: &Path) -> Result<Self, BridgeError> {
        Self::from_toml(&files::read_text(path)?, path)
    }

    /// Reads the text of a profile's file. `path` only names it in errors.
    ///
    /// # Errors
    /// A key or value is wrong.
    pub fn from_toml(text: &str, path: &Path) -> Result<Self, BridgeError> {
        if text.len() > MAX_BYTES {
            let what = format!("{} bytes are too many for an array profile", text.len());
            return Err(FileError::whole(path, what, "name the file of a profile").into());
        }
        let keys: ProfileKeys = files::keys_from_str(text, path)?;
        let in_file = |flaw: Flaw| BridgeError::from(flaw.in_file(text, path));
        let profile = Self::from_keys(keys).map_err(in_file)?;
        flaw(&profile).map_or(Ok(profile), |flaw| Err(in_file(flaw)))
    }

    /// The text of its file. Reading it gives the same profile again.
    ///
    /// # Errors
    /// The profile holds a value that no file may hold.
    pub fn to_toml(&self) -> Result<String, BridgeError> {
        self.check()?;
        let text = files::keys_to_string(&self.keys(), Path::new(&self.name))?;
        Ok(format!("{HEAD}{text}"))
    }

    /// Writes the file of the profile; a crash leaves the old one or the new one.
    ///
    /// # Errors
    /// As [`to_toml`](Self::to_toml), or the file cannot be written.
    pub fn write(&self, path: &Path) -> Result<(), BridgeError> {
        Ok(files::write_atomic(path, self.to_toml()?.as_bytes())?)
    }

    /// Whether every value is one that a file may hold.
    ///
    /// # Errors
    /// The first that is not.
    pub fn check(&self) -> Result<(), BridgeError> {
        let Some(flaw) = flaw(self) else {
            return Ok(());
        };
        Err(FileError::whole(Path::new(&self.name), flaw.what, flaw.mend).into())
    }

    fn from_keys(keys: ProfileKeys) -> Result<Self, Flaw> {
        let (pitch_um, contactors_mm) = match (keys.pitch_mm, keys.contactors_mm) {
            (Some(pitch_mm), None) => {
                (whole(("", 0, "pitch_mm"), pitch_mm, "mm", 1e3)?, Vec::new())
            }
            (None, Some(places)) if !places.is_empty() => (0, places),
            (Some(_), Some(_)) => {
                let what = "pitch_mm and contactors_mm are both given";
                return Err(Flaw::new(("", 0, "contactors_mm"), what, "keep one"));
            }
            (None, _) => {
                let mend = "give pitch_mm, or contactors_mm = [[x, y], …]";
                return Err(Flaw::new(("", 0, "rows"), "no contactor has a place", mend));
            }
        };
        let n = usize::from(keys.rows) * usize::from(keys.cols);
        let volts = |volts| whole(("", 0, "hv_v"), volts, "V", 10.0);
        Ok(Self {
            name: keys.name,
            rows: keys.rows,
            cols: keys.cols,
            pitch_um,
            contactors_mm,
            full_scale_um: keys.full_scale_um,
            limit_um: keys.limit_um,
            hold_ms: keys.hold_ms,
            ramp_ms: keys.ramp_ms,
            full_scale_mv: keys.full_scale_mv.unwrap_or(Self::USUAL_FULL_SCALE_MV),
            hv_dv: keys.hv_v.map(volts).transpose()?,
            i_ma_max: keys.i_ma_max,
            temperature_c: keys.temperature_c,
            baud: keys.baud.unwrap_or(Self::USUAL_BAUD),
            calibration: keys
                .calibration
                .map_or_else(|| Ok(Vec::new()), |keys| calibration_from(&keys, n))?,
            wiring: keys.wiring.map(wiring_from).transpose()?,
        })
    }

    fn keys(&self) -> ProfileKeys {
        let is_grid = self.contactors_mm.is_empty();
        ProfileKeys {
            name: self.name.clone(),
            rows: self.rows,
            cols: self.cols,
            pitch_mm: is_grid.then(|| f64::from(self.pitch_um) / 1e3),
            contactors_mm: (!is_grid).then(|| self.contactors_mm.clone()),
            full_scale_um: self.full_scale_um,
            limit_um: self.limit_um,
            hold_ms: self.hold_ms,
            ramp_ms: self.ramp_ms,
            full_scale_mv: unusual(self.full_scale_mv, Self::USUAL_FULL_SCALE_MV),
            hv_v: self.hv_dv.map(|dv| f64::from(dv) / 10.0),
            i_ma_max: self.i_ma_max,
            temperature_c: self.temperature_c,
            baud: unusual(self.baud, Self::USUAL_BAUD),
            calibration: calibration_keys(&self.calibration),
            wiring: self.wiring.as_ref().map(|wiring| WiringKeys {
                device_uid: wiring.device_uid.to_string(),
                channels: wiring.channels.clone(),
            }),
        }
    }
}

/// The first lines of a file.
const HEAD: &str = "\
# Array profile of Selvedge. Amplitudes in µm peak, [40 Hz, 320 Hz]; contactors and channels
# count from 0, contactors row by row from the fingertip's left.
";

/// A value worth a line.
fn unusual(value: u32, usual: u32) -> Option<u32> {
    (value != usual).then_some(value)
}

/// A number of `unit` as a whole number of its `per_unit` parts.
fn whole(place: Place, value: f64, unit: &str, per_unit: f64) -> Result<u16, Flaw> {
    let parts = (value * per_unit).round();
    let is_whole = (value * per_unit - parts).abs() < 1e-6;
    if !is_whole || !(0.0..=f64::from(u16::MAX)).contains(&parts) {
        let what = format!("{} is {value}", place.2);
        let most = f64::from(u16::MAX) / per_unit;
        let mend = format!(
            "give 0 to {most} {unit} in steps of {} {unit}",
            1.0 / per_unit
        );
        return Err(Flaw::new(place, what, mend));
    }
    Ok(to_whole(parts))
}

fn calibration_from(keys: &CalibrationKeys, n: usize) -> Result<Vec<Calibration>, Flaw> {
    let gains = [
        ("drive_gain_40", &keys.drive_gain_40),
        ("drive_gain_320", &keys.drive_gain_320),
    ];
    if let Some((key, gains)) = gains.into_iter().find(|(_, gains)| gains.len() != n) {
        let what = format!("{} gains for {n} contactors", gains.len());
        return Err(Flaw::new(
            ("calibration", 0, key),
            what,
            "give one a contactor",
        ));
    }
    if let Some(contactor) = keys.off.iter().find(|contactor| **contactor >= n) {
        let what = format!("there is no contactor {contactor}");
        let mend = format!("contactors are 0 to {}", n.saturating_sub(1));
        return Err(Flaw::new(("calibration", 0, "off"), what, mend));
    }
    let pairs = keys.drive_gain_40.iter().zip(&keys.drive_gain_320);
    let calibration = |(contactor, (&low, &high)): (usize, (&f64, &f64))| Calibration {
        drive_gain: [low, high],
        is_off: keys.off.contains(&contactor),
    };
    Ok(pairs.enumerate().map(calibration).collect())
}

fn calibration_keys(calibration: &[Calibration]) -> Option<CalibrationKeys> {
    let gains = |band: usize| calibration.iter().map(|c| c.drive_gain[band]).collect();
    let off = calibration.iter().enumerate().filter(|(_, c)| c.is_off);
    (!calibration.is_empty()).then(|| CalibrationKeys {
        drive_gain_40: gains(0),
        drive_gain_320: gains(1),
        off: off.map(|(contactor, _)| contactor).collect(),
    })
}

fn wiring_from(keys: WiringKeys) -> Result<Wiring, Flaw> {
    let uid = DeviceUid::parse(&keys.device_uid).ok_or_else(|| {
        let what = format!("{:?} is no device's number", keys.device_uid);
        let mend = "give its 24 hexadecimal digits, as \"selvedge bridge identify\" writes them";
        Flaw::new(("wiring", 0, "device_uid"), what, mend)
    })?;
    Ok(Wiring {
        device_uid: uid,
        channels: keys.channels,
    })
}
