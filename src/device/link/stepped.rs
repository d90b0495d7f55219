//! The device at the end of a link without threads: its owner says what time it is, and all that
//! happens until then happens at once, the same every time.

use std::fmt;
use std::time::{Duration, Instant};

use super::reader::Reader;
use super::writer::{Writer, Written};
use crate::port::Port;

/// Lets a device live until something happens, at most for so long since the link was opened; the
/// time it is then.
pub(crate) type Living = Box<dyn FnMut(Duration) -> Duration + Send>;

/// Both threads' work and the device's, on the owner's thread.
pub(super) struct Stepped {
    reader: Reader,
    writer: Writer,
    /// None when the link is gone.
    port: Option<Box<dyn Port>>,
    living: Living,
    start: Instant,
    pub(super) now: Instant,
    /// Until when everything has happened: that is when the device takes what is written next.
    settled: Instant,
}

impl fmt::Debug for Stepped {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Stepped").finish_non_exhaustive()
    }
}

impl Stepped {
    pub(super) fn new(
        (reader, writer): (Reader, Writer),
        (port, living): (Box<dyn Port>, Living),
        start: Instant,
    ) -> Self {
        Self {
            reader,
            writer,
            port: Some(port),
            living,
            start,
            now: start,
            settled: start,
        }
    }

    /// Writes what waits, and lets everything happen that happens until now.
    pub(super) fn settle(&mut self) {
        let Some(port) = &mut self.port else { return };
        while self.writer.step(port.as_mut(), Some(self.settled)) == Some(Written::Yes) {}
        loop {
            let at = self.start + (self.living)(self.now.saturating_duration_since(self.start));
            if !self.reader.hear(port.as_mut(), Some(at)) {
                self.port = None;
                return;
            }
            if at >= self.now {
                self.settled = self.now;
                return;
            }
        }
    }
}
