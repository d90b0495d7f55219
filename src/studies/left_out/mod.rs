//! The study of what is left out: what every saving saves, and that it changes nothing.
//!
//! Six scenes are rendered and what is left out is counted. Each scene is also built without the
//! textiles that no contactor touches: it must feel the same to the bit, and what it costs less is
//! what leaving them out still costs. What the engine and the library leave out stands beside them.

mod scenes;
mod sinks;

use scenes::Case;

use std::path::Path;

use super::readable::largest;
use super::{Bench, Findings, ReportError, Row, Study, textiles};
use selvedge_foundation::geometry::Displacement;
use selvedge_render::array::{ArrayRenderer, Method};
use selvedge_render::scene::{ExplorationPath, LoadedScene, PathRow, Pose};
use selvedge_render::{RenderScene, Rule};

/// Methods that savings are tried with: what leaves out bins, and what looks powers up.
const METHODS: [Method; 2] = [Method::Banded, Method::Table];
/// How settings with all savings and with none are called.
const ALL: &str = "all";
const NONE: &str = "none";

/// What every saving leaves out, and what that saves.
pub(crate) const STUDY: Study = Study {
    name: "left-out",
    question: "What does a tick leave out, what does it cost beside a scene of nothing but what \
               is touched, and is what is felt the same?",
    reference: "The same method on the scene as it is.",
    error: ("largest difference of amplitudes", "µm"),
    cost_of: "tick",
    run,
};

/// Something that is left out beside what rendering leaves out.
struct Saving {
    /// Who leaves it out: a floor of the program.
    floor: &'static str,
    name: &'static str,
    /// What is left out, one sentence.
    what: &'static str,
    /// What its counter counts.
    unit: &'static str,
}

const NEVER_PLACED: Saving = Saving {
    floor: "scene",
    name: "never placed",
    what: "A textile that the scene does not place is never read.",
    unit: "textiles",
};
const NEVER_FELT: Saving = Saving {
    floor: "scene",
    name: "never felt",
    what: "A textile of which an exploration feels nothing is not read.",
    unit: "textiles",
};
const UNASKED_TICK_SAMPLES: Saving = Saving {
    floor: "engine",
    name: "unasked tick samples",
    what: "A tick leaves no tick sample for plots over time unless somebody asked for them.",
    unit: "tick samples",
};
const UNHEARD_FRAMES: Saving = Saving {
    floor: "engine",
    name: "unheard frames",
    what: "Drive codes are not made unless an armed device listens.",
    unit: "frames",
};

impl Saving {
    /// So much of it in a row of its own.
    fn row(&self, n_left_out: u64, case: &str) -> Row {
        Row::of(self.floor, format!("only {}", self.name), case)
            .with("left_out_a_tick_of_all", n_left_out)
            .with("left_out", self.unit)
    }
}

fn run(bench: &mut Bench<'_>) -> Result<Findings, ReportError> {
    let mut rows = Vec::new();
    let cases = scenes::cases(bench.effort)?;
    for (number, case) in cases.iter().enumerate() {
        for (nth, method) in METHODS.into_iter().enumerate() {
            let done = (2 * number + nth) as f64 / (2 * cases.len()) as f64;
            bench.step(done, case.name)?;
            rows.extend(rows_of(bench, case, method)?);
        }
    }
    rows.extend(library_rows(bench)?);
    rows.extend(unread_rows(bench)?);
    rows.extend(sinks::rows(bench)?);
    let of_rendering = Rule::ALL.map(|rule| format!("render, {}: {}", rule.name(), rule.what()));
    let note = |saving: Saving| format!("{}, {}: {}", saving.floor, saving.name, saving.what);
    let beside = [
        NEVER_PLACED,
        NEVER_FELT,
        UNASKED_TICK_SAMPLES,
        UNHEARD_FRAMES,
    ]
    .map(note);
    let notes = of_rendering.into_iter().chain(beside);
    Ok(Findings::new(rows, Vec::new(), notes))
}

