//! What a device that lies does, where that is more than leaving a rule out.

use super::lie::{self, Rule};
use super::output::TICK;
use super::requests::Answer;
use super::{DeviceCore, DeviceSink, MS_US};
use crate::message::{AckCode, DeviceState, Fault, LogText, fault_bit, frame, kind};

/// How long the cause of an announced fault lasts, µs.
const CAUSE_US: u64 = 2_000_000;
/// What an announced fault tells: 85.00 °C.
const HOT_CDEG: i32 = 8500;
/// A text that no terminal should be given as it is.
const ODD_LOG: &[u8] = b"\x1b[2J\x07\xff\xfe\x00end";

impl DeviceCore {
    /// Whether a lie breaks this rule now.
    pub(super) fn breaks(&self, rule: Rule) -> bool {
        self.broken_by(rule).is_some()
    }

    /// By how much a lie breaks this rule now, 0 where it says nothing of that; `None`: the rule is
    /// kept.
    pub(super) fn broken_by(&self, rule: Rule) -> Option<u64> {
        if self.model.lies.is_empty() {
            return None;
        }
        lie::value(&self.model.lies, self.tick(), rule)
    }

    /// What happens every ms against the rules.
    pub(super) fn lie_for_a_ms(&mut self, sink: &mut impl DeviceSink) {
        if self.model.lies.is_empty() {
            return;
        }
        if let Some(status) = self.lie_memory.late_status(self.now_us) {
            self.send(&status, sink);
        }
        self.lie_about_faults(sink);
        if self.breaks(Rule::LogFlood) && self.session.is_some() {
            let packet = LogText::packet(self.next_seq, "still here");
            self.send_packet(packet.as_ref(), sink);
        }
        let armed_us = self.lie_memory.armed_us.unwrap_or(self.now_us);
        let times_out = self
            .broken_by(Rule::ArmedTimesOut)
            .is_some_and(|ms| self.now_us - armed_us >= ms * MS_US);
        if times_out && self.state == DeviceState::Armed {
            self.silence(DeviceState::Ready);
        }
    }

    fn lie_about_faults(&mut self, sink: &mut impl DeviceSink) {
        let at_us = self.broken_by(Rule::FaultAt).map(|tick| tick * TICK);
        if at_us == Some(self.now_us) {
            self.raise_fault(fault_bit::OVER_TEMPERATURE, u16::MAX, HOT_CDEG, sink);
        } else if at_us.is_some_and(|at_us| self.now_us == at_us + CAUSE_US) {
            self.end_fault_cause(fault_bit::OVER_TEMPERATURE);
        }
        if self.breaks(Rule::FaultUnlatched) && self.faults & self.fault_causes == 0 {
            self.faults = 0;
            if self.state == DeviceState::Fault {
                self.silence(self.after_faults());
            }
        }
        if self.breaks(Rule::FaultFlood) && self.session.is_some() {
            let fault = Fault {
                faults: fault_bit::OVER_TEMPERATURE,
                channel: u16::MAX,
                value: HOT_CDEG,
                tick: self.tick(),
            };
            self.send(&fault, sink);
        }
    }

    /// What happens at every tick against the rules, before its STATUS.
    pub(super) fn lie_for_a_tick(&mut self, sink: &mut impl DeviceSink) {
        if self.breaks(Rule::LogOdd) && self.session.is_some() {
            let packet = crate::framing::Packet::encode(kind::LOG, self.next_seq, ODD_LOG);
            self.send_packet(packet.as_ref(), sink);
        }
    }

    /// What a payload is taken for against the rules of lengths; `None` where they are kept.
    pub(super) fn lie_about_length(&self, kind: u8, payload: &[u8]) -> Option<Answer> {
        let expected = table_len(kind, self.model.n_channels())?;
        let is_frame = kind == kind::FRAME;
        if payload.len() < expected && self.breaks(Rule::ShortAnswered) {
            return Some(Answer::Ack(AckCode::OutOfRange));
        }
        let refuses = if is_frame {
            Rule::LongFrameBad
        } else {
            Rule::TrailingRefused
        };
        (payload.len() > expected && self.breaks(refuses)).then_some(Answer::Bad)
    }

    /// A payload as it is taken by a device that does not look at its length; `None` where it does.
    pub(super) fn payload_of_any_length(&self, kind: u8, payload: &[u8]) -> Option<Vec<u8>> {
        let expected = table_len(kind, self.model.n_channels())?;
        let is_taken = payload.len() < expected && self.breaks(Rule::ShortAccepted)
            || kind == kind::FRAME
                && payload.len() > expected
                && self.breaks(Rule::LongFrameAccepted);
        is_taken.then(|| {
            let mut whole = payload.to_vec();
            whole.resize(expected, 0);
            whole
        })
    }

    /// Takes the values of a frame for something else.
    pub(super) fn misread_frame(&mut self) {
        if self.breaks(Rule::BandsSwapped) {
            self.scratch.iter_mut().for_each(|codes| codes.reverse());
        }
        if self.breaks(Rule::ChannelsReversed) {
            self.scratch.reverse();
        }
        if self.breaks(Rule::BigEndian) {
            let codes = self.scratch.iter_mut().flatten();
            codes.for_each(|code| *code = code.swap_bytes());
        }
    }

    /// Whether the ACK of a packet is left out.
    pub(super) fn withholds(&self, kind: u8, code: AckCode) -> bool {
        let rule = match (kind, code) {
            (kind::ARM, _) => Rule::ArmWithoutAck,
            (kind::STOP, _) => Rule::StopWithoutAck,
            (kind::CLEAR, _) => Rule::ClearWithoutAck,
            (kind::IDENT, _) => Rule::IdentWithoutAck,
            (kind::CONFIG, _) => Rule::ConfigRefusalSilent,
            (kind::FRAME, _) => Rule::FrameRefusalSilent,
            _ => Rule::UnknownSilent,
        };
        self.breaks(rule)
    }
}

/// Bytes of a request's payload; `None` for what is none.
fn table_len(kind: u8, n_channels: usize) -> Option<usize> {
    Some(match kind {
        kind::HELLO => 16,
        kind::CONFIG => 16 + 4 * n_channels.div_ceil(32).max(1),
        kind::ARM | kind::SAMPLES => 8,
        kind::FRAME => frame::payload_len(n_channels),
        kind::STOP | kind::CLEAR => 2,
        kind::PING => 4,
        kind::IDENT => 6,
        _ => return None,
    })
}
