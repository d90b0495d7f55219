//! The study of what is left out: what every saving saves, and that it changes nothing.
//!
//! Six scenes are rendered with all savings, with none, and with each alone. With a saving off,
//! what it would leave out is evaluated and thrown away. What the engine and the library leave out
//! stands beside them.

mod saving;
mod scenes;
mod sinks;

use saving::Saving;
use scenes::Case;

use super::{Bench, Effort, Findings, ReportError, Row, Study};
use selvedge_render::array::{Accuracy, ArrayRenderer, Method};
use selvedge_render::scene::{LoadedScene, Pose};
use selvedge_render::{RenderScene, Rule, Rules};
use selvedge_textile::surface::{Direction, Surface};

/// Methods that savings are tried with: what leaves out bins, and what looks powers up.
const METHODS: [Method; 2] = [Method::Banded, Method::Table];
/// Contactors times textiles from which `banded` without savings takes the better part of a second
/// a tick: measured few times, and not at all where the report is to be quick.
const HEAVY: usize = 10_000;
/// How often it is measured then.
const FEW: usize = 3;

/// What every saving leaves out, and what that saves.
#[derive(Debug, Clone, Copy)]
pub(crate) struct LeftOutStudy;

impl Study for LeftOutStudy {
    fn name(&self) -> &'static str {
        "left-out"
    }

    fn question(&self) -> &'static str {
        "What does a tick cost with every saving, with none and with each alone, and is what is \
         felt the same?"
    }

    fn reference(&self) -> &'static str {
        "The same method with every saving in force."
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

/// The savings that a method knows.
fn applies(rule: Rule, method: Method) -> bool {
    let is_of_bins = matches!(rule, Rule::AboveBand | Rule::BelowFloor);
    !is_of_bins || method == Method::Banded
}

/// The sets of savings to try, by name.
fn sets(case: &Case, method: Method, effort: Effort) -> Vec<(Option<Rule>, Rules)> {
    let n_touches = n_touches(case);
    let is_banded = method == Method::Banded;
    let mut sets = vec![(None, Rules::ALL)];
    if is_banded && n_touches > effort.pick(HEAVY, usize::MAX) {
        return sets;
    }
    sets.push((None, Rules::NONE));
    if is_banded && n_touches > effort.pick(1000, usize::MAX) {
        return sets;
    }
    let alone = Rule::ALL.into_iter().filter(|rule| applies(*rule, method));
    sets.extend(alone.map(|rule| (Some(rule), Rules::only(rule))));
    sets
}

/// A row for every set of savings.
fn rows(bench: &mut Bench<'_>, case: &Case, method: Method) -> Result<Vec<Row>, ReportError> {
    let all = ArrayRenderer::prepare(&case.scene, method, &Accuracy::default())?;
    let poses = &timed(case, method, bench.effort)[..];
    let mut with_all = all.clone();
    let expected = felt(&mut with_all, poses);
    let floor_um = all.bound().floor * unfiltered_um(&case.scene);
    let mut rows = Vec::new();
    for (alone, rules) in sets(case, method, bench.effort) {
        let mut renderer = all.clone().with_rules(rules);
        let found = felt(&mut renderer, poses);
        let more = more_of(alone, [&renderer, &with_all]);
        let is_below_floor = method == Method::Banded && !rules.has(Rule::BelowFloor);
        let feel_all = || {
            for pose in poses {
                renderer.tick(std::slice::from_ref(pose));
            }
        };
        let is_heavy = method == Method::Banded && n_touches(case) > HEAVY;
        let cost = if is_heavy {
            bench.time_repeated(FEW, poses.len(), feel_all)
        } else {
            bench.time(poses.len(), feel_all)
        };
        rows.push(Row {
            method: method.name().to_owned(),
            setting: match alone {
                Some(rule) => format!("only {}", rule.name()),
                None if rules == Rules::ALL => ALL.to_owned(),
                None => NONE.to_owned(),
            },
            case: case.name.to_owned(),
            error: Some(largest_difference(&found, &expected)),
            promised: Some(if is_below_floor { floor_um } else { 0.0 }),
            cost: Some(cost),
            more,
            ..Row::default()
        });
    }
    Ok(rows)
}

/// What a saving left out in a tick, alone and beside all others.
fn more_of(alone: Option<Rule>, renderers: [&ArrayRenderer; 2]) -> Vec<(&'static str, String)> {
    let Some(rule) = alone else {
        return Vec::new();
    };
    let [by_itself, of_all] = renderers.map(|renderer| {
        let counters = *renderer.counters();
        (rule.left_out(&counters) as f64 / counters.ticks.max(1) as f64).to_string()
    });
    vec![
        ("left_out_a_tick", by_itself),
        ("left_out_a_tick_of_all", of_all),
        ("left_out", rule.unit().to_owned()),
    ]
}

/// How settings with all savings and with none are called.
const ALL: &str = "all";
const NONE: &str = "none";

/// The poses that a method is measured on: all, or, where a tick without savings takes long, a few
/// of them.
fn timed(case: &Case, method: Method, effort: Effort) -> Vec<Pose> {
    let n_wanted = match method {
        Method::Table => case.poses.len(),
        _ => (effort.pick(200, 2000) / n_touches(case).max(1)).max(1),
    };
    let n_step = case.poses.len().div_ceil(n_wanted).max(1);
    case.poses.iter().step_by(n_step).copied().collect()
}

/// Contactors times textiles.
fn n_touches(case: &Case) -> usize {
    let n_contactors: usize = case.scene.displays.iter().map(|d| d.offsets.len()).sum();
    n_contactors * case.scene.textiles.len()
}

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

/// The largest amplitude that any point of a scene would have unfiltered, µm.
fn unfiltered_um(scene: &RenderScene) -> f64 {
    let most = |surface: &Surface, directions: [Direction; 2]| {
        let of = |d: Direction| {
            let spectra = surface.spectra(d);
            let total = |point| spectra.powers_um2(point).iter().sum::<f64>();
            (0..spectra.n_points()).map(total).fold(0.0, f64::max)
        };
        of(directions[0]).max(of(directions[1]))
    };
    let squares = scene.textiles.iter().map(|placed| {
        let warp = [Direction::WarpForward, Direction::WarpReverse];
        let weft = [Direction::WeftForward, Direction::WeftReverse];
        2.0 * (most(&placed.surface, warp) + most(&placed.surface, weft))
    });
    squares.fold(0.0, f64::max).sqrt()
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
    let of_rendering = Rule::ALL.map(|rule| {
        let exact = if rule.is_exact() {
            "Amplitudes are the same to the bit."
        } else {
            "Amplitudes differ by less than the floor's share of the unfiltered amplitude."
        };
        format!("{} {exact}", Saving::of_rendering(rule).note())
    });
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
