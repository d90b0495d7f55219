//! A packet as the words of a line and back, to the byte.
//!
//! Most lines of a log are FRAME and STATUS, 40 of each in a second, so these are told by what is
//! not as was to be expected from the lines before; every other packet is its type, its number and
//! its payload in hexadecimal digits. Writer and reader keep the same state and change it with the
//! same lines. One FRAME in 40 is written whole, so that a reader may begin anywhere.

use super::bodies::{body_words, push, read_body};
use super::digits::{pack, unpack};
use super::earlier_digits;
use super::events::event;
use super::tap::Body;
use crate::fields::wrapped_u32;
use crate::framing::Received;
use crate::message::{LARGEST_CHANNELS, Message as _, Status, TICK_US, frame, kind};
use selvedge_foundation::files::sha256_hex;

/// Frames from one that is written whole to the next.
const WHOLE_EVERY: u32 = 40;
/// From one tick that is written although it was to be expected to the next.
const TICK_EVERY: u32 = 40;
/// The most frames that one line stands for.
pub(super) const MAX_AGAIN: u16 = 400;
/// Digits of a frame's hash.
const HASH_DIGITS: usize = 16;

/// A FRAME as a log without frames knows it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct HashedFrame {
    pub(crate) seq: u16,
    pub(crate) apply_tick: u32,
    pub(crate) n_channels: usize,
    pub(crate) hash: String,
}

/// What a line of a packet says: event, tick of the device, detail.
#[derive(Debug, PartialEq, Eq)]
pub(super) struct PacketWords {
    pub(super) event: &'static str,
    pub(super) tick: Option<u32>,
    pub(super) detail: String,
}

impl PacketWords {
    pub(super) fn new(event: &'static str, detail: String) -> Self {
        Self {
            event,
            tick: None,
            detail,
        }
    }
}

/// What was sent last.
#[derive(Clone, Debug, Default)]
struct LastFrame {
    seq: u16,
    apply_tick: u32,
    codes: Vec<[u16; 2]>,
    hash: String,
    /// Frames since one was whole; `None` before the first.
    since_whole: Option<u32>,
}

/// What the lines so far say of the packets to come.
#[derive(Clone, Debug, Default)]
pub(super) struct PacketCode {
    frame: LastFrame,
    sent_seq: u16,
    received_seq: u16,
    status: Status,
    /// By how much `last_seq` of STATUS rose last: 0 or 1.
    accepted_step: u16,
}

macro_rules! status_pairs {
    ($do:ident!($($arguments:tt)*)) => {
        $do! { $($arguments)*
            state queued underrun late dup bad clipped hv_dv i_ma temp_cdeg faults
        }
    };
}

impl PacketCode {
    /// The words of a packet that was written.
    pub(super) fn sent(&mut self, body: &Body, keeps_frames: bool) -> PacketWords {
        let words = match frame_of(body) {
            Some((apply_tick, codes)) => self.frame_words(body, apply_tick, codes, keeps_frames),
            None => plain(event::OUT, body),
        };
        self.sent_seq = body.seq;
        words
    }

    /// The words of a packet that arrived.
    pub(super) fn received(&mut self, body: &Body) -> PacketWords {
        let words = self
            .status_words(body)
            .unwrap_or_else(|| plain(event::IN, body));
        self.received_seq = body.seq;
        words
    }

    /// The words of a packet that was not written.
    pub(super) fn unsent(body: &Body) -> PacketWords {
        plain(event::UNSENT, body)
    }

    /// Whether this is the frame sent last once more, `n` frames later.
    pub(super) fn is_again(&self, body: &Body, n: u16) -> bool {
        let last = &self.frame;
        let is_next = body.seq == last.seq.wrapping_add(n) && last.since_whole.is_some();
        is_next
            && frame_of(body).is_some_and(|(apply_tick, codes)| {
                apply_tick == last.apply_tick.wrapping_add(u32::from(n)) && codes == last.codes
            })
    }

    /// The last frame came `n` times more.
    pub(super) fn again(&mut self, n: u16) -> PacketWords {
        self.frame.seq = self.frame.seq.wrapping_add(n);
        self.frame.apply_tick = self.frame.apply_tick.wrapping_add(u32::from(n));
        self.sent_seq = self.frame.seq;
        PacketWords::new(event::FRAME_AGAIN, n.to_string())
    }

