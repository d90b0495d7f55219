//! One direction of a link: bytes in at a time, bytes out at times, harmed as described.
//!
//! Pure: callers say what time it is. At most [`ROOM`] bytes wait; what finds no room is lost, as
//! in a full buffer of a terminal.

use std::collections::VecDeque;

use super::faults::{Direction, Injection, InjectionKind, Latency, LinkFaults};
use selvedge_foundation::numerics::{Random, to_whole};

/// Bytes that can wait in one direction.
const ROOM: usize = 4096;
/// Bytes of a full-speed USB packet.
const USB_PACKET: usize = 64;
/// Bytes at which an FTDI adapter sends without waiting for its timer.
const FTDI_FULL: usize = 62;
const USB_FRAME_US: u64 = 1000;
/// Bits of a byte on a serial line, times µs in a second.
const BIT_US: u64 = 10 * 1_000_000;
/// A host that wrote nothing for so long begins a new visit.
const VISIT_GAP_US: u64 = 1_000_000;
/// What a modem manager asks a port that it does not know.
const AT_CHATTER: &[u8] = b"AT\r\nAT+GCAP\r\n\x7e\x00\x78\xf0\x7e";
/// What a boot loader says to whoever listens.
pub(super) const BOOT_BANNER: &[u8] = b"\r\n\xff\x00array boot 1.0\r\nclock 120 MHz, reset ok\r\n";

/// Bytes under way.
#[derive(Clone, Debug)]
struct Chunk {
    due_us: u64,
    bytes: Vec<u8>,
}

/// How many bytes come until the next one that is harmed in one way.
#[derive(Clone, Debug)]
struct Gap {
    rate: f64,
    left: u64,
}

impl Gap {
    fn new(rate: f64, random: &mut Random) -> Self {
        let mut gap = Self { rate, left: 0 };
        gap.draw(random);
        gap
    }

    fn draw(&mut self, random: &mut Random) {
        self.left = if self.rate <= 0.0 {
            u64::MAX
        } else if self.rate >= 1.0 {
            0
        } else {
            to_whole::<u64>((1.0 - random.uniform()).ln() / (-self.rate).ln_1p())
        };
    }

    /// Whether this one is harmed.
    fn hits(&mut self, random: &mut Random) -> bool {
        if self.left > 0 {
            self.left -= 1;
            return false;
        }
        self.draw(random);
        true
    }
}

/// One direction.
#[derive(Clone, Debug)]
pub(super) struct FaultyChannel {
    faults: LinkFaults,
    direction: Direction,
    random: Random,
    drop: Gap,
    flip: Gap,
    insert: Gap,
    waiting: VecDeque<Chunk>,
    n_waiting: usize,
    last_due_us: u64,
    last_write_us: Option<u64>,
    next_garbage_us: Option<u64>,
    stalled_until_us: u64,
    /// When the last byte has left the serial line.
    line_free_us: u64,
    /// When the adapter's timer runs out, and how many bytes wait for it.
    timer: Option<(u64, usize)>,
    injections: Vec<Injection>,
}

impl FaultyChannel {
    pub(super) fn new(faults: LinkFaults, direction: Direction, seed: u64) -> Self {
        let purpose = match direction {
            Direction::ToDevice => "to device",
            Direction::ToHost => "to host",
        };
        let mut random = Random::new(seed).branch(purpose);
        let mut link = Self {
            drop: Gap::new(faults.drop_rate, &mut random),
            flip: Gap::new(faults.flip_rate, &mut random),
            insert: Gap::new(faults.insert_rate, &mut random),
            faults,
            direction,
            random,
            waiting: VecDeque::new(),
            n_waiting: 0,
            last_due_us: 0,
            last_write_us: None,
            next_garbage_us: None,
            stalled_until_us: 0,
            line_free_us: 0,
            timer: None,
            injections: Vec::new(),
        };
        link.draw_garbage(0);
        link
    }

