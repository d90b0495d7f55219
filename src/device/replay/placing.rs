//! When the device had each packet of the host, by its own clock.
//!
//! A log knows when a packet left the host. When it arrived is told by the device: STATUS names
//! the FRAME that was accepted last and its age (within a ms), PONG holds the time of its PING, and
//! every other request is answered before the STATUS of the tick in which it came. What is known so
//! is exact as far as the emulator is concerned, which acts on a 1 ms clock; between such bounds
//! the time of writing, moved by what the last FRAME or PING took, is a guess.

use std::collections::VecDeque;

use crate::message::{Ack, Status, kind};
use crate::session_log::{Body, HashedFrame};
use selvedge_foundation::numerics::to_whole;

const MS_US: u64 = 1000;
const TICK_US: u64 = 25 * MS_US;
/// Packets that wait for a sign of the device; with more the oldest is given up.
const MAX_WAITING: usize = 512;
/// A packet without a sign of the device for so long did not arrive, s.
const PATIENCE_S: f64 = 1.0;
/// A host that waits for an answer asks again after no less, s.
const ANSWER_S: f64 = 0.2;
/// By how much a guessed time may be off before it is taken as another tick, µs.
const DOUBT_US: u64 = 2 * MS_US;

/// What the host wrote.
#[derive(Clone, Debug)]
pub(super) enum Written {
    Body(Box<Body>),
    Hashed(HashedFrame),
    /// Bytes that are no packet: no sign tells of them.
    Bytes(Vec<u8>),
}

impl Written {
    /// Type and number, if it is a packet.
    fn name(&self) -> Option<(u8, u16)> {
        match self {
            Self::Body(body) => Some((body.kind, body.seq)),
            Self::Hashed(frame) => Some((kind::FRAME, frame.seq)),
            Self::Bytes(_) => None,
        }
    }

    /// The tick that a FRAME is for.
    pub(super) fn apply_tick(&self) -> Option<u32> {
        match self {
            Self::Hashed(frame) => Some(frame.apply_tick),
            Self::Body(body) if body.kind == kind::FRAME => {
                let first = body.payload().first_chunk()?;
                Some(u32::from_le_bytes(*first))
            }
            Self::Body(_) | Self::Bytes(_) => None,
        }
    }

    pub(super) fn is(&self, kind: u8) -> bool {
        self.name().is_some_and(|(own, _)| own == kind)
    }
}

/// How the device showed that it had a packet.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Sign {
    None,
    Answered,
    /// By its clock, µs since boot.
    At(u64),
}

/// A packet without its time at the device.
#[derive(Clone, Debug)]
struct Waiting {
    written: Written,
    host_s: f64,
    sign: Sign,
}

/// A packet with its time.
#[derive(Clone, Debug)]
pub(super) struct Placed {
    pub(super) written: Written,
    /// By the device's clock, µs since boot.
    pub(super) device_us: u64,
    /// Whether that is a guess within its tick.
    pub(super) is_guess: bool,
}

/// What a STATUS made of the packets that waited.
#[derive(Debug, Default)]
pub(super) struct Placement {
    pub(super) packets: Vec<Placed>,
    /// Packets that were followed by others that arrived: lost on the way.
    pub(super) n_lost: u64,
    /// Packets of which nobody can tell whether they arrived.
    pub(super) n_doubtful: u64,
}

/// Places packets.
#[derive(Debug, Default)]
pub(super) struct Placer {
    waiting: VecDeque<Waiting>,
    /// The device's clock less ours for a packet of the host on its way, µs.
    shift_us: Option<f64>,
    /// The time of the STATUS before and of the last packet that was placed.
    status_us: Option<u64>,
    placed_us: u64,
}

impl Placer {
    /// The host wrote this.
    pub(super) fn wrote(&mut self, written: Written, host_s: f64) -> u64 {
        self.waiting.push_back(Waiting {
            written,
            host_s,
            sign: Sign::None,
        });
        if self.waiting.len() > MAX_WAITING {
            self.waiting.pop_front();
            return 1;
        }
        0
    }

    /// The device acknowledged a packet, or refused it.
    pub(super) fn acknowledged(&mut self, ack: Ack) {
        let is_it = |it: &&mut Waiting| it.written.name() == Some((ack.kind, ack.seq));
        if let Some(waiting) = self.waiting.iter_mut().rev().find(is_it) {
            waiting.sign = Sign::Answered;
        }
    }

    /// The device answered a request that `is_it`; gives it to be changed. Of several the last, but
    /// not one that was written within the time of an answer to another.
    pub(super) fn answered(
        &mut self,
        is_it: impl Fn(&Body) -> bool,
        at_us: Option<u64>,
    ) -> Option<&mut Written> {
        let is_asked = |waiting: &Waiting| match &waiting.written {
            Written::Body(body) => waiting.sign == Sign::None && is_it(body),
            Written::Hashed(_) | Written::Bytes(_) => false,
        };
        let last = self.waiting.iter().rposition(is_asked)?;
        let since_s = self.waiting.get(last)?.host_s - ANSWER_S;
        let is_one = |waiting: &Waiting| waiting.host_s >= since_s && is_asked(waiting);
        let first = self.waiting.iter().position(is_one)?;
        let waiting = self.waiting.get_mut(first)?;
        waiting.sign = at_us.map_or(Sign::Answered, Sign::At);
        Some(&mut waiting.written)
    }

