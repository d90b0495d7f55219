//! What is asked of an array rather than of its link: another profile, one channel alone.

use std::time::Instant;

use super::Bridge;
use crate::bridge::host::ArrayChange;

impl Bridge {
    /// Follows another profile from the next frame on, as
    /// [`HostSession::set_array`](crate::bridge::HostSession::set_array).
    ///
    /// # Errors
    /// As there.
    pub fn set_array(&mut self, change: &mut ArrayChange) -> Result<(), &'static str> {
        let outcome = self.session.set_array(Instant::now(), change);
        self.flush();
        outcome
    }

    /// Drives one channel alone, as
    /// [`HostSession::identify`](crate::bridge::HostSession::identify): an amplitude in µm and a
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
