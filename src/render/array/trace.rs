//! Why a contactor does what it does: every number between its place and its amplitudes.
//!
//! For inspection, off the real-time path: a trace allocates, and computes as `reference` does. Its
//! contacts, points and components are those that the renderer finds.

use serde::Serialize;

use super::reading::Reading;
use super::reference::{amplitudes_of, bin_frequency_hz};
use crate::RenderScene;
use crate::gains::{GainTerms, Gains};
use crate::plan::{
    Axis, Component, Contacts, Counters, DisplayPlan, ScenePlan, TextilePlan, finite_pose,
};
use crate::scene::Pose;
use selvedge_foundation::geometry::Point;
use selvedge_textile::surface::{BIN_SPACING_PER_MM, Direction};
use selvedge_textile::tactile::{Band, Filters, MAX_FREQUENCY_HZ};

/// Explains the contactors of a scene: prepared once, asked as often as one likes.
#[derive(Debug, Clone)]
pub struct ContactInspector {
    pub(super) plan: ScenePlan,
    pub(super) displays: Vec<DisplayPlan>,
    pub(super) gains: Gains,
    pub(super) filters: Filters,
}

/// One bin of the vibration that arrives at a contactor: surface heights, before filters and gains.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct VibrationBin {
    /// Where it sounds, Hz; below 1 kHz.
    pub frequency_hz: f64,
    /// From one bin of its direction to the next, Hz: its power lies half that far to either side.
    pub spacing_hz: f64,
    /// Its power, µm²: a sinusoid's amplitude is `√(2 Σ P)`.
    pub power_um2: f64,
}

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
    /// The nearest point of the spectra of every direction, felt or not.
    pub points: [usize; 4],
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
    /// The nearest point of its spectra.
    pub point: usize,
    /// `[Σ P H_40², Σ P H_320²]` over the bins below 1 kHz, µm².
    pub band_powers_um2: [f64; 2],
    /// Every bin up to the surface's Nyquist wavenumber, also those that are not heard.
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

impl ContactInspector {
    /// An inspector of a scene, with the gains of its tuning.
    pub fn new(scene: &RenderScene) -> Self {
        Self {
            plan: ScenePlan::of(scene),
            displays: scene.displays.iter().map(DisplayPlan::new).collect(),
            gains: Gains::of(scene),
            filters: scene.filters,
        }
    }

    /// Takes the gains of a scene that is the same but for them.
    pub fn set_gains(&mut self, scene: &RenderScene) {
        self.gains = Gains::of(scene);
    }

    /// The trace of a contactor of a display at a pose; `None` when there is no such contactor or
    /// the pose's place is not finite. A motion that is not finite counts as rest.
    pub fn trace(&mut self, display: usize, contactor: usize, pose: &Pose) -> Option<ContactTrace> {
        let array = self.displays.get_mut(display)?;
        let offset = array.offset(contactor)?;
        let mut counters = Counters::default();
        let pose = finite_pose(pose, &mut counters)?;
        let rotation = array.begin(pose.angle_deg, &mut counters);
        let how = (&self.gains, &self.filters);
        let touch = at_contact(&self.plan, array, contactor, &pose, |contacts| {
            touch_of(&self.plan, contacts, contactor, how)
        });
        Some(ContactTrace {
            position: pose.position + rotation.turn(offset),
            amplitudes_um: touch.as_ref().map_or([0.0; 2], Touch::amplitudes_um),
            touch,
        })
    }

    /// Writes the bins below 1 kHz that arrive at a contactor of a display at a pose, those of the
    /// warp before those of the weft, each rising in frequency. None when there is no such
    /// contactor, it lies outside, or it does not move. Allocates nothing once `bins` has grown.
    pub fn vibration_into(
        &mut self,
        display: usize,
        contactor: usize,
        pose: &Pose,
        bins: &mut Vec<VibrationBin>,
    ) {
        bins.clear();
        let mut counters = Counters::default();
        let array = self.displays.get_mut(display);
        let array = array.filter(|array| contactor < array.n_contactors());
        let Some((array, pose)) = array.zip(finite_pose(pose, &mut counters)) else {
            return;
        };
        array.begin(pose.angle_deg, &mut counters);
        at_contact(&self.plan, array, contactor, &pose, |contacts| {
            let textile = &self.plan.textiles[contacts.textile];
            for axis in Axis::BOTH {
                let felt = contacts.feel(textile, axis, contactor, &mut counters);
                let Some(feel) = felt else { continue };
                let powers_um2 = self.plan.pool[feel.spectra].powers_um2(feel.point);
                let bin = |(k, &power_um2)| VibrationBin {
                    frequency_hz: bin_frequency_hz(feel.speed_mm_per_s, k),
                    spacing_hz: bin_frequency_hz(feel.speed_mm_per_s, 1),
                    power_um2,
                };
                let is_heard = |bin: &VibrationBin| bin.frequency_hz < MAX_FREQUENCY_HZ;
                bins.extend((1..).zip(powers_um2).map(bin).take_while(is_heard));
            }
        });
    }
}

/// What `explain` makes of the contacts with the textile that a contactor touches; `None` outside
/// every textile.
fn at_contact<T>(
    plan: &ScenePlan,
    display: &mut DisplayPlan,
    contactor: usize,
    pose: &Pose,
    mut explain: impl FnMut(&Contacts<'_>) -> T,
) -> Option<T> {
    let (mut counters, mut explained) = (Counters::default(), None);
    plan.for_each_touched(display, pose, &mut counters, |contacts, _| {
        if contacts.owns(contactor) {
            explained = Some(explain(contacts));
        }
    });
    explained
}

impl ContactTrace {
    /// The trace of a contactor of a display at a pose; `None` when there is no such contactor or
    /// the pose's place is not finite. The gains are those of the scene's tuning.
    ///
    /// For one question: who asks more often prepares a [`ContactInspector`].
    pub fn of(scene: &RenderScene, display: usize, contactor: usize, pose: &Pose) -> Option<Self> {
        ContactInspector::new(scene).trace(display, contactor, pose)
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
    let reading = Reading::of(plan, contacts, contactor);
    let directions = Axis::BOTH.map(|axis| match contacts.component(axis, contactor) {
        Component::Felt {
            speed_mm_per_s,
            is_reverse,
        } => {
            let direction = axis.direction(is_reverse);
            let point = reading.points[direction.index()];
            let at = (direction, point, speed_mm_per_s);
            Some(DirectionTrace::of(plan, textile, at, filters))
        }
        Component::AtRest | Component::TooFast => None,
    });
    Touch {
        textile: contacts.textile,
        place_mm: reading.place_mm,
        velocity_mm_per_s: reading.velocity_mm_per_s,
        points: reading.points,
        directions,
        gains: Band::ALL.map(|band| gains.terms(contacts.textile, band)),
    }
}

impl DirectionTrace {
    fn of(
        plan: &ScenePlan,
        textile: &TextilePlan,
        (direction, point, speed_mm_per_s): (Direction, usize, f64),
        filters: &Filters,
    ) -> Self {
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
