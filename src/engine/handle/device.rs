//! The device that is connected next, the log that its link is written to, and what the emulator's
//! contactors do.

use super::Engine;
use crate::order::Order;
use selvedge_device::{Bridge, PlantWatch, SessionLog, Target};

impl Engine {
    /// A look at the contactors of the emulator that was connected last; `None` of other devices.
    pub fn plant(&mut self) -> Option<&mut PlantWatch> {
        self.plant.as_mut()
    }

    pub(super) fn connect_order(&mut self, target: Target) -> Order {
        let switch = self.switch.clone();
        let wake = move || switch.wake_engine();
        let mut bridge = Bridge::open(target, self.profile.clone(), self.n_felt, wake);
        self.plant = bridge.take_plant();
        self.log(&mut bridge);
        self.switch.set_device(bridge.stop_handle());
        Order::Connect(Box::new(bridge))
    }

    /// Writes what happens on every link that is opened from now on to a log.
    pub fn log_links_to(&mut self, log: SessionLog) {
        self.session_log = Some(log);
    }

    /// The log that links are written to.
    pub fn session_log(&self) -> Option<&SessionLog> {
        self.session_log.as_ref()
    }

    /// Lets a link be logged, if there is a log.
    fn log(&self, bridge: &mut Bridge) {
        if let Some(log) = &self.session_log {
            let feed = log.feed(bridge.target());
            bridge.log_to(feed);
        }
    }
}
