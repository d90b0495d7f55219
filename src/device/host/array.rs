//! Another array profile in a session: limits, calibration, wiring.
//!
//! While the device may move only what lowers every code takes effect, and at once; all else needs
//! a device at rest, which is configured anew.

use std::time::Instant;

use super::HostSession;
use super::report::{BridgeEvent, BridgeState};
use crate::array::DeviceUid;
use crate::codes::{ArrayProfile, Coder};
use crate::session_log::Note;

/// A profile made ready for a session. After it took effect, what was there before: to be dropped
/// where dropping is cheap.
#[derive(Debug)]
pub struct ArrayChange {
    profile: ArrayProfile,
    coder: Coder,
}

impl ArrayChange {
    /// Makes a profile ready for a display of `n_contactors` contactors. Allocates.
    pub fn new(profile: ArrayProfile, n_contactors: usize) -> Self {
        Self {
            coder: Coder::new(&profile, n_contactors),
            profile,
        }
    }
}

impl HostSession {
    /// The link before this one had this device: another one is told. Before it is opened.
    pub fn came_after(&mut self, device: DeviceUid) {
        self.device.before = Some(device);
    }

    /// Tells when the device is not the one of before, and writes down when it is not the one that
    /// the profile was measured on.
    pub(super) fn compare_device(&mut self, now: Instant, device: DeviceUid) {
        let before = self.device.before;
        let other = before.and_then(|before| self.drive.profile.other_device(before, device));
        if let Some(message) = other {
            self.note(now, Note::Said("other-device", message.clone()));
            self.event(BridgeEvent::OtherDevice(message));
        }
        if let Some(doubt) = self.drive.profile.wiring_doubt(device) {
            self.note(now, Note::Said("wiring-doubt", doubt));
        }
    }

    /// Follows another profile from the next frame on; a device at rest is configured anew. Neither
    /// allocates nor waits.
    ///
    /// # Errors
    /// The device may move and the profile does not only lower, or it is of another array: nothing
    /// changed then, and the text says why.
    pub fn set_array(
        &mut self,
        now: Instant,
        change: &mut ArrayChange,
    ) -> Result<(), &'static str> {
        if change.profile.n_contactors() != self.drive.profile.n_contactors() {
            return Err("the array profile has another number of contactors");
        }
        if self.state.is_live() && !change.profile.only_lowers(&self.drive.profile) {
            return Err("the array profile waits until the device is disarmed");
        }
        change.coder.go_on_from(&self.drive.coder);
        std::mem::swap(&mut self.drive.profile, &mut change.profile);
        std::mem::swap(&mut self.drive.coder, &mut change.coder);
        if matches!(self.state, BridgeState::Ready | BridgeState::Configuring) {
            self.configure(now);
        }
        Ok(())
    }
}
