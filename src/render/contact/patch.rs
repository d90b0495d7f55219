//! A tip on a surface: where each of its contacts stands, and the force of all.

use std::sync::Arc;

use super::friction::{Bristles, Friction, Hold};
use super::law::{ContactLaw, Floor, ForceParts, Spring};
use super::relief::Relief;
use super::stepper::{Column, Motion};
use super::tip::Tip;
use crate::RenderError;
use selvedge_foundation::numerics::bisected;

/// Halvings that find where a tip comes to rest.
const HALVINGS: u32 = 60;
/// Instants of a step at which the surface is looked at: start, middle, end.
const INSTANTS: usize = 3;

/// A tip on a surface. Making one allocates; nothing after does.
#[derive(Debug, Clone)]
pub struct Contact {
    /// What the tip's lowest points rest on.
    relief: Arc<Relief>,
    tip: Tip,
    law: ContactLaw,
    friction: Friction,
    spring: Spring,
    floors: [Vec<Floor>; INSTANTS],
    bristles: Bristles,
}

/// What a tip is pushed with.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Load {
    /// Up, N.
    pub(super) up_n: f64,
    /// Along the normals of the contacts, added up, N.
    pub(super) normal_n: f64,
    /// The gradient's force along u and w, N.
    pub(super) along_n: [f64; 2],
    /// How stiff that is along u and w, N/m.
    pub(super) stiffness: [f64; 2],
    /// The deepest contact, m; 0 where none touches.
    pub(super) depth_m: f64,
}

impl Contact {
    /// A tip on a surface, which is taken as its spheres touch it ([`Relief::under_sphere`]).
    ///
    /// # Errors
    /// A law, a friction or a tip that is none.
    pub fn new(
        relief: &Relief,
        tip: Tip,
        law: ContactLaw,
        friction: Friction,
    ) -> Result<Self, RenderError> {
        law.check()?;
        friction.check()?;
        let places = tip.contacts_mm.iter().flatten();
        if tip.contacts_mm.is_empty() || !places.into_iter().all(|mm| mm.abs() <= 1e3) {
            return Err(RenderError::stylus(
                "the tip has no contact, or one that is not within 1 m",
                "give places in mm",
            ));
        }
        let n = tip.contacts_mm.len();
        Ok(Self {
            relief: Arc::new(relief.under_sphere(tip.radius_mm)?),
            spring: law.share(n),
            floors: std::array::from_fn(|_| vec![Floor::default(); n]),
            bristles: Bristles::default(),
            tip,
            law,
            friction,
        })
    }

    /// How the surface pushes back.
    pub fn law(&self) -> &ContactLaw {
        &self.law
    }

    /// Another law from now on, on the same surface: what a slider changes.
    ///
    /// # Errors
    /// A law that is none.
    pub fn set_law(&mut self, law: ContactLaw) -> Result<(), RenderError> {
        law.check()?;
        self.spring = law.share(self.tip.contacts_mm.len());
        self.law = law;
        Ok(())
    }

    /// What the tip's lowest points rest on: for a cross-section.
    pub fn relief(&self) -> &Relief {
        &self.relief
    }

    /// Forgets what was pressed and bent.
    pub(super) fn forget(&mut self) {
        self.bristles = Bristles::default();
        for floors in &mut self.floors {
            floors.fill(Floor::default());
        }
    }

    /// Goes where another is that is the same tip on the same surface.
    pub(super) fn go_where(&mut self, other: &Self) {
        self.bristles = other.bristles;
        for (floors, others) in self.floors.iter_mut().zip(&other.floors) {
            floors.clone_from_slice(others);
        }
    }

    /// Looks where the surface is under every contact at an instant of a step.
    pub(super) fn look(&mut self, instant: usize, place_mm: [f64; 2], velocity_m_per_s: [f64; 2]) {
        let contacts = self.tip.contacts_mm.iter();
        for (floor, [u_mm, w_mm, up_mm]) in self.floors[instant].iter_mut().zip(contacts) {
            let mut spot = self.relief.at([place_mm[0] + u_mm, place_mm[1] + w_mm]);
            spot.height_mm -= up_mm;
            *floor = Floor::of(spot, velocity_m_per_s, floor.deepest_m);
        }
    }

    /// Says how fast the tip moves along the surface over the step that begins.
    pub(super) fn set_off(&mut self, velocity_m_per_s: [f64; 2]) {
        for floor in &mut self.floors[0] {
            let [u, w] = floor.slope;
            floor.rise_m_per_s = u * velocity_m_per_s[0] + w * velocity_m_per_s[1];
        }
    }

