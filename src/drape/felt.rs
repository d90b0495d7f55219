//! From the pads to the tactile renderer: what each contactor touches, and how it slips.

use std::sync::Arc;

use super::pad::contactors;
use super::run::Drape;
use super::{DrapeError, DrapeScene};
use selvedge_render::scene::{
    ArrayLayout, Display, Geometry, LoadedScene, PlacedTextile, Scene, TICKS_PER_S,
};
use selvedge_render::{MaterialContact, RenderScene};
use selvedge_textile::Library;

impl DrapeScene {
    /// What the contactors of its fingers are rendered on: the textiles of its face and, if it has
    /// one of its own, its back lying flat, a display for each finger. Loads them.
    ///
    /// # Errors
    /// The scene names no textile, or it cannot be loaded.
    pub fn render_scene(&self) -> Result<RenderScene, DrapeError> {
        if self.textile().is_none() {
            let mend = "name a textile in the scene";
            return Err(DrapeError::input("the cloth has no surface to feel", mend));
        }
        let library = Library::named_or_shipped(self.library_folder.as_deref(), None)?;
        let display = || Display {
            geometry: Geometry::Array(ArrayLayout::Exeter24),
            rotation_deg: 0.0,
        };
        let placed = |id: &str| PlacedTextile {
            id: id.to_owned(),
            size_mm: self.size_mm(),
            ..PlacedTextile::default()
        };
        let scene = Scene {
            name: self.name().to_owned(),
            size_mm: self.size_mm(),
            textiles: self.surfaces().map(placed).collect(),
            displays: self.fingers().iter().map(|_| display()).collect(),
            ..Scene::default()
        };
        Ok(RenderScene::of(&LoadedScene::load(
            scene,
            Arc::new(library),
        )?))
    }
}

impl Drape {
    /// What each contactor of a finger touches at a tick of its display, with how far it slipped
    /// since the tick before: exactly still where friction holds it. `None` where it is off the
    /// cloth or presses with less than 50 Pa.
    pub fn tick_contacts(&mut self, finger: usize, contacts: &mut [Option<MaterialContact>; 24]) {
        contacts.fill(None);
        let Some(points) = self.points(finger) else {
            return;
        };
        let mut now = [[0.0; 2]; 24];
        for ((point, now), contact) in contactors().zip(&mut now).zip(contacts.iter_mut()) {
            let point = &points[point];
            *now = point.slipped_m;
            *contact = point
                .spot
                .filter(|_| point.is_felt())
                .map(|spot| MaterialContact {
                    place_mm: spot.place.map(|m| 1e3 * m),
                    velocity_mm_per_s: point.slipped_m,
                });
        }
        let before = self.ticked_mut(finger);
        for ((before, now), contact) in before.iter_mut().zip(now).zip(contacts) {
            let slipped = [0, 1].map(|axis| 1e3 * (now[axis] - before[axis]) * TICKS_PER_S);
            *before = now;
            if let Some(contact) = contact {
                contact.velocity_mm_per_s = slipped;
            }
        }
    }
}
