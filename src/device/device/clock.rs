//! What time does to a device: the 1 ms safety clock (lease, hold, ramp) and the 25 ms tick
//! (frames, slew, STATUS).

use super::lie::{self, Rule};
use super::output::TICK;
use super::{DeviceCore, DeviceSink, MS_US};
use crate::device::sink::AppliedFrame;
use crate::message::{DeviceState, Status, fault_bit};

impl DeviceCore {
    /// One step of the safety clock.
    pub(super) fn step_ms(&mut self, sink: &mut impl DeviceSink) {
        self.lie_for_a_ms(sink);
        self.check_lease(sink);
        if self
            .output
            .ident
            .is_some_and(|ident| self.now_us >= ident.until_us)
        {
            self.output.ident = None;
        }
        if self.state.is_live() {
            self.step_gain(sink);
        }
        // Without a session nobody is told, and the next one is told at once.
        let is_heard = self.session.is_some() || self.breaks(Rule::FaultOutsideSession);
        let is_due = is_heard && self.now_us >= self.next_fault_us;
        if self.state == DeviceState::Fault && is_due && !self.breaks(Rule::FaultToldOnce) {
            self.send_fault(sink);
        }
        self.report_change(sink);
    }

    fn step_gain(&mut self, sink: &mut impl DeviceSink) {
        let hold_us = u64::from(self.config.hold_ms) * MS_US;
        let is_at_once = self.config.ramp_ms == 0;
        let never = self.breaks(Rule::NoRamp) || is_at_once && self.breaks(Rule::RampZeroNever);
        let silent = self.age_us().is_some_and(|age_us| age_us > hold_us) && !never;
        let steps = match self.breaks(Rule::TickClock) {
            true if !self.now_us.is_multiple_of(TICK) => return,
            true => TICK / MS_US,
            false => 1,
        };
        if silent || self.descent.is_some() {
            if self.state != DeviceState::Ramp {
                self.say("the host fell silent: output ramps down", sink);
            }
            self.state = DeviceState::Ramp;
            if (0..steps).any(|_| self.output.fall(is_at_once)) {
                self.silence(self.descent.unwrap_or_else(|| self.after_ramp()));
            }
        } else if !self.output.is_gain_full() && !self.breaks(Rule::GainStays) {
            self.output.rise();
        }
    }

    /// Where the ramp of a host that fell silent ends.
    fn after_ramp(&self) -> DeviceState {
        if self.breaks(Rule::RampEndsIdle) {
            DeviceState::Idle
        } else if self.breaks(Rule::RearmsItself) {
            DeviceState::Armed
        } else {
            DeviceState::Ready
        }
    }

    /// No valid packet for the lease: running output ramps down first, then the session ends.
    fn check_lease(&mut self, sink: &mut impl DeviceSink) {
        let Some(session) = &self.session else { return };
        let is_over = self.now_us - session.last_valid_us > session.lease_us;
        if !is_over || self.breaks(Rule::NoLease) {
            return;
        }
        let end = if self.breaks(Rule::LeaseEndsReady) {
            DeviceState::Ready
        } else {
            DeviceState::Idle
        };
        match self.state {
            _ if self.breaks(Rule::LeaseFaults) => {
                self.raise_fault(fault_bit::LEASE_LOST, u16::MAX, 0, sink);
                self.end_fault_cause(fault_bit::LEASE_LOST);
                self.session = None;
            }
            _ if self.breaks(Rule::LeaseNoRamp) => self.silence(end),
            DeviceState::Run | DeviceState::Hold | DeviceState::Ramp => {
                if self.descent != Some(end) {
                    self.say("no sign of the host for its lease: the session ends", sink);
                }
                self.descent = Some(end);
                self.queue.clear();
            }
            DeviceState::Fault => self.session = None,
            _ => self.silence(end),
        }
    }

    /// Zero output, empty queue, disarmed, high voltage off, and on to `state`.
    pub(super) fn silence(&mut self, state: DeviceState) {
        self.output.reset(self.config.ramp_ms);
        if !self.breaks(Rule::StopKeepsQueue) {
            self.queue.clear();
        }
        self.descent = None;
        self.state = state;
        match state {
            DeviceState::Idle if self.breaks(Rule::LeaseKeepsStatus) => {}
            DeviceState::Idle => self.session = None,
            // No frame since ARM: the age must not start a ramp.
            DeviceState::Armed => self.last_frame_us = None,
            _ => {}
        }
    }

    /// The start of a tick: its frame takes effect, then STATUS tells.
    pub(super) fn step_tick(&mut self, sink: &mut impl DeviceSink) {
        self.output.settle();
        let early = self.breaks(Rule::StatusBeforeFrame).then(|| self.status());
        if self.state.is_live() && self.descent.is_none() {
            self.apply_frame(sink);
        }
        self.check_current(sink);
        self.report_change(sink);
        self.lie_for_a_tick(sink);
        let wants_status = self.session.as_ref().map(|session| session.wants_status);
        if wants_status.is_some_and(|wants| wants || self.breaks(Rule::StatusUnasked)) {
            self.tell_status(early.unwrap_or_else(|| self.status()), sink);
        }
    }

    fn tell_status(&mut self, status: Status, sink: &mut impl DeviceSink) {
        let (lies, tick) = (&self.model.lies, self.tick());
        if lies.is_empty() {
            self.send(&status, sink);
            return;
        }
        let value = |rule| lie::value(lies, tick, rule);
        for status in self.lie_memory.statuses(value, self.now_us, status) {
            self.send(&status, sink);
        }
    }

    fn apply_frame(&mut self, sink: &mut impl DeviceSink) {
        let tick = self.tick();
        let applied = if let Some(frame) = self.queue.take(tick) {
            self.output.set_target(&frame.allowed);
            self.counters.clipped = self.counters.clipped.wrapping_add(frame.clipped);
            self.scratch.copy_from_slice(&frame.received);
            Some(frame.seq)
        } else {
            None
        };
        match (applied, self.state) {
            (Some(_), DeviceState::Hold) if !self.breaks(Rule::HoldStays) => {
                self.state = DeviceState::Run;
            }
            (None, _) if self.last_frame_us.is_some() || self.breaks(Rule::UnderrunFromArm) => {
                self.counters.underrun = self.counters.underrun.wrapping_add(1);
                if self.state == DeviceState::Run && !self.breaks(Rule::NoHoldState) {
                    self.state = DeviceState::Hold;
                }
            }
            _ => {}
        }
        // A ramp without a new frame only falls: slewing upwards meanwhile would fight it.
        let moves = self.state != DeviceState::Ramp && !self.breaks(Rule::SlewOnlyFrames);
        if applied.is_none() && self.breaks(Rule::HoldMutes) {
            self.output
                .set_target(&vec![[0; 2]; self.model.n_channels()]);
            self.output.slew(u16::MAX);
        } else if applied.is_some() || moves {
            self.output.slew(self.config.slew);
        }
        if let Some(seq) = applied {
            let moment = self.moment();
            sink.applied(&AppliedFrame {
                moment,
                seq,
                codes: &self.scratch,
            });
        }
    }
}
