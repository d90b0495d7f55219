//! The link to the device that is judged: bytes and the host's own time, nothing else.
//!
//! In virtual time it stands around an emulated device, in real time it is the driver's. Time here
//! only says how long to wait; what a device did when is judged by the device's own clock.

use std::io;

use super::say::packet;
use crate::driver::DirectLine;
use crate::message::kind;
use crate::wire::WiredDevice;

/// A byte link to a device, and a clock to wait by.
pub trait Line {
    /// The host's time since the line was made, µs.
    fn now_us(&self) -> u64;

    /// Writes bytes. An error: the link is gone, or takes nothing.
    fn write(&mut self, bytes: &[u8]) -> io::Result<()>;

    /// Adds what arrives to `bytes`; returns when something came, and at `until_us` at the latest.
    /// An error: the link is gone.
    fn read(&mut self, until_us: u64, bytes: &mut Vec<u8>) -> io::Result<()>;

    /// STOP with zero now, ahead of whatever waits to be written. The device's own silence is what
    /// is left where the link takes nothing.
    fn stop(&mut self) {
        drop(self.write(&packet(kind::STOP, 0, 0, &[0, 1])));
    }

    /// For the record: what is tried from now on, or what came of it.
    fn check(&mut self, _text: &str) {}
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

impl Line for DirectLine {
    fn now_us(&self) -> u64 {
        self.now_us()
    }

    fn write(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.write(bytes)
    }

    fn read(&mut self, until_us: u64, bytes: &mut Vec<u8>) -> io::Result<()> {
        self.read(until_us, bytes)
    }

    fn stop(&mut self) {
        self.stop();
    }

    fn check(&mut self, text: &str) {
        self.check(text);
    }
}
