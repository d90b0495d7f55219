//! What is prepared for another scene or another array: the array that was chosen goes with every
//! scene whose first display has as many contactors.

use super::Engine;
use crate::Snapshot;
use crate::order::{ArrayOrder, NextScene, Order};
use selvedge_device::{ArrayChange, ArrayProfile, Coder};

impl Engine {
    pub(super) fn scene_order(&mut self, mut next: NextScene) -> Order {
        self.scene_profile = next.scene().profile().clone();
        if let Some(array) = &self.array {
            next.scene_mut().drive_as(array);
        }
        let scene = next.scene();
        let (input, output) = triple_buffer::triple_buffer(&Snapshot::of(scene));
        self.coming.push(output);
        if scene.n_felt() != self.n_felt {
            self.switch.set_device(None);
        }
        self.n_contactors = scene.n_contactors();
        self.n_felt = scene.n_felt();
        self.profile = scene.profile().clone();
        Order::Scene(next, input)
    }

    pub(super) fn array_order(&mut self, array: Option<Box<ArrayProfile>>) -> Order {
        let fits = |array: &&ArrayProfile| array.n_contactors() == self.n_felt;
        let chosen = array.as_deref().filter(fits);
        let profile = chosen.unwrap_or(&self.scene_profile).clone();
        self.array = array;
        self.profile = profile.clone();
        Order::Array(Box::new(ArrayOrder {
            coder: Coder::new(&profile, self.n_felt),
            change: ArrayChange::new(profile, self.n_felt),
        }))
    }
}
