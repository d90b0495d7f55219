//! The study of total cost: preparing and all ticks together, for explorations of a tick to an hour
//! on every scene of the program.
//!
//! What `auto` chose stands beside the cheapest method that keeps the same budget.

use std::f64::consts::TAU;
use std::path::Path;

use crate::{Bench, Findings, ReportError, Row, Study};
use selvedge_foundation::geometry::Point;
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
               cheap as the cheapest method?",
    reference: "The cheapest method that keeps the same error budget.",
    error: ("more than the cheapest and a quarter", "ms"),
    cost_of: "exploration",
    run,
};

fn run(bench: &mut Bench<'_>) -> Result<Findings, ReportError> {
    let mut rows = Vec::new();
    let lengths = &LENGTHS[..bench.effort.pick(3, 4)];
    for (nth, (name, text)) in SCENES.into_iter().enumerate() {
        let scene = RenderScene::of(&LoadedScene::from_toml(text, Path::new(name))?);
        for (length, (setting, n_ticks)) in lengths.iter().enumerate() {
            let n_all = SCENES.len() * lengths.len();
            let done = (nth * lengths.len() + length) as f64 / n_all as f64;
            bench.step(done, &format!("{name}, {setting}"))?;
            let exploration = Exploration::of(&scene, *n_ticks)?;
            rows.extend(exploration.rows(bench, (setting, name))?);
        }
    }
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
    Ok(Findings::new(rows, Vec::new(), notes).judged(judge))
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
        let rows = timed.into_iter().zip(methods).map(|((timing, _), method)| {
            let row = Row::of(method.name(), setting, case);
            let row = row.cost(timing.times(share_of(method).1));
            if method == Method::Auto {
                row.with("used", used.name())
            } else {
                row
            }
        });
        Ok(rows.collect())
    }

    fn prepared(&self, method: Method) -> Result<ArrayRenderer, RenderError> {
        ArrayRenderer::prepare_along(self.scene, method, &Accuracy::default(), &self.path)
    }
}

/// What `auto` costs beside the cheapest of the others, from the times of all processes.
fn judge(rows: &mut [Row]) {
    let is_same = |a: &Row, b: &Row| a.setting == b.setting && a.case == b.case;
    for group in rows.chunk_by_mut(is_same) {
        // What was not timed has no verdict.
        let _: Option<()> = judge_one(group);
    }
}

fn judge_one(group: &mut [Row]) -> Option<()> {
    let (auto, others) = group.split_first_mut()?;
    let own = auto.cost?;
    let times_auto = |row: &Row| Some(row.cost?.over(&own).middle);
    for row in others.iter_mut() {
        let times_auto = times_auto(row)?;
        row.set("times_auto", format!("{times_auto:.2}"));
    }
    let timed = others
        .iter()
        .filter_map(|row| Some((row, times_auto(row)?)));
    let (cheapest, times_auto) = timed.min_by(|a, b| a.1.total_cmp(&b.1))?;
    let (ratio, least_ms) = (1.0 / times_auto, 1e3 * cheapest.cost?.cpu_s);
    let over_ms = (ratio - 1.0) * least_ms;
    let (share, most_ms) = MOST_OVER;
    auto.error = Some((over_ms - share * least_ms).max(0.0));
    auto.promised = Some(most_ms);
    auto.set("cheapest", cheapest.method.clone());
    auto.set("times_cheapest", format!("{ratio:.2}"));
    auto.set("over_cheapest_ms", format!("{over_ms:.2}"));
    Some(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tests::quick;

    #[test]
    fn every_scene_and_length_has_auto_beside_the_cheapest() {
        let findings = quick(&STUDY, 1);
        let n_lengths = LENGTHS.len() - 1;
        assert_eq!(findings.rows.len(), SCENES.len() * n_lengths * 4);
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
    }

    #[test]
    fn verdicts_follow_the_times_of_all_processes() {
        use crate::Timing;
        let row = |method: &str, first_s: f64, others_s: [f64; 2]| {
            let others: Vec<_> = others_s.iter().map(|s| (*s, *s, 2)).collect();
            let timing = Timing::of(&mut [first_s], &mut [first_s]).and(&others);
            Row::of(method, "1 s", "a scene").cost(timing)
        };
        // By the first process alone banded would be the cheapest by far.
        let mut rows = [
            row("auto", 2.0, [2.0, 2.2]),
            row("reference", 9.0, [9.0, 9.0]),
            row("banded", 0.2, [3.0, 3.3]),
            row("table", 1.6, [1.6, 1.76]),
        ];
        judge(&mut rows);
        assert_eq!(rows[0].further("cheapest"), "table");
        assert_eq!(rows[0].further("times_cheapest"), "1.25");
        assert_eq!(rows[2].further("times_auto"), "1.50");
        assert_eq!(
            (rows[0].promised, rows[0].is_kept()),
            (Some(5.0), Some(true))
        );
        rows[3] = row("table", 1.0, [1.0, 1.1]);
        judge(&mut rows);
        assert_eq!(rows[0].is_kept(), Some(false), "{:?}", rows[0]);
    }
}
