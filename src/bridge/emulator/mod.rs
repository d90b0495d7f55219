//! Emulated devices in real time: the device's state machine with a clock and a link around it.
//!
//! They answer the same bytes as a real device, in process or behind a pseudo-terminal. What
//! contactors would do is modelled in `plant`, while somebody looks.

mod log;
#[cfg(unix)]
mod pty;

use std::io;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::Builder;
use std::time::{Duration, Instant};

use super::BridgeError;
use super::device::{AppliedFrame, DeviceCore, DeviceModel, DeviceSink, Moment};
use super::plant::PlantFeed;
use super::port::{PairPort, Port, pair};
pub use log::DeviceLog;
#[cfg(unix)]
pub use pty::PtyEmulator;

/// How long a quiet device sleeps before it looks whether to end.
const NAP: Duration = Duration::from_millis(50);

/// An emulated device on a thread of its own, connected within the process.
#[derive(Debug)]
pub struct EmulatorThread;

impl EmulatorThread {
    /// Boots a device and gives the host's end of its link; the thread ends when all copies of that
    /// end are gone.
    pub fn start(model: DeviceModel) -> Result<PairPort, BridgeError> {
        Self::start_watched(model, None)
    }

    /// The same with contactors that somebody may look at.
    pub fn start_watched(
        model: DeviceModel,
        plant: Option<PlantFeed>,
    ) -> Result<PairPort, BridgeError> {
        let (host, mut device) = pair("emulator");
        Builder::new()
            .name(String::from("bridge-emulator"))
            .spawn(move || {
                let mut emulation = Emulation {
                    core: DeviceCore::new(model),
                    log: None,
                    plant,
                };
                // The end of the link is this thread's way to end.
                drop(emulation.run(&mut device, &AtomicBool::new(false), || {}));
            })
            .map_err(BridgeError::Thread)?;
        Ok(host)
    }
}

/// A device, its log, and its contactors where somebody may look at them.
struct Emulation {
    core: DeviceCore,
    log: Option<DeviceLog>,
    plant: Option<PlantFeed>,
}

impl Emulation {
    /// Runs until `stop` or the end of the link. `housekeep` is called whenever the device wakes.
    fn run(
        &mut self,
        port: &mut dyn Port,
        stop: &AtomicBool,
        mut housekeep: impl FnMut(),
    ) -> io::Result<()> {
        let boot = Instant::now();
        let mut buffer = [0; 1024];
        while !stop.load(Ordering::Acquire) {
            let until = self.core.next_deadline_us().map(Duration::from_micros);
            let patience = until.map_or(NAP, |until| until.saturating_sub(boot.elapsed()).min(NAP));
            let count = port.read(&mut buffer, patience)?;
            let now_us = u64::try_from(boot.elapsed().as_micros()).unwrap_or(u64::MAX);
            let mut sink = LiveSink {
                port: &mut *port,
                log: self.log.as_mut(),
                plant: self.plant.as_mut(),
                gone: None,
            };
            self.core
                .receive(now_us, buffer.get(..count).unwrap_or(&[]), &mut sink);
            if let Some(error) = sink.gone {
                return Err(error);
            }
            housekeep();
        }
        Ok(())
    }
}

/// Writes packets to the link, dropping what does not fit: a device never waits for its host.
struct LiveSink<'a> {
    port: &'a mut dyn Port,
    log: Option<&'a mut DeviceLog>,
    plant: Option<&'a mut PlantFeed>,
    gone: Option<io::Error>,
}

impl DeviceSink for LiveSink<'_> {
    fn packet(&mut self, bytes: &[u8]) {
        if let Err(error) = self.port.write(bytes, Duration::ZERO)
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
        if let Some(plant) = &mut self.plant {
            plant.stepped(device);
        }
    }
}

#[cfg(test)]
mod tests;
