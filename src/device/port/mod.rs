//! A byte link to a device behind three methods, so that a serial port, a pty and an in-process
//! pair are alike.
//!
//! Reading and writing wait at most as long as they are told. Nothing here knows what the bytes
//! mean, and nothing ever flushes: a flush waits for the device.

mod holder;
mod listing;
mod pair;
mod refusal;
mod replug;
mod serial;

use std::io;
use std::time::Duration;

pub(super) use holder::holder_of;
pub use listing::PortEntry;
pub use listing::UsbIdentity;
pub use pair::PairPort;
pub use replug::{FoundPort, PortIdentity, RecognisedBy};
pub(crate) use serial::SerialLink;

/// The udev rule that gives access to arrays, keeps modem managers away and names them; for
/// `/etc/udev/rules.d/99-selvedge.rules`.
pub const UDEV_RULE: &str = include_str!("../../../assets/bridge/99-selvedge.rules");

/// One end of a byte link.
pub trait Port: Send {
    /// Name for people: a path, or `emulator`.
    fn name(&self) -> &str;

    /// Reads what is there, waiting at most `patience` for the first byte. `Ok(0)`: nothing came.
    /// An error: the link is gone.
    fn read(&mut self, buffer: &mut [u8], patience: Duration) -> io::Result<usize>;

    /// Writes one packet. `TimedOut`: the link did not take it within `patience`. Other errors: the
    /// link is gone.
    fn write(&mut self, packet: &[u8], patience: Duration) -> io::Result<()>;
}
