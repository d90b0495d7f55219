//! What is known of accuracy: ticks that are sampled while somebody looks, the cost of every tick,
//! and every method measured on this very scene.

use std::sync::Arc;

use crate::bench::Bench;
use crate::bench::background::{Task, finished};
use crate::tools::accuracy::checker::{Checker, ErrorView, Setting, TickSample};
use crate::tools::accuracy::measuring::{Measured, Wanted, measure};
use crate::tools::accuracy::worker::Checking;
use selvedge_engine::{ClockView, DurationHistogram, Snapshot};
use selvedge_foundation::geometry::Velocity;
use selvedge_foundation::progress::Progress;
use selvedge_render::array::Method;
use selvedge_render::scene::Pose;
use selvedge_studies::Effort;

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
pub(crate) struct Accuracy {
    checking: Option<Checking>,
    setting: Option<Arc<Setting>>,
    run: (u64, Option<Run>),
    /// The last tick that was looked at: scene, gains, pose.
    last: Option<(u64, u64, Vec<Pose>)>,
    /// Ticks that were seen.
    pub(crate) tally: Tally,
    found: ErrorView,
    clock: ClockView,
    before: ClockView,
    /// Bound of the level error of the method that runs, dB.
    pub(crate) bound_db: f64,
    /// A measurement at work.
    pub measuring: Option<Task<Measured>>,
    /// The last one that came to its end.
    pub measured: Option<Measured>,
    /// The row of it that is told in words.
    pub chosen: Option<usize>,
    /// Whether methods are shown where there is no room for all.
    pub(crate) shows_methods: bool,
}

impl Accuracy {
    /// Begins the statistics anew.
    pub(crate) fn reset(&mut self) {
        self.run.0 += 1;
        self.last = None;
        self.tally = Tally::default();
        self.before = self.clock;
    }

    /// Takes the errors found in this run; none of those before.
    pub(crate) fn take_found(&mut self) {
        if let Some(checking) = &mut self.checking {
            self.found = checking.found();
        }
        if self.found.run != self.run.0 {
            self.found = ErrorView::default();
        }
    }

    /// Errors found in this run.
    pub(crate) fn found(&self) -> &ErrorView {
        &self.found
    }

    /// The method that runs; `None` before the first tick.
    pub(crate) fn method(&self) -> Option<Method> {
        self.run.1.map(|(method, ..)| method)
    }

    /// What ticks cost in this run.
    pub(crate) fn cost(&self) -> CostView {
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
        let poses = poses(snapshot);
        let moves = |pose: &Pose| pose.velocity != Velocity::ZERO || pose.angular_rad_per_s != 0.0;
        let is_moving = poses.iter().any(moves);
        let seen = (snapshot.scene_serial, snapshot.revision, poses);
        let is_new = self.last.as_ref() != Some(&seen);
        self.last = Some(seen);
        is_new && is_moving
    }

    /// Looks at the tick that the engine did last, and lets it be checked. To be called while the
    /// pane is drawn.
    pub(crate) fn watch(&mut self, bench: &mut Bench) {
        let n_sent = bench.engine.commands_sent();
        let mute_solo = &bench.selection.mute_solo;
        let is_felt = mute_solo.contactor_mask(bench.n_contactors());
        let snapshot = bench.engine.snapshot();
        self.follow(snapshot, bench.inspection.n_scenes);
        if !self.is_worth_it(snapshot) {
            return;
        }
        let scene = &bench.inspection.scene;
        let is_settled = snapshot.counters.commands_obeyed == n_sent
            && snapshot.scene_serial == bench.engine_scene.serial
            && snapshot.rendering.tuning == scene.tuning
            // Neither a stylus nor a cloth that hangs is a rendering of the array on the scene.
            && snapshot.stylus.is_none()
            && !snapshot.rendering.is_cloth;
        if !is_settled {
            self.tally.changed += 1;
            return;
        }
        let n_edits = bench.inspection.n_edits;
        let known = self.setting.take().filter(|s| s.is_of(scene, n_edits));
        let setting = known.unwrap_or_else(|| {
            let scene = scene.clone();
            Arc::new(Setting { scene, n_edits })
        });
        self.setting = Some(Arc::clone(&setting));
        let amplitudes = |display: &selvedge_engine::DisplayView| {
            let contactors = display.contactors.iter();
            contactors.map(|contactor| contactor.amplitude_um).collect()
        };
        let sample = TickSample {
            run: self.run.0,
            setting,
            poses: poses(snapshot),
            is_felt,
            displays_um: snapshot.displays.iter().map(amplitudes).collect(),
        };
        if self.checking.is_none() {
            self.checking = if bench.is_stepped() {
                Some(Checking::AtOnce(Box::<Checker>::default()))
            } else {
                Checking::start(&bench.ctx).ok()
            };
        }
        let checking = self.checking.as_mut();
        if checking.is_some_and(|checking| checking.take(sample)) {
            self.tally.sampled += 1;
        } else {
            self.tally.busy += 1;
        }
    }

    /// Measures every method on the scene as it is felt now.
    pub(crate) fn measure(&mut self, bench: &Bench) {
        let wanted = Wanted {
            name: bench.document.scene().name.clone(),
            scene: bench.inspection.scene.clone(),
            path: bench
                .exploration
                .at_hand
                .as_ref()
                .map(|take| Arc::clone(take.path())),
            rendering: bench.engine_scene.rendering,
            n_edits: bench.inspection.n_edits,
        };
        let effort = if bench.is_stepped() {
            Effort::Quick
        } else {
            Effort::Full
        };
        let work = move |progress: &mut Progress<'_>| {
            measure(wanted, effort, progress).map_err(|error| error.to_string())
        };
        self.measuring = Some(bench.executor.start("selvedge-measure", work));
    }

    /// Takes what a measurement found, if it is over.
    pub(crate) fn poll_measuring(&mut self, bench: &mut Bench) {
        match finished(&mut self.measuring) {
            Some(Ok(measured)) => {
                self.chosen = measured.running();
                self.measured = Some(measured);
            }
            Some(Err(error)) => {
                let words = format!("The scene was not measured: {error}");
                bench.notices.give(words);
            }
            None => {}
        }
    }
}

/// The pose of every display that was rendered.
fn poses(snapshot: &Snapshot) -> Vec<Pose> {
    let displays = snapshot.displays.iter();
    displays.map(|display| display.rendered).collect()
}

#[cfg(test)]
mod tests;
