//! Every method on the scene at hand, measured on demand: a thread with progress, and what it
//! found.

use std::sync::Arc;

use eframe::egui;

use crate::bench::job::{Job, Polled};
use crate::bench::rendering::Rendering;
use crate::bench::task::Watch;
use selvedge_foundation::progress::Progress;
use selvedge_render::RenderScene;
use selvedge_render::scene::{ExplorationPath, Pose};
use selvedge_studies::{
    Bench, Effort, Findings, ReportError, Row, Running, ThisSceneStudy, pareto,
};

/// What random numbers would begin with; there are none.
const SEED: u64 = 1;
/// Ticks of an exploration that are handed on at most; the study takes still fewer.
const MOST_TICKS: u64 = 600;

/// What is measured.
pub(crate) struct Wanted {
    /// What people call the scene.
    pub name: String,
    /// The scene with the gains in force.
    pub scene: RenderScene,
    /// The exploration to measure along; without one every textile is crossed.
    pub path: Option<Arc<ExplorationPath>>,
    /// How the scene is rendered.
    pub rendering: Rendering,
    /// The change of the scene that it is of.
    pub(crate) n_edits: u64,
}

/// A measurement at work.
#[derive(Debug)]
pub(crate) struct Measuring {
    job: Job<Result<Measured, ReportError>>,
    watch: Watch,
}

/// A measurement that is over.
#[derive(Debug, Clone, Default)]
pub(crate) struct Measured {
    /// A row a method.
    pub rows: Vec<Row>,
    /// Whether nothing beats a row in both error and cost.
    pub front: Vec<bool>,
    /// Along what it was measured.
    pub note: String,
    /// The change of the scene that it is of.
    pub(crate) n_edits: u64,
}

impl Measured {
    fn of(findings: Findings, n_edits: u64) -> Self {
        let front = pareto(&findings.rows);
        Self {
            front: front.iter().map(|front| *front == Some(true)).collect(),
            rows: findings.rows,
            note: findings.notes.join(" "),
            n_edits,
        }
    }

    /// The row of the method that ran.
    pub(crate) fn running(&self) -> Option<usize> {
        self.rows.iter().position(ThisSceneStudy::is_running)
    }
}

impl Measuring {
    /// Begins to measure; `ctx` is woken as it goes on.
    ///
    /// # Errors
    /// The system gives no thread.
    pub(crate) fn start(
        wanted: Wanted,
        effort: Effort,
        ctx: &egui::Context,
    ) -> std::io::Result<Self> {
        let watch = Watch::default();
        let (own, waker) = (watch.clone(), ctx.clone());
        let work = move || own.over(&waker, |progress| measure(wanted, effort, progress));
        Ok(Self {
            job: Job::start("selvedge-measure", ctx, work)?,
            watch,
        })
    }

    /// How far it is, 0…1.
    pub(crate) fn share(&self) -> f32 {
        self.watch.share()
    }

    /// Asks it to stop.
    pub(crate) fn stop(&self) {
        self.watch.stop();
    }

    /// What it found, once it is over.
    pub(crate) fn poll(&self) -> Polled<Result<Measured, ReportError>> {
        self.job.poll()
    }
}

impl Drop for Measuring {
    fn drop(&mut self) {
        self.stop();
    }
}

fn measure(
    wanted: Wanted,
    effort: Effort,
    progress: &mut Progress<'_>,
) -> Result<Measured, ReportError> {
    let study = ThisSceneStudy {
        name: wanted.name,
        scene: wanted.scene,
        poses: wanted.path.map_or_else(Vec::new, |path| poses_of(&path)),
        running: Running {
            method: wanted.rendering.method,
            accuracy: wanted.rendering.accuracy(),
        },
    };
    let findings = study.run(&mut Bench::new(effort, SEED, progress))?;
    Ok(Measured::of(findings, wanted.n_edits))
}

/// Ticks spread evenly over an exploration.
fn poses_of(path: &ExplorationPath) -> Vec<Pose> {
    let step = usize::try_from(path.n_ticks().div_ceil(MOST_TICKS)).unwrap_or(usize::MAX);
    let ticks = path.ticks().step_by(step.max(1));
    ticks.map(|(_, pose)| pose).collect()
}
