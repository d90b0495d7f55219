//! Emulated devices in real time: the device's state machine with a clock and a link around it.
//!
//! They answer the same bytes as a real device, in process or behind a pseudo-terminal. What
//! contactors would do is modelled in `actuators`, while somebody looks.

mod log;
#[cfg(unix)]
mod named_link;
#[cfg(unix)]
mod pty;
mod stepped;

use std::io;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::Builder;
use std::time::{Duration, Instant};

use super::BridgeError;
use super::actuator_model::ActuatorFeed;
use super::device::{AppliedFrame, DeviceCore, DeviceModel, DeviceSink, Moment};
use super::port::{PairPort, Port};
use super::wire::{Faults, Injection, WireSink, WiredDevice};
pub(crate) use log::DeviceLog;
#[cfg(unix)]
pub use pty::PtyEmulator;
pub(crate) use stepped::SteppedEmulator;

/// How long a quiet device sleeps before it looks whether to end.
const NAP: Duration = Duration::from_millis(50);

/// An emulated device on a thread of its own, connected within the process.
#[derive(Debug)]
pub(crate) struct EmulatorThread;

impl EmulatorThread {
    /// Boots a device and gives the host's end of its link; the thread ends when all copies of that
    /// end are gone. Device and link have these faults, and somebody may look at the contactors.
    /// Within a process nothing can be plugged in again: a cable that is pulled ends the link.
    pub(crate) fn start(
        model: DeviceModel,
        faults: &Faults,
        actuators: Option<ActuatorFeed>,
    ) -> Result<PairPort, BridgeError> {
        let (host, mut device) = PairPort::pair("emulator");
        let mut wired = WiredDevice::new(model, faults);
        if let Some(feed) = &actuators {
            wired.set_load(feed.load());
        }
        Builder::new()
            .name(String::from("bridge-emulator"))
            .spawn(move || {
                let mut emulation = Emulation::new(wired, None, actuators);
                // The end of the link is this thread's way to end.
                drop(emulation.run(&mut device, &AtomicBool::new(false), || {}));
            })
            .map_err(BridgeError::Thread)?;
        Ok(host)
    }
}

/// Why an emulation no longer serves a port.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Ended {
    Told,
    Unplugged,
}

/// A device, its log, and its contactors where somebody may look at them.
struct Emulation {
    device: WiredDevice,
    log: Option<DeviceLog>,
    actuators: Option<ActuatorFeed>,
    start: Instant,
}

impl Emulation {
    fn new(device: WiredDevice, log: Option<DeviceLog>, actuators: Option<ActuatorFeed>) -> Self {
        Self {
            device,
            log,
            actuators,
            start: Instant::now(),
        }
    }

    /// Runs until `stop`, the end of the link, or a pulled cable. `housekeep` is called whenever
    /// the device wakes.
    fn run(
        &mut self,
        port: &mut dyn Port,
        stop: &AtomicBool,
        mut housekeep: impl FnMut(),
    ) -> io::Result<Ended> {
        let mut buffer = [0; 1024];
        while !stop.load(Ordering::Acquire) {
            let patience = self.patience();
            let count = if self.device.is_reading(self.now_us()) {
                port.read(&mut buffer, patience)?
            } else {
                // What the host writes piles up in the terminal, as with real hardware.
                std::thread::sleep(patience);
                0
            };
            let now_us = self.now_us();
            self.device
                .host_wrote(now_us, buffer.get(..count).unwrap_or(&[]));
            if !self.advance(port, now_us)? {
                return Ok(Ended::Unplugged);
            }
            housekeep();
        }
        Ok(Ended::Told)
    }

    /// Lets time pass; whether the cable is still in.
    fn advance(&mut self, port: &mut dyn Port, now_us: u64) -> io::Result<bool> {
        let mut sink = LiveSink {
            port: Some(port),
            log: self.log.as_mut(),
            actuators: self.actuators.as_mut(),
            gone: None,
        };
        self.device.advance(now_us, &mut sink);
        let gone = sink.gone;
        gone.map_or_else(|| Ok(self.device.is_plugged()), Err)
    }

    /// Runs without a port until the cable is in again; false when `stop` came first.
    #[cfg(unix)]
    fn wait_for_cable(&mut self, stop: &AtomicBool) -> bool {
        while !self.device.is_plugged() {
            if stop.load(Ordering::Acquire) {
                return false;
            }
            std::thread::sleep(self.patience());
            let now_us = self.now_us();
            let mut sink = LiveSink {
                port: None,
                log: self.log.as_mut(),
                actuators: self.actuators.as_mut(),
                gone: None,
            };
            self.device.advance(now_us, &mut sink);
        }
        true
    }

    fn now_us(&self) -> u64 {
        u64::try_from(self.start.elapsed().as_micros()).unwrap_or(u64::MAX)
    }

    /// How long nothing happens by itself, at most a nap.
    fn patience(&self) -> Duration {
        let until = self.device.next_deadline_us().map(Duration::from_micros);
        until.map_or(NAP, |until| {
            until.saturating_sub(self.start.elapsed()).min(NAP)
        })
    }
}

/// Writes packets to the link, dropping what does not fit: a device never waits for its host.
struct LiveSink<'a> {
    /// None while the cable is out.
    port: Option<&'a mut dyn Port>,
    log: Option<&'a mut DeviceLog>,
    actuators: Option<&'a mut ActuatorFeed>,
    gone: Option<io::Error>,
}

impl DeviceSink for LiveSink<'_> {
    fn packet(&mut self, bytes: &[u8]) {
        if let Some(port) = &mut self.port
            && let Err(error) = port.write(bytes, Duration::ZERO)
            && error.kind() != io::ErrorKind::TimedOut
        {
            self.gone = Some(error);
        }
    }

    fn applied(&mut self, frame: &AppliedFrame<'_>) {
        if let Some(log) = &mut self.log {
            log.frame(frame);
        }
    }

    fn changed(&mut self, moment: &Moment) {
        if let Some(log) = &mut self.log {
            log.change(moment);
        }
    }

    fn stepped(&mut self, device: &DeviceCore) {
        if let Some(actuators) = &mut self.actuators {
            actuators.stepped(device);
        }
    }
}

impl WireSink for LiveSink<'_> {
    fn injected(&mut self, moment: &Moment, injection: &Injection) {
        if let Some(log) = &mut self.log {
            log.injected(moment, injection);
        }
    }
}

#[cfg(test)]
mod tests;