    /// Takes what was written at `now_us`.
    pub(super) fn send(&mut self, now_us: u64, bytes: &[u8]) {
        self.chatter(now_us);
        self.last_write_us = Some(now_us);
        let arriving = self.harmed(bytes);
        let left_us = self.left_line_us(now_us, arriving.len());
        let due_us = self.due_us(left_us, arriving.len());
        if self.chance(self.faults.repeat_rate) {
            self.note(InjectionKind::Repeated(self.direction), arriving.len());
            self.put(due_us, arriving.clone());
        }
        self.put(due_us, arriving);
    }

    /// Says something that is not harmed: banners.
    pub(super) fn say(&mut self, now_us: u64, text: &[u8]) {
        if self.faults.chatter {
            self.note(InjectionKind::Chatter(self.direction), text.len());
            self.put(now_us, text.to_vec());
        }
    }

    /// Makes what is due by itself: bursts of garbage.
    pub(super) fn make_due(&mut self, now_us: u64) {
        while let Some(at_us) = self.next_garbage_us.filter(|at_us| *at_us <= now_us) {
            let length = 8 + self.random.index(113);
            let burst: Vec<u8> = (0..length).map(|_| self.random_byte()).collect();
            self.note(InjectionKind::Garbage(self.direction), length);
            self.put(at_us, burst);
            self.draw_garbage(at_us);
        }
    }

    /// What arrives by `now_us`.
    pub(super) fn take(&mut self, now_us: u64) -> Option<Vec<u8>> {
        let due = |chunk: &Chunk| chunk.due_us <= now_us && self.stalled_until_us <= now_us;
        if !self.waiting.front().is_some_and(due) {
            return None;
        }
        let chunk = self.waiting.pop_front()?;
        self.n_waiting -= chunk.bytes.len();
        Some(chunk.bytes)
    }

    /// When [`take`](Self::take) or [`make_due`](Self::make_due) has something to do next.
    pub(super) fn next_due_us(&self) -> Option<u64> {
        let first = self.waiting.front();
        let first_us = first.map(|chunk| chunk.due_us.max(self.stalled_until_us));
        [first_us, self.next_garbage_us].into_iter().flatten().min()
    }

    /// Nothing arrives before `until_us`.
    pub(super) fn stall(&mut self, until_us: u64) {
        self.stalled_until_us = self.stalled_until_us.max(until_us);
    }

    /// Everything under way is lost, and whoever writes next begins a new visit.
    pub(super) fn clear(&mut self) {
        self.waiting.clear();
        self.n_waiting = 0;
        self.timer = None;
        self.line_free_us = 0;
        self.stalled_until_us = 0;
        self.last_write_us = None;
    }

    /// Writes that wait.
    #[cfg(test)]
    pub(super) fn waiting(&self) -> impl Iterator<Item = &[u8]> {
        self.waiting.iter().map(|chunk| chunk.bytes.as_slice())
    }

    /// What was injected since the last call.
    pub(super) fn take_injections(&mut self) -> Vec<Injection> {
        std::mem::take(&mut self.injections)
    }

    fn chatter(&mut self, now_us: u64) {
        let is_visit = self
            .last_write_us
            .is_none_or(|last_us| now_us.saturating_sub(last_us) > VISIT_GAP_US);
        if self.direction == Direction::ToDevice && is_visit {
            self.say(now_us, AT_CHATTER);
        }
    }

    /// The bytes of one write as they arrive.
    fn harmed(&mut self, bytes: &[u8]) -> Vec<u8> {
        let mut arriving = Vec::with_capacity(bytes.len() + 4);
        let before = [0; 3];
        let mut harm = before;
        for packet in bytes.chunks(USB_PACKET) {
            if self.chance(self.faults.usb_loss_rate) {
                self.note(InjectionKind::UsbLost(self.direction), packet.len());
                continue;
            }
            for &byte in packet {
                self.harm(byte, &mut arriving, &mut harm);
            }
        }
        let way = self.direction;
        let kinds = [
            InjectionKind::Dropped(way),
            InjectionKind::Flipped(way),
            InjectionKind::Inserted(way),
        ];
        for (kind, count) in kinds.into_iter().zip(harm) {
            if count > 0 {
                self.note(kind, count);
            }
        }
        arriving
    }

