//! Every method on the scene at hand, measured on demand: a thread with progress, and what it
//! found.

use std::sync::Arc;
use std::sync::atomic::{AtomicU32, Ordering};
use std::time::Duration;

use eframe::egui;

use crate::app::job::{Job, Polled};
use crate::app::rendering::Rendering;
use crate::progress::{CancelFlag, Progress};
use crate::render::RenderScene;
use crate::report::{
    Bench, Effort, Findings, ReportError, Row, Running, Study as _, ThisSceneStudy, pareto,
};
use crate::scene::{ExplorationPath, Pose};

/// What random numbers would begin with; there are none.
const SEED: u64 = 1;
/// Ticks of an exploration that are handed on at most; the study takes still fewer.
const MOST_TICKS: u64 = 600;
/// Progress is drawn this often.
const NEWS: Duration = Duration::from_millis(100);

/// What is measured.
pub(crate) struct Wanted {
    /// What people call the scene.
    pub(crate) name: String,
    /// The scene with the gains in force.
    pub(crate) scene: RenderScene,
    /// The exploration to measure along; without one every textile is crossed.
    pub(crate) path: Option<Arc<ExplorationPath>>,
    /// How the scene is rendered.
    pub(crate) rendering: Rendering,
    /// The change of the scene that it is of.
    pub(crate) n_edits: u64,
}

/// A measurement at work.
#[derive(Debug)]
pub(crate) struct Measuring {
    job: Job<Result<Measured, ReportError>>,
    cancel: CancelFlag,
    done_permille: Arc<AtomicU32>,
}

/// A measurement that is over.
#[derive(Debug, Clone, Default)]
pub(crate) struct Measured {
    /// A row a method.
    pub(crate) rows: Vec<Row>,
    /// Whether nothing beats a row in both error and cost.
    pub(crate) front: Vec<bool>,
    /// Along what it was measured.
    pub(crate) note: String,
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
        let (cancel, done_permille) = (CancelFlag::new(), Arc::new(AtomicU32::new(0)));
        let (flag, done, waker) = (cancel.clone(), Arc::clone(&done_permille), ctx.clone());
        let work = move || {
            let mut heard = |share: f64, _: &str| {
                #[expect(
                    clippy::cast_possible_truncation,
                    clippy::cast_sign_loss,
                    reason = "a share of 1000"
                )]
                done.store((1000.0 * share) as u32, Ordering::Relaxed);
                waker.request_repaint_after(NEWS);
            };
            measure(wanted, effort, &mut Progress::new(&mut heard, flag))
        };
        Ok(Self {
            job: Job::start("selvedge-measure", ctx, work)?,
            cancel,
            done_permille,
        })
    }

    /// How far it is, 0…1.
    pub(crate) fn share(&self) -> f32 {
        let permille = self.done_permille.load(Ordering::Relaxed).min(1000);
        u16::try_from(permille).map_or(1.0, |permille| f32::from(permille) / 1000.0)
    }

    /// Asks it to stop.
    pub(crate) fn stop(&self) {
        self.cancel.cancel();
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
