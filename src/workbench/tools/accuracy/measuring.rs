//! Every method on the scene at hand, measured on demand, and what was found.

use std::sync::Arc;

use crate::bench::rendering::Rendering;
use selvedge_foundation::progress::Progress;
use selvedge_render::RenderScene;
use selvedge_render::scene::{ExplorationPath, Pose};
use selvedge_studies::{
    Bench, Effort, Findings, Front, ReportError, Row, Running, ThisSceneStudy, pareto,
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
            front: front
                .iter()
                .map(|front| *front == Some(Front::On))
                .collect(),
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

/// Measures.
pub(crate) fn measure(
    wanted: Wanted,
    effort: Effort,
    progress: &mut Progress<'_>,
) -> Result<Measured, ReportError> {
    let n_displays = wanted.scene.displays.len();
    let poses = |path: Arc<ExplorationPath>| poses_of(&path, n_displays);
    let study = ThisSceneStudy {
        name: wanted.name,
        scene: wanted.scene,
        poses: wanted.path.map_or_else(Vec::new, poses),
        running: Running {
            method: wanted.rendering.method,
            accuracy: wanted.rendering.accuracy(),
        },
    };
    let findings = study.run(&mut Bench::new(effort, SEED, progress))?;
    Ok(Measured::of(findings, wanted.n_edits))
}

/// Ticks spread evenly over an exploration: the poses of so many displays.
fn poses_of(path: &ExplorationPath, n_displays: usize) -> Vec<Vec<Pose>> {
    let step = usize::try_from(path.n_ticks().div_ceil(MOST_TICKS)).unwrap_or(usize::MAX);
    let ticks = path.ticks().step_by(step.max(1));
    let poses = |(_, first)| {
        let mut poses = vec![Pose::default(); n_displays];
        path.poses_into(&first, &mut poses);
        poses
    };
    ticks.map(poses).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bench::recording::tests::two_apart;
    use selvedge_scratch::ScratchFolder;

    #[test]
    fn an_exploration_is_measured_with_every_display_where_it_was() {
        let folder = ScratchFolder::made("measured-two");
        let desk = two_apart(&folder, 0);
        let made = desk.workbench.bench.exploration.at_hand.clone().unwrap();
        let poses = poses_of(made.path(), 3);
        assert_eq!(poses.len() as u64, made.path().n_ticks());
        let last = &poses[20];
        let speeds = [0, 1, 2].map(|n: usize| last[n].velocity.speed_mm_per_s().round());
        assert_eq!(speeds, [80.0, 120.0, 80.0], "the third goes with the first");
    }
}
