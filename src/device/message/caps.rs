//! CAPS: what a device says of itself in answer to HELLO.

use super::device::escaped;
use super::{FieldReader, FieldWriter, Message, kind};
use crate::fields::{read_fields, write_fields};
use crate::framing::Packet;

/// What a device is and can do.
///
/// ```text
/// 0 "HBP1" | 4 session u32 | 8 version u8 | 9 n_comp u8 | 10 n_ch u16
/// 12 rows u8 | 13 cols u8 | 14 pitch_um u16
/// 16 tick_us u32 | 20 queue u8 | 21 dac_bits u8 | 22 modes u16 | 24 fs_mV u32
/// 28 hv_max_dV u16 | 30 slew_max u16
/// 32 max_body u16 | 34 sample_hz u16 | 36 freq_mHz u32[2] | 44 comp_limit u16[2] | 48 uid u8[12]
/// 60 firmware u8[3] | 63 name_len u8 | 64 UTF-8 name
/// ```
///
/// With `n_comp` other than 2 nothing behind offset 36 is read: such a device is refused anyway.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Caps {
    /// `HBP1`.
    pub magic: [u8; 4],
    /// Echo of HELLO.
    pub session: u32,
    /// Version chosen, 0 = none in common.
    pub version: u8,
    /// Components per channel.
    pub n_comp: u8,
    /// Channels.
    pub n_ch: u16,
    /// Rows of contactors.
    pub rows: u8,
    /// Columns of contactors.
    pub cols: u8,
    /// Pitch in µm.
    pub pitch_um: u16,
    /// Tick in µs.
    pub tick_us: u32,
    /// Frames that the device can hold for later ticks.
    pub queue: u8,
    /// Resolution of its converters.
    pub dac_bits: u8,
    /// Bit 0 mode A, bit 1 reserved, bit 2 IDENT, bit 3 interpolation.
    pub modes: u16,
    /// Drive peak in mV at code 65535.
    pub fs_mv: u32,
    /// Largest high voltage in 0.1 V.
    pub hv_max_dv: u16,
    /// Largest change of a code per tick.
    pub slew_max: u16,
    /// Largest body, header and CRC included.
    pub max_body: u16,
    /// Sample rate of its synthesis in Hz.
    pub sample_hz: u16,
    /// Carrier frequencies in mHz.
    pub(crate) freq_mhz: [u32; 2],
    /// Largest code per component.
    pub comp_limit: [u16; 2],
    /// Unique number.
    pub uid: [u8; 12],
    /// Firmware version.
    pub firmware: [u8; 3],
    /// Name, UTF-8, padded with zeros.
    pub name: [u8; 32],
}

impl Caps {
    /// Bit of `modes`: amplitudes.
    pub const MODE_A: u16 = 1;
    /// Bit of `modes`: IDENT.
    pub const MODE_IDENT: u16 = 1 << 2;
    /// Bit of `modes`: amplitudes may move linearly inside a tick.
    pub const INTERPOLATES: u16 = 1 << 3;

    /// The name as text, without padding; bytes that are not UTF-8 end it.
    pub fn name(&self) -> &str {
        let used = self
            .name
            .iter()
            .position(|&byte| byte == 0)
            .unwrap_or(self.name.len());
        let bytes = &self.name[..used];
        match std::str::from_utf8(bytes) {
            Ok(name) => name,
            Err(error) => std::str::from_utf8(&bytes[..error.valid_up_to()]).unwrap_or(""),
        }
    }

    /// The name for people, in one line: control characters are shown escaped, what is no UTF-8
    /// replaced.
    pub fn shown_name(&self) -> String {
        let used = self.name.iter().position(|&byte| byte == 0);
        escaped(&self.name[..used.unwrap_or(self.name.len())])
    }

    /// Pads or cuts `name` to the field.
    pub(crate) fn name_field(name: &str) -> [u8; 32] {
        let mut field = [0; 32];
        for (slot, byte) in field.iter_mut().zip(name.bytes()) {
            *slot = byte;
        }
        field
    }
}

/// What stands before the fields of two components, in order.
macro_rules! head {
    ($fields:ident, $at:expr, $caps:ident) => {
        $fields! { $at, $caps {
            magic session version n_comp n_ch rows cols pitch_um tick_us queue dac_bits modes
            fs_mv hv_max_dv slew_max max_body sample_hz
        } }
    };
}

/// What stands behind it, before the name.
macro_rules! tail {
    ($fields:ident, $at:expr, $caps:ident) => {
        $fields! { $at, $caps { freq_mhz comp_limit uid firmware } }
    };
}

impl Message for Caps {
    const KIND: u8 = kind::CAPS;

    fn decode(payload: &[u8]) -> Option<Self> {
        let mut f = FieldReader::new(payload);
        let mut caps = Self::default();
        head!(read_fields, f, caps);
        if caps.n_comp == 2 {
            tail!(read_fields, f, caps);
            let name_len = usize::from(f.take::<u8>());
            let name = f.rest().get(..name_len)?;
            for (slot, &byte) in caps.name.iter_mut().zip(name) {
                *slot = byte;
            }
        }
        f.finish(caps)
    }

    fn packet(&self, seq: u16) -> Option<Packet> {
        let name = self.name().as_bytes();
        let mut f = FieldWriter::new();
        head!(write_fields, f, self);
        tail!(write_fields, f, self);
        f.put(u8::try_from(name.len()).unwrap_or(0)).bytes(name);
        Packet::encode(Self::KIND, seq, f.finish()?)
    }
}
