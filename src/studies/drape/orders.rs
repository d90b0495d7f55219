//! How fast errors fall with the step and with the spacing of the grid.

use super::{Sample, distance, off_mm};
use crate::readable::{number, rms, whole};
use crate::{Bench, Effort, Findings, ReportError, Row, Study};
use selvedge_drape::{Drape, Integrator};

/// Orders in time and in space.
pub(crate) const ORDERS: Study = Study {
    name: "drape-orders",
    chapter: "cloth",
    question: "How fast do errors of a hanging cloth fall with the step and with the spacing?",
    reference: "The first order of implicit Euler, the second of BDF2 and in space, by halving.",
    error: ("off the order", ""),
    cost_of: "",
    run,
};

/// How far from its order what is found may be: the finest are halves of halves.
const OFF: f64 = 0.2;
/// How long a cloth swings, s, and the steps, s: each half the one before.
const SWINGS_S: f64 = 0.08;
const STEPS_S: [f64; 4] = [0.4e-3, 0.2e-3, 0.1e-3, 0.05e-3];
/// Step of the explicit reference, s.
const REFERENCE_S: f64 = 2e-6;

fn run(bench: &mut Bench<'_>) -> Result<Findings, ReportError> {
    bench.step(0.0, "in time")?;
    let mut rows = in_time(bench.effort)?;
    bench.step(0.3, "in space")?;
    rows.extend(in_space(bench.effort)?);
    let note = "An order is the logarithm to base 2 of an error over that at half the step or \
                spacing. In space errors are from one grid to the next at the same places of the \
                cloth; that of the coarsest grids is not promised.";
    Ok(Findings::new(rows, Vec::new(), [note]))
}

/// A row for each halving, of which the last promises its order.
fn halvings((method, case): (&str, &str), errors: &[(String, f64)], order: f64) -> Vec<Row> {
    let row = |(nth, pair): (usize, &[(String, f64)])| {
        let [(from, before), (to, after)] = pair else {
            return Row::default();
        };
        let found = (before / after).log2();
        let is_last = nth + 2 == errors.len();
        Row::of(method, format!("{from} to {to}"), case)
            .error((found - order).abs())
            .promised(is_last.then_some(OFF))
            .number("order", 2, found)
            .with("before_mm", number(*before))
            .with("after_mm", number(*after))
    };
    errors.windows(2).enumerate().map(row).collect()
}

/// A small soft cloth that is let go at 46°, against explicit steps far shorter.
fn in_time(effort: Effort) -> Result<Vec<Row>, ReportError> {
    let sample = Sample {
        n: effort.pick(6, 9),
        stiffness_n_per_m: Some(100.0),
        ..Sample::SHIRTING
    };
    let swung = |integrator: Integrator, step_s: f64| -> Result<Drape, ReportError> {
        let mut drape = sample.drape(46.0, (integrator, Some(step_s)))?;
        drape.solve_exactly();
        (0..whole((SWINGS_S / step_s).round())).try_for_each(|_| drape.step(&[]))?;
        Ok(drape)
    };
    let reference = swung(Integrator::Explicit, REFERENCE_S)?;
    let truth_mm: Vec<_> = reference.places_mm().collect();
    let mut rows = Vec::new();
    for (integrator, order) in [(Integrator::ImplicitEuler, 1.0), (Integrator::Bdf2, 2.0)] {
        let error = |step_s: f64| {
            let name = format!("{} ms", number(1e3 * step_s));
            Ok((name, off_mm(&swung(integrator, step_s)?, &truth_mm)))
        };
        let errors: Result<Vec<_>, ReportError> = STEPS_S.into_iter().map(error).collect();
        rows.extend(halvings((integrator.name(), "in time"), &errors?, order));
    }
    Ok(rows)
}

/// The shape at rest of a limp cloth in an upright frame.
fn in_space(effort: Effort) -> Result<Vec<Row>, ReportError> {
    let hung = |n: &usize| -> Result<Vec<[f64; 3]>, ReportError> {
        let sample = Sample {
            n: *n,
            pins: "frame",
            stiffness_n_per_m: Some(10.0),
            // A finger far away: the cloth hangs, and nobody touches it.
            n_fingers: 1,
            ..Sample::SHIRTING
        };
        let drape = sample.drape(0.0, (Integrator::ImplicitEuler, Some(1e-3)))?;
        Ok(drape.places_mm().collect())
    };
    let grids = effort.pick(&[7, 13, 25, 49][..], &[13, 25, 49, 97]);
    let shapes: Vec<_> = grids.iter().map(hung).collect::<Result<_, _>>()?;
    let error = |(n, pair): (&usize, &[Vec<[f64; 3]>])| {
        let apart = pair[0].iter().enumerate().map(|(vertex, place)| {
            let [i, j] = [vertex % n, vertex / n];
            distance(*place, pair[1][2 * (j * (2 * n - 1) + i)])
        });
        (format!("{n}²"), rms(&apart.collect::<Vec<f64>>()))
    };
    let errors: Vec<_> = grids.iter().zip(shapes.windows(2)).map(error).collect();
    Ok(halvings(("rest", "in space"), &errors, 2.0))
}
