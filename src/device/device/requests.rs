//! What a device does with each packet. Every refusal has its ACK code; nothing here panics on any
//! bytes.

use super::lie::caps_packet;
use super::output::{IdentDrive, allow};
use super::{DeviceCore, DeviceSink, MS_US, Session};
use crate::fields::wrapped_u32;
use crate::framing::Received;
use crate::message::{
    ARM_KEY, Ack, AckCode, Arm, Caps, Clear, Config, DeviceState, Hello, Ident, MAGIC,
    Message as _, NEXT_TICK, Ping, Pong, Stop, StopHow, VERSION, frame, kind,
};

const DEFAULT_LEASE_MS: u16 = 1000;
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
        let answer = match self.answer(packet, sink) {
            Answer::Bad => return false,
            Answer::Ack(code) => Some(code),
            Answer::Silence => None,
        };
        if let Some(session) = &mut self.session {
            session.last_valid_us = self.now_us;
        }
        if let Some(code) = answer {
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

    fn answer(&mut self, packet: Received<'_>, sink: &mut impl DeviceSink) -> Answer {
        let payload = packet.payload;
        let decoded = match packet.kind {
            kind::FIRST_DEVICE.. => None,
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
            _ => Some(Answer::Ack(AckCode::UnknownType)),
        };
        decoded.unwrap_or(Answer::Bad)
    }

    /// A new session from any state; a HELLO that is not one of ours (`None`) changes nothing.
    fn hello(&mut self, payload: &[u8], sink: &mut impl DeviceSink) -> Option<Answer> {
        let hello = Hello::decode(payload)?;
        if hello.magic != MAGIC || hello.session == 0 {
            return None;
        }
        let common = (hello.ver_min..=hello.ver_max).contains(&VERSION);
        let faulted = self.state == DeviceState::Fault;
        self.session = None;
        self.last_frame_us = None;
        self.silence(match (faulted, common) {
            (true, _) => DeviceState::Fault,
            (false, true) => DeviceState::Ready,
            (false, false) => DeviceState::Idle,
        });
        if common {
            let lease_ms = if hello.lease_ms == 0 {
                DEFAULT_LEASE_MS
            } else {
                hello.lease_ms
            };
            self.session = Some(Session {
                id: hello.session,
                wants_status: hello.host_flags & Hello::WANT_STATUS != 0,
                wants_log: hello.host_flags & Hello::WANT_LOG != 0,
                lease_us: u64::from(lease_ms) * MS_US,
                last_valid_us: self.now_us,
                last_seq: None,
                configured: false,
            });
        }
        let caps = self
            .model
            .caps(hello.session, if common { VERSION } else { 0 });
        let caps = caps_packet(caps, &self.model.lies, self.next_seq);
        self.send_packet(caps.as_ref(), sink);
        Some(Answer::Silence)
    }

    fn configure(&mut self, wish: &Config, sink: &mut impl DeviceSink) -> Answer {
        match self.state {
            DeviceState::Ready => {}
            DeviceState::Fault => return Answer::Ack(AckCode::Faulted),
            _ => return Answer::Ack(AckCode::WrongState),
        }
        self.config = self.model.clamp(wish);
        self.output.is_interpolated = self.config.flags & Config::INTERPOLATE != 0;
        if let Some(session) = &mut self.session {
            session.configured = true;
        }
        let reply = self.config.reply(self.next_seq, self.model.n_channels());
        self.send_packet(reply.as_ref(), sink);
        Answer::Silence
    }

    fn arm(&mut self, arm: Arm) -> AckCode {
        match self.state {
            DeviceState::Fault => return AckCode::Faulted,
            DeviceState::Ready | DeviceState::Armed => {}
            _ => return AckCode::WrongState,
        }
        let Some(session) = self.session.as_ref().filter(|session| session.configured) else {
            return AckCode::WrongState;
        };
        if arm.session != session.id || arm.key != session.id ^ ARM_KEY {
            return AckCode::BadSession;
        }
        if self.state == DeviceState::Ready {
            self.silence(DeviceState::Armed);
        }
        AckCode::Ok
    }

    /// An accepted FRAME has no ACK: STATUS names the last one.
    fn frame(&mut self, seq: u16, payload: &[u8]) -> Answer {
        if payload.len() < frame::payload_len(self.model.n_channels()) {
            return Answer::Bad;
        }
        let Some(apply_tick) = frame::decode_into(payload, &mut self.scratch) else {
            return Answer::Ack(AckCode::OutOfRange);
        };
        if self.state == DeviceState::Fault {
            return Answer::Ack(AckCode::Faulted);
        }
        let live = self.state.is_live() && self.descent.is_none();
        let Some(session) = self.session.as_mut().filter(|_| live) else {
            return Answer::Ack(AckCode::WrongState);
        };
        if session.last_seq == Some(seq) {
            self.counters.dup = self.counters.dup.wrapping_add(1);
            return Answer::Silence;
        }
        let present = wrapped_u32(self.now_us / super::TICK);
        let next = present.wrapping_add(1);
        let ahead = apply_tick.wrapping_sub(present).cast_signed();
        let late = apply_tick != NEXT_TICK && ahead <= 0;
        let tick = if late || apply_tick == NEXT_TICK {
            next
        } else {
            apply_tick
        };
        if tick.wrapping_sub(next) >= u32::from(self.model.queue) {
            return Answer::Ack(AckCode::QueueFull);
        }
        session.last_seq = Some(seq);
        self.accept_frame(seq, tick, late);
        Answer::Silence
    }

    fn accept_frame(&mut self, seq: u16, tick: u32, late: bool) {
        self.counters.late = self.counters.late.wrapping_add(u16::from(late));
        if let Some(slot) = self.queue.slot(tick, seq) {
            slot.received.copy_from_slice(&self.scratch);
            let clipped = allow(&slot.received, &self.config, &mut slot.allowed);
            self.counters.clipped = self.counters.clipped.wrapping_add(clipped);
        }
        self.output.ident = None;
        self.last_frame_us = Some(self.now_us);
        if matches!(self.state, DeviceState::Armed | DeviceState::Ramp) {
            self.state = DeviceState::Run;
        }
    }

    /// Disarms at once; a ramp only where there is output to ramp.
    fn stop(&mut self, stop: Stop) -> AckCode {
        self.queue.clear();
        let after = self.descent.unwrap_or(DeviceState::Ready);
        match self.state {
            DeviceState::Idle | DeviceState::Fault => {}
            DeviceState::Run | DeviceState::Hold | DeviceState::Ramp
                if stop.how == StopHow::Ramp =>
            {
                self.descent = Some(after);
                self.state = DeviceState::Ramp;
            }
            _ => self.silence(after),
        }
        AckCode::Ok
    }

    fn clear(&mut self, clear: Clear) -> AckCode {
        if self.fault_causes & self.faults & clear.bits != 0 {
            return AckCode::Faulted;
        }
        self.faults &= !clear.bits;
        if self.state == DeviceState::Fault && self.faults == 0 {
            let session = self.session.is_some();
            self.silence(if session {
                DeviceState::Ready
            } else {
                DeviceState::Idle
            });
        }
        AckCode::Ok
    }

    fn ident(&mut self, ident: Ident) -> AckCode {
        if self.model.modes & Caps::MODE_IDENT == 0 {
            return AckCode::UnknownType;
        }
        if self.state != DeviceState::Armed {
            return AckCode::WrongState;
        }
        let channel = usize::from(ident.channel);
        if channel >= self.model.n_channels() || ident.ms > LONGEST_IDENT_MS {
            return AckCode::OutOfRange;
        }
        let sounds = self.config.mask.contains(channel);
        self.output.ident = Some(IdentDrive {
            channel,
            amp: if sounds {
                ident.amp.min(self.config.comp_limit[1])
            } else {
                0
            },
            until_us: self.now_us + u64::from(ident.ms) * MS_US,
        });
        AckCode::Ok
    }

    fn pong(&mut self, ping: Ping, sink: &mut impl DeviceSink) -> Answer {
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
