//! The array that a device drives: the scene's own, or one that was chosen and goes with every
//! scene whose first display has as many contactors.

use crate::PreparedScene;
use crate::fingers::n_others;
use crate::ready::{NextArray, ReadyCommand};
use selvedge_device::{ArrayChange, ArrayProfile, Coder};

/// What is known of the displays of the scene that was sent last.
#[derive(Debug)]
pub(super) struct DrivenArray {
    /// Displays beside the first that fingers may hold.
    pub(super) n_others: usize,
    /// Contactors of all displays.
    pub(super) n_contactors: usize,
    /// Contactors of the first display: those that a device plays.
    pub(super) n_felt: usize,
    /// Those of the second.
    pub(super) n_second: usize,
    /// The profile in force.
    pub(super) profile: ArrayProfile,
    of_scene: ArrayProfile,
    chosen: Option<Box<ArrayProfile>>,
}

impl DrivenArray {
    /// The scene's own.
    pub(super) fn of(scene: &PreparedScene) -> Self {
        Self {
            n_others: n_others(scene.n_displays()),
            n_contactors: scene.n_contactors(),
            n_felt: scene.n_felt(),
            n_second: scene.n_felt_of(1),
            profile: scene.profile().clone(),
            of_scene: scene.profile().clone(),
            chosen: None,
        }
    }

    /// Follows another scene, which is driven as the chosen array if that fits. Says of its first
    /// two displays whether they have another number of contactors.
    pub(super) fn follow(&mut self, scene: &mut PreparedScene) -> [bool; 2] {
        self.of_scene = scene.profile().clone();
        if let Some(chosen) = &self.chosen {
            scene.drive_as(chosen);
        }
        let is_other = [
            scene.n_felt() != self.n_felt,
            scene.n_felt_of(1) != self.n_second,
        ];
        self.n_others = n_others(scene.n_displays());
        self.n_contactors = scene.n_contactors();
        self.n_felt = scene.n_felt();
        self.n_second = scene.n_felt_of(1);
        self.profile = scene.profile().clone();
        is_other
    }

    /// Chooses another array; `None`, or one that does not fit, is the scene's own.
    pub(super) fn choose(&mut self, array: Option<Box<ArrayProfile>>) -> ReadyCommand {
        let fits = |array: &&ArrayProfile| array.n_contactors() == self.n_felt;
        let chosen = array.as_deref().filter(fits);
        let profile = chosen.unwrap_or(&self.of_scene).clone();
        self.chosen = array;
        self.profile = profile.clone();
        ReadyCommand::Array(Box::new(NextArray {
            coder: Coder::new(&profile, self.n_felt),
            second: ArrayChange::new(self.of_second(), self.n_felt),
            change: ArrayChange::new(profile, self.n_felt),
        }))
    }

    /// The second display's: as the first, but for what was measured of that one device.
    pub(super) fn of_second(&self) -> ArrayProfile {
        ArrayProfile {
            calibration: Vec::new(),
            wiring: None,
            ..self.profile.clone()
        }
    }
}
