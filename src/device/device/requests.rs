//! What a device does with each packet. Every refusal has its ACK code; nothing here panics on any
//! bytes.

use super::lie::{self, Rule};
use super::output::IdentDrive;
use super::{DeviceCore, DeviceSink, MS_US};
use crate::fields::wrapped_u32;
use crate::framing::Received;
use crate::message::{
    ARM_KEY, Ack, AckCode, Arm, Caps, Clear, Config, DeviceState, Ident, Message as _, Ping, Pong,
    Stop, StopHow, fault_bit, kind,
};

const LONGEST_IDENT_MS: u16 = 1000;
/// Bytes of a SAMPLES payload before its samples.
const SAMPLES_HEAD_LEN: usize = 8;

/// What a packet leads to, beside its effect.
pub(super) enum Answer {
    /// Not a valid packet.
    Bad,
    /// Valid; the reply, if there is one, is not an ACK.
    Silence,
    Ack(AckCode),
}

impl DeviceCore {
    /// Acts on one packet. False: it is not a valid packet, so it counts as `bad` and does not
    /// renew the lease.
    pub(super) fn handle(&mut self, packet: Received<'_>, sink: &mut impl DeviceSink) -> bool {
        let repeats = self.last_seq() == Some(packet.seq);
        if repeats && self.breaks(Rule::DupAnyType) {
            return true;
        }
        let answer = match self.answer(packet, sink) {
            Answer::Bad
                if packet.kind < kind::FIRST_DEVICE && self.breaks(Rule::ShortRenewsLease) =>
            {
                self.renew_lease();
                return false;
            }
            Answer::Bad => return false,
            Answer::Ack(code) => Some(code),
            Answer::Silence if packet.kind == kind::FRAME && self.breaks(Rule::FrameAcked) => {
                Some(AckCode::Ok)
            }
            Answer::Silence => None,
        };
        let not_renewed = match packet.kind {
            kind::PING => self.breaks(Rule::PingNoRenewal),
            kind::FRAME => repeats && self.breaks(Rule::DupNotLease),
            _ => false,
        };
        if !not_renewed {
            self.renew_lease();
        }
        if let Some(code) = answer.filter(|code| !self.withholds(packet.kind, *code)) {
            self.send(
                &Ack {
                    kind: packet.kind,
                    code,
                    seq: packet.seq,
                },
                sink,
            );
        }
        true
    }

    /// A valid packet came.
    pub(super) fn renew_lease(&mut self) {
        if let Some(session) = &mut self.session {
            session.last_valid_us = self.now_us;
        }
    }

    /// The seq of the last accepted FRAME of this session.
    pub(super) fn last_seq(&self) -> Option<u16> {
        self.session.as_ref().and_then(|session| session.last_seq)
    }

    fn answer(&mut self, packet: Received<'_>, sink: &mut impl DeviceSink) -> Answer {
        if let Some(answer) = self.lie_about_length(packet.kind, packet.payload) {
            return answer;
        }
        let other = self.payload_of_any_length(packet.kind, packet.payload);
        let payload = other.as_deref().unwrap_or(packet.payload);
        let decoded = match packet.kind {
            kind::FIRST_DEVICE.. if !self.breaks(Rule::AnswersDeviceTypes) => None,
            kind::HELLO => self.hello(payload, sink),
            kind::CONFIG => Config::decode(payload, self.model.n_channels())
                .map(|wish| self.configure(&wish, sink)),
            kind::ARM => Arm::decode(payload).map(|arm| Answer::Ack(self.arm(arm))),
            kind::FRAME => Some(self.frame(packet.seq, payload)),
            kind::STOP => Stop::decode(payload).map(|stop| Answer::Ack(self.stop(stop))),
            kind::PING => Ping::decode(payload).map(|ping| self.pong(ping, sink)),
            kind::CLEAR => Clear::decode(payload).map(|clear| Answer::Ack(self.clear(clear))),
            kind::SAMPLES if payload.len() < SAMPLES_HEAD_LEN => None,
            kind::IDENT => Ident::decode(payload).map(|ident| Answer::Ack(self.ident(ident))),
            kind::SAMPLES if self.breaks(Rule::SamplesAccepted) => Some(Answer::Ack(AckCode::Ok)),
            _ => self.unknown(sink),
        };
        decoded.unwrap_or(Answer::Bad)
    }

