//! Amplitudes of a contactor array that moves over textiles.
//!
//! After Philpott and Summers (2012), section 2.2. A contactor at u, w that moves in its
//! textile's frame feels the local spectra P of the nearest points along warp and weft; bin k
//! of a direction d sounds at `f = |v_d|·0.23·k` Hz, below 1 kHz, and
//! `A_b = √(2 Σ_d Σ_k P_{d,k} H_b(f_{d,k})²)` for the bands b at 40 and 320 Hz.
//!
//! Lifecycle: [`ArrayRenderer::prepare`] allocates, [`ArrayRenderer::reset`] clears counters and
//! frames, [`ArrayRenderer::tick`] renders 25 ms and never allocates, locks, logs or fails.

mod auto;
mod banded;
mod bin_gains;
mod drive;
mod frame;
mod method;
mod reading;
mod reference;
mod response;
mod table;
mod trace;

pub use drive::DriveSynth;
pub use frame::DisplayFrame;
pub use method::{Accuracy, ErrorBound, Method, UnknownMethod, unfiltered_um};
pub use reading::{ContactorReading, Reading};
pub use response::{PointSpread, TextileResponse, VelocityMap};
pub use selvedge_foundation::numerics::to_single as single;
pub use trace::{BinTrace, ContactInspector, ContactTrace, DirectionTrace, Touch, VibrationBin};

use banded::BandedEvaluator;
use reference::ReferenceEvaluator;
use table::{Grid, TableEvaluator};

use std::sync::Arc;

use super::gains::Gains;
use super::plan::{Contacts, Counters, DisplayPlan, MaterialContact, ScenePlan, finite_pose};
use super::{PlacedLevel, RenderError, RenderScene};
use crate::scene::{ExplorationPath, Pose};
use selvedge_foundation::geometry::Point;
use selvedge_textile::surface::Surface;
use selvedge_textile::tactile::Tuning;

/// How powers are found.
#[derive(Debug, Clone)]
enum Evaluator {
    Reference(ReferenceEvaluator),
    Banded(Box<BandedEvaluator>),
    Table(Box<TableEvaluator>),
}

/// Renders the amplitudes of every display of a scene, tick by tick.
#[derive(Debug, Clone)]
pub struct ArrayRenderer {
    plan: ScenePlan,
    gains: Gains,
    evaluator: Evaluator,
    method: Method,
    bound: ErrorBound,
    displays: Vec<DisplayPlan>,
    frames: Vec<DisplayFrame>,
    counters: Counters,
}

impl ArrayRenderer {
    /// A renderer of a scene by a method, to be moved live: `auto` is resolved here, from error
    /// bounds known before the first tick and from counts of operations over a minute. Allocates;
    /// takes well below a millisecond for four textiles.
    ///
    /// # Errors
    /// What [`RenderScene::check`] refuses; an accuracy that is no number; tables that would not
    /// fit into memory (never with `auto`).
    pub fn prepare(
        scene: &RenderScene,
        method: Method,
        accuracy: &Accuracy,
    ) -> Result<Self, RenderError> {
        Self::prepare_for(scene, (method, accuracy), None)
    }

    /// The same for the ticks of a path and no others: `auto` is the cheapest for these.
    ///
    /// # Errors
    /// As there.
    pub fn prepare_along(
        scene: &RenderScene,
        method: Method,
        accuracy: &Accuracy,
        path: &ExplorationPath,
    ) -> Result<Self, RenderError> {
        Self::prepare_for(scene, (method, accuracy), Some(path))
    }

    fn prepare_for(
        scene: &RenderScene,
        (method, accuracy): (Method, &Accuracy),
        path: Option<&ExplorationPath>,
    ) -> Result<Self, RenderError> {
        scene.check()?;
        accuracy.check()?;
        let plan = ScenePlan::of(scene);
        let (method, grid) = match method {
            Method::Auto => auto::resolve(scene, &plan, accuracy, path),
            Method::Table => (method, Some(Grid::new(&scene.filters, accuracy.budget_db))),
            Method::Reference | Method::Banded => (method, None),
        };
        let (evaluator, bound) = match (method, &grid) {
            (Method::Table, Some(grid)) => {
                let (table, bound) = TableEvaluator::prepare(&scene.filters, &plan, grid)?;
                (Evaluator::Table(Box::new(table)), bound)
            }
            (Method::Banded, _) => {
                let banded = BandedEvaluator::prepare(&plan, &scene.filters, accuracy.banded_floor);
                (
                    Evaluator::Banded(Box::new(banded)),
                    ErrorBound::of_floor(accuracy.banded_floor),
                )
            }
            _ => {
                let reference = ReferenceEvaluator::prepare(&plan, &scene.filters);
                (Evaluator::Reference(reference), ErrorBound::EXACT)
            }
        };
        let is_exact = !matches!(evaluator, Evaluator::Table(_));
        let frame = |array| DisplayFrame::new(array, is_exact);
        Ok(Self {
            plan,
            gains: Gains::of(scene),
            evaluator,
            method,
            bound,
            displays: scene.displays.iter().map(DisplayPlan::new).collect(),
            frames: scene.displays.iter().map(frame).collect(),
            counters: Counters::default(),
        })
    }