    /// The end of a step becomes the start of the next, and what was pressed is remembered.
    pub(super) fn go_on(&mut self, z_m: f64) {
        let [start, middle, end] = &mut self.floors;
        for ((start, middle), end) in start.iter_mut().zip(middle).zip(end) {
            let depth_m = end.height_m - z_m;
            let deepest_m = if depth_m > 0.0 {
                end.deepest_m.max(depth_m)
            } else {
                0.0
            };
            end.deepest_m = deepest_m;
            middle.deepest_m = deepest_m;
            *start = *end;
        }
    }

    /// What acts over a step on a mass with so much damping under a held force.
    pub(super) fn column(&self, mass_kg: f64, damping: f64, push_n: f64) -> Column<'_> {
        Column {
            mass_kg,
            damping,
            push_n,
            spring: &self.spring,
            floors: [&self.floors[0], &self.floors[1], &self.floors[2]],
        }
    }

    /// The force of all contacts at an instant, as much of it as is displayed.
    pub(super) fn load(&self, instant: usize, at: Motion) -> Load {
        let mut load = Load::default();
        for floor in &self.floors[instant] {
            let force_n = self.spring.force_n(floor, at.z_m, at.v_m_per_s);
            load.depth_m = load.depth_m.max(floor.height_m - at.z_m);
            load.up_n += force_n;
            load.normal_n += force_n * floor.lean();
            for axis in 0..2 {
                let slope = floor.slope[axis];
                load.along_n[axis] -= force_n * slope;
                if force_n > 0.0 {
                    load.stiffness[axis] += self.spring.k * slope * slope;
                }
            }
        }
        if self.law.parts == ForceParts::Normal {
            (load.along_n, load.stiffness) = ([0.0; 2], [0.0; 2]);
        }
        load
    }

    /// Energy that the contacts give back at an instant, J.
    pub(super) fn energy_j(&self, instant: usize, z_m: f64) -> f64 {
        let floors = self.floors[instant].iter();
        floors.map(|floor| self.spring.energy_j(floor, z_m)).sum()
    }

    /// The work of moving along the surface over a step from and to these heights, J: how far it
    /// rises under each contact by that contact's force. `mean_n` is the force that all had in the
    /// mean over the step, where that is known; of one contact the work is then exact.
    pub(super) fn lifting_j(&self, z_m: [f64; 2], mean_n: Option<f64>) -> f64 {
        let (mut force_n, mut work_j, mut rise_m) = (0.0, 0.0, 0.0);
        for (before, after) in self.floors[0].iter().zip(&self.floors[2]) {
            let first = self.spring.force_n(before, z_m[0], before.rise_m_per_s);
            let last = self.spring.force_n(after, z_m[1], after.rise_m_per_s);
            let rises_m = after.height_m - before.height_m;
            force_n += 0.5 * (first + last);
            work_j += 0.5 * (first + last) * rises_m;
            rise_m += rises_m / self.floors[0].len() as f64;
        }
        match mean_n {
            Some(mean_n) if force_n > 0.0 => work_j * mean_n / force_n,
            Some(mean_n) => rise_m * mean_n,
            None => work_j,
        }
    }

    /// Where a tip rests that is pressed with a force, m: on the highest contact if nothing holds.
    pub(super) fn rest_m(&self, instant: usize, press_n: f64) -> f64 {
        let floors = &self.floors[instant];
        let high = floors.iter().map(|floor| floor.height_m);
        let top_m = high.fold(f64::NEG_INFINITY, f64::max);
        let force_n = |z_m: f64| -> f64 {
            let one = |floor: &Floor| self.spring.force_n(floor, z_m, floor.rise_m_per_s);
            floors.iter().map(one).sum()
        };
        let mut down_m = 1e-6;
        while force_n(top_m - down_m) < press_n && down_m < 1.0 {
            down_m *= 4.0;
        }
        if down_m >= 1.0 || press_n <= 0.0 {
            return top_m;
        }
        bisected([top_m - down_m, top_m], HALVINGS, |z_m| {
            force_n(z_m) >= press_n
        })
    }

    /// What friction holds a tip with over a step, under a load at a place.
    pub(super) fn hold(
        &self,
        (load_n, u_mm): (f64, f64),
        velocity_m_per_s: [f64; 2],
        step_s: f64,
    ) -> Hold {
        let load_n = if self.law.parts == ForceParts::Normal {
            0.0
        } else {
            load_n
        };
        let place = (load_n, u_mm);
        self.bristles
            .hold(&self.friction, place, velocity_m_per_s, step_s)
    }

    /// The friction of the moment under a load, N.
    pub(super) fn friction_n(&self, load: &Load) -> f64 {
        if load.normal_n > 0.0 {
            self.bristles.size_n()
        } else {
            0.0
        }
    }

    /// Rubs for a step, and gives the friction at its end, N.
    pub(super) fn rub(&mut self, hold: &Hold, velocity_m_per_s: [f64; 2], step_s: f64) -> [f64; 2] {
        self.bristles
            .bend(&self.friction, hold, velocity_m_per_s, step_s)
    }
}
