//! What an emulated device says of itself in CAPS.

use super::lie::FirmwareLie;
use super::miswiring::Miswiring;
use super::sense::Load;
use crate::array::DeviceUid;
use crate::codes::ArrayProfile;
use crate::framing::{CRC_LEN, HEADER_LEN, LARGEST_BODY};
use crate::message::{Caps, Config, MAGIC, TICK_US, frame};

/// Samples a second of its converters.
pub(super) const SAMPLE_HZ: u16 = 8000;

/// Build-time properties of a device; the default is a 6 × 4 array with plain capabilities.
#[derive(Clone, Debug, PartialEq)]
pub struct DeviceModel {
    /// Rows of contactors.
    pub rows: u8,
    /// Columns of contactors.
    pub cols: u8,
    /// Pitch in µm.
    pub pitch_um: u16,
    /// Frames that can wait for later ticks.
    pub queue: u8,
    /// Bits as in [`Caps::modes`].
    pub modes: u16,
    /// Largest change of a code per tick.
    pub slew_max: u16,
    /// Largest code per component.
    pub comp_limit: [u16; 2],
    /// Largest body in bytes.
    pub max_body: u16,
    /// Largest high voltage in 0.1 V.
    pub hv_max_dv: u16,
    /// Name shown to people, at most 32 bytes.
    pub name: String,
    /// What it says although it is not so, and the rules that it breaks.
    pub lies: Vec<FirmwareLie>,
    /// How its contactors are connected.
    pub wiring: Miswiring,
    /// What its amplifiers take; `None`: it measures no current.
    pub load: Option<Load>,
    /// The current above which it reports over-current, mA; `None`: it never does by itself.
    pub over_current_ma: Option<u16>,
}

impl Default for DeviceModel {
    fn default() -> Self {
        Self {
            rows: 6,
            cols: 4,
            pitch_um: 2000,
            queue: 4,
            modes: Caps::MODE_A | Caps::MODE_IDENT,
            slew_max: u16::MAX,
            comp_limit: [u16::MAX; 2],
            max_body: 256,
            hv_max_dv: 600,
            name: String::from("emulated array"),
            lies: Vec::new(),
            wiring: Miswiring::default(),
            load: None,
            over_current_ma: None,
        }
    }
}

impl DeviceModel {
    /// A device shaped like `profile`; its largest body grows with the number of channels, up to
    /// 1024 bytes.
    pub fn for_array(profile: &ArrayProfile) -> Self {
        let needed = HEADER_LEN + frame::payload_len(profile.n_contactors()) + CRC_LEN;
        Self {
            rows: profile.rows,
            cols: profile.cols,
            pitch_um: profile.pitch_um,
            max_body: u16::try_from(needed.clamp(256, LARGEST_BODY)).unwrap_or(u16::MAX),
            ..Self::default()
        }
    }

    /// Number of channels, `rows · cols`.
    pub fn n_channels(&self) -> usize {
        usize::from(self.rows) * usize::from(self.cols)
    }

    /// The CAPS for a session.
    pub fn caps(&self, session: u32, version: u8) -> Caps {
        Caps {
            magic: MAGIC,
            session,
            version,
            n_comp: 2,
            n_ch: u16::from(self.rows) * u16::from(self.cols),
            rows: self.rows,
            cols: self.cols,
            pitch_um: self.pitch_um,
            tick_us: TICK_US,
            queue: self.queue,
            dac_bits: 12,
            modes: self.modes,
            fs_mv: 50_000,
            hv_max_dv: self.hv_max_dv,
            slew_max: self.slew_max,
            max_body: self.max_body,
            sample_hz: SAMPLE_HZ,
            freq_mhz: [40_000, 320_000],
            comp_limit: self.comp_limit,
            uid: DeviceUid::EMULATOR.0,
            firmware: [1, 0, 0],
            name: Caps::name_field(&self.name),
        }
    }

    /// The values that hold when a host asks for `wish`: everything within build-time limits,
    /// silence within 100 ms.
    pub fn clamp(&self, wish: &Config) -> Config {
        let hold_ms = wish.hold_ms.min(100);
        let all = crate::message::ChannelMask::first(self.n_channels());
        Config {
            mode: Config::AMPLITUDES,
            flags: if self.modes & Caps::INTERPOLATES == 0 {
                0
            } else {
                wish.flags & Config::INTERPOLATE
            },
            hold_ms,
            ramp_ms: wish.ramp_ms.min(100 - hold_ms),
            slew: if wish.slew == 0 {
                self.slew_max
            } else {
                wish.slew.min(self.slew_max)
            },
            hv_dv: wish.hv_dv.min(self.hv_max_dv),
            comp_limit: [0, 1].map(|band| wish.comp_limit[band].min(self.comp_limit[band])),
            mask: wish.mask.and(&all),
        }
    }
}
