//! What the parts of a step cost, and whether whole scenes keep up with life.

use std::time::Instant;

use super::{Sample, pinch};
use crate::{Bench, Effort, ReportError, Row, Timing};
use selvedge_drape::{Drape, Hand, Integrator, StepParts};
use selvedge_foundation::numerics::to_index;
use selvedge_foundation::progress::thread_cpu_seconds;

/// A part of a step, what is done for it, and what it is to cost at most, ns a vertex.
type Part = (&'static str, fn(&mut StepParts), Option<u32>);

const PARTS: [Part; 4] = [
    ("gradient", StepParts::gradient, Some(55)),
    ("product", StepParts::product, Some(20)),
    ("line", StepParts::line, Some(8)),
    ("making line", StepParts::lines, None),
];

/// A whole scene: vertices a side, whether two pads rub it, how it is stepped, whether by one
/// Newton step, and what is asked for.
type Scene = (usize, bool, (Integrator, f64), bool, &'static str);

const SCENES: [Scene; 6] = [
    (26, false, (Integrator::Bdf2, 1e-3), false, ""),
    (
        26,
        true,
        (Integrator::Bdf2, 1e-3),
        false,
        "0.7 cores, p99 1 ms",
    ),
    (26, true, (Integrator::Bdf2, 1.0 / 480.0), false, ""),
    (51, false, (Integrator::Bdf2, 1.0 / 480.0), false, ""),
    (51, true, (Integrator::Bdf2, 1.0 / 480.0), false, "told"),
    (
        51,
        true,
        (Integrator::ImplicitEuler, 1.0 / 240.0),
        true,
        "1 core",
    ),
];

/// Parts, contact and whole scenes.
pub(super) fn rows(bench: &mut Bench<'_>) -> Result<Vec<Row>, ReportError> {
    let grids = bench.effort.pick(&[13][..], &[26, 51]);
    let mut rows = Vec::new();
    for n in grids {
        rows.extend(parts(*n, bench)?);
    }
    for scene in SCENES {
        match bench.effort {
            Effort::Full => rows.push(keeps_up((scene, 0.5))?),
            Effort::Quick if scene.0 == 26 => {
                let (_, is_rubbed, step, is_cut, asked) = scene;
                rows.push(keeps_up(((13, is_rubbed, step, is_cut, asked), 0.25))?);
            }
            Effort::Quick => {}
        }
    }
    Ok(rows)
}

/// The parts of a step of a cloth between two pads, and a pass of positions.
fn parts(n: usize, bench: &mut Bench<'_>) -> Result<Vec<Row>, ReportError> {
    let case = format!("a part of a step, {n}²");
    let mut drape = pinched(n, (Integrator::Bdf2, 1e-3))?;
    for _ in 0..150 {
        let hands = rubbed(drape.t_s());
        drape.step(&hands)?;
    }
    let mut of_step = drape.parts();
    let n_vertices = n * n;
    let row = |name: &str, (cost, reach): (Timing, Option<u32>)| {
        let ns = 1e9 * cost.cpu_s / n_vertices as f64;
        let reach = reach.map_or_else(String::new, |ns| format!("{ns} ns"));
        let row = Row::of(name, "once", case.clone());
        row.number("ns_a_vertex", 1, ns).with("reach", reach)
    };
    let mut rows = Vec::new();
    for (name, work, reach) in PARTS {
        rows.push(row(name, (bench.time(1, || work(&mut of_step)), reach)));
    }
    let mut moved = swinging(n, (Integrator::Xpbd, 1.0 / 2400.0))?;
    let cost = bench.time(1, || moved.step(&[]).is_ok());
    rows.push(row("XPBD substep", (cost, Some(80))));
    let n_points = of_step.contact();
    let cost = bench.time(1, || of_step.contact());
    rows.push(
        Row::of("contact", "two pads", case)
            .with("points", n_points)
            .number("us_a_newton_step", 2, 1e6 * cost.cpu_s)
            .with("reach", "20 µs"),
    );
    Ok(rows)
}

/// A scene stepped for so many seconds: what a second costs, and how long the longest steps take.
fn keeps_up(
    ((n, is_rubbed, step, is_cut, asked), seconds): (Scene, f64),
) -> Result<Row, ReportError> {
    let mut drape = if is_rubbed {
        pinched(n, step)?
    } else {
        swinging(n, step)?
    };
    if is_cut {
        drape.bound_newton(1);
    }
    let before = *drape.counters();
    let (mut took_s, start) = (Vec::new(), Instant::now());
    while drape.t_s() < seconds - 1e-9 {
        let hands = rubbed(drape.t_s());
        let start_s = thread_cpu_seconds();
        drape.step(&hands[..if is_rubbed { 2 } else { 0 }])?;
        took_s.push(thread_cpu_seconds() - start_s);
    }
    let wall_s = start.elapsed().as_secs_f64() / seconds;
    let n_steps = took_s.len() as f64;
    let second_s = took_s.iter().sum::<f64>() / seconds;
    took_s.sort_by(f64::total_cmp);
    let at = |share: f64| 1e3 * took_s[to_index(share * (n_steps - 1.0))];
    let what = if is_rubbed { "two pads" } else { "swing" };
    let cut = if is_cut { ", one Newton step" } else { "" };
    let (integrator, _) = drape.integrator();
    let setting = format!("{:.2} ms{cut}", 1e3 * drape.step_s());
    let counters = *drape.counters();
    let newton = (counters.newton - before.newton) as f64 / n_steps;
    let linear = (counters.linear - before.linear) as f64 / n_steps;
    let cost = Timing::of(&mut [second_s], &mut [wall_s]);
    Ok(Row::of(
        integrator.name(),
        setting,
        format!("keeps up: {what}, {n}²"),
    )
    .cost(cost)
    .number("median_ms", 3, at(0.5))
    .number("p99_ms", 3, at(0.99))
    .number("newton_a_step", 2, newton)
    .number("linear_a_step", 1, linear)
    .with("redone", counters.redone - before.redone)
    .with("unconverged", counters.unconverged - before.unconverged)
    .with("reach", asked))
}

/// A shirting that is let go at 46°.
fn swinging(n: usize, (integrator, step_s): (Integrator, f64)) -> Result<Drape, ReportError> {
    let sample = Sample {
        n,
        ..Sample::SHIRTING
    };
    sample.drape(46.0, (integrator, Some(step_s)))
}

/// The same at rest between two pads, in air.
fn pinched(n: usize, (integrator, step_s): (Integrator, f64)) -> Result<Drape, ReportError> {
    let sample = Sample {
        n,
        n_fingers: 2,
        ..Sample::SHIRTING
    };
    sample.drape(0.0, (integrator, Some(step_s)))
}

/// Two pads that close, rub against each other and pull the cloth along.
fn rubbed(t_s: f64) -> [Hand; 2] {
    let along = 20.0 * (8.0 * (t_s - 0.1).max(0.0)).sin();
    let opening = 2.0 * (20.0 - 250.0 * t_s).max(-1.0);
    let mut hands = pinch([100.0, 80.0 + along, 0.0], opening);
    for (hand, side) in hands.iter_mut().zip([1.0, -1.0]) {
        hand.centre_mm[0] += 0.3 * side * along;
    }
    hands
}
