//! From the pads to the tactile renderer: what each contactor touches, and how it slips.

use std::sync::Arc;

use super::pad::contactors;
use super::run::Drape;
use super::{DrapeError, DrapeScene};
use selvedge_render::array::{Accuracy, ArrayRenderer, DisplayFrame, Method};
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
    pub(crate) fn render_scene(&self) -> Result<RenderScene, DrapeError> {
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

/// What the contactors of a scene's fingers are given, tick by tick of their displays.
#[derive(Debug)]
pub struct Felt {
    renderer: ArrayRenderer,
    n_fingers: usize,
    tick: u64,
}

/// What the contactors of a finger are given at a tick.
#[derive(Debug, Clone, Copy)]
pub struct FeltTick<'a> {
    /// Number of the tick, from 1.
    pub tick: u64,
    /// Whose.
    pub finger: usize,
    /// Which of the scene's surfaces it touches.
    pub surface: usize,
    /// What each contactor touches.
    pub contacts: &'a [Option<MaterialContact>; 24],
    /// What it is given.
    pub frame: &'a DisplayFrame,
}

impl Felt {
    /// Prepares the textiles of a scene.
    ///
    /// # Errors
    /// The scene names no textile, or it cannot be loaded.
    pub fn new(scene: &DrapeScene) -> Result<Self, DrapeError> {
        let flat = scene.render_scene()?;
        Ok(Self {
            n_fingers: flat.displays.len(),
            renderer: ArrayRenderer::prepare(&flat, Method::Auto, &Accuracy::default())?,
            tick: 0,
        })
    }

    /// The next tick is that of a cloth at its start.
    pub fn restart(&mut self) {
        self.tick = 0;
    }

    /// Renders the ticks that a step has come to, if it has, and tells what each finger is given.
    ///
    /// # Errors
    /// Those of `each`.
    pub fn take<E>(
        &mut self,
        drape: &mut Drape,
        mut each: impl FnMut(FeltTick<'_>) -> Result<(), E>,
    ) -> Result<(), E> {
        let mut contacts = [None; 24];
        loop {
            let tick_s = (self.tick + 1) as f64 / TICKS_PER_S;
            if drape.t_s() < tick_s - 1e-9 {
                return Ok(());
            }
            self.tick += 1;
            for finger in 0..self.n_fingers {
                drape.tick_contacts((finger, tick_s), &mut contacts);
                let surface = drape.surface(finger);
                let Some(frame) = self.renderer.touch((finger, surface), &contacts) else {
                    continue;
                };
                each(FeltTick {
                    tick: self.tick,
                    finger,
                    surface,
                    contacts: &contacts,
                    frame,
                })?;
            }
        }
    }
}

impl Drape {
    /// What each contactor of a finger touches at a tick of its display, s, within the last step,
    /// with how far it slipped since the tick before: exactly still where friction holds it. `None`
    /// where it is off the cloth or presses with less than 50 Pa.
    pub(crate) fn tick_contacts(
        &mut self,
        (finger, tick_s): (usize, f64),
        contacts: &mut [Option<MaterialContact>; 24],
    ) {
        contacts.fill(None);
        let Some((points, step_ago_m)) = self.points(finger) else {
            return;
        };
        // Ticks fall between steps of 2 ms: what slipped after one belongs to the next.
        let late = ((self.t_s() - tick_s) / self.step_s()).clamp(0.0, 1.0);
        let mut now = [[0.0; 2]; 24];
        for ((point, now), contact) in contactors().zip(&mut now).zip(contacts.iter_mut()) {
            let (point, before) = (&points[point], step_ago_m[point]);
            *now = [0, 1].map(|axis| {
                let slipped = point.slipped_m[axis];
                slipped - late * (slipped - before[axis])
            });
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
