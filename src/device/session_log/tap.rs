//! From the threads of a link to its log: what was written to the port and what arrived from it, as
//! plain values in bounded rings. Putting one in neither allocates nor waits; what finds no room is
//! counted.

use std::fmt;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::time::Instant;

use rtrb::{Consumer, Producer, RingBuffer};

use crate::framing::{CRC_LEN, Decoder, HEADER_LEN, LARGEST_BODY, Packet, Received};

/// Room for packets on their way to the log: more than arrive while its writer sleeps.
const MAX_PASSING: usize = 256;
const LARGEST_PAYLOAD: usize = LARGEST_BODY - HEADER_LEN - CRC_LEN;

/// A packet without its framing.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) struct Body {
    pub(crate) kind: u8,
    pub(crate) flags: u8,
    pub(crate) seq: u16,
    len: usize,
    bytes: [u8; LARGEST_PAYLOAD],
}

impl Body {
    /// The body of a packet; `None` when its payload is larger than any.
    pub(crate) fn new(packet: &Received<'_>) -> Option<Self> {
        let mut body = Self {
            kind: packet.kind,
            flags: 0,
            seq: packet.seq,
            len: packet.payload.len(),
            bytes: [0; LARGEST_PAYLOAD],
        };
        let room = body.bytes.get_mut(..body.len)?;
        room.copy_from_slice(packet.payload);
        Some(body)
    }

    /// The body in a framed packet; `None` for what is no packet, as the lone delimiter.
    pub(crate) fn of_wire(wire: &[u8]) -> Option<Self> {
        let mut decoder = Decoder::new(LARGEST_BODY);
        let body = wire
            .iter()
            .find_map(|&byte| Self::new(&decoder.push(byte)?));
        body.map(|body| body.with_flags(decoder.flags()))
    }

    /// The same with these flags.
    pub(crate) fn with_flags(self, flags: u8) -> Self {
        Self { flags, ..self }
    }

    pub(crate) fn payload(&self) -> &[u8] {
        self.bytes.get(..self.len).unwrap_or(&[])
    }
}

impl fmt::Debug for Body {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self {
            kind, flags, seq, ..
        } = self;
        write!(
            f,
            "Body({kind:02x} {flags:02x} {seq} {:02x?})",
            self.payload()
        )
    }
}

/// What passes a port.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Passed {
    /// The port took this packet.
    Sent(Packet),
    /// The port did not take it.
    Unsent(Packet),
    /// This packet arrived.
    Received(Body),
    /// So many texts arrived that were no packet.
    Bad(u64),
}

/// The same with its time.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Passing {
    pub(crate) at: Instant,
    pub(crate) what: Passed,
}

/// What both ends of a tap share.
#[derive(Debug, Default)]
struct Shared {
    is_on: AtomicBool,
    n_lost: AtomicU64,
}

/// A thread's end.
#[derive(Debug)]
pub(crate) struct Tap {
    ring: Producer<Passing>,
    shared: Arc<Shared>,
}

/// The log's end.
#[derive(Debug)]
pub(crate) struct TapEnd {
    ring: Consumer<Passing>,
    shared: Arc<Shared>,
}

/// Both ends; nothing is taken before the log's end is opened.
pub(crate) fn tap() -> (Tap, TapEnd) {
    let (to_log, ring) = RingBuffer::new(MAX_PASSING);
    let shared = Arc::new(Shared::default());
    let tap = Tap {
        ring: to_log,
        shared: Arc::clone(&shared),
    };
    (tap, TapEnd { ring, shared })
}

impl Tap {
    /// Takes note of what passed; without room it is counted.
    pub(crate) fn put(&mut self, at: Instant, what: &Passed) {
        let what = *what;
        let is_wanted = self.shared.is_on.load(Ordering::Relaxed);
        if is_wanted && self.ring.push(Passing { at, what }).is_err() {
            self.shared.n_lost.fetch_add(1, Ordering::Relaxed);
        }
    }
}

impl TapEnd {
    /// From now on what passes is taken.
    pub(super) fn open(&self) {
        self.shared.is_on.store(true, Ordering::Relaxed);
    }

    /// Whether nothing more can come.
    pub(super) fn is_over(&self) -> bool {
        self.ring.is_abandoned()
    }

    pub(super) fn next(&mut self) -> Option<Passing> {
        self.ring.pop().ok()
    }

    /// How many found no room since the last call.
    pub(super) fn take_lost(&self) -> u64 {
        self.shared.n_lost.swap(0, Ordering::Relaxed)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_full_ring_counts_what_it_lost() {
        let (mut tap, mut end) = tap();
        tap.put(Instant::now(), &Passed::Bad(1));
        assert!(end.next().is_none(), "nobody records yet");
        end.open();
        for _ in 0..MAX_PASSING + 5 {
            tap.put(Instant::now(), &Passed::Bad(1));
        }
        let n_kept = std::iter::from_fn(|| end.next()).count();
        assert_eq!((n_kept, end.take_lost()), (MAX_PASSING, 5));
        tap.put(Instant::now(), &Passed::Bad(2));
        assert!(end.next().is_some() && end.take_lost() == 0 && !end.is_over());
        drop(tap);
        assert!(end.is_over());
    }
}
