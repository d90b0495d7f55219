//! The study of total cost: preparing and all ticks together, for explorations of a tick to an hour
//! on every scene of the program, and what turning costs.
//!
//! What `auto` chose stands beside the cheapest method that keeps the same budget.

use std::f64::consts::TAU;
use std::path::Path;

use crate::textiles::{exeter, placed, scene_of, shipped};
use crate::{Bench, Findings, ReportError, Row, Study, Timing};
use selvedge_foundation::geometry::{Point, Velocity};
use selvedge_render::array::{Accuracy, ArrayRenderer, Method};
use selvedge_render::scene::{ExplorationPath, LoadedScene, PathRow, Pose, TICKS_PER_S};
use selvedge_render::{RenderError, RenderScene};

/// How much more than the cheapest `auto` may cost: a share, and ms beside it.
const MOST_OVER: (f64, f64) = (0.25, 5.0);
/// Ticks of the reference that are measured: each costs the same whatever came before.
const MOST_OF_REFERENCE: usize = 48;
/// Scenes that come with the program and take libraries that are part of it: their file's name, and
/// what it holds.
const SCENES: [(&str, &str); 2] = [
    (
        "four alternatives",
        include_str!("../../../assets/scenes/four-alternatives.scene.toml"),
    ),
    (
        "all sixteen",
        include_str!("../../../assets/scenes/all-sixteen.scene.toml"),
    ),
];
/// How long explorations are, and how many ticks those are.
const LENGTHS: [(&str, u32); 4] = [
    ("1 tick", 1),
    ("1 s", 40),
    ("1 min", 2400),
    ("1 h", 144_000),
];

/// What `auto` costs in all, beside the cheapest.
pub(crate) const STUDY: Study = Study {
    name: "total-cost",
    chapter: "amplitudes",
    question: "What do preparing and all ticks of an exploration cost together, is auto about as \
               cheap as the cheapest method, and what does a turning display cost?",
    reference: "The cheapest method that keeps the same error budget.",
    error: ("more than the cheapest and a quarter", "ms"),
    cost_of: "exploration, or tick",
    run,
};

fn run(bench: &mut Bench<'_>) -> Result<Findings, ReportError> {
    let mut rows = Vec::new();
    let lengths = &LENGTHS[..bench.effort.pick(3, 4)];
    for (nth, (name, text)) in SCENES.into_iter().enumerate() {
        let scene = RenderScene::of(&LoadedScene::from_toml(text, Path::new(name))?);
        for (length, (setting, n_ticks)) in lengths.iter().enumerate() {
            let n_all = SCENES.len() * lengths.len() + 1;
            let done = (nth * lengths.len() + length) as f64 / n_all as f64;
            bench.step(done, &format!("{name}, {setting}"))?;
            let exploration = Exploration::of(&scene, *n_ticks)?;
            rows.extend(exploration.rows(bench, (setting, name))?);
        }
    }
    bench.step(0.95, "turning")?;
    rows.extend(turning(bench)?);
    let (share, ms) = MOST_OVER;
    let notes = [
        format!(
            "Explorations run over the whole scene at up to 400 mm/s and rest now and then; auto \
             is to cost at most {}&nbsp;% and {ms} ms more than the cheapest of the others.",
            100.0 * share
        ),
        format!(
            "Every tick of banded and table is run, and all of preparing; of the reference, which \
             remembers nothing, at most {MOST_OF_REFERENCE} ticks spread over the exploration, \
             times how many there are."
        ),
        "Reading textiles is not in it: it costs every method the same. The scene of five Brownian \
         surfaces is left out: its library is no part of the program."
            .to_owned(),
    ];
    Ok(Findings::new(rows, Vec::new(), notes))
}

/// A scene and a way over it.
struct Exploration<'a> {
    scene: &'a RenderScene,
    path: ExplorationPath,
    poses: Vec<Pose>,
}

impl<'a> Exploration<'a> {
    /// So many ticks over all of a scene: to and fro at changing speeds, with rests.
    fn of(scene: &'a RenderScene, n_ticks: u32) -> Result<Self, ReportError> {
        let far = |of: fn(&Point) -> f64| {
            let corners = scene.textiles.iter().map(|placed| {
                let [width_mm, height_mm] = placed.size_mm;
                of(&placed
                    .workspace_from_textile
                    .point(Point::new(width_mm, height_mm)))
            });
            corners.fold(1.0, f64::max)
        };
        let size_mm = [far(|at| at.x_mm), far(|at| at.y_mm)];
        let row = |tick: u32| {
            let t_s = f64::from(tick) / TICKS_PER_S;
            // Slower and faster, and for a moment not at all.
            let way_s = t_s + 0.6 * (TAU * t_s / 7.0).sin();
            let share = |period_s: f64| 0.5 - 0.45 * (TAU * way_s / period_s + 0.4).cos();
            PathRow {
                t_s,
                position: Point::new(size_mm[0] * share(3.1), size_mm[1] * share(4.7)),
                ..PathRow::default()
            }
        };
        let path = ExplorationPath::new((0..n_ticks).map(row).collect())?;
        let poses = path.ticks().map(|(_, pose)| pose).collect();
        Ok(Self { scene, path, poses })
    }