    /// Goes on counting where another renderer is.
    pub fn go_on_from(&mut self, other: &Self) {
        self.counters = other.counters;
    }

    /// Clears counters and frames; tuning and levels stay.
    pub fn reset(&mut self) {
        self.counters = Counters::default();
        self.displays.iter_mut().for_each(DisplayPlan::forget);
        self.frames.iter_mut().for_each(DisplayFrame::silence);
    }

    /// Renders one tick: display i follows pose i; a display without a pose is silent. Returns
    /// one frame per display.
    ///
    /// A pose that holds NaN or infinity is silent and counted.
    pub fn tick(&mut self, poses: &[Pose]) -> &[DisplayFrame] {
        self.counters.ticks += 1;
        self.evaluator.begin_tick();
        for index in 0..self.frames.len() {
            if let Some(pose) = poses.get(index) {
                self.tick_display(index, pose);
            } else {
                self.counters.poses_missing += 1;
                self.displays[index].forget();
                self.frames[index].silence();
            }
        }
        &self.frames
    }

    fn tick_display(&mut self, index: usize, pose: &Pose) {
        let (display, frame) = (&mut self.displays[index], &mut self.frames[index]);
        let Some(pose) = finite_pose(pose, &mut self.counters) else {
            display.forget();
            frame.silence();
            return;
        };
        if !display.stands(&pose, &mut self.counters) {
            self.render_display(index, &pose);
        }
        let display = &self.displays[index];
        self.counters.contactors_inside += display.n_owned as u64;
        self.counters.contactors_outside += (display.n_contactors() - display.n_owned) as u64;
    }

    fn render_display(&mut self, index: usize, pose: &Pose) {
        let (display, frame) = (&mut self.displays[index], &mut self.frames[index]);
        let counters = &mut self.counters;
        frame.begin();
        frame.position = pose.position;
        frame.rotation = display.begin(pose.angle_deg, counters);
        let (plan, evaluator) = (&self.plan, &mut self.evaluator);
        plan.for_each_touched(display, pose, counters, |contacts, counters| {
            let factors = self.gains.factors(contacts.textile);
            evaluator.evaluate(plan, contacts, factors, frame, counters);
        });
        frame.owners.copy_from_slice(&display.owners);
        frame.round();
    }

    /// Renders a tick of one display whose contactors touch one textile (its place in the list)
    /// each by itself, as on a cloth that hangs; those without a contact are silent. Other displays
    /// keep their frames.
    pub fn touch(
        &mut self,
        (display, textile): (usize, usize),
        contacts: &[Option<MaterialContact>],
    ) -> Option<&DisplayFrame> {
        let (plan, frame) = (
            self.displays.get_mut(display)?,
            self.frames.get_mut(display)?,
        );
        self.counters.ticks += 1;
        self.evaluator.begin_tick();
        frame.begin();
        let is_known = textile < self.plan.textiles.len();
        if let Some(contacts) = plan.lay(textile, contacts).filter(|_| is_known) {
            let factors = self.gains.factors(textile);
            let evaluator = &mut self.evaluator;
            evaluator.evaluate(&self.plan, &contacts, factors, frame, &mut self.counters);
        }
        frame.owners.copy_from_slice(&plan.owners);
        frame.round();
        Some(frame)
    }

    /// Silences contactors of one display in the frames of the last tick: those whose place in
    /// `is_felt` holds false.
    pub fn mask_display(&mut self, display: usize, is_felt: &[bool]) {
        if let Some(frame) = self.frames.get_mut(display) {
            frame.mask(is_felt);
        }
    }

    /// The amplitude factors of a textile's gains, by band.
    pub(crate) fn gain_factors(&self, textile: usize) -> [f64; 2] {
        self.gains.factors(textile)
    }

    /// Gives every contactor of one display these amplitudes [A40, A320] in the frames of the last
    /// tick, µm peak, wherever it is.
    pub fn vibrate_display(&mut self, display: usize, amplitude_um: [f32; 2]) {
        if let Some(frame) = self.frames.get_mut(display) {
            frame.vibrate(amplitude_um);
            // The next tick renders anew even where the display stands.
            self.displays[display].forget();
        }
    }

    /// The same with what a source of its own makes of this textile (its place in the list), before
    /// gains, µm peak: they come on top, as on what is rendered.
    pub fn drive_display(&mut self, display: usize, textile: usize, amplitude_um: [f64; 2]) {
        let known = (textile < self.plan.textiles.len()).then(|| self.gains.factors(textile));
        let factors = known.unwrap_or_default();
        let amplitude_um = [0, 1].map(|band| single(factors[band] * amplitude_um[band]));
        self.vibrate_display(display, amplitude_um);
    }

