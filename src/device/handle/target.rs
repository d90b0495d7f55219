//! Which device to talk to, and how both ends of its port are opened.

use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use crate::BridgeError;
use crate::actuator_model::ActuatorFeed;
use crate::codes::ArrayProfile;
use crate::device::DeviceModel;
use crate::emulator::{EmulatorThread, SteppedEmulator};
use crate::link::{Ends, Living};
use crate::port::{Port, SerialLink, holder_of};
use crate::wire::Faults;

const BUSY_PATIENCE: Duration = Duration::from_secs(1);
const BUSY_NAP: Duration = Duration::from_millis(20);

/// Which device to talk to.
#[derive(Clone, Debug, PartialEq)]
pub enum Target {
    /// An emulated device inside this process, shaped like the profile.
    Emulator,
    /// The same with faults.
    FaultyEmulator(Box<Faults>),
    /// A serial port, or anything that looks like one.
    Port(PathBuf),
}

impl Target {
    /// Whether it is a device inside this process.
    pub fn is_emulator(&self) -> bool {
        !matches!(self, Self::Port(_))
    }

    /// A name for people: `emulator`, `emulator with faults` or the path.
    pub fn name(&self) -> String {
        match self {
            Self::Emulator => String::from("emulator"),
            Self::FaultyEmulator(_) => String::from("emulator with faults"),
            Self::Port(path) => path.display().to_string(),
        }
    }

    /// An emulated device that lives when it is told to, and the host's end of its link.
    pub(crate) fn boot(
        &self,
        profile: &ArrayProfile,
        actuators: Option<ActuatorFeed>,
    ) -> (Box<dyn Port>, Living) {
        let faults = match self {
            Self::FaultyEmulator(faults) => faults,
            Self::Emulator | Self::Port(_) => &Box::default(),
        };
        let model = DeviceModel::for_array(profile);
        let (mut device, port) = SteppedEmulator::boot(model, faults, actuators);
        let living = move |end| device.advance(end);
        (Box::new(port), Box::new(living))
    }

    /// Opens both ends. May block.
    pub(crate) fn open(
        &self,
        profile: &ArrayProfile,
        actuators: Option<ActuatorFeed>,
    ) -> Result<Ends, BridgeError> {
        let emulate = |faults: &Faults| -> Result<Ends, BridgeError> {
            let model = DeviceModel::for_array(profile);
            let port = EmulatorThread::start(model, faults, actuators)?;
            Ok((Box::new(port.clone()), Box::new(port)))
        };
        match self {
            Self::Emulator => emulate(&Faults::default()),
            Self::FaultyEmulator(faults) => emulate(faults),
            Self::Port(path) => {
                let port = open_patiently(&path.display().to_string(), profile.baud)?;
                Ok((Box::new(port.try_clone()?), Box::new(port)))
            }
        }
    }
}

/// Opens a port that an earlier link of this program may still be letting go.
fn open_patiently(path: &str, baud: u32) -> Result<SerialLink, BridgeError> {
    let deadline = Instant::now() + BUSY_PATIENCE;
    loop {
        match SerialLink::open(path, baud) {
            Err(BridgeError::Busy { .. }) if Instant::now() < deadline => {
                std::thread::sleep(BUSY_NAP);
            }
            Err(BridgeError::Busy { port, .. }) => {
                let holder = holder_of(Path::new(path));
                return Err(BridgeError::Busy { port, holder });
            }
            result => return result,
        }
    }
}
