//! A device that is spoken to without a session, by whoever must say what no host says.
//!
//! Threads, STOP slot, panic hook and record are those of every other session; what is said, when,
//! and what comes of it is the owner's. Nothing paces it.

use std::io;
use std::sync::Arc;
use std::thread;
use std::time::{Duration, Instant};

use super::{GOODBYE, stop_on_panic};
use crate::BridgeError;
use crate::codes::ArrayProfile;
use crate::framing::Packet;
use crate::handle::{Target, host_counters};
use crate::host::Sequence;
use crate::link::{Hearing, Incoming, Link};
use crate::message::StopHow;
use crate::session_log::{LogFeed, Note, event};
use selvedge_foundation::panics::OnPanic;

/// How long a port may take until there is room for more.
const ROOM_PATIENCE: Duration = Duration::from_millis(200);
/// Between two looks whether there is room.
const NAP: Duration = Duration::from_millis(1);
/// Bytes of one write at most.
const LARGEST_WRITE: usize = 1024;
/// About as many bytes are taken at once.
const LARGEST_READ: usize = 64 * 1024;

/// The link of a device without a session.
#[derive(Debug)]
pub struct DirectLine {
    link: Link,
    start: Instant,
    log: Option<LogFeed>,
    _on_panic: OnPanic,
}

impl DirectLine {
    /// Opens `target`, on the thread that will speak to it, and records what passes. A panic of any
    /// thread stops the device before it is reported.
    ///
    /// # Errors
    /// It cannot be opened.
    pub fn open(
        target: Target,
        profile: &ArrayProfile,
        log: Option<LogFeed>,
    ) -> Result<Self, BridgeError> {
        let name = target.name();
        let shape = profile.clone();
        let waiting = thread::current();
        let link = Link::open(
            Box::new(move || target.open(&shape, None)),
            Hearing::Bytes,
            Sequence::default(),
            Arc::new(move || waiting.unpark()),
        )?;
        let mut line = Self {
            _on_panic: stop_on_panic(link.stop_handle()),
            link,
            start: Instant::now(),
            log,
        };
        if let (Some(taps), Some(log)) = (line.link.take_taps(), &line.log) {
            log.follow(taps);
        }
        match line.wait_open() {
            Ok(()) => Ok(line),
            Err(reason) => {
                line.note(Note::Said(event::LOST, reason.clone()));
                Err(BridgeError::Open { port: name, reason })
            }
        }
    }

    fn wait_open(&mut self) -> Result<(), String> {
        loop {
            match self.link.next() {
                Some(Incoming::Opened) => return Ok(()),
                Some(Incoming::Gone(reason)) => return Err(reason),
                Some(_) => {}
                None => thread::park(),
            }
        }
    }

    /// Time since it was opened, µs.
    pub(crate) fn now_us(&self) -> u64 {
        u64::try_from(self.start.elapsed().as_micros()).unwrap_or(u64::MAX)
    }

    /// Gives bytes to the port.
    ///
    /// # Errors
    /// It takes nothing any more.
    pub(crate) fn write(&mut self, bytes: &[u8]) -> io::Result<()> {
        for piece in bytes.chunks(LARGEST_WRITE) {
            if let Some(piece) = Packet::verbatim(piece) {
                self.give(&piece)?;
            }
        }
        Ok(())
    }

    fn give(&mut self, piece: &Packet) -> io::Result<()> {
        let deadline = Instant::now() + ROOM_PATIENCE;
        while !self.link.send_control(piece) {
            if Instant::now() >= deadline {
                return Err(io::ErrorKind::TimedOut.into());
            }
            thread::sleep(NAP);
        }
        Ok(())
    }

    /// STOP, at once, ahead of all that waits to be written.
    pub(crate) fn stop(&mut self) {
        self.link.stop_handle().stop(StopHow::Now);
        self.note(Note::Stop(StopHow::Now));
    }