    /// Gives the contactors of one display amplitudes [A40, A320] that something else made, before
    /// the gains of master and bands, µm peak; those beyond the end of the list are silent.
    pub fn give_display(&mut self, display: usize, amplitudes_um: &[[f64; 2]]) {
        let factors = self.gains.plain_factors();
        if let Some(frame) = self.frames.get_mut(display) {
            let tuned = |um: &[f64; 2]| [0, 1].map(|band| factors[band] * um[band]);
            frame.give(amplitudes_um.iter().map(tuned));
            self.displays[display].forget();
        }
    }

    /// The surfaces of the textiles, in the order of the scene's list.
    pub fn surfaces(&self) -> impl ExactSizeIterator<Item = &Arc<Surface>> {
        self.plan.textiles.iter().map(|textile| &textile.surface)
    }

    /// The topmost textile under a point of the workspace (its place in the list), and where that
    /// is along its warp and weft, mm.
    pub fn place_on_textile(&self, at: Point) -> Option<(usize, [f64; 2])> {
        let mut textiles = self.plan.textiles.iter().enumerate().rev();
        textiles.find_map(|(textile, plan)| {
            let place = plan.ground.place_of(at);
            let is_on = at.is_finite() && plan.ground.contains(place.x_mm, place.y_mm);
            is_on.then_some((textile, [place.x_mm, place.y_mm]))
        })
    }

    /// Lets one display feel this textile alone (its place in the list) from the next tick on,
    /// whatever lies upon it; with `None`, each contactor the topmost one beneath it.
    pub fn uncover(&mut self, display: usize, textile: Option<usize>) {
        if let Some(display) = self.displays.get_mut(display) {
            display.uncover(textile);
        }
    }

    /// The frames of the last tick.
    pub fn frames(&self) -> &[DisplayFrame] {
        &self.frames
    }

    /// Takes a new tuning from the next tick on. Recomputes and allocates nothing.
    ///
    /// # Errors
    /// A tuning that makes no sense (NaN, +∞, compression outside 0…1): the last one stays.
    pub fn set_tuning(&mut self, tuning: &Tuning) -> Result<(), RenderError> {
        self.set_gains(tuning, &[])
    }

    /// Takes a tuning and the gains that the scene gives some textiles (place in the list, dB)
    /// together from the next tick on. Recomputes and allocates nothing.
    ///
    /// # Errors
    /// A tuning or gain that makes no sense, or no such textile: all stays as it was.
    pub fn set_gains(
        &mut self,
        tuning: &Tuning,
        textiles_db: &[(usize, f64)],
    ) -> Result<(), RenderError> {
        self.gains.set(tuning, textiles_db)
    }

    /// Takes levels that were pending, one for every placed textile.
    ///
    /// # Errors
    /// Another number of levels than of textiles: nothing changes.
    pub fn set_levels(&mut self, levels: &[PlacedLevel]) -> Result<(), RenderError> {
        self.gains.set_levels(levels)
    }

    /// The tuning that sounds.
    pub fn tuning(&self) -> &Tuning {
        self.gains.tuning()
    }

    /// Whether compression waits for levels; until they come its gain is 0 dB.
    pub fn compression_is_pending(&self) -> bool {
        self.gains.compression_is_pending()
    }

    /// The level that compression leaves alone, dB re 1 µm, once it is known.
    pub fn compression_reference_db(&self) -> Option<f64> {
        self.gains.reference_db()
    }

    /// The method in use: never `auto`, but what it chose.
    pub fn method(&self) -> Method {
        self.method
    }

    /// How far amplitudes may be from `reference`, known before the first tick.
    pub fn bound(&self) -> ErrorBound {
        self.bound
    }

    /// Bytes that powers are found from: spectra, or tables.
    pub fn n_bytes(&self) -> usize {
        let n_spectra: usize = self.plan.pool.iter().map(|spectra| spectra.n_bytes()).sum();
        match &self.evaluator {
            Evaluator::Reference(_) => n_spectra,
            Evaluator::Banded(banded) => n_spectra + banded.n_bytes(),
            Evaluator::Table(table) => table.n_bytes(),
        }
    }

    /// What was evaluated and left out since the last reset.
    pub fn counters(&self) -> &Counters {
        &self.counters
    }
}

impl Evaluator {
    fn begin_tick(&mut self) {
        if let Self::Banded(banded) = self {
            banded.begin_tick();
        }
    }

    fn evaluate(
        &mut self,
        plan: &ScenePlan,
        contacts: &Contacts<'_>,
        factors: [f64; 2],
        frame: &mut DisplayFrame,
        counters: &mut Counters,
    ) {
        match self {
            Self::Reference(reference) => {
                reference.evaluate(plan, contacts, factors, &mut frame.exact_um, counters);
            }
            Self::Banded(banded) => {
                banded.evaluate(plan, contacts, factors, &mut frame.exact_um, counters);
            }
            Self::Table(table) => {
                table.evaluate(plan, contacts, factors, &mut frame.amplitudes_um, counters);
            }
        }
    }
}

#[cfg(test)]
mod tests;
