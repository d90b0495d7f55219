//! HELLO: a session ends, another begins.

use super::lie::Rule;
use super::requests::Answer;
use super::{CoreCounters, DeviceCore, DeviceSink, MS_US, Session};
use crate::message::{DeviceState, Hello, MAGIC, Message as _, VERSION};

const DEFAULT_LEASE_MS: u16 = 1000;

impl DeviceCore {
    /// A new session from any state; a HELLO that is not one of ours (`None`) changes nothing.
    pub(super) fn hello(&mut self, payload: &[u8], sink: &mut impl DeviceSink) -> Option<Answer> {
        let hello = Hello::decode(payload)?;
        let is_ours = hello.magic == MAGIC || self.breaks(Rule::AnyMagic);
        if !is_ours || hello.session == 0 && !self.breaks(Rule::SessionZero) {
            return None;
        }
        let ignores = match self.state {
            DeviceState::Fault => self.breaks(Rule::FaultBlocksHello),
            state => state.is_live() && self.breaks(Rule::HelloIgnoredLive),
        };
        if ignores {
            return Some(Answer::Silence);
        }
        let offered = (hello.ver_min..=hello.ver_max).contains(&VERSION);
        let common = offered || self.breaks(Rule::VersionAny);
        if common || !self.breaks(Rule::VersionKeepsSession) {
            self.begin_session(&hello, common);
        }
        let caps = self
            .model
            .caps(hello.session, if common { VERSION } else { 0 });
        self.send(&caps, sink);
        Some(Answer::Silence)
    }

    /// Ends what was and, if there is a common version, begins what comes.
    fn begin_session(&mut self, hello: &Hello, common: bool) {
        let (configured, last_seq) = self.kept_through_hello();
        let armed = self.breaks(Rule::ArmedByHello)
            || self.session.is_none()
                && self.state == DeviceState::Armed
                && self.breaks(Rule::ArmedAtStart);
        let goes_on = self.state.is_live() && self.breaks(Rule::HelloKeepsOutput);
        let faulted = self.state == DeviceState::Fault;
        self.session = None;
        if !goes_on {
            let queue = self
                .breaks(Rule::HelloKeepsQueue)
                .then(|| self.queue.clone());
            self.last_frame_us = None;
            self.silence(match (faulted, common) {
                (true, _) => DeviceState::Fault,
                (false, true) if armed => DeviceState::Armed,
                (false, true) => DeviceState::Ready,
                (false, false) => DeviceState::Idle,
            });
            if let Some(queue) = queue {
                self.queue = queue;
            }
        }
        if common {
            self.session = Some(Session {
                id: hello.session,
                wants_status: hello.host_flags & Hello::WANT_STATUS != 0,
                wants_log: hello.host_flags & Hello::WANT_LOG != 0,
                lease_us: self.lease_us(hello.lease_ms),
                last_valid_us: self.now_us,
                last_seq,
                configured,
            });
        }
    }

    /// Whether there is a CONFIG, and the seq of the last frame, in a new session; what else a
    /// HELLO does to a device that lies.
    fn kept_through_hello(&mut self) -> (bool, Option<u16>) {
        let last_seq = self.last_seq();
        let was_configured = self.session.as_ref().is_some_and(|it| it.configured);
        if self.breaks(Rule::HelloResetsCounters) {
            self.counters = CoreCounters::default();
        }
        if self.breaks(Rule::HelloResetsClock) {
            self.lie_memory.first_tick = self.tick();
        }
        if self.breaks(Rule::HelloClearsFault) && self.state == DeviceState::Fault {
            self.faults = 0;
            self.silence(DeviceState::Ready);
        }
        let keeps_config = self.breaks(Rule::HelloKeepsConfig);
        let keeps_seq = self.breaks(Rule::HelloKeepsSeq);
        (
            was_configured && keeps_config,
            last_seq.filter(|_| keeps_seq),
        )
    }

    /// How long a session lasts without a packet, µs.
    fn lease_us(&self, asked_ms: u16) -> u64 {
        let is_usual = asked_ms == 0 && !self.breaks(Rule::LeaseZero);
        let lease_ms = if is_usual || self.breaks(Rule::LeaseFixed) {
            DEFAULT_LEASE_MS
        } else {
            asked_ms
        };
        let later_ms = self.broken_by(Rule::LeaseLonger).unwrap_or(0);
        let earlier_ms = self.broken_by(Rule::LeaseShorter).unwrap_or(0);
        (u64::from(lease_ms) + later_ms).saturating_sub(earlier_ms) * MS_US
    }
}
