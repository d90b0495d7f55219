//! The devices that were connected last: what emulated contactors of the first do, and the log of
//! their links.

use std::collections::BTreeMap;
use std::time::Instant;

use super::Engine;
use super::array::DrivenArray;
use crate::ready::ReadyCommand;
use crate::{EngineError, StopSwitch};
use selvedge_device::{ActuatorWatch, Bridge, SessionLog, Target};

/// What the handle keeps of devices.
#[derive(Debug, Default)]
pub(super) struct DeviceHandle {
    /// A look at the contactors of the emulator that was connected last.
    pub(super) actuators: Option<ActuatorWatch>,
    /// What links are written to.
    pub(super) session_log: Option<SessionLog>,
    /// What is felt, as every link's log says it.
    said: BTreeMap<&'static str, String>,
    /// Whether emulated devices live in the time that the engine is told.
    pub(super) is_stepped: bool,
}

impl DeviceHandle {
    /// Begins to open a device for the first or second display. The switch stops it from now on,
    /// and its link wakes the engine.
    pub(super) fn open(
        &mut self,
        (display, target): (usize, Target),
        driven: &DrivenArray,
        (switch, told): (&StopSwitch, Option<Instant>),
    ) -> ReadyCommand {
        let waker = switch.clone();
        let wake = move || waker.wake_engine();
        let n_felt = driven.n_felt;
        let profile = match display {
            0 => driven.profile.clone(),
            _ => driven.of_second(),
        };
        let about = profile.clone();
        let mut bridge = match told.filter(|_| self.is_stepped) {
            Some(now) => Bridge::open_stepped(target, profile, n_felt, now, wake),
            None => Bridge::open(target, profile, n_felt, wake),
        };
        if display == 0 {
            self.actuators = bridge.take_actuators();
        }
        if let Some(log) = &self.session_log {
            let mut feed = bridge.feed_of(log);
            feed.about_array(&about);
            for (name, value) in &self.said {
                feed.about(name, value);
            }
            bridge.log_to(feed);
        }
        switch.set_device(display, bridge.stop_handle());
        ReadyCommand::Connect(display, Some(Box::new(bridge)))
    }

    /// Says what is felt to the link that is open, and to those to come.
    pub(super) fn say(&mut self, name: &'static str, value: String) {
        if let Some(log) = &self.session_log {
            log.about(name, &value);
        }
        self.said.insert(name, value);
    }
}

impl Engine {
    /// Begins to open a device for the first or second display.
    ///
    /// # Errors
    /// There is no such display that is like the first.
    pub(super) fn connect(
        &mut self,
        display: usize,
        target: Target,
    ) -> Result<ReadyCommand, EngineError> {
        if display > 0 && self.driven.n_second != self.driven.n_felt {
            return Err(EngineError::NoSecondDisplay);
        }
        let when = (&self.switch, self.body.told());
        Ok(self.device.open((display, target), &self.driven, when))
    }

    /// Lets go of the device of a display.
    pub(super) fn disconnect(&mut self, display: usize) -> ReadyCommand {
        self.switch.set_device(display, None);
        if display == 0 {
            self.device.actuators = None;
        }
        ReadyCommand::Connect(display, None)
    }
}
