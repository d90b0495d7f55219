//! Array profiles: what the host takes an array to be, contactor by contactor.
//!
//! A profile states shape, scale, limits, how strongly each contactor must be driven, and which
//! channel of which device drives it. It is kept in a TOML file (`file.rs`); three are part of the
//! program (`shipped.rs`); the wiring is found by asking a person (`wiring.rs`). What a profile
//! makes of an amplitude is decided in `codes` and nowhere else.

mod check;
mod file;
mod folder;
mod shipped;
pub mod wiring;

pub use folder::ProfileFolder;

use std::fmt;

/// What the host assumes of an array: shape, scale, limits, calibration and wiring.
///
/// The scale is an assumption of this program (50 µm at 50 V), not a property that a device
/// reports; what voltage a code stands for is.
#[derive(Clone, Debug, PartialEq)]
pub struct ArrayProfile {
    /// Name for people, `exeter-24`.
    pub name: String,
    /// Rows, the fingertip end first.
    pub rows: u8,
    /// Columns, left first.
    pub cols: u8,
    /// Distance of neighbouring contactors in µm.
    pub pitch_um: u16,
    /// Places of contactors that form no grid, seen from the middle, mm; empty for a grid.
    pub contactors_mm: Vec<[f64; 2]>,
    /// `[F40, F320]`: peak displacement in µm at a drive peak of `full_scale_mv`.
    pub full_scale_um: [f64; 2],
    /// Drive peak at which `full_scale_um` holds, mV.
    pub full_scale_mv: u32,
    /// Largest amplitude per band in µm.
    pub limit_um: [f64; 2],
    /// Time without an accepted frame before the device starts its ramp, in ms.
    pub hold_ms: u16,
    /// Duration of the device's ramp to silence, in ms.
    pub ramp_ms: u16,
    /// High voltage to ask for, in 0.1 V; `None`: what the device gives at most.
    pub hv_dv: Option<u16>,
    /// Supply current above which output ends, mA; `None`: it is not judged.
    pub i_ma_max: Option<u16>,
    /// Lowest and highest temperature at which output goes on, °C; `None`: −10 to 70.
    pub temperature_c: Option<[f64; 2]>,
    /// Symbols a second of a serial line; USB ignores it.
    pub baud: u32,
    /// One a contactor; those beyond its end are as at first.
    pub calibration: Vec<Calibration>,
    /// Which channel drives which contactor; `None`: channel 0 drives contactor 0, and so on.
    pub wiring: Option<Wiring>,
}

/// How one contactor answers its drive.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Calibration {
    /// Drive that the contactor needs for an amplitude, as a multiple of what the full scale says,
    /// `[40 Hz, 320 Hz]`: 1.25 for one that moves 40 µm where 50 are meant.
    pub drive_gain: [f64; 2],
    /// Whether it is never driven: dead, or better left alone.
    pub is_off: bool,
}

impl Calibration {
    /// Smallest and largest gain: what differs by more than a factor of 4 is broken.
    pub const DRIVE_GAIN: [f64; 2] = [0.25, 4.0];

    /// Whether the contactor answers its drive as full scale says, in both bands.
    pub fn is_nominal(self) -> bool {
        self.drive_gain
            .iter()
            .all(|gain| (gain - 1.0).abs() < 1e-12)
    }
}

impl Default for Calibration {
    fn default() -> Self {
        Self {
            drive_gain: [1.0; 2],
            is_off: false,
        }
    }
}

/// Which channel of a device drives which contactor, and the device that this was measured on.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Wiring {
    /// The device.
    pub device_uid: DeviceUid,
    /// The channel of each contactor, in contactor order; each channel once.
    pub channels: Vec<u16>,
}

/// The unique number in a device's CAPS; reads and prints as 24 hexadecimal digits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct DeviceUid(pub [u8; 12]);

impl DeviceUid {
    /// The number of every emulator, in this program or behind a port.
    pub const EMULATOR: Self = Self(*b"selvedge-emu");

