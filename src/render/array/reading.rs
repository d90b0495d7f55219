//! Which points all contactors of a display read, and how they move: a trace's beginning, cheap
//! enough to be drawn with every frame.

use super::trace::ContactInspector;
use crate::plan::{Axis, Component, Contacts, Counters, ScenePlan, finite_pose, nearest_mm};
use crate::scene::Pose;
use selvedge_foundation::geometry::{Point, Velocity};
use selvedge_textile::surface::Direction;

/// A contactor as it moves over the workspace.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ContactorReading {
    /// Where it is in the workspace.
    pub position: Point,
    /// Its own velocity in the workspace: v + ω × r.
    pub velocity: Velocity,
    /// What it reads; `None` outside every textile.
    pub reading: Option<Reading>,
}

/// Where a contactor reads a textile.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Reading {
    /// The textile's place in the scene's list.
    pub textile: usize,
    /// Its place along the warp (u) and the weft (w), mm.
    pub place_mm: [f64; 2],
    /// The whole millimetres along warp and weft nearest to that place: where the points that it
    /// reads lie on the cloth. Which points they are repeats with each profile's length.
    pub nearest_mm: [f64; 2],
    /// Its velocity components along warp and weft, mm/s.
    pub velocity_mm_per_s: [f64; 2],
    /// The nearest point of the profile of every direction, felt or not.
    pub points: [usize; 4],
    /// The directions that are felt along warp and weft.
    pub directions: [Option<Direction>; 2],
}

impl Reading {
    /// What a contactor reads by the contacts that the renderer finds.
    pub(super) fn of(plan: &ScenePlan, contacts: &Contacts<'_>, contactor: usize) -> Self {
        let textile = &plan.textiles[contacts.textile];
        let place_mm = Axis::BOTH.map(|axis| contacts.places_mm[axis as usize][contactor]);
        Self {
            textile: contacts.textile,
            place_mm,
            nearest_mm: place_mm.map(|mm| f64::from(nearest_mm(mm))),
            velocity_mm_per_s: contacts.velocity_mm_per_s(contactor),
            points: Direction::ALL.map(|direction| {
                let along = direction.index() / 2;
                let grid = textile.points[direction.index()];
                grid.nearest(place_mm[along], place_mm[1 - along])
            }),
            directions: Axis::BOTH.map(|axis| match contacts.component(axis, contactor) {
                Component::Felt { is_reverse, .. } => Some(axis.direction(is_reverse)),
                Component::AtRest | Component::TooFast => None,
            }),
        }
    }
}

impl ContactInspector {
    /// Writes where every contactor of a display reads, and how it moves, at a pose; none when
    /// there is no such display or the pose's place is not finite. A motion that is not finite
    /// counts as rest. Allocates nothing once `readings` has grown.
    pub fn readings_into(
        &mut self,
        display: usize,
        pose: &Pose,
        readings: &mut Vec<ContactorReading>,
    ) {
        readings.clear();
        let mut counters = Counters::default();
        let array = self.displays.get_mut(display);
        let Some((array, pose)) = array.zip(finite_pose(pose, &mut counters)) else {
            return;
        };
        let rotation = array.begin(pose.angle_deg, &mut counters);
        let offsets = (0..array.n_contactors()).map_while(|contactor| array.offset(contactor));
        readings.extend(offsets.map(|offset| {
            let turned = rotation.turn(offset);
            ContactorReading {
                position: pose.position + turned,
                velocity: pose.velocity.at_offset(turned, pose.angular_rad_per_s),
                reading: None,
            }
        }));
        let plan = &self.plan;
        plan.for_each_touched(array, &pose, &mut counters, |contacts, _| {
            contacts.for_each_owned(readings, |contactor, reading| {
                reading.reading = Some(Reading::of(plan, contacts, contactor));
            });
        });
    }
}
