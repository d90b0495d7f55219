//! The product's methods on one scene that somebody has at hand, along strokes of their own.
//!
//! The same rows as the study of rendering, with the method that runs among them.

use super::{Case, Configured, product_methods};
use crate::{Bench, Findings, ReportError, Row};
use selvedge_foundation::geometry::Displacement;
use selvedge_foundation::quantity;
use selvedge_render::array::{Accuracy, ArrayRenderer, Method};
use selvedge_render::scene::{Pose, Stroke};
use selvedge_render::{PlacedSurface, RenderScene};

/// The column that marks the method that runs.
const RUNNING: &str = "is_running";
/// Contactors rendered for one method at most, so that an array of thousands is measured in
/// seconds too.
const MOST_CONTACTORS: usize = 600 * 24;
/// Most poses, and fewest.
const N_POSES: [usize; 2] = [16, 600];
/// Speeds at which every textile is crossed where there is no exploration, mm/s.
const SPEEDS_MM_PER_S: [f64; 3] = [20.0, 120.0, 500.0];
/// Most textiles that are crossed.
const MOST_CROSSED: usize = 12;
/// Poses on one crossing.
const N_ON_CROSSING: u16 = 16;

/// The method that runs, and what was asked of it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Running {
    /// The method asked for; `auto` is resolved on the scene.
    pub method: Method,
    /// Its accuracy.
    pub accuracy: Accuracy,
}

/// The product's methods on one scene.
#[derive(Debug, Clone)]
pub struct ThisSceneStudy {
    /// What people call the scene.
    pub name: String,
    /// The scene, with its gains.
    pub scene: RenderScene,
    /// An exploration, tick by tick the pose of every display; where it is empty every textile is
    /// crossed at three speeds.
    pub poses: Vec<Vec<Pose>>,
    /// The method that runs on it.
    pub running: Running,
}

impl ThisSceneStudy {
    /// Whether a row is that of the method that runs.
    pub fn is_running(row: &Row) -> bool {
        !row.further(RUNNING).is_empty()
    }

    /// A row a method.
    ///
    /// # Errors
    /// It was cancelled, or the scene cannot be rendered.
    pub fn run(&self, bench: &mut Bench<'_>) -> Result<Findings, ReportError> {
        bench.step(0.0, "reference amplitudes")?;
        let poses = self.poses();
        let n_poses = poses.len();
        let methods = self.methods()?;
        let case = Case::new(self.name.clone(), self.scene.clone(), poses)?;
        let mut findings = Findings::default();
        for (nth, (is_running, (named, accuracy))) in methods.iter().enumerate() {
            let share = (nth + 1) as f64 / (methods.len() + 1) as f64;
            bench.step(share, &format!("{} {}", named.0.name(), named.1))?;
            let mut row = match case.product_row(bench, named.clone(), accuracy) {
                // Tables that would not fit are no reason to measure nothing.
                Err(ReportError::Render(error)) if !is_running => {
                    findings.notes.push(format!("{}: {error}.", named.0.name()));
                    continue;
                }
                row => row?,
            };
            if *is_running {
                row = row.with(RUNNING, true);
            }
            findings.rows.push(row);
        }
        findings.notes.push(if self.poses.is_empty() {
            let [slow, middle, fast] = SPEEDS_MM_PER_S.map(|v| quantity::fixed(v, 0));
            format!("{n_poses} poses: every textile crossed at {slow}, {middle} and {fast} mm/s.")
        } else {
            format!("{n_poses} ticks of the exploration.")
        });
        Ok(findings)
    }

    /// The poses that are measured: at most as many as the scene's contactors allow, evenly from
    /// the whole exploration.
    fn poses(&self) -> Vec<Vec<Pose>> {
        let n_displays = self.scene.displays.len();
        let poses = if self.poses.is_empty() {
            let crossings = crossings(&self.scene.textiles).into_iter();
            crossings.map(|pose| vec![pose; n_displays]).collect()
        } else {
            self.poses.clone()
        };
        let displays = self.scene.displays.iter();
        let n_contactors: usize = displays.map(|display| display.offsets.len()).sum();
        let [fewest, most] = N_POSES;
        let n_poses = (MOST_CONTACTORS / n_contactors.max(1)).clamp(fewest, most);
        let step = poses.len().div_ceil(n_poses).max(1);
        poses.into_iter().step_by(step).collect()
    }

