//! What is asked of an array rather than of its link: another profile, one channel alone.

use std::time::Instant;

use super::Bridge;
use super::pulse::Pulse;
use crate::array::DeviceUid;
use crate::host::{ArrayChange, BridgeEvent};

impl Bridge {
    /// Tells when another device answers than `last` had, both on a port: call it before the first
    /// [`poll`](Self::poll).
    pub fn came_after(&mut self, last: DeviceUid) {
        if !self.is_emulator {
            self.session.came_after(last);
        }
    }

    /// The number of the device on the port; `None` before it answered, and within this process.
    pub fn device_uid(&self) -> Option<DeviceUid> {
        let caps = self.session.caps().filter(|_| !self.is_emulator);
        caps.map(|caps| DeviceUid(caps.uid))
    }

    /// Follows another profile from the next frame on, as
    /// [`HostSession::set_array`](crate::HostSession::set_array).
    ///
    /// # Errors
    /// As there.
    pub fn set_array(&mut self, change: &mut ArrayChange) -> Result<(), &'static str> {
        let outcome = self.session.set_array(self.now(), change);
        self.flush();
        outcome
    }

    /// Drives one channel alone, as
    /// [`HostSession::identify`](crate::HostSession::identify): an amplitude in µm and a time in
    /// ms, reached softly within 400 ms. `Identified` tells of its beginning.
    ///
    /// # Errors
    /// As there.
    pub fn identify(&mut self, channel: u16, how: (f32, u16)) -> Result<(), &'static str> {
        let pulse = Pulse::new(channel, how);
        let outcome = self.session.identify(self.now(), channel, pulse.how());
        self.pulse = outcome.is_ok().then_some(pulse);
        self.flush();
        outcome
    }

    /// Lets a channel that is driven alone grow louder, if it is time.
    pub(super) fn raise(&mut self, now: Instant) {
        let is_louder = self.pulse.as_mut().is_some_and(|pulse| pulse.advance(now));
        let Some(pulse) = self.pulse.filter(|_| is_louder) else {
            return;
        };
        let taken = self.session.identify(now, pulse.channel, pulse.how());
        // A device that is not armed any more ends it.
        self.pulse = taken.is_ok().then_some(pulse);
    }

    /// Whether a piece of news is one for the owner: of the steps of a channel only the first is,
    /// and one that the device does not take.
    pub(super) fn is_news(&mut self, event: &BridgeEvent, now: Instant) -> bool {
        match (event, &mut self.pulse) {
            (BridgeEvent::Identified { channel }, Some(pulse)) if *channel == pulse.channel => {
                let is_first = pulse.taken(now);
                if pulse.is_last() {
                    self.pulse = None;
                }
                is_first
            }
            (BridgeEvent::NotIdentified { .. }, pulse) => {
                *pulse = None;
                true
            }
            _ => true,
        }
    }
}