    /// A row a method.
    fn rows(
        &self,
        bench: &Bench<'_>,
        (setting, case): (&str, &str),
    ) -> Result<Vec<Row>, ReportError> {
        let methods = [
            Method::Auto,
            Method::Reference,
            Method::Banded,
            Method::Table,
        ];
        let n_step = self.poses.len().div_ceil(MOST_OF_REFERENCE).max(1);
        let few: Vec<Pose> = self.poses.iter().copied().step_by(n_step).collect();
        let used = self.prepared(Method::Auto)?.method();
        let share_of = |method: Method| {
            let uses = if method == Method::Auto { used } else { method };
            let is_reference = uses == Method::Reference;
            let poses = if is_reference { &few } else { &self.poses };
            (poses, self.poses.len() as f64 / poses.len() as f64)
        };
        let works = methods.map(|method| {
            let poses = share_of(method).0;
            let work: Box<dyn FnMut() -> Result<(), RenderError>> = Box::new(move || {
                let mut renderer = self.prepared(method)?;
                let mut all = vec![Pose::default(); self.scene.displays.len()];
                for pose in poses {
                    all.fill(*pose);
                    renderer.tick(&all);
                }
                Ok(())
            });
            work
        });
        let timed = bench.time_in_turn(1, works.into());
        let timed = timed
            .into_iter()
            .zip(methods)
            .map(|((timing, multiple), method)| {
                let factor = share_of(method).1;
                (method, timing.times(factor), multiple * factor)
            });
        let timed: Vec<(Method, Timing, f64)> = timed.collect();
        let is_fixed = |(method, ..): &&(Method, Timing, f64)| *method != Method::Auto;
        let cheapest = timed
            .iter()
            .filter(is_fixed)
            .min_by(|a, b| a.2.total_cmp(&b.2));
        let own = timed.first().map_or(1.0, |(.., multiple)| *multiple);
        let rows = timed.iter().map(|(method, timing, multiple)| {
            let row = Row::of(method.name(), setting, case).cost(*timing);
            let Some((name, least, of_auto)) = cheapest.filter(|_| *method == Method::Auto) else {
                return row.number("times_auto", 2, multiple / own);
            };
            let (ratio, least_ms) = (own / of_auto, 1e3 * least.cpu_s);
            let over_ms = (ratio - 1.0) * least_ms;
            let (share, most_ms) = MOST_OVER;
            row.error((over_ms - share * least_ms).max(0.0))
                .promised(most_ms)
                .with("used", used.name())
                .with("cheapest", name.name())
                .number("times_cheapest", 2, ratio)
                .number("over_cheapest_ms", 2, over_ms)
        });
        Ok(rows.collect())
    }

    fn prepared(&self, method: Method) -> Result<ArrayRenderer, RenderError> {
        ArrayRenderer::prepare_along(self.scene, method, &Accuracy::default(), &self.path)
    }
}

/// What a tick costs where a display turns, beside one that does not, once tables are made.
fn turning(bench: &Bench<'_>) -> Result<Vec<Row>, ReportError> {
    let scene = scene_of(vec![placed(&shipped("denim")?, Point::default())], exeter());
    let poses = |angular_rad_per_s: f64| -> Vec<Pose> {
        let pose = |n: u32| {
            let share = f64::from(n) / TICKS_PER_S;
            Pose {
                position: Point::new(20.0 + 80.0 * share, 20.0 + 60.0 * share),
                angle_deg: (angular_rad_per_s * share).to_degrees(),
                velocity: Velocity::new(80.0, 60.0),
                angular_rad_per_s,
                ..Pose::default()
            }
        };
        (0..40).map(pose).collect()
    };
    let motions = [("straight", poses(0.0)), ("turning at 2 rad/s", poses(2.0))];
    let methods = [Method::Reference, Method::Banded, Method::Table];
    let mut named = Vec::new();
    let mut works: Vec<Box<dyn FnMut()>> = Vec::new();
    for (setting, poses) in &motions {
        for method in methods {
            let mut renderer = ArrayRenderer::prepare(&scene, method, &Accuracy::default())?;
            named.push((method, *setting));
            works.push(Box::new(move || {
                for pose in poses {
                    renderer.tick(std::slice::from_ref(pose));
                }
            }));
        }
    }
    let timed = bench.time_in_turn(motions[0].1.len(), works);
    let multiples: Vec<f64> = timed.iter().map(|(_, multiple)| *multiple).collect();
    let rows =
        timed
            .iter()
            .zip(&named)
            .enumerate()
            .map(|(nth, ((timing, own), (method, setting)))| {
                let row = Row::of(method.name(), *setting, "one textile").cost(*timing);
                let first_of_motion = nth - nth % methods.len();
                row.number("times_straight", 2, own / multiples[nth % methods.len()])
                    .number("times_reference", 3, own / multiples[first_of_motion])
            });
    Ok(rows.collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tests::quick;

    #[test]
    fn every_scene_and_length_has_auto_beside_the_cheapest() {
        let findings = quick(&STUDY, 1);
        let n_lengths = LENGTHS.len() - 1;
        assert_eq!(findings.rows.len(), SCENES.len() * n_lengths * 4 + 6);
        let of_auto: Vec<&Row> = (findings.rows.iter())
            .filter(|row| row.method == "auto")
            .collect();
        assert_eq!(of_auto.len(), SCENES.len() * n_lengths);
        for row in of_auto {
            assert!(row.error.is_some() && row.promised == Some(5.0), "{row:?}");
            assert!(row.further_number("times_cheapest").is_some(), "{row:?}");
            let is_still = row.setting == "1 tick";
            assert!(!is_still || row.further("used") == "reference", "{row:?}");
        }
        let turning = findings.rows.iter().filter(|row| row.case == "one textile");
        for row in turning {
            assert!(row.further_number("times_straight") > Some(0.0), "{row:?}");
        }
    }
}
