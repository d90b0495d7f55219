//! The emulated device behind a pseudo-terminal: any program opens it like a serial port.
//!
//! One slave handle stays open inside the emulator, or the master would report a hang-up whenever
//! no host is connected. A symbolic link gives the terminal a name that does not change from run to
//! run.

use std::fs;
use std::os::unix::fs::symlink;
use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;
use std::time::{Duration, Instant};

use serialport::{SerialPort as _, TTYPort};

use super::{DeviceLog, Emulation};
use crate::bridge::BridgeError;
use crate::bridge::device::{DeviceCore, DeviceModel};
use crate::bridge::plant::{ContactorModel, PlantFeed, PlantWatch, plant_watch};
use crate::bridge::port::SerialLink;

const RELEASE_EVERY: Duration = Duration::from_millis(250);

/// An emulated device that waits to be run.
#[derive(Debug)]
pub struct PtyEmulator {
    model: DeviceModel,
    master: TTYPort,
    slave: TTYPort,
    device_path: String,
    link: NamedLink,
    log: Option<DeviceLog>,
    plant: Option<PlantFeed>,
}

impl PtyEmulator {
    /// Makes a pseudo-terminal and the link to it. An older link to a terminal is replaced,
    /// anything else is refused.
    pub fn new(model: DeviceModel, link: &Path, log: Option<&Path>) -> Result<Self, BridgeError> {
        let (master, slave) =
            TTYPort::pair().map_err(|error| BridgeError::Pty(error.to_string()))?;
        let device_path = slave.name().unwrap_or_default();
        let log = match log {
            Some(path) => Some(DeviceLog::create(path, model.n_channels())?),
            None => None,
        };
        let link = NamedLink::new(link, Path::new(&device_path))?;
        Ok(Self {
            model,
            master,
            slave,
            device_path,
            link,
            log,
            plant: None,
        })
    }

    /// Gives the device contactors of this kind, and a way to look at them while it runs.
    pub fn watch(&mut self, model: ContactorModel) -> PlantWatch {
        let (feed, watch) = plant_watch(model, self.model.n_channels());
        self.plant = Some(feed);
        watch
    }

    /// The terminal itself, `/dev/pts/7`.
    pub fn device_path(&self) -> &str {
        &self.device_path
    }

    /// Boots the device and runs it on this thread until `stop` is set; then the link is removed
    /// and the log complete.
    pub fn run(self, stop: &AtomicBool) -> Result<(), BridgeError> {
        let mut port = SerialLink::from_port(Box::new(self.master), &self.device_path);
        let mut emulation = Emulation {
            core: DeviceCore::new(self.model),
            log: self.log,
            plant: self.plant,
        };
        let mut released = Instant::now();
        let slave = self.slave;
        let ended = emulation.run(&mut port, stop, || {
            if released.elapsed() >= RELEASE_EVERY {
                released = Instant::now();
                release_exclusive(&slave);
            }
        });
        drop(self.link);
        if let Some(log) = emulation.log {
            log.finish()?;
        }
        ended.map_err(|error| BridgeError::Link {
            port: self.device_path,
            reason: format!("the terminal is gone: {error}"),
        })
    }
}

/// A host that was killed leaves the terminal marked exclusive, and nobody could open it again.
/// Closing a copy of the slave clears the mark; a living host keeps its lock on the file.
fn release_exclusive(slave: &TTYPort) {
    drop(slave.try_clone_native());
}

/// A symbolic link that removes itself.
#[derive(Debug)]
struct NamedLink {
    path: PathBuf,
    target: PathBuf,
}

impl NamedLink {
    fn new(path: &Path, target: &Path) -> Result<Self, BridgeError> {
        if let Ok(found) = fs::symlink_metadata(path) {
            if !found.is_symlink() || !points_to_terminal(path) {
                return Err(BridgeError::LinkTaken(path.to_path_buf()));
            }
            fs::remove_file(path).map_err(BridgeError::file("replace the link", path))?;
        }
        symlink(target, path).map_err(BridgeError::file("make the link", path))?;
        Ok(Self {
            path: path.to_path_buf(),
            target: target.to_path_buf(),
        })
    }
}

/// Whether a link leads to a pseudo-terminal, present or gone, or nowhere.
fn points_to_terminal(path: &Path) -> bool {
    let terminal = fs::read_link(path).is_ok_and(|target| target.starts_with("/dev/"));
    terminal || !path.exists()
}

impl Drop for NamedLink {
    fn drop(&mut self) {
        // Another emulator may have taken the name over.
        if fs::read_link(&self.path).is_ok_and(|target| target == self.target) {
            drop(fs::remove_file(&self.path));
        }
    }
}
