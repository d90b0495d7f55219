//! The reader's thread: opens the port, starts the writer, then turns bytes into messages as they
//! come.

use std::sync::Arc;
use std::sync::atomic::Ordering;
use std::thread::Builder;
use std::time::{Duration, Instant};

use rtrb::Producer;

use super::{Incoming, Opener, Running, Shared, Writer, count};
use crate::framing::{Decoder, LARGEST_BODY};
use crate::message::{DeviceMessage, Unreadable};
use crate::port::Port;
use crate::session_log::{Body, Passed, Tap};

/// How long a read waits before it looks whether to end.
const PATIENCE: Duration = Duration::from_millis(50);

/// What the reading thread owns.
pub(super) struct Reader {
    shared: Arc<Shared>,
    to_owner: Producer<Incoming>,
    n_channels: usize,
    decoder: Decoder,
    tap: Tap,
}

impl Reader {
    pub(super) fn new(
        shared: Arc<Shared>,
        to_owner: Producer<Incoming>,
        n_channels: usize,
        tap: Tap,
    ) -> Self {
        Self {
            shared,
            to_owner,
            n_channels,
            decoder: Decoder::new(LARGEST_BODY),
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
        let mut buffer = [0; 1024];
        while !self.shared.has_quit() {
            match port.read(&mut buffer, PATIENCE) {
                Ok(0) => {}
                Ok(count) => self.take(buffer.get(..count).unwrap_or(&[]), Instant::now()),
                Err(error) => {
                    let reason = format!("the device is gone ({error}): check the cable");
                    return self.send(Incoming::Gone(reason));
                }
            }
        }
    }

    fn take(&mut self, bytes: &[u8], received: Instant) {
        let mut found = false;
        let bad_before = self.decoder.bad();
        for &byte in bytes {
            let Some(packet) = self.decoder.push(byte) else {
                continue;
            };
            let body = Body::new(&packet);
            let message = DeviceMessage::decode(&packet, self.n_channels);
            if let Some(body) = body {
                let body = body.with_flags(self.decoder.flags());
                self.tap.put(received, &Passed::Received(body));
            }
            match message {
                Ok(message) => {
                    found = true;
                    let incoming = Incoming::Message { message, received };
                    if self.to_owner.push(incoming).is_err() {
                        count(&self.shared.events_dropped);
                    }
                }
                // A later version may send what this one does not know.
                Err(Unreadable::UnknownKind) => {}
                Err(Unreadable::Short) => self.decoder.count_bad(),
            }
        }
        let n_bad = self.decoder.bad() - bad_before;
        if n_bad > 0 {
            self.tap.put(received, &Passed::Bad(n_bad));
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

    fn send(&mut self, incoming: Incoming) {
        if self.to_owner.push(incoming).is_err() {
            count(&self.shared.events_dropped);
        }
        (self.shared.waker)();
    }
}
