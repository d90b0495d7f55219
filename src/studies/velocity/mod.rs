//! The study of velocity estimators: how wrong, how late, how dear.
//!
//! Pointing devices with steps, noise, stamps that come late and bursts draw strokes whose velocity
//! is known; every method is asked at ticks of 25 ms, as the engine asks it.

mod candidates;
mod pointers;
mod strokes;
mod tally;
mod verdict;

use std::time::{Duration, Instant};

use selvedge_engine::{PointerSample, TICKS_PER_S, VelocityEstimator, VelocityMethod};
use selvedge_foundation::numerics::Random;

use super::{Bench, Findings, ReportError, Row, Study, Timing};
use candidates::{candidates, setting};
use pointers::{POINTERS, Pointer, QUICK_POINTERS, Sample};
use strokes::{QUICK_STROKES, STROKES};
use tally::{Estimated, Tally};

/// Ticks before this time are not judged, s: every method has seen something by then.
const FROM_S: f64 = 0.3;

/// A method on a pointer, over all strokes.
#[derive(Clone)]
struct Outcome {
    method: VelocityMethod,
    pointer: Pointer,
    cost: Timing,
    tally: Tally,
    /// 99th percentile of the level error of the steady stroke, dB.
    steady_db: f64,
}

/// Velocity error against delay and cost of the five estimators.
pub(crate) const STUDY: Study = Study {
    name: "velocity",
    chapter: "velocity",
    question: "How far from the finger's velocity is each estimator, how late, and at what cost?",
    reference: "The velocity of strokes known in closed form, at the tick that asks.",
    error: ("rms velocity error", "mm/s"),
    cost_of: "sample",
    run,
};

fn run(bench: &mut Bench<'_>) -> Result<Findings, ReportError> {
    let pointers: &[Pointer] = bench.effort.pick(&QUICK_POINTERS, &POINTERS);
    let candidates = candidates(bench.effort.pick(1, 6));
    let mut findings = Findings::default();
    let mut results = Vec::new();
    for (n_done, pointer) in pointers.iter().enumerate() {
        bench.step(n_done as f64 / pointers.len() as f64, pointer.label)?;
        results.extend(on_pointer(*pointer, &candidates, bench, &mut findings.rows));
    }
    findings.plots = verdict::plots(&results, pointers);
    findings.notes = verdict::notes(&results);
    Ok(findings)
}

/// Every candidate on one pointer; a row a stroke, and one for all strokes.
fn on_pointer(
    pointer: Pointer,
    candidates: &[VelocityMethod],
    bench: &mut Bench<'_>,
    rows: &mut Vec<Row>,
) -> Vec<Outcome> {
    let strokes = bench.effort.pick(&QUICK_STROKES[..], &STROKES[..]);
    let duration_s = bench.effort.pick(6.0, 20.0);
    let random = Random::new(bench.seed).branch(pointer.label);
    let drawn = |stroke: &strokes::Stroke| {
        let mut random = random.branch(stroke.label);
        pointer.samples(&stroke.at, duration_s, &mut random)
    };
    let drawings: Vec<Vec<Sample>> = strokes.iter().map(drawn).collect();
    let busiest = drawings.iter().max_by_key(|samples| samples.len());
    let busiest = busiest.map_or(&[][..], Vec::as_slice);
    let mut results = Vec::new();
    for &method in candidates {
        let mut estimator = VelocityEstimator::new(method);
        let cost = bench.time(busiest.len(), || {
            estimates(&mut estimator, busiest, duration_s)
        });
        let (mut all, mut steady_db) = (Tally::default(), f64::NAN);
        for (stroke, samples) in strokes.iter().zip(&drawings) {
            let estimates = estimates(&mut estimator, samples, duration_s);
            let tally = Tally::of(&estimates, &stroke.at, stroke.is_varied);
            if stroke.label == strokes::STEADY.label {
                steady_db = tally.p99_db();
            }
            all.add(&tally);
            let case = format!("{}; {}", pointer.label, stroke.label);
            let is_promised = stroke.label == strokes::STEADY.label
                && method == VelocityMethod::default()
                && !pointer.is_bursty();
            let row = row(method, case, &tally, cost);
            rows.push(row.promised(is_promised.then(verdict::steady_mm_per_s)));
        }
        let case = format!("{}; all strokes", pointer.label);
        rows.push(row(method, case, &all, cost));
        results.push(Outcome {
            method,
            pointer,
            cost,
            tally: all,
            steady_db,
        });
    }
    results
}

/// What an estimator says at every tick from [`FROM_S`] on.
fn estimates(
    estimator: &mut VelocityEstimator,
    samples: &[Sample],
    duration_s: f64,
) -> Vec<Estimated> {
    estimator.reset();
    let start = Instant::now();
    let at = |t_s: f64| start + Duration::from_secs_f64(t_s);
    let mut waiting = samples.iter().peekable();
    let mut found = Vec::new();
    let mut tick = 0.0;
    while tick < duration_s * TICKS_PER_S {
        let t_s = tick / TICKS_PER_S;
        tick += 1.0;
        while let Some(&(stamp_s, position)) = waiting.next_if(|sample| sample.0 <= t_s) {
            let stamp = at(stamp_s);
            estimator.push(PointerSample { stamp, position });
        }
        if t_s >= FROM_S {
            let estimate = estimator.estimate(at(t_s));
            found.push((t_s, estimate.velocity, estimate.lag_s));
        }
    }
    found
}

fn row(method: VelocityMethod, case: String, tally: &Tally, cost: Timing) -> Row {
    Row::of(method.label(), setting(method), case)
        .error(tally.rms_mm_per_s())
        .p99(tally.p99_mm_per_s())
        .cost(cost)
        .number("rms_db", 3, tally.rms_db())
        .number("p99_db", 3, tally.p99_db())
        .number("delay_ms", 2, 1e3 * tally.delay_s())
        .number("stated_lag_ms", 2, 1e3 * tally.lag_s())
        .number("jitter_mm_per_s", 3, tally.jitter_mm_per_s())
}

#[cfg(test)]
mod tests;
