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

/// A tick in mode B, at its end: which samples came during it, and how loud those were that played.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SampledTick<'a> {
    /// The moment of its end, output included.
    pub moment: Moment,
    /// Counts.
    pub count: SampleCount,
    /// The largest sample that was played, as twice its size per channel, everything applied.
    pub peaks: &'a [u16],
}

/// What became of samples during a tick; samples are counted once for all channels.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct SampleCount {
    /// SAMPLES packets that were accepted.
    pub packets: u16,
    /// Samples in them.
    pub received: u32,
    /// Of those, samples whose time was over.
    pub late: u32,
    /// Values that were above their limit.
    pub clipped: u16,
    /// Samples that were played.
    pub played: u32,
    /// Samples that repeated the last one because they had not come.
    pub missing: u32,
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
    /// Mode B: these samples were played, interleaved, everything applied.
    fn played(&mut self, _first: u64, _samples: &[i16]) {}
    /// Mode B: a tick in which samples came or were played is over.
    fn sampled(&mut self, _tick: &SampledTick<'_>) {}
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