    /// The methods of the study; the one that runs marked, and added if it is not among them.
    fn methods(&self) -> Result<Vec<(bool, Configured)>, ReportError> {
        let Running { method, accuracy } = self.running;
        let used = ArrayRenderer::prepare(&self.scene, method, &accuracy)?.method();
        let is_used = |(named, setting): &Configured| {
            named.0 == used
                && match used {
                    Method::Table => setting.budget_db.to_bits() == accuracy.budget_db.to_bits(),
                    Method::Banded => {
                        setting.banded_floor.to_bits() == accuracy.banded_floor.to_bits()
                    }
                    Method::Reference | Method::Auto => true,
                }
        };
        let of_product = product_methods().into_iter();
        let marked = of_product.map(|configured| (is_used(&configured), configured));
        let mut methods: Vec<(bool, Configured)> = marked.collect();
        if !methods.iter().any(|(is_running, _)| *is_running) {
            let setting = format!("within {} dB", accuracy.budget_db);
            methods.push((true, ((used, setting), accuracy)));
        }
        Ok(methods)
    }
}

/// Poses on lines from one corner region of each textile to the opposite one, at several speeds.
fn crossings(textiles: &[PlacedSurface]) -> Vec<Pose> {
    let mut poses = Vec::new();
    for textile in textiles.iter().take(MOST_CROSSED) {
        let place = |share: f64| {
            let frame = &textile.workspace_from_textile;
            let [width_mm, height_mm] = textile.size_mm;
            let within = Displacement::new(share * width_mm, share * height_mm);
            frame.origin + frame.rotation.turn(within)
        };
        for speed_mm_per_s in SPEEDS_MM_PER_S {
            let (start, end) = (place(0.1), place(0.9));
            let line = Stroke::Line {
                start,
                end,
                speed_mm_per_s,
            };
            if line.check().is_err() {
                continue;
            }
            let whole_s = (end - start).length_mm() / speed_mm_per_s;
            let at = |n: u16| whole_s * (f64::from(n) + 0.5) / f64::from(N_ON_CROSSING);
            poses.extend((0..N_ON_CROSSING).map(|n| line.pose_at(at(n))));
        }
    }
    poses
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Effort, pareto};
    use selvedge_foundation::progress::Progress;
    use selvedge_render::scene::LoadedScene;

    fn study(method: Method, accuracy: Accuracy) -> ThisSceneStudy {
        ThisSceneStudy {
            name: "four".to_owned(),
            scene: RenderScene::of(&LoadedScene::shipped().unwrap()),
            poses: Vec::new(),
            running: Running { method, accuracy },
        }
    }

    fn findings(study: &ThisSceneStudy) -> Findings {
        Progress::unheard(|progress| study.run(&mut Bench::new(Effort::Quick, 1, progress)))
            .unwrap()
    }

    #[test]
    fn every_method_is_measured_on_the_scene_and_the_one_that_runs_is_marked() {
        let found = findings(&study(Method::Auto, Accuracy::default()));
        assert_eq!(found.rows.len(), product_methods().len());
        let running: Vec<&Row> = found
            .rows
            .iter()
            .filter(|row| ThisSceneStudy::is_running(row))
            .collect();
        assert_eq!(running.len(), 1);
        let row = running[0];
        assert_eq!((&*row.method, &*row.setting), ("table", "within 0.05 dB"));
        let error = row.error.unwrap();
        assert!(error > 1e-6 && error <= 0.05, "it was felt: {row:?}");
        assert_eq!(found.rows[0].error, Some(0.0), "reference against itself");
        assert_eq!(found.n_broken(), 0);
        let front = pareto(&found.rows);
        assert_eq!(
            front[0],
            Some(crate::Front::On),
            "nothing beats an error of 0"
        );
        assert!(found.notes[0].contains("192 poses"), "{:?}", found.notes);
    }

    #[test]
    fn a_budget_of_ones_own_is_measured_beside_the_others() {
        let found = findings(&study(Method::Auto, Accuracy::within_db(0.02)));
        let last = found.rows.last().unwrap();
        assert!(ThisSceneStudy::is_running(last), "{last:?}");
        assert_eq!(last.setting, "within 0.02 dB");
        assert!(last.error.unwrap() <= 0.02, "{last:?}");
    }

    #[test]
    fn an_exploration_is_thinned_out_for_large_arrays_and_nothing_is_no_reason_to_fail() {
        let mut large = study(Method::Auto, Accuracy::default());
        let offsets = large.scene.displays[0].offsets.clone();
        large.scene.displays[0].offsets = offsets.into_iter().cycle().take(2400).collect();
        large.poses = vec![vec![Pose::default()]; 1000];
        assert_eq!(large.poses().len(), 16);
        let empty = ThisSceneStudy {
            scene: RenderScene::default(),
            ..study(Method::Auto, Accuracy::default())
        };
        let found = findings(&empty);
        assert!(found.rows.iter().all(|row| row.error == Some(0.0)));
    }
}
