//! A serial port: opening it with a reason when that fails, reading and writing with time-outs.
//!
//! Write one packet per call. The operating system's write may block beyond any time-out when it is
//! given more than fits, so a packet goes out in pieces that fit whenever it takes any.

use std::fmt;
use std::io;
use std::time::Duration;

use serialport::{ClearBuffer, SerialPort};

use super::Port;
use super::refusal::open_error;
use crate::BridgeError;

/// A terminal that takes anything has room for this much.
const LARGEST_PIECE: usize = 128;
const OPEN_PATIENCE: Duration = Duration::from_millis(50);

/// An open serial port.
pub(crate) struct SerialLink {
    port: Box<dyn SerialPort>,
    name: String,
}

impl fmt::Debug for SerialLink {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("SerialLink")
            .field("name", &self.name)
            .finish_non_exhaustive()
    }
}

impl SerialLink {
    /// Opens `path` at `baud` for this program alone and drops whatever input it holds. May block:
    /// not for a GUI thread.
    pub(crate) fn open(path: &str, baud: u32) -> Result<Self, BridgeError> {
        let opened = serialport::new(path, baud).timeout(OPEN_PATIENCE).open();
        let port = opened.map_err(|error| open_error(path, &error))?;
        let link = Self::from_port(port, path);
        // What cannot be purged is ignored by the session until its own CAPS.
        drop(link.port.clear(ClearBuffer::Input));
        Ok(link)
    }

    /// Wraps an open port.
    pub(crate) fn from_port(port: Box<dyn SerialPort>, name: &str) -> Self {
        Self {
            port,
            name: String::from(name),
        }
    }

    /// A second handle, so that one thread can read while another writes.
    pub(crate) fn try_clone(&self) -> Result<Self, BridgeError> {
        let port = self.port.try_clone().map_err(|error| BridgeError::Open {
            port: self.name.clone(),
            reason: format!("cannot be read and written at once: {error}"),
        })?;
        Ok(Self {
            port,
            name: self.name.clone(),
        })
    }

    fn set_patience(&mut self, patience: Duration) -> io::Result<()> {
        self.port.set_timeout(patience).map_err(io::Error::from)
    }
}

impl Port for SerialLink {
    fn name(&self) -> &str {
        &self.name
    }

    fn read(&mut self, buffer: &mut [u8], patience: Duration) -> io::Result<usize> {
        self.set_patience(patience)?;
        match self.port.read(buffer) {
            Ok(0) => Err(io::ErrorKind::BrokenPipe.into()),
            Ok(count) => Ok(count),
            Err(error) if is_patience(&error) => Ok(0),
            Err(error) => Err(error),
        }
    }

    fn write(&mut self, packet: &[u8], patience: Duration) -> io::Result<()> {
        self.set_patience(patience)?;
        let mut rest = packet;
        while !rest.is_empty() {
            let piece = rest.get(..LARGEST_PIECE).unwrap_or(rest);
            match self.port.write(piece) {
                Ok(0) => return Err(io::ErrorKind::BrokenPipe.into()),
                Ok(count) => rest = rest.get(count..).unwrap_or(&[]),
                Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
                Err(error) => return Err(error),
            }
        }
        Ok(())
    }
}

fn is_patience(error: &io::Error) -> bool {
    matches!(
        error.kind(),
        io::ErrorKind::TimedOut | io::ErrorKind::Interrupted | io::ErrorKind::WouldBlock
    )
}

#[cfg(all(test, unix))]
mod tests {
    use super::*;

    const BAUD: u32 = 1_000_000;

    #[test]
    fn ports_that_do_not_open_say_why_in_one_line() {
        let folder = std::env::temp_dir();
        for (path, word) in [
            (
                folder.join("no-such-port").display().to_string(),
                "no such port",
            ),
            (String::from("/dev/null"), "not a serial port"),
            (folder.display().to_string(), "cannot be opened"),
            (String::new(), "no such port"),
        ] {
            let message = SerialLink::open(&path, BAUD).unwrap_err().to_string();
            assert!(
                message.contains(word) && !message.contains('\n'),
                "{message}"
            );
            assert!(message.starts_with(&path));
        }
    }

    #[test]
    fn a_port_has_the_rate_that_it_was_opened_with() {
        let (_master, slave) = serialport::TTYPort::pair().unwrap();
        let path = slave.name().unwrap();
        for baud in [115_200, 250_000, 1_000_000] {
            let link = SerialLink::open(&path, baud).unwrap();
            assert_eq!(link.port.baud_rate().unwrap(), baud);
        }
    }

    #[test]
    fn a_second_opener_is_told_that_the_port_is_in_use() {
        let (_master, slave) = serialport::TTYPort::pair().unwrap();
        let path = slave.name().unwrap();
        let _first = SerialLink::open(&path, BAUD).unwrap();
        let message = SerialLink::open(&path, BAUD).unwrap_err().to_string();
        assert!(message.contains("in use by another program"), "{message}");
    }

    #[test]
    fn a_port_that_takes_nothing_times_out_for_packets_of_any_size() {
        for length in [16, 111, 500, 1031] {
            let (_master, slave) = serialport::TTYPort::pair().unwrap();
            let mut link = SerialLink::open(&slave.name().unwrap(), BAUD).unwrap();
            let packet = vec![7; length];
            let error = (0..10_000).find_map(|_| {
                let patience = Duration::from_millis(5);
                link.write(&packet, patience).err()
            });
            assert_eq!(error.unwrap().kind(), io::ErrorKind::TimedOut, "{length}");
        }
    }

    #[test]
    fn a_vanished_device_is_an_error_and_silence_is_none() {
        let (master, slave) = serialport::TTYPort::pair().unwrap();
        let mut link = SerialLink::open(&slave.name().unwrap(), BAUD).unwrap();
        let mut buffer = [0; 8];
        assert_eq!(link.read(&mut buffer, Duration::ZERO).unwrap(), 0);
        drop(master);
        drop(slave);
        assert!(link.read(&mut buffer, Duration::ZERO).is_err());
        assert!(link.write(&[0], Duration::ZERO).is_err());
    }
}
