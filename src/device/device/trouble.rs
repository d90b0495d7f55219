//! What happens to a device from outside its protocol: its sensors show something, something in it
//! breaks, its cable is pulled.

use super::lie::Rule;
use super::sense::{Load, Sense};
use super::{DeviceCore, DeviceSink};
use crate::message::{DeviceState, Fault, fault_bit};
use selvedge_foundation::numerics::to_whole;

impl DeviceCore {
    /// Measures the current of amplifiers with this load from now on.
    pub(crate) fn set_load(&mut self, load: Load) {
        self.model.load = Some(load);
    }

    /// The supply current that STATUS tells, mA: what amplifiers take for the codes of this moment,
    /// 0 where the model has none.
    pub(super) fn measured_ma(&self) -> u16 {
        let load = self.model.load.filter(|_| self.state.is_live());
        let taken = load.map_or(0.0, |load| {
            let dead = &self.model.wiring.dead;
            let channels = (0..self.model.n_channels()).zip(0_u16..);
            let alive = channels.filter(|(_, channel)| !dead.contains(channel));
            load.ma(alive.map(|(at, _)| self.output.code(at)))
        });
        whole(taken).saturating_add(self.sense.i_ma)
    }

    /// Trips where the amplifiers take more than the model's supply gives. Output is off at once,
    /// so that the cause is gone.
    pub(super) fn check_current(&mut self, sink: &mut impl DeviceSink) {
        let Some(max_ma) = self.model.over_current_ma else {
            return;
        };
        let ma = self.measured_ma();
        if self.state.is_live() && ma > max_ma {
            self.raise_fault(fault_bit::OVER_CURRENT, u16::MAX, i32::from(ma), sink);
            self.end_fault_cause(fault_bit::OVER_CURRENT);
        }
    }

    /// What the sensors show from now on.
    pub(crate) fn set_sense(&mut self, sense: Sense) {
        self.sense = sense;
    }

    /// The high voltage that STATUS tells, 0.1 V.
    pub(super) fn measured_hv_dv(&self) -> u16 {
        let was_armed = self.lie_memory.armed_us.is_some();
        let is_on = self.state.is_live()
            || self.breaks(Rule::NoHvOff) && was_armed
            || self.breaks(Rule::HvInReady) && self.state == DeviceState::Ready;
        if !is_on || self.breaks(Rule::NoHv) {
            return 0;
        }
        let wanted = u32::from(self.config.hv_dv);
        let measured = wanted * u32::from(self.sense.hv_per_mille) / 1000;
        u16::try_from(measured).unwrap_or(u16::MAX)
    }

    /// Something in the device broke: output zero and high voltage off at once, latched until
    /// cleared.
    pub fn raise_fault(&mut self, bits: u16, channel: u16, value: i32, sink: &mut impl DeviceSink) {
        self.faults |= bits;
        self.fault_causes |= bits;
        self.fault = Fault {
            faults: self.faults,
            channel,
            value,
            tick: self.tick(),
        };
        if !self.breaks(Rule::FaultKeepsOutput) {
            self.silence(DeviceState::Fault);
        }
        self.send_fault(sink);
        self.report_change(sink);
    }

    /// The cause of these fault bits is gone; the faults stay latched until CLEAR.
    pub fn end_fault_cause(&mut self, bits: u16) {
        self.fault_causes &= !bits;
    }

    /// The host's end of the cable is gone (DTR dropped, USB suspended): running output ramps down
    /// from the next ms on, then the session ends.
    pub fn hang_up(&mut self, sink: &mut impl DeviceSink) {
        if self.breaks(Rule::HangUpIgnored) {
            return;
        }
        match self.state {
            DeviceState::Run | DeviceState::Hold | DeviceState::Ramp => {
                self.descent = Some(DeviceState::Idle);
                self.queue.clear();
                self.state = DeviceState::Ramp;
            }
            DeviceState::Fault => self.session = None,
            _ => self.silence(DeviceState::Idle),
        }
        self.report_change(sink);
    }

    /// Age of the last accepted frame in µs if it is above `above_us` and there is still output;
    /// for those who watch that it ends in time.
    pub(crate) fn loud_age_us(&self, above_us: u64) -> Option<u64> {
        self.age_us()
            .filter(|age_us| *age_us > above_us && self.amp_sum() > 0)
    }

    /// How much it holds room for: text, waiting frames, codes.
    #[cfg(test)]
    pub fn held(&self) -> usize {
        self.decoder.capacity() + self.queue.held() + self.scratch.capacity()
    }
}

/// Rounded half up.
fn whole(ma: f64) -> u16 {
    to_whole((ma + 0.5).floor())
}
