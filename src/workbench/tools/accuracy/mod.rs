//! How accurate the running method is and what it costs: ticks checked against `reference` while
//! somebody looks, the cost of every tick, and every method measured on this very scene.
//!
//! ```text
//! snapshot ─▶ sample ─▶ bounded queue ─▶ thread: reference, error ─▶ latest view ─▶ pane
//! ```
//!
//! Nothing is sampled while the pane is hidden. A tick is checked only when the snapshot shows all
//! commands that were sent, so that a slider on its way is never taken for an error.

pub(crate) mod checker;
pub(crate) mod dispatch;
pub(crate) mod measuring;
#[cfg(test)]
mod tests;
pub(crate) mod view;
pub(crate) mod worker;

pub(crate) use crate::tools::accuracy::checker::ErrorView;
#[cfg(test)]
pub(crate) use crate::tools::accuracy::checker::ROUNDING_DB;
pub(crate) use crate::tools::accuracy::measuring::Measured;
pub(crate) use crate::tools::accuracy::measuring::Measuring;

use std::sync::Arc;

use crate::tools::accuracy::checker::{Checker, Setting, TickSample};
use crate::tools::accuracy::worker::Checking;

use crate::bench::Bench;
use crate::bench::command::Command;
use crate::bench::job::Polled;
use crate::bench::rendering::Rendering;
use selvedge_engine::{ClockView, DurationHistogram, Snapshot};
use selvedge_foundation::geometry::Velocity;
use selvedge_render::array::Method;
use selvedge_render::scene::Pose;
use selvedge_studies::ReportError;

/// What can be done about accuracy.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum AccuracyCommand {
    /// Render by this method.
    Method(Method),
    /// The level error that `auto` and `table` may make, dB.
    Budget(f64),
    /// Begin the statistics of errors and costs anew.
    Reset,
    /// Measure every method on this scene.
    Measure,
    /// Stop measuring.
    StopMeasuring,
    /// Show the methods instead of errors and costs where there is no room for both, or no longer.
    ToggleMethods,
    /// Say in words what a measured method is, by its row, or no longer.
    Choose(Option<usize>),
}

impl From<AccuracyCommand> for Command {
    fn from(command: AccuracyCommand) -> Self {
        Self::Accuracy(command)
    }
}

/// Ticks that were seen.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) struct Tally {
    /// Handed on to be checked.
    pub sampled: u64,
    /// Left out because earlier ones still waited.
    pub busy: u64,
    /// Left out because the scene or a gain was on its way.
    pub changed: u64,
}

/// What the engine's clock says since the statistics began.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) struct CostView {
    /// Wall time of every tick.
    pub costs: DurationHistogram,
    /// Ticks that began more than 1 ms late.
    pub late: u64,
    /// Ticks that never were.
    pub missed: u64,
}

/// What the statistics are of: method, bound, opened scene.
type Run = (Method, u64, u64);

/// What the window remembers of accuracy.
#[derive(Default)]
pub(crate) struct AccuracyWatch {
    checking: Option<Checking>,
    setting: Option<Arc<Setting>>,
    run: (u64, Option<Run>),
    /// The last tick that was looked at: scene, gains, pose.
    last: Option<(u64, u64, Pose)>,
    tally: Tally,
    found: ErrorView,
    clock: ClockView,
    before: ClockView,
    bound_db: f64,
    /// A measurement at work.
    pub measuring: Option<Measuring>,
    /// The last one that came to its end.
    pub measured: Option<Measured>,
    /// The row of it that is told in words.
    pub chosen: Option<usize>,
    /// Whether methods are shown where there is no room for all.
    pub(crate) shows_methods: bool,
}

/// What the pane draws.
#[derive(Debug)]
pub(crate) struct AccuracyView<'a> {
    /// What the user chose.
    pub rendering: Rendering,
    /// Whether that is still on its way to the engine.
    pub(crate) is_preparing: bool,
    /// The method that runs; `None` before the first tick.
    pub method: Option<Method>,
    /// Bound of its level error, dB.
    pub bound_db: f64,
    /// Errors found.
    pub found: &'a ErrorView,
    /// Ticks seen.
    pub tally: Tally,
    /// What ticks cost.
    pub cost: CostView,
    /// How far a measurement is, 0…1.
    pub measuring: Option<f32>,
    /// The last measurement.
    pub measured: Option<&'a Measured>,
    /// Whether the scene has changed since.
    pub(crate) is_outdated: bool,
    /// The row of it that is told in words.
    pub chosen: Option<usize>,
    /// Whether methods are shown where there is no room for all.
    pub(crate) shows_methods: bool,
}

impl AccuracyWatch {
    /// Begins the statistics anew.
    pub(crate) fn reset(&mut self) {
        self.run.0 += 1;
        self.last = None;
        self.tally = Tally::default();
        self.before = self.clock;
    }

    /// Ticks that were seen.
    pub(crate) fn tally(&self) -> Tally {
        self.tally
    }