    fn harm(&mut self, byte: u8, arriving: &mut Vec<u8>, harm: &mut [usize; 3]) {
        if self.drop.hits(&mut self.random) {
            harm[0] += 1;
            return;
        }
        if self.insert.hits(&mut self.random) {
            harm[2] += 1;
            let random = self.random_byte();
            arriving.push(random);
        }
        if self.flip.hits(&mut self.random) {
            harm[1] += 1;
            // Any other byte: a flip that changes nothing would be none.
            let other = u8::try_from(1 + self.random.index(255)).unwrap_or(1);
            arriving.push(byte ^ other);
        } else {
            arriving.push(byte);
        }
    }

    /// When all of them have left a serial line, one byte behind the other.
    fn left_line_us(&mut self, now_us: u64, n_bytes: usize) -> u64 {
        let Some(baud) = self.faults.baud else {
            return now_us;
        };
        let takes_us = (n_bytes as u64 * BIT_US).div_ceil(u64::from(baud.max(1)));
        self.line_free_us = self.line_free_us.max(now_us) + takes_us;
        self.line_free_us
    }

    fn due_us(&mut self, now_us: u64, n_bytes: usize) -> u64 {
        let mut due_us = match self.faults.latency {
            Latency::None => now_us,
            Latency::UsbFrame => now_us.next_multiple_of(USB_FRAME_US),
            Latency::Timer(period_us) => self.timed(now_us, n_bytes, period_us),
            Latency::Normal {
                mean_us,
                deviation_us,
            } => {
                now_us
                    + to_whole::<u64>(
                        f64::from(mean_us) + f64::from(deviation_us) * self.random.normal(),
                    )
            }
        };
        if self.chance(self.faults.hiccup_rate) {
            let longer_us = self.faults.hiccup_us;
            self.injections.push(Injection {
                kind: InjectionKind::Hiccup(self.direction),
                amount: longer_us,
            });
            due_us += longer_us;
        }
        due_us
    }

    /// An adapter with a latency timer: bytes wait for it together, or leave when they are many.
    fn timed(&mut self, now_us: u64, n_bytes: usize, period_us: u64) -> u64 {
        let running = self.timer.filter(|(at_us, _)| *at_us > now_us);
        let (at_us, before) = running.unwrap_or((now_us + period_us, 0));
        let n_bytes = before + n_bytes;
        if n_bytes < FTDI_FULL {
            self.timer = Some((at_us, n_bytes));
            return at_us;
        }
        self.timer = None;
        let leaves_us = now_us.next_multiple_of(USB_FRAME_US);
        for chunk in &mut self.waiting {
            chunk.due_us = chunk.due_us.min(leaves_us);
        }
        self.last_due_us = self.last_due_us.min(leaves_us);
        leaves_us
    }

    fn put(&mut self, due_us: u64, bytes: Vec<u8>) {
        if bytes.is_empty() {
            return;
        }
        if self.n_waiting + bytes.len() > ROOM {
            self.note(InjectionKind::Overflow(self.direction), bytes.len());
            return;
        }
        self.last_due_us = self.last_due_us.max(due_us);
        self.n_waiting += bytes.len();
        self.waiting.push_back(Chunk {
            due_us: self.last_due_us,
            bytes,
        });
    }

    fn draw_garbage(&mut self, from_us: u64) {
        self.next_garbage_us = self.faults.garbage_every_us.map(|mean_us| {
            let wait_us = -(mean_us as f64) * (1.0 - self.random.uniform()).ln();
            from_us + to_whole::<u64>(wait_us).max(1)
        });
    }

    fn chance(&mut self, rate: f64) -> bool {
        rate > 0.0 && self.random.uniform() < rate
    }

    fn random_byte(&mut self) -> u8 {
        u8::try_from(self.random.index(256)).unwrap_or(0)
    }

    fn note(&mut self, kind: InjectionKind, amount: usize) {
        self.injections.push(Injection {
            kind,
            amount: amount as u64,
        });
    }
}

#[cfg(test)]
mod tests;
