//! The reader's thread: opens the port, starts the writer, then turns bytes into messages as they
//! come.

use std::sync::Arc;
use std::sync::atomic::Ordering;
use std::thread::Builder;
use std::time::{Duration, Instant};

use rtrb::Producer;

use super::shared::{Hearing, Incoming, Opener, Running, Shared, count};
use super::writer::Writer;
use crate::framing::{Decoder, LARGEST_BODY, Packet};
use crate::message::{DeviceMessage, Unreadable};
use crate::port::Port;
use crate::session_log::{Body, Passed, Tap};

/// How long a read waits before it looks whether to end.
const PATIENCE: Duration = Duration::from_millis(50);

/// Of a text that is no packet so many bytes are recorded.
const RECORDED: usize = 256;

/// What the reading thread owns.
pub(super) struct Reader {
    shared: Arc<Shared>,
    to_owner: Producer<Incoming>,
    hearing: Hearing,
    decoder: Decoder,
    /// The beginning of the text since the last zero, and what had been bad before it.
    text: Vec<u8>,
    bad_before: u64,
    tap: Tap,
}

impl Reader {
    pub(super) fn new(
        shared: Arc<Shared>,
        to_owner: Producer<Incoming>,
        hearing: Hearing,
        tap: Tap,
    ) -> Self {
        Self {
            shared,
            to_owner,
            hearing,
            decoder: Decoder::new(LARGEST_BODY),
            text: Vec::with_capacity(RECORDED),
            bad_before: 0,
            tap,
        }
    }

    pub(super) fn run(mut self, opener: Opener, writer: Writer) {
        let (port, writing) = match opener() {
            Ok(ends) => ends,
            Err(error) => return self.send(Incoming::Gone(error.without_port())),
        };
        let running = Running::new(&self.shared);
        let spawned = Builder::new()
            .name(String::from("bridge-writer"))
            .spawn(move || {
                let _running = running;
                writer.run(writing);
            });
        match spawned {
            Ok(handle) => {
                // Set once: this is the only place.
                self.shared.writer.get_or_init(|| handle.thread().clone());
                self.send(Incoming::Opened);
                self.read(port);
            }
            Err(error) => self.send(Incoming::Gone(format!("cannot start a thread: {error}"))),
        }
    }

    fn read(mut self, mut port: Box<dyn Port>) {
        while !self.shared.has_quit() && self.hear(port.as_mut(), None) {}
    }

    /// Takes what arrives next; where it is told what time it is, what is there. False when the
    /// link is gone.
    pub(super) fn hear(&mut self, port: &mut dyn Port, told: Option<Instant>) -> bool {
        let mut buffer = [0; 1024];
        let patience = told.map_or(PATIENCE, |_now| Duration::ZERO);
        match port.read(&mut buffer, patience) {
            Ok(0) => {}
            Ok(count) => {
                let received = told.unwrap_or_else(Instant::now);
                self.take(buffer.get(..count).unwrap_or(&[]), received);
            }
            Err(error) => {
                let reason = format!("the device is gone ({error}): check the cable");
                self.send(Incoming::Gone(reason));
                return false;
            }
        }
        true
    }

    fn take(&mut self, bytes: &[u8], received: Instant) {
        let mut found = self.hearing == Hearing::Bytes;
        if found {
            self.hand_on(Incoming::Bytes(bytes.to_vec()));
        }
        for &byte in bytes {
            found |= self.push(byte, received);
        }
        let n_bytes = u64::try_from(bytes.len()).unwrap_or(u64::MAX);
        self.shared
            .bytes_received
            .fetch_add(n_bytes, Ordering::Relaxed);
        self.shared
            .bad_received
            .store(self.decoder.bad(), Ordering::Relaxed);
        if found {
            (self.shared.waker)();
        }
    }

    /// Takes a byte; whether it completes a message for the owner.
    fn push(&mut self, byte: u8, received: Instant) -> bool {
        if byte != 0 && self.text.len() < RECORDED {
            self.text.push(byte);
        }
        let message = self.complete(byte, received);
        if byte == 0 {
            self.record_broken(received);
        }
        let Some(message) = message else {
            return false;
        };
        self.hand_on(Incoming::Message { message, received });
        true
    }

    /// The message that a byte completes, for an owner who hears messages.
    fn complete(&mut self, byte: u8, received: Instant) -> Option<DeviceMessage> {
        let packet = self.decoder.push(byte)?;
        let body = Body::new(&packet);
        let message = match self.hearing {
            Hearing::Messages { n_channels } => DeviceMessage::decode(&packet, n_channels),
            // Those who hear bytes judge for themselves.
            Hearing::Bytes => Err(Unreadable::UnknownKind),
        };
        match (&message, body) {
            (Err(Unreadable::Short), _) => self.decoder.count_bad(),
            (_, Some(body)) => {
                let body = body.with_flags(self.decoder.flags());
                self.tap.put(received, &Passed::Received(body));
            }
            // No body is larger than the decoder's.
            (_, None) => {}
        }
        // A later version may send what this one does not know.
        message.ok()
    }

    /// A text has ended: if it was no packet, it is recorded as it came.
    fn record_broken(&mut self, received: Instant) {
        let bad = self.decoder.bad();
        if std::mem::replace(&mut self.bad_before, bad) != bad
            && let Some(text) = Packet::verbatim(&self.text)
        {
            self.tap.put(received, &Passed::Broken(text));
        }
        self.text.clear();
    }

    fn hand_on(&mut self, incoming: Incoming) {
        if self.to_owner.push(incoming).is_err() {
            count(&self.shared.events_dropped);
        }
    }

    pub(super) fn send(&mut self, incoming: Incoming) {
        self.hand_on(incoming);
        (self.shared.waker)();
    }
}