    fn frame_words(
        &mut self,
        body: &Body,
        apply_tick: u32,
        codes: Vec<[u16; 2]>,
        keeps_frames: bool,
    ) -> PacketWords {
        let ahead = apply_tick.wrapping_sub(self.status.tick).cast_signed();
        let mut detail = ahead.to_string();
        let last = &mut self.frame;
        let since = last.since_whole.filter(|since| *since + 1 < WHOLE_EVERY);
        let is_whole = since.is_none() || codes.len() != last.codes.len();
        if !keeps_frames {
            last.hash = hash_of(&codes);
            push(
                &mut detail,
                format_args!(" ={} {}", codes.len(), &last.hash),
            );
        } else if is_whole {
            push(&mut detail, format_args!(" ={} ", codes.len()));
            pack(&codes, &vec![[0; 2]; codes.len()], &mut detail);
        } else {
            detail.push(' ');
            pack(&codes, &last.codes, &mut detail);
        }
        last.since_whole = Some(if is_whole {
            0
        } else {
            since.map_or(0, |n| n + 1)
        });
        (last.seq, last.apply_tick, last.codes) = (body.seq, apply_tick, codes);
        if body.seq != self.sent_seq.wrapping_add(1) {
            push(&mut detail, format_args!(" seq={}", body.seq));
        }
        let event = if keeps_frames {
            event::FRAME
        } else {
            event::FRAME_HASH
        };
        PacketWords::new(event, detail)
    }

    /// The STATUS that is to be expected at a tick.
    fn expected(&self, tick: u32) -> Status {
        Status {
            tick,
            dev_us: wrapped_u32(u64::from(tick) * u64::from(TICK_US)),
            last_seq: self.status.last_seq.wrapping_add(self.accepted_step),
            ..self.status
        }
    }

    fn heard(&mut self, status: Status) {
        let step = status.last_seq.wrapping_sub(self.status.last_seq);
        self.accepted_step = step.min(1);
        self.status = status;
    }

    /// `None` for what is no STATUS of v1 to the byte.
    fn status_words(&mut self, body: &Body) -> Option<PacketWords> {
        macro_rules! changed {
            ($detail:ident $expected:ident $status:ident $($name:ident)+) => {
                $(if $status.$name != $expected.$name {
                    let name = stringify!($name);
                    push(&mut $detail, format_args!(" {name}={}", $status.$name));
                })+
            };
        }
        if body.kind != kind::STATUS {
            return None;
        }
        let status = Status::decode(body.payload())?;
        if body_of_status(&status, body.seq).as_ref() != Some(body) {
            return None;
        }
        let is_next = status.tick == self.status.tick.wrapping_add(1);
        let tick = (!is_next || status.tick.is_multiple_of(TICK_EVERY)).then_some(status.tick);
        let expected = self.expected(status.tick);
        let mut detail = format!("{} {}", status.age_ms, status.amp_sum);
        if body.seq != self.received_seq.wrapping_add(1) {
            push(&mut detail, format_args!(" seq={}", body.seq));
        }
        changed!(detail expected status dev_us last_seq);
        status_pairs!(changed!(detail expected status));
        self.heard(status);
        Some(PacketWords {
            event: event::STATUS,
            tick,
            detail,
        })
    }

    /// Reads a FRAME of this event.
    pub(super) fn read_frame(&mut self, event: &str, detail: &str) -> Option<Body> {
        let unpack = match event {
            event::FRAME => unpack,
            _ => earlier_digits::unpack,
        };
        let mut words = detail.split(' ');
        let apply_tick = self.read_apply_tick(words.next()?)?;
        let first = words.next()?;
        match first.strip_prefix('=') {
            Some(n) => {
                let n = n.parse().ok().filter(|n| *n <= LARGEST_CHANNELS)?;
                let mut codes = vec![[0; 2]; n];
                unpack(words.next()?, &mut codes)?;
                self.frame.codes = codes;
            }
            None if self.frame.since_whole.is_none() => return None,
            None => unpack(first, &mut self.frame.codes)?,
        }
        self.frame.hash.clear();
        self.frame.since_whole = Some(0);
        self.frame.apply_tick = apply_tick;
        self.frame.seq = Self::read_seq(words.next(), self.sent_seq)?;
        self.sent_seq = self.frame.seq;
        words.next().is_none().then(|| self.last_frame())?
    }

    /// Reads a `frame-hash`.
    pub(super) fn read_hash(&mut self, detail: &str) -> Option<HashedFrame> {
        let mut words = detail.split(' ');
        let apply_tick = self.read_apply_tick(words.next()?)?;
        let n = words.next()?.strip_prefix('=')?.parse().ok();
        let n = n.filter(|n| *n <= LARGEST_CHANNELS)?;
        let hash = words.next()?;
        let is_hash = hash.len() == HASH_DIGITS && hash.bytes().all(|b| b.is_ascii_hexdigit());
        self.frame = LastFrame {
            seq: Self::read_seq(words.next(), self.sent_seq)?,
            apply_tick,
            codes: vec![[0; 2]; n],
            hash: hash.to_owned(),
            since_whole: None,
        };
        self.sent_seq = self.frame.seq;
        (is_hash && words.next().is_none()).then(|| self.last_hash())
    }

