//! A tap: what is felt at every tick, for another program that listens.
//!
//! The engine writes numbers into a bounded ring and wakes whoever reads them; it neither waits nor
//! allocates. A tick that finds no room is lost as a whole and counted.

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::thread::Thread;

use rtrb::{Consumer, Producer, RingBuffer};

use super::TICKS_PER_S;

/// Ticks of the largest array that find room: a second and a half.
const N_TICKS: usize = 64;
/// Numbers of a tick before its amplitudes: how many contactors, tick, x, y, angle.
const N_HEAD: usize = 5;
/// Contactors that are written at most.
const MAX_CONTACTORS: usize = 256;

/// The engine's end of a tap.
#[derive(Debug)]
pub struct Tap {
    ring: Producer<f64>,
    reader: Thread,
    n_lost: Arc<AtomicU64>,
}

/// The other end.
#[derive(Debug)]
pub(super) struct TapReader {
    ring: Consumer<f64>,
    n_lost: Arc<AtomicU64>,
}

/// One tick as it was felt.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct FeltTick {
    /// Ticks since the engine started.
    pub(super) tick: f64,
    /// Where the display was, mm, and how it was turned, degrees.
    pub(super) place: [f64; 3],
    /// `A40, A320` of the first contactor, then of the next, µm.
    pub(super) amplitudes_um: Vec<f64>,
}

impl FeltTick {
    /// Time since the engine started, s.
    pub(super) fn t_s(&self) -> f64 {
        self.tick / TICKS_PER_S
    }
}

/// Both ends; `reader` is woken when there is something to read.
pub(super) fn tap(reader: Thread) -> (Tap, TapReader) {
    let (sender, ring) = RingBuffer::new(N_TICKS * (N_HEAD + 2 * MAX_CONTACTORS));
    let n_lost = Arc::new(AtomicU64::new(0));
    let tap = Tap {
        ring: sender,
        reader,
        n_lost: Arc::clone(&n_lost),
    };
    (tap, TapReader { ring, n_lost })
}

impl Tap {
    /// Writes a tick: its number, where the display is (mm) and how it is turned (degrees), and
    /// `[A40, A320]` of every contactor that the device plays, µm.
    pub(super) fn write(&mut self, tick: u64, place: [f64; 3], felt_um: &[[f32; 2]]) {
        let felt_um = &felt_um[..felt_um.len().min(MAX_CONTACTORS)];
        let n_contactors = felt_um.len();
        let Ok(chunk) = self.ring.write_chunk_uninit(N_HEAD + 2 * n_contactors) else {
            self.n_lost.fetch_add(1, Ordering::Relaxed);
            return;
        };
        let head = [n_contactors as f64, tick as f64].into_iter().chain(place);
        let amplitudes_um = felt_um.iter().flatten().copied().map(f64::from);
        chunk.fill_from_iter(head.chain(amplitudes_um));
        self.reader.unpark();
    }
}

impl TapReader {
    /// The oldest tick that was not taken yet; false if there is none.
    pub(super) fn next(&mut self, felt: &mut FeltTick) -> bool {
        let Ok(&n_contactors) = self.ring.peek() else {
            return false;
        };
        // A whole number that `write` wrote.
        let n_contactors = (0..=MAX_CONTACTORS)
            .find(|&n| n as f64 >= n_contactors)
            .unwrap_or(0);
        let Ok(chunk) = self.ring.read_chunk(N_HEAD + 2 * n_contactors) else {
            return false;
        };
        let mut numbers = chunk.into_iter().skip(1);
        let mut next = || numbers.next().unwrap_or_default();
        felt.tick = next();
        felt.place = [next(), next(), next()];
        felt.amplitudes_um.clear();
        felt.amplitudes_um.extend(numbers);
        true
    }

    /// Whether nobody will write any more.
    pub(super) fn is_abandoned(&self) -> bool {
        self.ring.is_abandoned()
    }

    /// Ticks that found no room.
    pub(super) fn n_lost(&self) -> u64 {
        self.n_lost.load(Ordering::Relaxed)
    }
}
