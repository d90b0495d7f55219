//! The longest step that does not grow without end, by method and stiffness.

use super::cases::{SAMPLE_S, propagator};
use crate::chart::chart;
use crate::{Bench, Findings, Row};
use selvedge_chart::{Axis, Series, Style};
use selvedge_device::{ContactorModel, Skin};
use selvedge_foundation::numerics::ode::StepMethod;
use selvedge_foundation::quantity::time_span;

/// Steps that are looked at, s.
const STEPS_S: [f64; 2] = [1e-9, 1.0];
/// Halvings of the range, by ratio: to a millionth.
const HALVINGS: usize = 25;
/// A growth that rounding may feign.
const ROUNDING: f64 = 1e-6;

/// Rows and a plot of the limits.
pub(super) fn find(bench: &Bench<'_>, findings: &mut Findings) {
    let n_decades = bench.effort.pick(1, 4);
    let stiffnesses =
        (0..=5 * n_decades).map(|nth| 10.0_f64.powf(f64::from(nth) / f64::from(n_decades)));
    let stiffnesses: Vec<f64> = std::iter::once(0.0).chain(stiffnesses).collect();
    let mut all = Vec::new();
    for quality in [40.0, ContactorModel::MAX_QUALITY] {
        for method in StepMethod::ALL {
            let limit = |&ks: &f64| [ks, limit_s(&contactor(ks, quality), method)];
            let limits: Vec<[f64; 2]> = stiffnesses.iter().map(limit).collect();
            let rows = limits.iter().map(|limit| row(method, quality, *limit));
            findings.rows.extend(rows);
            if method == StepMethod::RungeKutta4 {
                // Free skin has no place on a logarithmic axis; it stands in the table.
                let placed = limits.into_iter().filter(|limit| limit[0] > 0.0);
                let name = format!("{}, Q {quality}", method.name());
                all.push(Series::of(name, Style::Line, placed));
            }
        }
    }
    let flat = |name: &str, s: f64| Series::of(name, Style::Dashed, [[1.0, s], [1e5, s]]);
    all.push(flat("a sample of the DAC", SAMPLE_S));
    all.push(flat("the others: every step", STEPS_S[1]));
    let longest = time_span(STEPS_S[1]);
    let plot = chart(
        "Longest stable step",
        Axis::log("stiffness of the skin, N/m"),
        Axis::log("step, s"),
        all,
        format!("Skin without damping. Steps up to {longest} were looked at."),
    );
    findings.plots.push(("bimorph-limits".to_owned(), plot));
}

fn contactor(stiffness_n_per_m: f64, quality: f64) -> ContactorModel {
    ContactorModel {
        quality,
        skin: Skin::bonded(stiffness_n_per_m, 0.0),
        ..ContactorModel::default()
    }
}

fn is_stable(model: &ContactorModel, method: StepMethod, step_s: f64) -> bool {
    let step = propagator(model, method, step_s);
    step.is_some_and(|step| step.growth() <= 1.0 + ROUNDING)
}

/// The longest stable step, found by halving the range; its upper end where all are stable.
pub(super) fn limit_s(model: &ContactorModel, method: StepMethod) -> f64 {
    let [mut stable_s, mut other_s] = STEPS_S;
    if is_stable(model, method, other_s) {
        return other_s;
    }
    for _ in 0..HALVINGS {
        let middle_s = (stable_s * other_s).sqrt();
        if is_stable(model, method, middle_s) {
            stable_s = middle_s;
        } else {
            other_s = middle_s;
        }
    }
    stable_s
}

fn row(method: StepMethod, quality: f64, [stiffness, limit_s]: [f64; 2]) -> Row {
    let setting = if limit_s < STEPS_S[1] {
        format!("stable up to {}", time_span(limit_s))
    } else {
        "stable at every step".to_owned()
    };
    let case = format!("limit of stability, Q {quality}");
    Row::of(method.name(), setting, case)
        .size(stiffness)
        .with("quality", quality)
        .with("skin_n_per_m", stiffness)
        .with("stable_up_to_s", format!("{limit_s:e}"))
}