    /// The number that these 24 digits write.
    pub fn parse(digits: &str) -> Option<Self> {
        if digits.len() != 24 || !digits.bytes().all(|digit| digit.is_ascii_hexdigit()) {
            return None;
        }
        let mut uid = [0; 12];
        for (place, byte) in uid.iter_mut().enumerate() {
            *byte = u8::from_str_radix(digits.get(2 * place..2 * place + 2)?, 16).ok()?;
        }
        Some(Self(uid))
    }
}

impl fmt::Display for DeviceUid {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.iter().try_for_each(|byte| write!(f, "{byte:02x}"))
    }
}

impl ArrayProfile {
    /// Largest full scale that a file or a field takes, µm.
    pub const LARGEST_SCALE_UM: f64 = 1000.0;
    /// Smallest full scale, µm.
    pub const SMALLEST_SCALE_UM: f64 = 0.1;
    /// Hold and ramp together take at most this, ms.
    pub const LONGEST_SILENCING_MS: u16 = 100;
    /// Largest high voltage to ask for, 0.1 V.
    pub const LARGEST_HV_DV: u16 = 5000;
    /// Drive peak of full scale where a profile names none, mV.
    pub const USUAL_FULL_SCALE_MV: u32 = 50_000;
    /// Largest drive peak of full scale, mV.
    pub const LARGEST_FULL_SCALE_MV: u32 = 1_000_000;
    /// Symbols a second where a profile names none.
    pub(crate) const USUAL_BAUD: u32 = 1_000_000;
    /// Slowest and fastest rate of a serial line: a slower one has no time for frames.
    pub const BAUD: [u32; 2] = [115_200, 12_000_000];
    /// Temperatures outside of which no device works, °C.
    pub const TEMPERATURE_C: [f64; 2] = [-10.0, 70.0];

    /// A rate of a serial line as people write it, baud.
    ///
    /// # Errors
    /// One line: what was expected.
    pub fn read_baud(word: &str) -> Result<u32, String> {
        let [slowest, fastest] = Self::BAUD;
        let rate = word.trim().parse().ok();
        rate.filter(|rate| (slowest..=fastest).contains(rate))
            .ok_or_else(|| format!("give a whole number, {slowest} to {fastest} baud"))
    }

    /// `rows · cols`.
    pub fn n_contactors(&self) -> usize {
        usize::from(self.rows) * usize::from(self.cols)
    }

    /// How a contactor answers its drive.
    pub fn calibration_of(&self, contactor: usize) -> Calibration {
        self.calibration.get(contactor).copied().unwrap_or_default()
    }

    /// Changes how a contactor answers its drive. One beyond the array is left alone.
    pub fn set_calibration(&mut self, contactor: usize, calibration: Calibration) {
        if contactor >= self.n_contactors() {
            return;
        }
        if self.calibration.len() <= contactor {
            let n = self.n_contactors();
            self.calibration.resize(n, Calibration::default());
        }
        self.calibration[contactor] = calibration;
        if self
            .calibration
            .iter()
            .all(|c| *c == Calibration::default())
        {
            self.calibration.clear();
        }
    }

    /// The channel that drives a contactor, as far as it was measured.
    pub fn channel_of(&self, contactor: usize) -> usize {
        let wired = self.wiring.as_ref();
        let channel = wired.and_then(|wiring| wiring.channels.get(contactor).copied());
        channel.map_or(contactor, usize::from)
    }

    /// Where the contactors are, seen from the middle, mm: x to the right, y to the fingertip.
    pub fn places_mm(&self) -> Vec<[f64; 2]> {
        if !self.contactors_mm.is_empty() {
            return self.contactors_mm.clone();
        }
        let pitch_mm = f64::from(self.pitch_um) * 1e-3;
        let middle = |count: u8| (f64::from(count) - 1.0) / 2.0;
        let columns = move |row: u8| (0..self.cols).map(move |column| (row, column));
        let place = |(row, column): (u8, u8)| {
            let x_mm = (f64::from(column) - middle(self.cols)) * pitch_mm;
            [x_mm, (middle(self.rows) - f64::from(row)) * pitch_mm]
        };
        (0..self.rows).flat_map(columns).map(place).collect()
    }

