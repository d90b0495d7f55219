//! The emulated device behind a pseudo-terminal: any program opens it like a serial port.
//!
//! One slave handle stays open inside the emulator, or the master would report a hang-up whenever
//! no host is connected. A symbolic link gives the terminal a name that does not change from run to
//! run.

use std::io;
use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;
use std::time::{Duration, Instant};

use serialport::{SerialPort as _, TTYPort};

use super::named_link::NamedLink;
use super::{DeviceLog, Emulation, Ended};
use crate::BridgeError;
use crate::actuator_model::{ActuatorFeed, ActuatorWatch, ContactorModel, actuator_watch};
use crate::device::DeviceModel;
use crate::port::SerialLink;
use crate::wire::{Faults, WiredDevice};

const RELEASE_EVERY: Duration = Duration::from_millis(250);

/// An emulated device that waits to be run.
#[derive(Debug)]
pub struct PtyEmulator {
    device: WiredDevice,
    terminal: Terminal,
    name: PathBuf,
    log: Option<DeviceLog>,
    actuators: Option<ActuatorFeed>,
}

impl PtyEmulator {
    /// Makes a pseudo-terminal and the link to it. A link that a killed emulator left is replaced;
    /// one of a running emulator, and anything else, is refused.
    pub fn new(
        model: DeviceModel,
        faults: &Faults,
        link: &Path,
        log: Option<&Path>,
    ) -> Result<Self, BridgeError> {
        let terminal = Terminal::new(link)?;
        let log = match log {
            Some(path) => Some(DeviceLog::create(path, model.n_channels())?),
            None => None,
        };
        Ok(Self {
            device: WiredDevice::new(model, faults),
            terminal,
            name: link.to_path_buf(),
            log,
            actuators: None,
        })
    }

    /// Gives the device contactors of this kind, and a way to look at them while it runs.
    pub fn watch(&mut self, model: ContactorModel) -> ActuatorWatch {
        let (feed, watch) = actuator_watch(model, self.device.core().output().len());
        self.device.set_load(feed.load());
        self.actuators = Some(feed);
        watch
    }

    /// The terminal itself, `/dev/pts/7`.
    pub fn device_path(&self) -> &str {
        &self.terminal.path
    }

    /// Boots the device and runs it on this thread until `stop` is set; then the link is removed
    /// and the log complete. A pulled cable takes terminal and link away; when it is in again there
    /// is another terminal under another name, `PATH-2` after `PATH`, and `moved` hears of it.
    pub fn run(
        self,
        stop: &AtomicBool,
        mut moved: impl FnMut(&Path, &str),
    ) -> Result<(), BridgeError> {
        let mut emulation = Emulation::new(self.device, self.log, self.actuators);
        let mut terminal = self.terminal;
        let mut n_names = 1;
        let ended = loop {
            let path = terminal.path.clone();
            match terminal.serve(&mut emulation, stop) {
                Ok(Ended::Told) => break Ok(()),
                Ok(Ended::Unplugged) => {}
                Err(error) => {
                    break Err(BridgeError::Link {
                        port: path,
                        reason: format!("the terminal is gone: {error}"),
                    });
                }
            }
            if !emulation.wait_for_cable(stop) {
                break Ok(());
            }
            n_names += 1;
            let mut name = self.name.clone().into_os_string();
            name.push(format!("-{n_names}"));
            let name = PathBuf::from(name);
            terminal = Terminal::new(&name)?;
            moved(&name, &terminal.path);
        };
        if let Some(log) = emulation.log {
            log.finish()?;
        }
        ended
    }
}

/// A pseudo-terminal with a name.
#[derive(Debug)]
struct Terminal {
    master: TTYPort,
    slave: TTYPort,
    path: String,
    link: NamedLink,
}

impl Terminal {
    fn new(link: &Path) -> Result<Self, BridgeError> {
        let (master, slave) =
            TTYPort::pair().map_err(|error| BridgeError::Pty(error.to_string()))?;
        let path = slave.name().unwrap_or_default();
        let link = NamedLink::new(link, Path::new(&path))?;
        Ok(Self {
            master,
            slave,
            path,
            link,
        })
    }

    /// Serves hosts until there is no terminal any more.
    fn serve(self, emulation: &mut Emulation, stop: &AtomicBool) -> io::Result<Ended> {
        let mut port = SerialLink::from_port(Box::new(self.master), &self.path);
        let mut released = Instant::now();
        let slave = self.slave;
        let ended = emulation.run(&mut port, stop, || {
            if released.elapsed() >= RELEASE_EVERY {
                released = Instant::now();
                release_exclusive(&slave);
            }
        });
        drop(self.link);
        ended
    }
}

/// A host that was killed leaves the terminal marked exclusive, and nobody could open it again.
/// Closing a copy of the slave clears the mark; a living host keeps its lock on the file.
fn release_exclusive(slave: &TTYPort) {
    drop(slave.try_clone_native());
}
