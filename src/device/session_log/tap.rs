//! From the threads of a link to its log: what was written to the port and what arrived from it, as
//! plain values in bounded rings. Putting one in neither allocates nor waits; what finds no room is
//! counted.

use std::fmt;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, OnceLock};
use std::thread::Thread;
use std::time::Instant;

use rtrb::{Consumer, Producer, RingBuffer};

use crate::framing::{CRC_LEN, Decoder, HEADER_LEN, LARGEST_BODY, Packet, Received};

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

    /// The body of a packet that is framed as we frame it, to the byte, with nothing beside it.
    pub(crate) fn of_whole(wire: &[u8]) -> Option<Self> {
        let body = Self::of_wire(wire)?;
        let [seq_low, seq_high] = body.seq.to_le_bytes();
        let covered = [&[body.kind, body.flags, seq_low, seq_high], body.payload()].concat();
        let is_whole = Packet::sealed(&covered)?.as_bytes() == wire;
        is_whole.then_some(body)
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
    /// The port took this.
    Sent(Packet),
    /// The port did not take it.
    Unsent(Packet),
    /// This packet arrived.
    Received(Body),
    /// These bytes arrived between two zeros and were no packet; of a long text its beginning.
    Broken(Packet),
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
    /// Who empties the ring, once somebody does.
    log: OnceLock<Thread>,
    n_lost: AtomicU64,
}

/// A thread's end.
#[derive(Debug)]
pub(crate) struct Tap {
    ring: Producer<Passing>,
    /// With fewer free places the log is woken.
    few: usize,
    shared: Arc<Shared>,
}

/// The log's end.
#[derive(Debug)]
pub(crate) struct TapEnd {
    ring: Consumer<Passing>,
    shared: Arc<Shared>,
}

/// Both ends, with room for so many; nothing is taken before the log's end is opened.
pub(crate) fn tap(n_places: usize) -> (Tap, TapEnd) {
    let (to_log, ring) = RingBuffer::new(n_places);
    let shared = Arc::new(Shared::default());
    let tap = Tap {
        ring: to_log,
        few: n_places / 2,
        shared: Arc::clone(&shared),
    };
    (tap, TapEnd { ring, shared })
}

impl Tap {
    /// Takes note of what passed; without room it is counted.
    pub(crate) fn put(&mut self, at: Instant, what: &Passed) {
        let what = *what;
        let Some(log) = self.shared.log.get() else {
            return;
        };
        if self.ring.push(Passing { at, what }).is_err() {
            self.shared.n_lost.fetch_add(1, Ordering::Relaxed);
        }
        if self.ring.slots() < self.few {
            log.unpark();
        }
    }
}

impl TapEnd {
    /// From now on what passes is taken; this thread is woken when much of it waits.
    pub(super) fn open(&self, log: &Thread) {
        self.shared.log.get_or_init(|| log.clone());
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
        let (mut tap, mut end) = tap(64);
        let passed = Passed::Broken(Packet::delimiter());
        tap.put(Instant::now(), &passed);
        assert!(end.next().is_none(), "nobody records yet");
        end.open(&std::thread::current());
        for _ in 0..64 + 5 {
            tap.put(Instant::now(), &passed);
        }
        let n_kept = std::iter::from_fn(|| end.next()).count();
        assert_eq!((n_kept, end.take_lost()), (64, 5));
        tap.put(Instant::now(), &passed);
        assert!(end.next().is_some() && end.take_lost() == 0 && !end.is_over());
        drop(tap);
        assert!(end.is_over());
    }

    #[test]
    fn only_a_packet_that_is_framed_as_ours_is_whole() {
        let packet = Packet::sealed(&[6, 0x80, 1, 2, 9, 0, 9]).unwrap();
        let wire = packet.as_bytes();
        let body = Body::of_whole(wire).unwrap();
        assert_eq!((body.flags, body.payload()), (0x80, &[9, 0, 9][..]));
        let longer = [&wire[..wire.len() - 1], &[1, 0]].concat();
        for other in [&wire[1..], &wire[..wire.len() - 1], &[0], &longer, &[]] {
            assert_eq!(Body::of_whole(other), None, "{other:02x?}");
        }
    }
}