    /// Errors found in this run; none of those before.
    pub(crate) fn found(&mut self) -> &ErrorView {
        if let Some(checking) = &mut self.checking {
            self.found = checking.found();
        }
        if self.found.run != self.run.0 {
            self.found = ErrorView::default();
        }
        &self.found
    }

    fn cost(&self) -> CostView {
        CostView {
            costs: self.clock.costs.since(&self.before.costs),
            late: self.clock.late.saturating_sub(self.before.late),
            missed: self.clock.missed.saturating_sub(self.before.missed),
        }
    }

    /// Takes what the engine says of itself; another method, bound or scene begins anew.
    fn follow(&mut self, snapshot: &Snapshot, n_scenes: u64) {
        self.clock = snapshot.clock;
        self.bound_db = snapshot.rendering.bound.level_db;
        let run = (snapshot.rendering.method, self.bound_db.to_bits(), n_scenes);
        if self.run.1.replace(run) != Some(run) {
            self.reset();
        }
    }

    /// Whether a tick is new, and shows anything: at rest everything is silent.
    fn is_worth_it(&mut self, snapshot: &Snapshot) -> bool {
        let pose = snapshot.rendered;
        let seen = (snapshot.scene_serial, snapshot.revision, pose);
        let is_new = self.last.replace(seen) != Some(seen);
        is_new && (pose.velocity != Velocity::ZERO || pose.angular_rad_per_s != 0.0)
    }
}

impl Bench {
    /// Looks at the tick that the engine did last, and lets it be checked. To be called while the
    /// pane is drawn.
    pub(crate) fn watch_accuracy(&mut self) {
        let n_sent = self.engine.commands_sent();
        let is_felt = self.transient.mute_solo.contactor_mask(self.n_contactors());
        let snapshot = self.engine.snapshot();
        let watch = &mut self.transient.accuracy;
        watch.follow(snapshot, self.inspection.n_scenes);
        if !watch.is_worth_it(snapshot) {
            return;
        }
        let scene = &self.inspection.scene;
        let is_settled = snapshot.counters.commands_obeyed == n_sent
            && snapshot.scene_serial == self.scene_serial
            && snapshot.rendering.tuning == scene.tuning;
        if !is_settled {
            watch.tally.changed += 1;
            return;
        }
        let n_edits = self.inspection.n_edits;
        let known = watch.setting.take().filter(|s| s.is_of(scene, n_edits));
        let setting = known.unwrap_or_else(|| {
            let scene = scene.clone();
            Arc::new(Setting { scene, n_edits })
        });
        watch.setting = Some(Arc::clone(&setting));
        let amplitudes = |display: &selvedge_engine::DisplayView| {
            let contactors = display.contactors.iter();
            contactors.map(|contactor| contactor.amplitude_um).collect()
        };
        let sample = TickSample {
            run: watch.run.0,
            setting,
            pose: snapshot.rendered,
            is_felt,
            displays_um: snapshot.displays.iter().map(amplitudes).collect(),
        };
        if watch.checking.is_none() {
            watch.checking = if self.is_stepped {
                Some(Checking::AtOnce(Box::<Checker>::default()))
            } else {
                Checking::start(&self.ctx).ok()
            };
        }
        let checking = watch.checking.as_mut();
        if checking.is_some_and(|checking| checking.take(sample)) {
            watch.tally.sampled += 1;
        } else {
            watch.tally.busy += 1;
        }
    }

    /// What the pane draws.
    pub(crate) fn accuracy_view(&mut self) -> AccuracyView<'_> {
        let watch = &mut self.transient.accuracy;
        watch.found();
        let measured = watch.measured.as_ref();
        AccuracyView {
            rendering: self.settings.preferences.rendering,
            is_preparing: self.preparing.is_busy(),
            method: watch.run.1.map(|(method, ..)| method),
            bound_db: watch.bound_db,
            found: &watch.found,
            tally: watch.tally,
            cost: watch.cost(),
            measuring: watch.measuring.as_ref().map(Measuring::share),
            measured,
            is_outdated: measured.is_some_and(|m| m.n_edits != self.inspection.n_edits),
            chosen: watch.chosen,
            shows_methods: watch.shows_methods,
        }
    }

    /// Takes what a measurement found, if it is over.
    pub(crate) fn poll_measuring(&mut self) {
        let watch = &mut self.transient.accuracy;
        match watch.measuring.as_ref().map(Measuring::poll) {
            None | Some(Polled::Working) => return,
            Some(Polled::Done(Ok(measured))) => {
                watch.chosen = measured.running();
                watch.measured = Some(measured);
            }
            Some(Polled::Done(Err(ReportError::Cancelled))) => {}
            Some(Polled::Done(Err(error))) => {
                let words = format!("The scene was not measured: {error}");
                self.transient.notices.give(words);
            }
            Some(Polled::BrokeOff) => {
                let words = "Measuring the scene broke off; please report the scene";
                self.transient.notices.give(words);
            }
        }
        self.transient.accuracy.measuring = None;
    }
}

impl std::fmt::Debug for AccuracyWatch {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("AccuracyWatch")
            .field("tally", &self.tally)
            .finish_non_exhaustive()
    }
}
