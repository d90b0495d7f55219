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

use selvedge_engine::{PointerSample, TICKS_PER_S, VelocityEstimator};
use selvedge_foundation::numerics::Random;

use super::{Bench, Findings, ReportError, Row, Study, Timing};
use candidates::{Candidate, candidates};
use pointers::{POINTERS, Pointer, QUICK_POINTERS, Sample};
use strokes::{QUICK_STROKES, STROKES};
use tally::{Estimated, Tally};

/// Ticks before this time are not judged, s: every method has seen something by then.
const FROM_S: f64 = 0.3;

/// Velocity error against delay and cost of the five estimators.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct VelocityStudy;

/// A method on a pointer, over all strokes.
struct Outcome {
    candidate: Candidate,
    pointer: Pointer,
    cost: Timing,
    tally: Tally,
    /// 99th percentile of the level error of the steady stroke, dB.
    steady_db: f64,
}

impl Study for VelocityStudy {
    fn name(&self) -> &'static str {
        "velocity"
    }

    fn question(&self) -> &'static str {
        "How far from the finger's velocity is each estimator, how late, and at what cost?"
    }

    fn reference(&self) -> &'static str {
        "The velocity of strokes known in closed form, at the tick that asks."
    }

    fn error_measure(&self) -> (&'static str, &'static str) {
        ("rms velocity error", "mm/s")
    }

    fn cost_of(&self) -> &'static str {
        "sample"
    }

    fn run(&self, bench: &mut Bench<'_>) -> Result<Findings, ReportError> {
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
}

/// Every candidate on one pointer; a row a stroke, and one for all strokes.
fn on_pointer(
    pointer: Pointer,
    candidates: &[Candidate],
    bench: &mut Bench<'_>,
    rows: &mut Vec<Row>,
) -> Vec<Outcome> {
    let strokes = bench.effort.pick(&QUICK_STROKES[..], &STROKES[..]);
    let duration_s = bench.effort.pick(6.0, 20.0);
    let random = Random::new(bench.seed).branch(pointer.label);
    let drawn = |stroke: &strokes::Stroke| {
        let mut random = random.branch(&stroke.label());
        pointer.samples(&|t_s| stroke.at(t_s), duration_s, &mut random)
    };
    let drawings: Vec<Vec<Sample>> = strokes.iter().map(drawn).collect();
    let busiest = drawings.iter().max_by_key(|samples| samples.len());
    let busiest = busiest.map_or(&[][..], Vec::as_slice);
    let mut results = Vec::new();
    for candidate in candidates {
        let mut estimator = VelocityEstimator::new(candidate.method);
        let cost = bench.time(busiest.len(), || {
            estimates(&mut estimator, busiest, duration_s)
        });
        let (mut all, mut steady_db) = (Tally::default(), f64::NAN);
        for (stroke, samples) in strokes.iter().zip(&drawings) {
            let estimates = estimates(&mut estimator, samples, duration_s);
            let tally = Tally::of(&estimates, &|t_s| stroke.at(t_s), stroke.is_varied());
            if *stroke == strokes::STEADY {
                steady_db = tally.p99_db();
            }
            all.add(&tally);
            let case = format!("{}; {}", pointer.label, stroke.label());
            rows.push(row(candidate, case, &tally, cost));
        }
        rows.push(row(
            candidate,
            format!("{}; all strokes", pointer.label),
            &all,
            cost,
        ));
        let candidate = candidate.clone();
        results.push(Outcome {
            steady_db,
            candidate,
            pointer,
            cost,
            tally: all,
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

fn row(candidate: &Candidate, case: String, tally: &Tally, cost: Timing) -> Row {
    let number = |value: f64, decimals: usize| {
        if value.is_finite() {
            format!("{value:.decimals$}")
        } else {
            String::new()
        }
    };
    Row {
        method: candidate.method.label().to_owned(),
        setting: candidate.setting.clone(),
        case,
        error: Some(tally.rms_mm_per_s()),
        error_p99: Some(tally.p99_mm_per_s()),
        cost: Some(cost),
        more: vec![
            ("rms_db", number(tally.rms_db(), 3)),
            ("p99_db", number(tally.p99_db(), 3)),
            ("delay_ms", number(1e3 * tally.delay_s(), 2)),
            ("stated_lag_ms", number(1e3 * tally.lag_s(), 2)),
            ("jitter_mm_per_s", number(tally.jitter_mm_per_s(), 3)),
        ],
        ..Row::default()
    }
}

#[cfg(test)]
mod tests;
