//! An emulated device in told time: nothing happens but what its owner asks for, the same every
//! time.

use std::time::Duration;

use super::Emulation;
use crate::actuator_model::ActuatorFeed;
use crate::device::DeviceModel;
use crate::port::{PairPort, Port as _};
use crate::wire::{Faults, WiredDevice};

/// An emulated device without a thread, connected within the process.
pub(crate) struct SteppedEmulator {
    emulation: Emulation,
    /// None when the cable was pulled or the host is gone.
    port: Option<PairPort>,
    now_us: u64,
}

impl SteppedEmulator {
    /// Boots a device, and gives the host's end of its link.
    pub(crate) fn boot(
        model: DeviceModel,
        faults: &Faults,
        actuators: Option<ActuatorFeed>,
    ) -> (Self, PairPort) {
        let (host, device) = PairPort::pair("emulator");
        let mut wired = WiredDevice::new(model, faults);
        if let Some(feed) = &actuators {
            wired.set_load(feed.load());
        }
        let stepped = Self {
            emulation: Emulation::new(wired, None, actuators),
            port: Some(device),
            now_us: 0,
        };
        (stepped, host)
    }

    /// Takes what the host wrote and lets time pass until something happens, at most until `end`
    /// after the boot. The time it is then.
    pub(crate) fn advance(&mut self, end: Duration) -> Duration {
        let end_us = u64::try_from(end.as_micros()).unwrap_or(u64::MAX);
        let is_there = self.port.as_mut().is_some_and(|port| {
            let device = &mut self.emulation.device;
            let mut buffer = [0; 1024];
            let read = if device.is_reading(self.now_us) {
                port.read(&mut buffer, Duration::ZERO)
            } else {
                Ok(0)
            };
            let count = read.as_ref().map_or(0, |count| *count);
            device.host_wrote(self.now_us, buffer.get(..count).unwrap_or(&[]));
            let next_us = device.next_deadline_us().unwrap_or(end_us);
            self.now_us = next_us.min(end_us).max(self.now_us);
            let is_plugged = self.emulation.advance(port, self.now_us);
            read.is_ok() && is_plugged.unwrap_or(false)
        });
        if !is_there {
            self.port = None;
            return end;
        }
        if self.now_us >= end_us {
            end
        } else {
            Duration::from_micros(self.now_us)
        }
    }
}
