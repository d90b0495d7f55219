//! Why a contactor does what it does: every number between its place and its amplitudes.
//!
//! For inspection, off the real-time path: it allocates, and computes as `reference` does.

use serde::Serialize;

use super::reference::{amplitudes_of, bin_frequency_hz};
use crate::geometry::Point;
use crate::render::RenderScene;
use crate::render::gains::{GainTerms, Gains};
use crate::render::plan::{Axis, Component, Contacts, DisplayPlan, ScenePlan, TextilePlan};
use crate::scene::Pose;
use crate::surface::{BIN_SPACING_PER_MM, Direction};
use crate::tactile::{Band, Filters, MAX_FREQUENCY_HZ};

/// One contactor at one tick.
#[derive(Debug, Clone, PartialEq)]
pub struct ContactTrace {
    /// Where it is in the workspace.
    pub position: Point,
    /// What it touches; `None` outside every textile, then it is silent.
    pub touch: Option<Touch>,
    /// `[A40, A320]` after gains, µm.
    pub amplitudes_um: [f64; 2],
}

/// A contactor on a textile.
#[derive(Debug, Clone, PartialEq)]
pub struct Touch {
    /// The textile's place in the scene's list.
    pub textile: usize,
    /// Its place along the warp (u) and the weft (w), mm.
    pub place_mm: [f64; 2],
    /// Its velocity components along warp and weft, mm/s.
    pub velocity_mm_per_s: [f64; 2],
    /// What it feels along warp and weft; `None` where the component is not felt.
    pub directions: [Option<DirectionTrace>; 2],
    /// The terms of its gain, by band.
    pub gains: [GainTerms; 2],
}

/// The spectrum that a contactor feels along warp or weft.
#[derive(Debug, Clone, PartialEq)]
pub struct DirectionTrace {
    /// Which of the four.
    pub direction: Direction,
    /// The nearest point of its profile.
    pub point: usize,
    /// `[Σ P H_40², Σ P H_320²]` over the bins below 1 kHz, µm².
    pub band_powers_um2: [f64; 2],
    /// Every bin, also those that are not heard.
    pub bins: Vec<BinTrace>,
}

/// One bin of a spectrum at a speed.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct BinTrace {
    /// Its wavenumber, cycles/mm.
    pub wavenumber_per_mm: f64,
    /// Where it sounds, Hz.
    pub frequency_hz: f64,
    /// Its power, µm².
    pub power_um2: f64,
    /// Amplitude gain of the filters at 40 and 320 Hz; 0 at and above 1 kHz.
    pub filter_gains: [f64; 2],
}

impl ContactTrace {
    /// The trace of a contactor of a display at a pose; `None` when there is no such contactor or
    /// the pose's place is not finite. The gains are those of the scene's tuning.
    pub fn of(scene: &RenderScene, display: usize, contactor: usize, pose: &Pose) -> Option<Self> {
        let array = scene.displays.get(display)?;
        let offset = *array.offsets.get(contactor)?;
        let mut counters = crate::render::Counters::default();
        let pose = super::finite_pose(pose, &mut counters)?;
        let plan = ScenePlan::of(scene);
        let mut display = DisplayPlan::new(array);
        let rotation = display.begin(pose.angle_deg);
        let mut trace = Self {
            position: pose.position + rotation.turn(offset),
            touch: None,
            amplitudes_um: [0.0; 2],
        };
        for (number, textile) in plan.textiles.iter().enumerate().rev() {
            let Some(placing) = textile.placing(&display, pose.position) else {
                continue;
            };
            let contacts = display.claim((textile, number), &placing, &pose);
            let Some(contacts) = contacts.filter(|contacts| contacts.owns(contactor)) else {
                continue;
            };
            let gains = Gains::of(scene);
            let touch = touch_of(&plan, &contacts, contactor, (&gains, &scene.filters));
            trace.amplitudes_um = touch.amplitudes_um();
            trace.touch = Some(touch);
            break;
        }
        Some(trace)
    }
}

impl Touch {
    fn amplitudes_um(&self) -> [f64; 2] {
        let mut sums = [0.0; 2];
        for direction in self.directions.iter().flatten() {
            (0..2).for_each(|b| sums[b] += direction.band_powers_um2[b]);
        }
        amplitudes_of(sums, self.gains.map(|terms| terms.factor()))
    }
}

fn touch_of(
    plan: &ScenePlan,
    contacts: &Contacts<'_>,
    contactor: usize,
    (gains, filters): (&Gains, &Filters),
) -> Touch {
    let textile = &plan.textiles[contacts.textile];
    let place_mm = Axis::BOTH.map(|axis| contacts.places_mm[axis as usize][contactor]);
    let directions = Axis::BOTH.map(|axis| match contacts.component(axis, contactor) {
        Component::Felt {
            speed_mm_per_s,
            is_reverse,
        } => {
            let direction = axis.direction(is_reverse);
            let at = (direction, place_mm[axis as usize], speed_mm_per_s);
            Some(DirectionTrace::of(plan, textile, at, filters))
        }
        Component::AtRest | Component::TooFast => None,
    });
    Touch {
        textile: contacts.textile,
        place_mm,
        velocity_mm_per_s: contacts.velocity_mm_per_s(contactor),
        directions,
        gains: Band::ALL.map(|band| gains.terms(contacts.textile, band)),
    }
}

impl DirectionTrace {
    fn of(
        plan: &ScenePlan,
        textile: &TextilePlan,
        (direction, place_mm, speed_mm_per_s): (Direction, f64, f64),
        filters: &Filters,
    ) -> Self {
        let point = textile.points[direction.index()].nearest(place_mm);
        let powers_um2 = plan.pool[textile.spectra[direction.index()]].powers_um2(point);
        let bin = |(k, &power_um2): (usize, &f64)| {
            let frequency_hz = bin_frequency_hz(speed_mm_per_s, k);
            let gain = |band| {
                let is_heard = frequency_hz < MAX_FREQUENCY_HZ;
                if is_heard {
                    filters.gain(band, frequency_hz)
                } else {
                    0.0
                }
            };
            BinTrace {
                wavenumber_per_mm: BIN_SPACING_PER_MM * k as f64,
                frequency_hz,
                power_um2,
                filter_gains: Band::ALL.map(gain),
            }
        };
        let bins: Vec<BinTrace> = (1..).zip(powers_um2).map(bin).collect();
        let band_powers_um2 = [0, 1].map(|b| {
            bins.iter()
                .map(|bin| bin.power_um2 * bin.filter_gains[b].powi(2))
                .sum()
        });
        Self {
            direction,
            point,
            band_powers_um2,
            bins,
        }
    }
}
