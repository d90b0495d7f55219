//! What is asked of an array rather than of its link: another profile, one channel alone.

use std::time::Instant;

use super::Bridge;
use crate::array::DeviceUid;
use crate::host::ArrayChange;

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
        let outcome = self.session.set_array(Instant::now(), change);
        self.flush();
        outcome
    }

    /// Drives one channel alone, as
    /// [`HostSession::identify`](crate::HostSession::identify): an amplitude in µm and a
    /// time in ms.
    ///
    /// # Errors
    /// As there.
    pub fn identify(&mut self, channel: u16, how: (f32, u16)) -> Result<(), &'static str> {
        let outcome = self.session.identify(Instant::now(), channel, how);
        self.flush();
        outcome
    }
}
