//! The link to the device that is judged: bytes and the host's own time, nothing else.
//!
//! In virtual time it stands around an emulated device, in real time around a port. Time here only
//! says how long to wait; what a device did when is judged by the device's own clock.

use std::io;
use std::time::{Duration, Instant};

use crate::port::Port;
use crate::wire::WiredDevice;

/// How long a port may take one packet, twice at most.
const WRITE_PATIENCE: Duration = Duration::from_millis(100);

/// A byte link to a device, and a clock to wait by.
pub trait Line {
    /// The host's time since the line was made, µs.
    fn now_us(&self) -> u64;

    /// Writes bytes. An error: the link is gone, or takes nothing.
    fn write(&mut self, bytes: &[u8]) -> io::Result<()>;

    /// Adds what arrives to `bytes`; returns when something came, and at `until_us` at the latest.
    /// An error: the link is gone.
    fn read(&mut self, until_us: u64, bytes: &mut Vec<u8>) -> io::Result<()>;
}

/// An emulated device and its link in virtual time: waiting takes none of ours.
#[derive(Debug)]
pub struct VirtualLine {
    device: WiredDevice,
    now_us: u64,
}

impl VirtualLine {
    /// A line to this device, `at_us` after its boot.
    pub fn new(device: WiredDevice, at_us: u64) -> Self {
        let mut line = Self { device, now_us: 0 };
        line.advance(at_us, &mut Vec::new());
        line
    }

    /// The device at its end.
    pub fn device(&self) -> &WiredDevice {
        &self.device
    }

    fn advance(&mut self, to_us: u64, bytes: &mut Vec<u8>) {
        self.device.advance(to_us, bytes);
        self.now_us = to_us;
    }
}

impl Line for VirtualLine {
    fn now_us(&self) -> u64 {
        self.now_us
    }

    fn write(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.device.host_wrote(self.now_us, bytes);
        Ok(())
    }

    fn read(&mut self, until_us: u64, bytes: &mut Vec<u8>) -> io::Result<()> {
        let n_before = bytes.len();
        loop {
            let due_us = self.device.next_deadline_us().unwrap_or(until_us);
            let to_us = due_us.min(until_us).max(self.now_us);
            self.advance(to_us, bytes);
            if bytes.len() > n_before || to_us >= until_us {
                return Ok(());
            }
        }
    }
}

/// A port in real time.
pub(crate) struct PortLine<'a> {
    port: &'a mut dyn Port,
    start: Instant,
}

impl<'a> PortLine<'a> {
    /// A line over an open port.
    pub(crate) fn new(port: &'a mut dyn Port) -> Self {
        Self {
            port,
            start: Instant::now(),
        }
    }
}

impl Line for PortLine<'_> {
    fn now_us(&self) -> u64 {
        u64::try_from(self.start.elapsed().as_micros()).unwrap_or(u64::MAX)
    }

    fn write(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.port
            .write(bytes, WRITE_PATIENCE)
            .or_else(|error| match error.kind() {
                // Whatever was cut off ends with the zero that opens the next.
                io::ErrorKind::TimedOut => self.port.write(bytes, WRITE_PATIENCE),
                _ => Err(error),
            })
    }

    fn read(&mut self, until_us: u64, bytes: &mut Vec<u8>) -> io::Result<()> {
        let mut buffer = [0; 1024];
        let left = Duration::from_micros(until_us.saturating_sub(self.now_us()));
        let count = self.port.read(&mut buffer, left)?;
        bytes.extend_from_slice(buffer.get(..count).unwrap_or(&[]));
        Ok(())
    }
}
