//! FRAME: whether it is taken, for which tick, and what is kept of it.

use super::lie::{self, Rule};
use super::output::allow;
use super::requests::Answer;
use super::{DeviceCore, TICK};
use crate::fields::wrapped_u32;
use crate::message::{AckCode, DeviceState, NEXT_TICK, frame};

impl DeviceCore {
    /// An accepted FRAME has no ACK: STATUS names the last one.
    pub(super) fn frame(&mut self, seq: u16, payload: &[u8]) -> Answer {
        if payload.len() < frame::payload_len(self.model.n_channels()) {
            return Answer::Bad;
        }
        let Some(apply_tick) = frame::decode_into(payload, &mut self.scratch) else {
            return Answer::Ack(AckCode::OutOfRange);
        };
        self.misread_frame();
        if self.state == DeviceState::Fault {
            return Answer::Ack(AckCode::Faulted);
        }
        let Some(session) = self.session.as_ref().filter(|_| self.takes_frames()) else {
            return Answer::Ack(AckCode::WrongState);
        };
        if session.last_seq == Some(seq) && !self.breaks(Rule::DupApplied) {
            return self.repeated_frame();
        }
        let present = wrapped_u32(self.now_us / TICK);
        let next = present.wrapping_add(1);
        let ahead = apply_tick.wrapping_sub(present).cast_signed();
        let late = apply_tick != NEXT_TICK && ahead <= 0;
        let tick = if late || apply_tick == NEXT_TICK {
            next
        } else {
            apply_tick
        };
        let is_full = tick.wrapping_sub(next) >= self.n_ticks_ahead()
            || late && self.breaks(Rule::LateRefused)
            || apply_tick == NEXT_TICK && self.breaks(Rule::NextRefused);
        let is_named = if is_full {
            self.breaks(Rule::LastSeqRefused)
        } else {
            !late || !self.breaks(Rule::LastSeqNotLate)
        };
        if let Some(session) = self.session.as_mut().filter(|_| is_named) {
            session.last_seq = Some(seq);
        }
        if is_full {
            return Answer::Ack(AckCode::QueueFull);
        }
        self.accept_frame(seq, tick, late);
        Answer::Silence
    }

    /// Whether the state is one in which frames are played.
    fn takes_frames(&self) -> bool {
        let in_ready = self.state == DeviceState::Ready && self.breaks(Rule::FrameWithoutArm);
        let in_ramp = self.state == DeviceState::Ramp && self.breaks(Rule::RampRefusesFrames);
        let is_stopped = self.descent.is_some() && !self.breaks(Rule::StopTurnedBack);
        in_ready || self.state.is_live() && !is_stopped && !in_ramp
    }

    /// How many ticks ahead a frame may be, this one not counted.
    fn n_ticks_ahead(&self) -> u32 {
        let by = |rule| u32::try_from(self.broken_by(rule).unwrap_or(0)).unwrap_or(0);
        let more = u32::from(self.model.queue).saturating_add(by(Rule::QueueDeep));
        more.saturating_sub(by(Rule::QueueShallow))
    }

    /// A FRAME with the seq of the last accepted one.
    fn repeated_frame(&mut self) -> Answer {
        self.counters.dup = self.counters.dup.wrapping_add(1);
        if self.breaks(Rule::DupRenewsAge) {
            self.last_frame_us = Some(self.now_us);
        }
        if self.breaks(Rule::DupRefused) {
            return Answer::Ack(AckCode::WrongState);
        }
        Answer::Silence
    }

    fn accept_frame(&mut self, seq: u16, tick: u32, late: bool) {
        self.counters.late = self.counters.late.wrapping_add(u16::from(late));
        if self.state == DeviceState::Ready {
            self.become_armed();
        }
        self.store_frame(seq, tick, late);
        if !self.breaks(Rule::IdentOutlastsFrame) {
            self.output.ident = None;
        }
        self.last_frame_us = Some(if self.breaks(Rule::AgeFromApply) {
            let n_ticks = tick.wrapping_sub(self.tick());
            (self.now_us / TICK + u64::from(n_ticks)) * TICK
        } else {
            self.now_us
        });
        self.descent = None;
        if self.state == DeviceState::Ramp && self.breaks(Rule::GainJumps) {
            self.output.fill_gain();
        }
        if matches!(self.state, DeviceState::Armed | DeviceState::Ramp) {
            self.state = DeviceState::Run;
        }
    }

    /// Keeps what was received, and what is allowed of it, for its tick.
    fn store_frame(&mut self, seq: u16, tick: u32, late: bool) {
        let tick = if self.breaks(Rule::FramesEarly) {
            self.tick().wrapping_add(1)
        } else {
            tick.wrapping_add(u32::from(self.breaks(Rule::FramesDelayed)))
        };
        let is_first = !self.queue.holds(tick);
        if late && self.breaks(Rule::LateDropped) || !is_first && self.breaks(Rule::FirstWriterWins)
        {
            return;
        }
        let at_tick = self.breaks(Rule::ClippedAtTick);
        let in_order = self.breaks(Rule::QueueOrder);
        let (lies, now) = (&self.model.lies, wrapped_u32(self.now_us / TICK));
        let breaks = |rule| lie::value(lies, now, rule).is_some();
        if let Some(slot) = self.queue.slot(tick, seq) {
            slot.received.copy_from_slice(&self.scratch);
            let clipped = allow(&slot.received, &self.config, breaks, &mut slot.allowed);
            if at_tick {
                slot.clipped = clipped;
            } else {
                self.counters.clipped = self.counters.clipped.wrapping_add(clipped);
            }
        }
        if in_order {
            self.queue.order_by_seq();
        }
    }
}
