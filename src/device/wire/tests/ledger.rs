//! What a device's counters should be, worked out anew from what arrived at it and when: with other
//! people's COBS and CRC, and without the device's code.

use super::*;
use crate::message::kind;

const TICK_US: u64 = 25_000;
const NEXT_TICK: u32 = u32::MAX;
const MAX_BODY: usize = 256;

/// Counts of a whole life, all boots together.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Ledger {
    pub(super) bad: u64,
    pub(super) late: u64,
    pub(super) dup: u64,
    pub(super) underrun: u64,
    /// FRAMEs that arrived whole.
    pub(super) frames: u64,
    /// Of these, those that the device refused.
    pub(super) refused: u64,
    /// FRAMEs in what was lost with a cable or to a device that was down.
    pub(super) frames_lost: u64,
    pub(super) boots: u64,
    /// Times that the device went into its fault state, and into ARMED.
    pub(super) faulted: u64,
    pub(super) armed: u64,
}

/// A packet that arrived whole.
struct Whole {
    kind: u8,
    seq: u16,
    payload: Vec<u8>,
}

/// Splits text at zeros, as the framing says.
#[derive(Default)]
struct Splitter {
    text: Vec<u8>,
}

impl Splitter {
    /// The packets that these bytes complete; `None` for a text that is none.
    fn take(&mut self, bytes: &[u8]) -> Vec<Option<Whole>> {
        let mut found = Vec::new();
        for &byte in bytes {
            if byte != 0 {
                self.text.push(byte);
            } else if !self.text.is_empty() {
                found.push(whole(&std::mem::take(&mut self.text)));
            }
        }
        found
    }
}

fn whole(text: &[u8]) -> Option<Whole> {
    let body = cobs::decode_vec(text).ok()?;
    if body.len() < 8 || body.len() > MAX_BODY {
        return None;
    }
    let (covered, crc) = body.split_at(body.len() - 4);
    let oracle = crc::Crc::<u32>::new(&crc::CRC_32_ISO_HDLC);
    let is_whole = oracle.checksum(covered).to_le_bytes() == crc && covered[0] < 0x80;
    is_whole.then(|| Whole {
        kind: covered[0],
        seq: u16::from_le_bytes([covered[2], covered[3]]),
        payload: covered[4..].to_vec(),
    })
}

/// The device as the ledger knows it.
#[derive(Default)]
struct Known {
    splitter: Splitter,
    state: Option<DeviceState>,
    is_descending: bool,
    last_seq: Option<u16>,
    has_frame: bool,
    applied: Option<u32>,
    /// FRAMEs of the last delivery that are not refused yet: seq, whether late, whether repeated.
    open: Vec<(u16, bool, bool)>,
}

/// Goes through a life.
pub(super) fn ledger(entries: &[Tapped]) -> Ledger {
    let mut sums = Ledger::default();
    let mut known = Known::default();
    for entry in entries {
        match entry {
            Tapped::Delivered(device_us, bytes) => {
                known.settle(&mut sums);
                known.deliver(*device_us, bytes, &mut sums);
            }
            Tapped::Lost(bytes) => {
                let found = Splitter::default().take(bytes);
                let frames = found.iter().flatten().filter(|it| it.kind == kind::FRAME);
                sums.frames_lost += frames.count() as u64;
            }
            Tapped::Emitted(bytes) => known.hear(bytes, &mut sums),
            Tapped::Applied(tick) => known.applied = Some(*tick),
            Tapped::Changed(state) => known.change(*state, &mut sums),
            Tapped::Booted => {
                known.settle(&mut sums);
                sums.boots += 1;
                known = Known::default();
            }
            Tapped::HungUp => known.is_descending = true,
        }
    }
    known.settle(&mut sums);
    sums
}

impl Known {
    fn deliver(&mut self, device_us: u64, bytes: &[u8], sums: &mut Ledger) {
        for found in self.splitter.take(bytes) {
            let Some(packet) = found else {
                sums.bad += 1;
                continue;
            };
            match packet.kind {
                kind::HELLO => {
                    self.last_seq = None;
                    self.has_frame = false;
                }
                kind::FRAME => {
                    sums.frames += 1;
                    let stamp: [u8; 4] = packet.payload[..4].try_into().unwrap();
                    let apply_tick = u32::from_le_bytes(stamp);
                    let tick = u32::try_from(device_us / TICK_US).unwrap();
                    let is_late =
                        apply_tick != NEXT_TICK && apply_tick.wrapping_sub(tick).cast_signed() <= 0;
                    let is_repeated = self.last_seq == Some(packet.seq);
                    // A second refusal of the same frame names the same seq: settled one by one.
                    self.open.push((packet.seq, is_late, is_repeated));
                    if self.is_live() {
                        self.last_seq = Some(packet.seq);
                        self.has_frame = true;
                    }
                }
                _ => {}
            }
        }
    }

    /// Whatever was not refused until the next delivery was accepted or repeated.
    fn settle(&mut self, sums: &mut Ledger) {
        for (_, is_late, is_repeated) in self.open.drain(..) {
            sums.dup += u64::from(is_repeated);
            sums.late += u64::from(is_late && !is_repeated);
        }
    }

    fn hear(&mut self, bytes: &[u8], sums: &mut Ledger) {
        let packet = Splitter::default().take(bytes).pop().flatten();
        assert!(packet.is_none(), "types of the device lie above 80");
        let body = cobs::decode_vec(&bytes[1..bytes.len() - 1]).unwrap();
        let payload = &body[4..body.len() - 4];
        match body[0] {
            kind::ACK if payload[0] == kind::FRAME && payload[1] != 0 => {
                let seq = u16::from_le_bytes([payload[2], payload[3]]);
                let at = self.open.iter().position(|(open, ..)| *open == seq);
                self.open
                    .remove(at.expect("it refuses what has just arrived"));
                sums.refused += 1;
            }
            kind::STATUS => {
                let tick = u32::from_le_bytes(payload[..4].try_into().unwrap());
                let misses = self.is_live() && self.has_frame && !self.is_descending;
                sums.underrun += u64::from(misses && self.applied != Some(tick));
            }
            _ => {}
        }
    }

    fn change(&mut self, state: DeviceState, sums: &mut Ledger) {
        self.state = Some(state);
        if !state.is_live() {
            self.is_descending = false;
            self.has_frame = false;
        }
        sums.faulted += u64::from(state == DeviceState::Fault);
        if state == DeviceState::Armed {
            sums.armed += 1;
            self.has_frame = false;
        }
    }

    fn is_live(&self) -> bool {
        self.state.is_some_and(DeviceState::is_live)
    }
}
