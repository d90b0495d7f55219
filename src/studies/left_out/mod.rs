//! The study of what is left out: what every saving saves, and that it changes nothing.
//!
//! Six scenes are rendered and what is left out is counted. Each scene is also built without the
//! textiles that no contactor touches: it must feel the same to the bit, and what it costs less is
//! what leaving them out still costs. What the engine and the library leave out stands beside them.

mod saving;
mod scenes;
mod sinks;

use saving::Saving;
use scenes::Case;

use super::{Bench, Findings, ReportError, Row, Study};
use selvedge_render::array::{Accuracy, ArrayRenderer, Method};
use selvedge_render::scene::{LoadedScene, Pose};
use selvedge_render::{Counters, RenderScene, Rule};

/// Methods that savings are tried with: what leaves out bins, and what looks powers up.
const METHODS: [Method; 2] = [Method::Banded, Method::Table];

/// What every saving leaves out, and what that saves.
#[derive(Debug, Clone, Copy)]
pub(crate) struct LeftOutStudy;

impl Study for LeftOutStudy {
    fn name(&self) -> &'static str {
        "left-out"
    }

    fn question(&self) -> &'static str {
        "What does a tick leave out, what does it cost beside a scene of nothing but what is \
         touched, and is what is felt the same?"
    }

    fn reference(&self) -> &'static str {
        "The same method on the scene as it is."
    }

    fn error_measure(&self) -> (&'static str, &'static str) {
        ("largest difference of amplitudes", "µm")
    }

    fn cost_of(&self) -> &'static str {
        "tick"
    }

    fn run(&self, bench: &mut Bench<'_>) -> Result<Findings, ReportError> {
        let mut findings = Findings::default();
        let cases = scenes::cases(bench.effort)?;
        let n_steps = (cases.len() * METHODS.len()) as f64;
        for (number, case) in cases.iter().enumerate() {
            for (nth, method) in METHODS.into_iter().enumerate() {
                let done = number * METHODS.len() + nth;
                bench.step(done as f64 / n_steps, case.name)?;
                findings.rows.extend(rows(bench, case, method)?);
            }
        }
        findings.rows.extend(library_rows(bench)?);
        findings.rows.extend(sinks::rows(bench)?);
        findings.notes = notes();
        Ok(findings)
    }
}

/// A row for the scene as it is, one for that of nothing but what is touched, and one for what each
/// saving of the method left out.
fn rows(bench: &mut Bench<'_>, case: &Case, method: Method) -> Result<Vec<Row>, ReportError> {
    let mut as_it_is = prepared(&case.scene, method)?;
    let expected = felt(&mut as_it_is, &case.poses);
    let counters = *as_it_is.counters();
    let mut touched = prepared(&touched_only(case, &mut as_it_is), method)?;
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
        rows.push(Row {
            method: method.name().to_owned(),
            setting: setting.to_owned(),
            case: case.name.to_owned(),
            error: Some(largest_difference(felt, &expected)),
            promised: Some(0.0),
            cost: Some(cost),
            ..Row::default()
        });
    }
    let applied = Rule::ALL.into_iter().filter(|rule| applies(*rule, method));
    rows.extend(applied.map(|rule| Row {
        method: method.name().to_owned(),
        case: case.name.to_owned(),
        more: more_of(rule, &counters),
        ..Saving::of_rendering(rule).row()
    }));
    Ok(rows)
}

fn prepared(scene: &RenderScene, method: Method) -> Result<ArrayRenderer, ReportError> {
    let accuracy = Accuracy::default();
    Ok(ArrayRenderer::prepare(scene, method, &accuracy)?)
}

/// The savings that a method knows.
fn applies(rule: Rule, method: Method) -> bool {
    let is_of_bins = matches!(rule, Rule::AboveBand | Rule::BelowFloor);
    !is_of_bins || method == Method::Banded
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

/// What a saving left out in a tick.
fn more_of(rule: Rule, counters: &Counters) -> Vec<(&'static str, String)> {
    let a_tick = rule.left_out(counters) as f64 / counters.ticks.max(1) as f64;
    vec![
        ("left_out_a_tick", a_tick.to_string()),
        ("left_out", rule.unit().to_owned()),
    ]
}

/// How settings with all savings and with none are called.
const ALL: &str = "all";
const NONE: &str = "none";

/// Amplitudes of every tick and contactor, µm.
fn felt(renderer: &mut ArrayRenderer, poses: &[Pose]) -> Vec<[f64; 2]> {
    let mut felt = Vec::new();
    for pose in poses {
        for frame in renderer.tick(std::slice::from_ref(pose)) {
            let contactors = 0..frame.n_contactors();
            felt.extend(contactors.map(|contactor| frame.amplitude_um(contactor)));
        }
    }
    felt
}

/// The largest difference of amplitudes; 0 only if they are the same to the bit.
fn largest_difference(found: &[[f64; 2]], expected: &[[f64; 2]]) -> f64 {
    let pairs = found.iter().flatten().zip(expected.iter().flatten());
    let differences = pairs.map(|(a, b)| {
        if a.to_bits() == b.to_bits() {
            0.0
        } else {
            (a - b).abs().max(f64::MIN_POSITIVE)
        }
    });
    differences.fold(0.0, f64::max)
}

/// What it costs to load a scene, and what it would with all that its library knows.
fn library_rows(bench: &mut Bench<'_>) -> Result<Vec<Row>, ReportError> {
    let loaded = LoadedScene::shipped()?;
    let ids = loaded.library().ids();
    let is_placed = |id: &&String| {
        loaded
            .scene()
            .textiles
            .iter()
            .any(|placed| placed.id == **id)
    };
    let n_placed = ids.iter().filter(is_placed).count();
    let saving = Saving::never_placed(ids.len().saturating_sub(n_placed) as u64);
    let rest: Vec<&String> = ids.iter().filter(|id| !is_placed(id)).collect();
    let of = |setting: &str, cost| Row {
        setting: setting.to_owned(),
        case: "loading four alternatives".to_owned(),
        cost: Some(cost),
        ..saving.row()
    };
    let as_it_is = bench.time(1, LoadedScene::shipped);
    let with_rest = bench.time(1, || {
        let scene = LoadedScene::shipped();
        let rest: Vec<_> = rest.iter().map(|id| loaded.library().load(id)).collect();
        (scene, rest)
    });
    Ok(vec![of("only never placed", as_it_is), of(NONE, with_rest)])
}

/// What every saving leaves out, a sentence each.
fn notes() -> Vec<String> {
    let of_rendering = Rule::ALL.map(|rule| Saving::of_rendering(rule).note());
    let beside = [
        Saving::never_placed(0),
        Saving::unasked_glimpses(0),
        Saving::unheard_frames(0),
    ];
    let beside = beside.map(|saving| saving.note());
    of_rendering.into_iter().chain(beside).collect()
}

#[cfg(test)]
mod tests;