    /// Whether a device that obeys `before` may obey this at once, whatever it does: every drive
    /// code is at most what it was, on the same channel, and everything else is as it was.
    pub fn only_lowers(&self, before: &Self) -> bool {
        let is_same_array = (self.rows, self.cols, &self.wiring)
            == (before.rows, before.cols, &before.wiring)
            && self.full_scale_um.map(f64::to_bits) == before.full_scale_um.map(f64::to_bits)
            && self.full_scale_mv == before.full_scale_mv
            && (self.hold_ms, self.ramp_ms, self.hv_dv)
                == (before.hold_ms, before.ramp_ms, before.hv_dv);
        let at_most = |new: [f64; 2], old: [f64; 2]| new[0] <= old[0] && new[1] <= old[1];
        let is_lower = |contactor: usize| {
            let [new, old] = [self, before].map(|profile| profile.calibration_of(contactor));
            new.is_off || (!old.is_off && at_most(new.drive_gain, old.drive_gain))
        };
        is_same_array
            && at_most(self.limit_um, before.limit_um)
            && (0..self.n_contactors()).all(is_lower)
    }

    /// The same with limits of at most this share of full scale, 0…1.
    #[must_use]
    pub fn capped(mut self, share: f64) -> Self {
        for (limit_um, full_um) in self.limit_um.iter_mut().zip(self.full_scale_um) {
            *limit_um = limit_um.min(share.clamp(0.0, 1.0) * full_um);
        }
        self
    }

    /// Why the device with this number may not be wired as this profile says, in one line; `None`
    /// when it is the one that was measured, or none was.
    pub fn wiring_doubt(&self, connected: DeviceUid) -> Option<String> {
        let measured = self.wiring.as_ref()?.device_uid;
        (measured != connected).then(|| {
            format!(
                "the wiring in \"{}\" was measured on device {measured}, this is {connected}: \
                 identify its channels again",
                self.name
            )
        })
    }

    /// What is to be said when the device with the number `now` follows the one with `before`, in
    /// one line; `None` when it is the same. What was measured on an array is not said of another.
    pub(crate) fn other_device(&self, before: DeviceUid, now: DeviceUid) -> Option<String> {
        let is_wired_for = |wiring: &Wiring| wiring.device_uid == now;
        let is_its_own = self.wiring.as_ref().is_some_and(is_wired_for);
        let measured = match (self.calibration.is_empty(), self.wiring.is_none()) {
            _ if is_its_own => None,
            (true, true) => None,
            (false, true) => Some("calibration"),
            (true, false) => Some("wiring"),
            (false, false) => Some("calibration and wiring"),
        };
        let mend = measured.map_or_else(String::new, |what| {
            format!(
                "; {what} in \"{}\" may be of the other one: choose this device's own profile, or \
                 identify its channels and measure its gains",
                self.name
            )
        });
        let said = format!("another device than before: {now}, it was {before}{mend}");
        (before != now).then_some(said)
    }
}

impl Default for ArrayProfile {
    fn default() -> Self {
        Self {
            name: String::from("exeter-24"),
            rows: 6,
            cols: 4,
            pitch_um: 2000,
            contactors_mm: Vec::new(),
            full_scale_um: [50.0, 50.0],
            limit_um: [50.0, 50.0],
            hold_ms: 60,
            ramp_ms: 40,
            full_scale_mv: Self::USUAL_FULL_SCALE_MV,
            hv_dv: Some(600),
            i_ma_max: None,
            temperature_c: None,
            baud: Self::USUAL_BAUD,
            calibration: Vec::new(),
            wiring: None,
        }
    }
}

#[cfg(test)]
mod tests;
