//! Lies about messages: the one way out of a device, where packets and STATUS are changed.

use std::collections::VecDeque;

use super::declared::Act;
use super::firmware::{FirmwareLie, value};
use super::hearing::Hearing;
use super::rules::Rule;
use crate::framing::{CRC_LEN, Decoder, LARGEST_BODY, Packet};
use crate::message::{Status, kind};

/// Told STATUS that are remembered for those that want to see them again.
const MOST_TOLD: usize = 64;
/// What a boot loader would say.
const BANNER: &[u8] = b"\r\nboot ok\r\n";
/// How often told ticks jump.
const JUMP_EVERY: u32 = 40;

/// What a device that lies remembers of what it heard and told.
#[derive(Clone, Debug, Default)]
pub(crate) struct LieMemory {
    /// What came in since the last zero.
    pub(crate) hearing: Hearing,
    /// The tick from which told ones count.
    pub(crate) first_tick: u32,
    /// When it was armed last.
    pub(crate) armed_us: Option<u64>,
    n_packets: u64,
    told: VecDeque<Status>,
    late: Option<(u64, Status)>,
}

impl LieMemory {
    /// What goes over the wire in place of a packet.
    pub(crate) fn packet(&mut self, lies: &[FirmwareLie], tick: u32, packet: &Packet) -> Vec<u8> {
        self.n_packets += 1;
        let value = |rule| value(lies, tick, rule);
        let breaks = |rule| value(rule).is_some();
        let mut decoder = Decoder::new(LARGEST_BODY);
        let mut bodies = packet.as_bytes().iter().filter_map(|&byte| {
            let whole = decoder.push(byte)?;
            Some((whole.kind, whole.seq, whole.payload.to_vec()))
        });
        let Some((kind, seq, payload)) = bodies.next() else {
            return packet.as_bytes().to_vec();
        };
        let flags = value(Rule::FlagsSent).map_or(0, |flags| flags.to_le_bytes()[0]);
        let [low, high] = if breaks(Rule::SeqStuck) {
            [1, 0]
        } else {
            seq.to_le_bytes()
        };
        let mut body = vec![kind, flags, low, high];
        body.extend(self.payload(lies, tick, kind, payload));
        body.truncate(LARGEST_BODY - CRC_LEN);
        let sealed = Packet::sealed(&body);
        let mut wire = sealed.map_or_else(Vec::new, |packet| packet.as_bytes().to_vec());
        if value(Rule::BadCrcEvery).is_some_and(|every| self.n_packets.is_multiple_of(every)) {
            spoil(&mut wire);
        }
        if breaks(Rule::NoLeadingZero) {
            wire.drain(..1.min(wire.len()));
        }
        if breaks(Rule::RepeatsPackets) {
            wire = wire.repeat(2);
        }
        if kind == kind::CAPS && breaks(Rule::Banner) {
            wire.splice(..0, BANNER.iter().copied());
        }
        wire
    }

    /// The payload of a message with its fields changed.
    fn payload(&self, lies: &[FirmwareLie], tick: u32, kind: u8, mut payload: Vec<u8>) -> Vec<u8> {
        let (tick_at, us_at) = match kind {
            kind::STATUS => (0, 4),
            kind::PONG => (8, 4),
            _ => (0, 0),
        };
        if self.first_tick > 0 && us_at > 0 {
            let first_us = u64::from(self.first_tick) * u64::from(crate::message::TICK_US);
            change(&mut payload, tick_at, 4, |tick| {
                tick.wrapping_sub(self.first_tick.into())
            });
            change(&mut payload, us_at, 4, |us| us.wrapping_sub(first_us));
        }
        for lie in lies.iter().filter(|lie| tick >= lie.from_tick) {
            match lie.declared.act {
                Act::Field {
                    kind: of,
                    at,
                    width,
                } if of == kind => {
                    let value = lie.value.cast_unsigned();
                    change(&mut payload, at, width, |is| {
                        if lie.is_added {
                            is.wrapping_add(value)
                        } else {
                            value
                        }
                    });
                }
                Act::Cut(of) if of == kind => payload.truncate(length(lie.value)),
                Act::Extra(of) if of == kind => {
                    payload.resize(payload.len() + length(lie.value), 0xee);
                }
                _ => {}
            }
        }
        payload
    }

    /// What is told in place of a tick's STATUS, in order.
    pub(crate) fn statuses(
        &mut self,
        value: impl Fn(Rule) -> Option<u64>,
        now_us: u64,
        mut status: Status,
    ) -> Vec<Status> {
        let of_tick = status.tick;
        if let Some(by) = value(Rule::TickJumps) {
            let jumped = u64::from(of_tick / JUMP_EVERY).wrapping_mul(by);
            status.tick = of_tick.wrapping_add(crate::fields::wrapped_u32(jumped));
        }
        self.told.push_front(status);
        self.told.truncate(MOST_TOLD);
        let every = value(Rule::StatusEvery).unwrap_or(1);
        if value(Rule::NoStatus).is_some() || !u64::from(of_tick).is_multiple_of(every) {
            return Vec::new();
        }
        if let Some(by_ms) = value(Rule::StatusLate) {
            self.late = Some((now_us + 1000 * by_ms, status));
            return Vec::new();
        }
        let copies = 1 + length(value(Rule::StatusFlood).map_or(0, u64::cast_signed));
        let old = value(Rule::StatusOld).map(u64::cast_signed);
        let old = old.and_then(|ago| self.told.get(length(ago)).copied());
        std::iter::repeat_n(status, copies).chain(old).collect()
    }

    /// A STATUS that was held back until now.
    pub(crate) fn late_status(&mut self, now_us: u64) -> Option<Status> {
        let due = self.late.take_if(|(due_us, _)| *due_us <= now_us);
        due.map(|(_, status)| status)
    }
}

/// Changes a little-endian number in a payload that reaches so far.
fn change(payload: &mut [u8], at: usize, width: usize, new: impl FnOnce(u64) -> u64) {
    let Some(field) = payload.get_mut(at..at + width) else {
        return;
    };
    let mut bytes = [0; 8];
    bytes[..width].copy_from_slice(field);
    let changed = new(u64::from_le_bytes(bytes)).to_le_bytes();
    field.copy_from_slice(&changed[..width]);
}

/// Changes the last byte of the CRC, never to or from zero.
fn spoil(wire: &mut [u8]) {
    let end = wire.len().saturating_sub(2);
    if let Some(last) = wire.get_mut(end) {
        *last = if *last == 1 { 2 } else { *last - 1 };
    }
}

fn length(value: i64) -> usize {
    usize::try_from(value).unwrap_or(0)
}
