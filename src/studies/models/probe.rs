//! The virtual probe: what the step of the surface costs it, against the curve that a disc's
//! lowest point follows over a wave.

use std::f64::consts::TAU;

use crate::readable::{apart_percent, rms, whole};
use crate::{Bench, Findings, ReportError, Row, Study};
use selvedge_foundation::numerics::{Grid, bisected};
use selvedge_textile::surface::Probe;

/// Length of the stroke, mm.
const LENGTH_MM: f64 = 10.0;

/// Error of the virtual probe by step and wave, and what a stroke costs.
pub(crate) const STUDY: Study = Study {
    name: "virtual-probe",
    chapter: "surfaces",
    question: "How finely must a surface be sampled for the virtual tester's wire?",
    reference: "The curve parallel to a wave, which the middle of a round wire follows over it.",
    error: ("rms error", "%"),
    cost_of: "mm of a track",
    run,
};

fn run(bench: &mut Bench<'_>) -> Result<Findings, ReportError> {
    let waves = [(10.0, 1.0), (10.0, 2.5), (40.0, 1.2), (2.0, 5.0)];
    let steps = [0.1, 0.05, 0.02, 0.01, 1.0 / 230.0, 0.002];
    let n_steps = bench.effort.pick(3, steps.len());
    let mut rows = Vec::new();
    for (done, wave) in waves.into_iter().enumerate() {
        bench.step(done as f64 / 4.0, "drawing the wire over a wave")?;
        for step_mm in steps.into_iter().take(n_steps) {
            rows.push(row(wave, step_mm, bench));
        }
    }
    let notes = [
        "Waves that the wire follows into every valley; where it bridges them there is no \
         such formula. Promised: a rounded top is missed by at most an eighth of its curvature \
         times the square of the step, the disc's and the wave's together; nothing where that is \
         more than the wave.",
    ];
    Ok(Findings::new(rows, Vec::new(), notes))
}

fn row((a_um, per_mm): (f64, f64), step_mm: f64, bench: &mut Bench<'_>) -> Row {
    let probe = Probe::ideal();
    let margin = probe.margin_samples(step_mm);
    let n = whole((LENGTH_MM / step_mm).round());
    let mut track = Grid::filled(n + 2 * margin, 1, 0.0);
    for (i, height_um) in track.row_mut(0).iter_mut().enumerate() {
        let x_mm = (i as f64 - margin as f64) * step_mm;
        *height_um = a_um * (TAU * per_mm * x_mm).cos();
    }
    let found = probe.lift_um(&track, step_mm);
    let truth: Vec<f64> = (0..n)
        .map(|i| parallel_um((a_um, per_mm), probe.radius_mm, i as f64 * step_mm))
        .collect();
    let cost = bench.time(1, || probe.lift_um(&track, step_mm));
    let bend_per_mm = a_um / 1000.0 * (TAU * per_mm).powi(2);
    // How steep the disc may be where it is touched, half a step farther out.
    let slope = a_um / 1000.0 * TAU * per_mm;
    let sine = slope / slope.hypot(1.0) + 0.5 * step_mm / probe.radius_mm;
    let disc_per_mm = (1.0 - sine * sine).powf(-1.5) / probe.radius_mm;
    let most_um = 125.0 * step_mm * step_mm * (bend_per_mm + disc_per_mm);
    let most_percent = 100.0 * most_um / rms(&truth);
    let case = format!("{a_um} µm at {per_mm}/mm");
    Row::of("dilation", format!("{step_mm:.4} mm"), case)
        .error(apart_percent(&found, &truth))
        .promised((most_percent < 100.0).then_some(most_percent))
        .cost(cost.times(1.0 / LENGTH_MM))
        .number("curvature_times_radius", 2, bend_per_mm * probe.radius_mm)
}

/// Height of the lowest point of a disc that touches `a cos(2πνx)` once, its middle over `x_mm`:
/// the middle stands one radius along the normal from where it touches.
pub(super) fn parallel_um((a_um, per_mm): (f64, f64), radius_mm: f64, x_mm: f64) -> f64 {
    let omega = TAU * per_mm;
    let a_mm = a_um / 1000.0;
    let slope = |x: f64| -a_mm * omega * (omega * x).sin();
    let shift = |x: f64| radius_mm * slope(x) / slope(x).hypot(1.0);
    // Where it touches: x = x_c − shift(x_c) rises with x_c, so halving the interval finds it.
    let ends = [x_mm - radius_mm, x_mm + radius_mm];
    let touch = bisected(ends, 60, |middle| middle - shift(middle) < x_mm);
    let up_mm = radius_mm / slope(touch).hypot(1.0) - radius_mm;
    a_um * (omega * touch).cos() + 1000.0 * up_mm
}