    /// Adds what arrives; returns when something came, and at `until_us` at the latest.
    ///
    /// # Errors
    /// The link is gone.
    pub(crate) fn read(&mut self, until_us: u64, bytes: &mut Vec<u8>) -> io::Result<()> {
        let n_before = bytes.len();
        loop {
            match self.link.next() {
                Some(Incoming::Bytes(new)) => {
                    bytes.extend(new);
                    if bytes.len() - n_before > LARGEST_READ {
                        return Ok(());
                    }
                }
                Some(Incoming::Gone(reason)) => {
                    self.note(Note::Said(event::LOST, reason.clone()));
                    return Err(io::Error::other(reason));
                }
                Some(_) => {}
                None => {
                    let left_us = until_us.saturating_sub(self.now_us());
                    if bytes.len() > n_before || left_us == 0 {
                        return Ok(());
                    }
                    thread::park_timeout(Duration::from_micros(left_us));
                }
            }
        }
    }

    /// Writes down what is tried, or what came of it.
    pub(crate) fn check(&mut self, text: &str) {
        self.note(Note::Said(event::CHECK, text.to_owned()));
    }

    fn note(&mut self, note: Note) {
        if let Some(log) = &mut self.log {
            log.note(note);
        }
    }

    /// Ends the link's threads, so that port and log are free again.
    pub fn close(mut self) {
        self.note(Note::HostCounters(host_counters(&self.link.counters())));
        self.link.quit();
        let deadline = Instant::now() + GOODBYE;
        while self.link.is_running() && Instant::now() < deadline {
            thread::sleep(NAP);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::framing::{Decoder, LARGEST_BODY};
    use crate::message::{Hello, Message as _, Ping, kind};
    use crate::session_log::SessionLog;
    use selvedge_scratch::ScratchFolder;

    /// Reads until a packet of this type has come.
    fn hear(line: &mut DirectLine, wanted: u8) {
        let mut decoder = Decoder::new(LARGEST_BODY);
        let until_us = line.now_us() + 20_000_000;
        let mut has_come = false;
        while !has_come {
            assert!(line.now_us() < until_us, "{wanted:02x}");
            let mut bytes = Vec::new();
            line.read(until_us, &mut bytes).unwrap();
            for byte in bytes {
                let packet = decoder.push(byte);
                has_come |= packet.is_some_and(|packet| packet.kind == wanted);
            }
        }
    }

    #[test]
    fn broken_bytes_and_the_last_stop_stand_in_the_record() {
        let folder = ScratchFolder::new("direct");
        std::fs::create_dir_all(&folder).unwrap();
        let path = folder.join("link.csv");
        let log = SessionLog::append(&path, None).unwrap();
        let feed = Some(log.feed("emulator"));
        let profile = ArrayProfile::default();
        let mut line = DirectLine::open(Target::Emulator, &profile, feed).unwrap();
        let hello = Hello::new(7).packet(1).unwrap();
        let ping = Ping { token: 9 }.packet(2).unwrap();
        line.check("a text that is no packet");
        for bytes in [hello.as_bytes(), &[0, 5, 1, 2, 0], ping.as_bytes()] {
            line.write(bytes).unwrap();
        }
        hear(&mut line, kind::PONG);
        line.stop();
        hear(&mut line, kind::ACK);
        line.close();
        log.finish().unwrap();
        let text = std::fs::read_to_string(&path).unwrap();
        let mut rest = text.as_str();
        for event in [
            ",link,",
            ",check,",
            ",out,HELLO 1 ",
            ",out-bytes,0005010200",
            ",out,PING 2 ",
            ",out,STOP 0 ",
            ",in,ACK ",
            ",host-counters,",
        ] {
            let at = rest
                .find(event)
                .unwrap_or_else(|| panic!("{event}: {text}"));
            rest = &rest[at..];
        }
    }

    #[test]
    fn a_port_that_cannot_be_opened_says_why() {
        let target = Target::Port("/dev/no-such-port".into());
        let error = DirectLine::open(target, &ArrayProfile::default(), None).unwrap_err();
        let line = error.to_string();
        assert!(
            line.starts_with("/dev/no-such-port: no such port"),
            "{line}"
        );
    }
}