    /// A STATUS of `device_us`, µs since boot, arrived at `host_s`: which packets came before it.
    pub(super) fn status(&mut self, status: &Status, device_us: u64, host_s: f64) -> Placement {
        let confirmed = self.confirm(status, device_us);
        let mut placement = Placement::default();
        let is_told = |waiting: &Waiting| waiting.sign != Sign::None;
        let n_before = self
            .waiting
            .iter()
            .rposition(is_told)
            .map_or(0, |at| at + 1);
        let shift_us = self.shift(device_us, host_s);
        let is_next = self
            .status_us
            .is_some_and(|last_us| device_us.saturating_sub(last_us) < TICK_US + TICK_US / 2);
        let mut before: Vec<(Waiting, u64)> = Vec::with_capacity(n_before);
        for (at, waiting) in self.waiting.drain(..n_before).enumerate() {
            let guess_us = rounded(waiting.host_s * 1e6 + shift_us);
            let was_before = self.status_us.is_some_and(|us| guess_us + DOUBT_US < us);
            let is_frame = waiting.written.is(kind::FRAME);
            // A later one would be the last that STATUS names.
            let may_be = is_frame && confirmed.is_some_and(|confirmed| at < confirmed);
            let is_packet = waiting.written.name().is_some();
            if is_told(&waiting) || !is_packet {
                before.push((waiting, guess_us));
            } else if !may_be || is_next && was_before {
                placement.n_lost += 1;
            } else {
                placement.n_doubtful += 1;
                before.push((waiting, guess_us));
            }
        }
        self.place(before, device_us, &mut placement);
        let is_old = |it: &Waiting| host_s - it.host_s > PATIENCE_S;
        while self.waiting.front().is_some_and(is_old) {
            self.waiting.pop_front();
            placement.n_lost += 1;
        }
        self.status_us = Some(device_us);
        placement
    }

    /// The FRAME that a STATUS names came at its age, known within a ms. Its place, if it waits.
    fn confirm(&mut self, status: &Status, device_us: u64) -> Option<usize> {
        let is_it = |it: &Waiting| it.written.name() == Some((kind::FRAME, status.last_seq));
        let age_us = u64::from(status.age_ms) * MS_US + MS_US / 2;
        if status.age_ms == u16::MAX {
            return None;
        }
        let at = self.waiting.iter().position(is_it)?;
        let waiting = self.waiting.get_mut(at)?;
        if waiting.sign == Sign::None {
            waiting.sign = Sign::At(device_us.saturating_sub(age_us));
        }
        Some(at)
    }

    /// The device's clock less ours, as the last packet with a known time had it; at first as this
    /// STATUS has it.
    fn shift(&mut self, device_us: u64, host_s: f64) -> f64 {
        let known = self.waiting.iter().rev().find_map(|waiting| {
            let Sign::At(at_us) = waiting.sign else {
                return None;
            };
            Some(at_us as f64 - waiting.host_s * 1e6)
        });
        let first = device_us as f64 - host_s * 1e6;
        let shift = known.or(self.shift_us).unwrap_or(first);
        self.shift_us = Some(shift);
        shift
    }

    /// Gives each packet a time between those of its neighbours.
    fn place(&mut self, before: Vec<(Waiting, u64)>, device_us: u64, placement: &mut Placement) {
        let mut latest_us = device_us.saturating_sub(1);
        let mut times = vec![0; before.len()];
        for ((waiting, guess_us), time_us) in before.iter().zip(&mut times).rev() {
            let wanted_us = match waiting.sign {
                Sign::At(at_us) => at_us,
                _ => *guess_us,
            };
            latest_us = wanted_us.min(latest_us);
            *time_us = latest_us;
        }
        for ((waiting, _), time_us) in before.into_iter().zip(times) {
            let is_guess = !matches!(waiting.sign, Sign::At(_));
            // A request that is answered after a STATUS came after it.
            let after = self.status_us.filter(|_| waiting.sign == Sign::Answered);
            let earliest_us = self.placed_us.max(after.map_or(0, |us| us + 1));
            self.placed_us = time_us.max(earliest_us);
            placement.packets.push(Placed {
                written: waiting.written,
                device_us: self.placed_us,
                is_guess,
            });
        }
    }

    /// Packets that nothing was heard of.
    pub(super) fn n_waiting(&self) -> u64 {
        self.waiting.len() as u64
    }
}

fn rounded(us: f64) -> u64 {
    to_whole(us.round().clamp(0.0, 1e18))
}