    fn unknown(&mut self, sink: &mut impl DeviceSink) -> Option<Answer> {
        if self.breaks(Rule::UnknownFaults) {
            self.raise_fault(fault_bit::SELF_TEST, u16::MAX, 0, sink);
            self.end_fault_cause(fault_bit::SELF_TEST);
        }
        let is_bad = self.breaks(Rule::UnknownBad);
        (!is_bad).then_some(Answer::Ack(AckCode::UnknownType))
    }

    fn configure(&mut self, wish: &Config, sink: &mut impl DeviceSink) -> Answer {
        let (refusal, takes) = match self.state {
            DeviceState::Ready => (AckCode::WrongState, !self.breaks(Rule::ConfigRefused)),
            DeviceState::Fault => (AckCode::Faulted, self.breaks(Rule::ConfigFault)),
            DeviceState::Idle => (AckCode::WrongState, self.breaks(Rule::ConfigIdle)),
            _ => (AckCode::WrongState, self.breaks(Rule::ConfigLive)),
        };
        let breaks = |rule| self.breaks(rule);
        let granted = lie::granted(breaks, wish, self.model.clamp(wish));
        if takes || self.breaks(Rule::RefusedConfigHolds) {
            self.keep_config(&granted);
        }
        if !takes {
            return Answer::Ack(refusal);
        }
        let reply = granted.reply(self.next_seq, self.model.n_channels());
        self.send_packet(reply.as_ref(), sink);
        if self.breaks(Rule::ArmedByConfig) && self.state == DeviceState::Ready {
            self.become_armed();
        }
        Answer::Silence
    }

    /// These settings hold from now on.
    fn keep_config(&mut self, granted: &Config) {
        let had_one = self.session.as_ref().is_some_and(|it| it.configured);
        if had_one && self.breaks(Rule::ConfigIgnored) {
            return;
        }
        let value = |rule| self.broken_by(rule);
        self.config = lie::in_effect(value, granted, self.model.n_channels());
        self.output.is_interpolated =
            self.config.flags & Config::INTERPOLATE != 0 || self.breaks(Rule::InterpolatesUnasked);
        if let Some(session) = &mut self.session {
            session.configured = true;
        }
    }

    fn arm(&mut self, arm: Arm) -> AckCode {
        match self.state {
            DeviceState::Fault if self.breaks(Rule::ArmFault) => {}
            DeviceState::Fault => return AckCode::Faulted,
            DeviceState::Armed if self.breaks(Rule::ArmRepeatRefused) => {
                return AckCode::WrongState;
            }
            DeviceState::Ready | DeviceState::Armed => {}
            DeviceState::Idle if self.breaks(Rule::ArmIdle) => {
                self.become_armed();
                return AckCode::Ok;
            }
            state if state.is_live() && self.breaks(Rule::ArmWhileRunning) => return AckCode::Ok,
            _ => return AckCode::WrongState,
        }
        let needs_config = !self.breaks(Rule::ArmWithoutConfig);
        let session = self.session.as_ref();
        let Some(session) = session.filter(|session| session.configured || !needs_config) else {
            return AckCode::WrongState;
        };
        let id = if self.breaks(Rule::AnySession) {
            arm.session
        } else {
            session.id
        };
        let is_key = arm.key == id ^ ARM_KEY || self.breaks(Rule::AnyKey);
        if arm.session != id || !is_key {
            return AckCode::BadSession;
        }
        if self.state != DeviceState::Armed && !self.breaks(Rule::ArmIgnored) {
            self.become_armed();
        }
        AckCode::Ok
    }

    pub(super) fn become_armed(&mut self) {
        self.silence(DeviceState::Armed);
        self.lie_memory.armed_us = Some(self.now_us);
    }

