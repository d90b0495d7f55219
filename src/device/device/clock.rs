//! What time does to a device: the 1 ms safety clock (lease, hold, ramp) and the 25 ms tick
//! (frames, slew, STATUS).

use super::{DeviceCore, DeviceSink, MS_US};
use crate::device::sink::AppliedFrame;
use crate::message::DeviceState;

impl DeviceCore {
    /// One step of the safety clock.
    pub(super) fn step_ms(&mut self, sink: &mut impl DeviceSink) {
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
        let is_due = self.session.is_some() && self.now_us >= self.next_fault_us;
        if self.state == DeviceState::Fault && is_due {
            self.send_fault(sink);
        }
        self.report_change(sink);
    }

    fn step_gain(&mut self, sink: &mut impl DeviceSink) {
        let hold_us = u64::from(self.config.hold_ms) * MS_US;
        let silent = self.age_us().is_some_and(|age_us| age_us > hold_us);
        if silent || self.descent.is_some() {
            if self.state != DeviceState::Ramp {
                self.say("the host fell silent: output ramps down", sink);
            }
            self.state = DeviceState::Ramp;
            if self.output.fall(self.config.ramp_ms == 0) {
                self.silence(self.descent.unwrap_or(DeviceState::Ready));
            }
        } else if !self.output.is_gain_full() {
            self.output.rise();
        }
    }

    /// No valid packet for the lease: running output ramps down first, then the session ends.
    fn check_lease(&mut self, sink: &mut impl DeviceSink) {
        let Some(session) = &self.session else { return };
        if self.now_us - session.last_valid_us <= session.lease_us {
            return;
        }
        match self.state {
            DeviceState::Run | DeviceState::Hold | DeviceState::Ramp => {
                if self.descent != Some(DeviceState::Idle) {
                    self.say("no sign of the host for its lease: the session ends", sink);
                }
                self.descent = Some(DeviceState::Idle);
                self.queue.clear();
            }
            DeviceState::Fault => self.session = None,
            _ => self.silence(DeviceState::Idle),
        }
    }

    /// Zero output, empty queue, disarmed, high voltage off, and on to `state`.
    pub(super) fn silence(&mut self, state: DeviceState) {
        self.output.reset(self.config.ramp_ms);
        self.queue.clear();
        self.descent = None;
        self.state = state;
        match state {
            DeviceState::Idle => self.session = None,
            // No frame since ARM: the age must not start a ramp.
            DeviceState::Armed => self.last_frame_us = None,
            _ => {}
        }
    }

    /// The start of a tick: its frame takes effect, then STATUS tells.
    pub(super) fn step_tick(&mut self, sink: &mut impl DeviceSink) {
        self.output.settle();
        if self.state.is_live() && self.descent.is_none() {
            self.apply_frame(sink);
        }
        self.check_current(sink);
        self.report_change(sink);
        if self
            .session
            .as_ref()
            .is_some_and(|session| session.wants_status)
        {
            self.send(&self.status(), sink);
        }
    }

    fn apply_frame(&mut self, sink: &mut impl DeviceSink) {
        let tick = self.tick();
        let applied = if let Some(frame) = self.queue.take(tick) {
            self.output.set_target(&frame.allowed);
            self.scratch.copy_from_slice(&frame.received);
            Some(frame.seq)
        } else {
            None
        };
        match (applied, self.state) {
            (Some(_), DeviceState::Hold) => self.state = DeviceState::Run,
            (None, _) if self.last_frame_us.is_some() => {
                self.counters.underrun = self.counters.underrun.wrapping_add(1);
                if self.state == DeviceState::Run {
                    self.state = DeviceState::Hold;
                }
            }
            _ => {}
        }
        // A ramp without a new frame only falls: slewing upwards meanwhile would fight it.
        if applied.is_some() || self.state != DeviceState::Ramp {
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
