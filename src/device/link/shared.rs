//! What the owner of a link and its threads pass to each other, and share with stop handles.

use std::sync::atomic::{AtomicBool, AtomicU8, AtomicU64, Ordering};
use std::sync::{Arc, Mutex, OnceLock, PoisonError};
use std::thread::Thread;
use std::time::Instant;

use super::timings::Histogram;
use crate::BridgeError;
use crate::framing::Packet;
use crate::host::Sequence;
use crate::message::DeviceMessage;
use crate::port::Port;

pub(super) const CONTROLS: usize = 16;
/// The same for whoever says what no session says: many packets at once.
const DIRECT_CONTROLS: usize = 256;
/// Room for packets on their way to the log: more than arrive while its writer sleeps.
pub(super) const PASSING: usize = 256;
const DIRECT_PASSING: usize = 4096;

/// The reading and the writing end of an open port.
pub(crate) type Ends = (Box<dyn Port>, Box<dyn Port>);
/// Opens a port; runs on the reader's thread because it may block.
pub(crate) type Opener = Box<dyn FnOnce() -> Result<Ends, BridgeError> + Send>;
/// Called whenever there may be news.
pub(crate) type Waker = Arc<dyn Fn() + Send + Sync>;

/// What the reader hands on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Hearing {
    /// Messages of a device with so many channels; what is none is counted.
    Messages { n_channels: usize },
    /// Bytes as they come, for an owner that believes no framing either.
    Bytes,
}

impl Hearing {
    /// Places in the ring of control packets, and in each ring to the log.
    pub(super) fn places(self) -> [usize; 2] {
        match self {
            Self::Messages { .. } => [CONTROLS, PASSING],
            Self::Bytes => [DIRECT_CONTROLS, DIRECT_PASSING],
        }
    }
}

/// What the threads tell the owner.
#[derive(Debug)]
pub(crate) enum Incoming {
    /// The port is open.
    Opened,
    /// A message arrived.
    Message {
        message: DeviceMessage,
        received: Instant,
    },
    /// Bytes arrived.
    Bytes(Vec<u8>),
    /// The port could not be opened, or is gone.
    Gone(String),
}

/// A FRAME on its way to the port.
#[derive(Clone, Copy, Debug)]
pub(crate) struct QueuedFrame {
    pub(crate) packet: Packet,
    /// When it was due, as the answer to a STATUS.
    pub(crate) due: Option<Instant>,
    /// Time of the input that it is made of.
    pub(crate) stamp: Option<Instant>,
}

/// Only the STOP slot has a lock, held for the copy of one packet.
pub(super) struct Shared {
    pub(super) sequence: Sequence,
    stop: Mutex<Option<Packet>>,
    pub(super) stops_asked: AtomicU64,
    pub(super) stops_written: AtomicU64,
    /// A STOP that came through a handle, for the owner to learn of: 0 none, 1 ramp, 2 now.
    pub(super) stop_by_handle: AtomicU8,
    pub(super) quit: AtomicBool,
    pub(super) running: AtomicU8,
    pub(super) writer: OnceLock<Thread>,
    pub(super) waker: Waker,
    pub(super) due_to_write: Histogram,
    pub(super) stamp_to_write: Histogram,
    pub(super) round_trip: Histogram,
    pub(super) frame_interval: Histogram,
    pub(super) frames_sent: AtomicU64,
    pub(super) frames_superseded: AtomicU64,
    pub(super) bad_received: AtomicU64,
    pub(super) bytes_received: AtomicU64,
    pub(super) events_dropped: AtomicU64,
    pub(super) write_timeouts: AtomicU64,
}

impl Shared {
    pub(super) fn new(sequence: Sequence, waker: Waker) -> Self {
        Self {
            sequence,
            stop: Mutex::new(None),
            stops_asked: AtomicU64::new(0),
            stops_written: AtomicU64::new(0),
            stop_by_handle: AtomicU8::new(0),
            quit: AtomicBool::new(false),
            running: AtomicU8::new(0),
            writer: OnceLock::new(),
            waker,
            due_to_write: Histogram::new(),
            stamp_to_write: Histogram::new(),
            round_trip: Histogram::new(),
            frame_interval: Histogram::new(),
            frames_sent: AtomicU64::new(0),
            frames_superseded: AtomicU64::new(0),
            bad_received: AtomicU64::new(0),
            bytes_received: AtomicU64::new(0),
            events_dropped: AtomicU64::new(0),
            write_timeouts: AtomicU64::new(0),
        }
    }

    pub(super) fn put_stop(&self, packet: &Packet) {
        let mut slot = self.stop.lock().unwrap_or_else(PoisonError::into_inner);
        *slot = Some(*packet);
        self.stops_asked.fetch_add(1, Ordering::Release);
        drop(slot);
        self.unpark_writer();
    }

    /// The STOP to write and the number of STOPs that its writing will have fulfilled.
    pub(super) fn take_stop(&self) -> Option<(Packet, u64)> {
        let mut slot = self.stop.lock().unwrap_or_else(PoisonError::into_inner);
        let packet = slot.take()?;
        Some((packet, self.stops_asked.load(Ordering::Acquire)))
    }

    pub(super) fn unpark_writer(&self) {
        if let Some(writer) = self.writer.get() {
            writer.unpark();
        }
    }

    pub(super) fn has_quit(&self) -> bool {
        self.quit.load(Ordering::Acquire)
    }
}

/// Counts one more.
pub(super) fn count(counter: &AtomicU64) {
    counter.fetch_add(1, Ordering::Relaxed);
}

/// Counts a thread as running for as long as it lives.
pub(super) struct Running(Arc<Shared>);

impl Running {
    pub(super) fn new(shared: &Arc<Shared>) -> Self {
        shared.running.fetch_add(1, Ordering::AcqRel);
        Self(Arc::clone(shared))
    }
}

impl Drop for Running {
    fn drop(&mut self) {
        self.0.running.fetch_sub(1, Ordering::AcqRel);
    }
}
