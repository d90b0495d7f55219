//! What a device tells the outside besides its output: packets, and moments worth logging.

use super::DeviceCore;
use crate::message::DeviceState;

/// A FRAME that took effect at a tick.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AppliedFrame<'a> {
    /// The moment, output included.
    pub moment: Moment,
    /// Seq of the FRAME.
    pub seq: u16,
    /// Its codes as received, `[40 Hz, 320 Hz]` per channel.
    pub codes: &'a [[u16; 2]],
}

/// The device at one instant of its own clock.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Moment {
    /// Device clock since boot in µs.
    pub dev_us: u64,
    /// Ticks since boot.
    pub tick: u32,
    /// State from now on.
    pub state: DeviceState,
    /// Age of the last accepted frame in ms; 65535 = none or older.
    pub age_ms: u16,
    /// The same in µs, as long as one was accepted since ARM or HELLO.
    pub age_us: Option<u64>,
    /// Hold and ramp gain, 0…1.
    pub gain: f64,
    /// Sum of all output codes, gain included, rounded down.
    pub amp_sum: u32,
}

/// Takes what a [`DeviceCore`] emits.
pub trait DeviceSink {
    /// One framed packet for the host.
    fn packet(&mut self, bytes: &[u8]);
    /// A FRAME took effect.
    fn applied(&mut self, _frame: &AppliedFrame<'_>) {}
    /// The state changed.
    fn changed(&mut self, _moment: &Moment) {}
    /// A step of the 1 ms clock is done; what the device puts out now holds until the next.
    fn stepped(&mut self, _device: &DeviceCore) {}
}

/// Collects the bytes and drops the rest.
impl DeviceSink for Vec<u8> {
    fn packet(&mut self, bytes: &[u8]) {
        self.extend_from_slice(bytes);
    }
}