/// A row for the scene as it is, one for that of nothing but what is touched, and one for what each
/// saving of the method left out.
fn rows_of(bench: &mut Bench<'_>, case: &Case, method: Method) -> Result<Vec<Row>, ReportError> {
    let mut as_it_is = textiles::prepared(&case.scene, method)?;
    let expected = felt(&mut as_it_is, &case.poses);
    let counters = *as_it_is.counters();
    let mut touched = textiles::prepared(&touched_only(case, &mut as_it_is), method)?;
    let found = felt(&mut touched, &case.poses);
    let mut rows = Vec::new();
    for (setting, felt, renderer) in [
        (ALL, &expected, &mut as_it_is),
        ("only what is touched", &found, &mut touched),
    ] {
        let cost = bench.time(case.poses.len(), || {
            for pose in &case.poses {
                renderer.tick(std::slice::from_ref(pose));
            }
        });
        let row = Row::of(method.name(), setting, case.name);
        let error = largest_difference(felt, &expected);
        rows.push(row.error(error).promised(0.0).cost(cost));
    }
    let applies = |rule: &Rule| {
        method == Method::Banded || !matches!(rule, Rule::AboveBand | Rule::BelowFloor)
    };
    rows.extend(Rule::ALL.into_iter().filter(applies).map(|rule| {
        let a_tick = rule.left_out(&counters) as f64 / counters.ticks.max(1) as f64;
        Row::of(method.name(), format!("only {}", rule.name()), case.name)
            .with("left_out_a_tick", a_tick)
            .with("left_out", rule.unit())
    }));
    Ok(rows)
}

/// The same scene without the textiles that no contactor touches.
fn touched_only(case: &Case, renderer: &mut ArrayRenderer) -> RenderScene {
    let mut is_touched = vec![false; case.scene.textiles.len()];
    for pose in &case.poses {
        for frame in renderer.tick(std::slice::from_ref(pose)) {
            for textile in (0..frame.n_contactors()).filter_map(|i| frame.textile(i)) {
                is_touched[textile] = true;
            }
        }
    }
    let mut scene = case.scene.clone();
    let mut is_touched = is_touched.into_iter();
    scene.textiles.retain(|_| is_touched.next() == Some(true));
    scene
}

/// Amplitudes of every tick and contactor, µm.
fn felt(renderer: &mut ArrayRenderer, poses: &[Pose]) -> Vec<[f64; 2]> {
    let mut felt = Vec::new();
    for pose in poses {
        felt.extend(textiles::amplitudes_um(
            renderer,
            std::slice::from_ref(pose),
        ));
    }
    felt
}

/// The largest difference of amplitudes; 0 only if they are the same to the bit.
fn largest_difference(found: &[[f64; 2]], expected: &[[f64; 2]]) -> f64 {
    let pairs = found.iter().flatten().zip(expected.iter().flatten());
    let differs = pairs.filter(|(a, b)| a.to_bits() != b.to_bits());
    largest(differs.map(|(a, b)| (a - b).abs().max(f64::MIN_POSITIVE)))
}

/// What it costs to load a scene, and what it would with all that its library knows.
fn library_rows(bench: &mut Bench<'_>) -> Result<[Row; 2], ReportError> {
    let loaded = LoadedScene::shipped()?;
    let placed = &loaded.scene().textiles;
    let is_rest = |id: &&String| !placed.iter().any(|placed| placed.id == **id);
    let rest: Vec<&String> = loaded.library().ids().iter().filter(is_rest).collect();
    let row = NEVER_PLACED.row(rest.len() as u64, "loading four alternatives");
    let as_it_is = bench.time(1, LoadedScene::shipped);
    let with_rest = bench.time(1, || {
        let scene = LoadedScene::shipped();
        let rest: Vec<_> = rest.iter().map(|id| loaded.library().load(id)).collect();
        (scene, rest)
    });
    let whole = Row {
        setting: NONE.to_owned(),
        ..row.clone()
    };
    Ok([row.cost(as_it_is), whole.cost(with_rest)])
}

/// What it costs to read a scene for a stroke over one of its textiles, and for any.
fn unread_rows(bench: &mut Bench<'_>) -> Result<[Row; 2], ReportError> {
    let text = (scenes::ALL_SIXTEEN, Path::new("all-sixteen.scene.toml"));
    let read_all = || LoadedScene::from_toml(text.0, text.1);
    let all = read_all()?;
    let row_at = |(n, x_mm): (u32, f64)| PathRow {
        t_s: f64::from(n) / 40.0,
        position: all.scene().textiles[0].origin_mm + Displacement::new(x_mm, 25.0),
        ..PathRow::default()
    };
    let path = ExplorationPath::new((0..).zip([20.0, 25.0, 30.0]).map(row_at).collect())?;
    let read_felt = || LoadedScene::from_text_along(text, None, &path);
    let n_unread = read_felt()?.unread().len() as u64;
    let row = NEVER_FELT.row(n_unread, "a stroke over one of sixteen");
    let whole = Row {
        setting: NONE.to_owned(),
        ..row.clone()
    };
    let (felt, all) = (bench.time(1, read_felt), bench.time(1, read_all));
    Ok([row.cost(felt), whole.cost(all)])
}

#[cfg(test)]
mod tests;
