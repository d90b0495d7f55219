//! What happens to a device from outside its protocol: its sensors show something, something in it
//! breaks, its cable is pulled.

use super::{DeviceCore, DeviceSink};
use crate::bridge::message::{DeviceState, Fault};

/// What a device's sensors show, as STATUS tells it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Sense {
    /// Temperature in 0.01 °C.
    pub temp_cdeg: i16,
    /// Supply current in mA.
    pub i_ma: u16,
    /// High voltage in thousandths of what was asked for.
    pub hv_per_mille: u16,
}

impl Default for Sense {
    /// 25 °C, no current, full voltage.
    fn default() -> Self {
        Self {
            temp_cdeg: 2500,
            i_ma: 0,
            hv_per_mille: 1000,
        }
    }
}

impl DeviceCore {
    /// What the sensors show from now on.
    pub fn set_sense(&mut self, sense: Sense) {
        self.sense = sense;
    }

    /// The high voltage that STATUS tells, 0.1 V.
    pub(super) fn measured_hv_dv(&self) -> u16 {
        if !self.state.is_live() {
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
        self.silence(DeviceState::Fault);
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
    pub fn loud_age_us(&self, above_us: u64) -> Option<u64> {
        self.age_us()
            .filter(|age_us| *age_us > above_us && self.amp_sum() > 0)
    }

    /// How much it holds room for: text, waiting frames, codes.
    #[cfg(test)]
    pub(in crate::bridge) fn held(&self) -> usize {
        self.decoder.capacity() + self.queue.held() + self.scratch.capacity()
    }
}