    /// Disarms at once; a ramp only where there is output to ramp.
    fn stop(&mut self, stop: Stop) -> AckCode {
        if self.breaks(Rule::IgnoreStop) {
            return AckCode::Ok;
        }
        let is_idle = self.state == DeviceState::Idle;
        if self.breaks(Rule::StopRefused) || is_idle && self.breaks(Rule::StopIdleRefused) {
            return AckCode::WrongState;
        }
        if !self.breaks(Rule::StopKeepsQueue) {
            self.queue.clear();
        }
        let after = self.descent.unwrap_or_else(|| self.after_stop());
        let ramps = match stop.how {
            StopHow::Ramp => !self.breaks(Rule::StopRampAtOnce),
            StopHow::Now => self.breaks(Rule::StopNowRamps),
        };
        match self.state {
            DeviceState::Idle if !self.breaks(Rule::StopWakesIdle) => {}
            DeviceState::Fault if !self.breaks(Rule::StopLeavesFault) => {}
            DeviceState::Run | DeviceState::Hold | DeviceState::Ramp if ramps => {
                if self.breaks(Rule::StopRampRestarts) {
                    self.output.fill_gain();
                }
                self.descent = Some(after);
                self.state = DeviceState::Ramp;
            }
            _ => self.silence(after),
        }
        AckCode::Ok
    }

    /// Where STOP leads to.
    fn after_stop(&self) -> DeviceState {
        if self.breaks(Rule::StopKeepsArmed) {
            DeviceState::Armed
        } else if self.breaks(Rule::StopEndsSession) {
            DeviceState::Idle
        } else {
            DeviceState::Ready
        }
    }

    fn clear(&mut self, clear: Clear) -> AckCode {
        let bits = if self.breaks(Rule::ClearAny) {
            u16::MAX
        } else {
            clear.bits
        };
        let persists = self.fault_causes & self.faults & bits != 0;
        if persists && !self.breaks(Rule::ClearClearsCause)
            || self.faults & bits != 0 && self.breaks(Rule::ClearRefused)
        {
            return AckCode::Faulted;
        }
        self.faults &= !bits;
        if self.state == DeviceState::Fault && self.faults == 0 && !self.breaks(Rule::ClearStays) {
            self.silence(self.after_faults());
        }
        AckCode::Ok
    }

    /// Where a device goes when its faults are cleared.
    pub(super) fn after_faults(&self) -> DeviceState {
        if self.session.is_some() && !self.breaks(Rule::ClearEndsSession) {
            DeviceState::Ready
        } else {
            DeviceState::Idle
        }
    }

    fn ident(&mut self, ident: Ident) -> AckCode {
        if self.model.modes & Caps::MODE_IDENT == 0 || self.breaks(Rule::IdentUnknown) {
            return AckCode::UnknownType;
        }
        let anywhere = self.session.is_some() && self.breaks(Rule::IdentAnywhere);
        if self.state != DeviceState::Armed && !anywhere {
            return AckCode::WrongState;
        }
        let channel = usize::from(ident.channel);
        let is_there = channel < self.model.n_channels() || self.breaks(Rule::IdentBadChannel);
        if !is_there || ident.ms > LONGEST_IDENT_MS && !self.breaks(Rule::IdentTooLong) {
            return AckCode::OutOfRange;
        }
        let sounds = self.config.mask.contains(channel);
        let limit = if self.breaks(Rule::IdentOverLimit) {
            u16::MAX
        } else {
            self.config.comp_limit[1]
        };
        let longer_ms = self.broken_by(Rule::IdentLonger).unwrap_or(0);
        self.output.ident = Some(IdentDrive {
            channel,
            amp: if sounds { ident.amp.min(limit) } else { 0 },
            until_us: self.now_us + (u64::from(ident.ms) + longer_ms) * MS_US,
            band: usize::from(!self.breaks(Rule::IdentLow)),
        });
        AckCode::Ok
    }

    fn pong(&mut self, ping: Ping, sink: &mut impl DeviceSink) -> Answer {
        let is_idle = self.session.is_none();
        if self.breaks(Rule::NoPong) || is_idle && self.breaks(Rule::PingSilentIdle) {
            return Answer::Silence;
        }
        let pong = Pong {
            token: ping.token,
            dev_us: wrapped_u32(self.now_us),
            tick: self.tick(),
            phase_us: u16::try_from(self.now_us % super::TICK).unwrap_or(0),
        };
        self.send(&pong, sink);
        Answer::Silence
    }
}