    /// The frame that came last, with the next number and tick.
    pub(super) fn next_frame(&mut self) -> Result<Option<Body>, HashedFrame> {
        self.frame.seq = self.frame.seq.wrapping_add(1);
        self.frame.apply_tick = self.frame.apply_tick.wrapping_add(1);
        self.sent_seq = self.frame.seq;
        if self.frame.hash.is_empty() {
            return Ok(self.frame.since_whole.and_then(|_| self.last_frame()));
        }
        Err(self.last_hash())
    }

    /// Reads a `status`.
    pub(super) fn read_status(&mut self, tick: Option<u32>, detail: &str) -> Option<Body> {
        macro_rules! take {
            ($status:ident $name:ident $value:ident $($field:ident)+) => {
                match $name {
                    $(stringify!($field) => $status.$field = $value.parse().ok()?,)+
                    _ => return None,
                }
            };
        }
        let mut words = detail.split(' ');
        let next = self.status.tick.wrapping_add(1);
        let mut status = self.expected(tick.unwrap_or(next));
        status.age_ms = words.next()?.parse().ok()?;
        status.amp_sum = words.next()?.parse().ok()?;
        let mut seq = self.received_seq.wrapping_add(1);
        for pair in words {
            let (name, value) = pair.split_once('=')?;
            match name {
                "seq" => seq = value.parse().ok()?,
                "dev_us" => status.dev_us = value.parse().ok()?,
                "last_seq" => status.last_seq = value.parse().ok()?,
                _ => status_pairs!(take!(status name value)),
            }
        }
        self.heard(status);
        self.received_seq = seq;
        body_of_status(&status, seq)
    }

    /// Reads an `out`, `in` or `unsent`.
    pub(super) fn read_plain(&mut self, event: &str, detail: &str) -> Option<Body> {
        let body = read_body(detail)?;
        match event {
            event::IN => self.received_seq = body.seq,
            event::OUT => self.sent_seq = body.seq,
            _ => {}
        }
        Some(body)
    }

    fn read_apply_tick(&self, ahead: &str) -> Option<u32> {
        let ahead: i32 = ahead.parse().ok()?;
        Some(self.status.tick.wrapping_add(ahead.cast_unsigned()))
    }

    fn read_seq(word: Option<&str>, last: u16) -> Option<u16> {
        match word {
            None => Some(last.wrapping_add(1)),
            Some(word) => word.strip_prefix("seq=")?.parse().ok(),
        }
    }

    fn last_frame(&self) -> Option<Body> {
        let LastFrame {
            seq, apply_tick, ..
        } = self.frame;
        let mut payload = apply_tick.to_le_bytes().to_vec();
        let codes = self.frame.codes.iter().flatten();
        payload.extend(codes.flat_map(|code| code.to_le_bytes()));
        Body::new(&Received {
            kind: kind::FRAME,
            seq,
            payload: &payload,
        })
    }

    fn last_hash(&self) -> HashedFrame {
        HashedFrame {
            seq: self.frame.seq,
            apply_tick: self.frame.apply_tick,
            n_channels: self.frame.codes.len(),
            hash: self.frame.hash.clone(),
        }
    }
}

fn plain(event: &'static str, body: &Body) -> PacketWords {
    PacketWords::new(event, body_words(body))
}

/// Apply tick and codes of a FRAME that is one to the byte.
fn frame_of(body: &Body) -> Option<(u32, Vec<[u16; 2]>)> {
    let n_bytes = body.payload().len().checked_sub(4)?;
    let is_whole = body.kind == kind::FRAME && body.flags == 0 && n_bytes.is_multiple_of(4);
    let n_channels = (n_bytes / 4).min(LARGEST_CHANNELS);
    let mut codes = vec![[0; 2]; if is_whole { n_channels } else { return None }];
    let apply_tick = frame::decode_into(body.payload(), &mut codes)?;
    Some((apply_tick, codes))
}

fn hash_of(codes: &[[u16; 2]]) -> String {
    let bytes: Vec<u8> = codes
        .iter()
        .flatten()
        .flat_map(|code| code.to_le_bytes())
        .collect();
    let mut hash = sha256_hex([bytes.as_slice()]);
    hash.truncate(HASH_DIGITS);
    hash
}

fn body_of_status(status: &Status, seq: u16) -> Option<Body> {
    Body::of_wire(status.packet(seq)?.as_bytes())
}
