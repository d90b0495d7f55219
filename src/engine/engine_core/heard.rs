//! What is heard of a tick.

use super::EngineCore;
use crate::SoundFeed;
use crate::sound::stereo_levels;

impl EngineCore {
    /// Hands the last tick to whoever makes sound of it: what a device at full gain plays, armed
    /// or not.
    pub(crate) fn sound_to(&self, feed: &mut SoundFeed) {
        let felt_um = self.felt_um();
        let Some(frame) = self.scene.renderer().frames().first() else {
            return;
        };
        let (middle, half_mm) = (frame.position(), self.scene.start().x_mm);
        let from_middle = |index: usize| frame.contactor_position(index).x_mm - middle.x_mm;
        let widest_mm =
            (0..felt_um.len()).fold(0.0, |most, index| from_middle(index).abs().max(most));
        let contactors = felt_um.iter().enumerate();
        let contactors = contactors.map(|(index, &felt_um)| {
            let place = from_middle(index) / f64::max(widest_mm, 1e-9);
            (place, self.scene.limited_um(index, felt_um))
        });
        let finger = (middle.x_mm - half_mm) / f64::max(half_mm, 1e-9);
        feed.push(stereo_levels(finger, contactors));
    }
}
