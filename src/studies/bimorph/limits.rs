//! The longest step that does not grow without end, by method and stiffness.

use super::cases::{SAMPLE_S, propagator};
use crate::Bench;
use crate::{Findings, Row};
use selvedge_chart::{Axis, Chart, Series, Style};
use selvedge_device::{ContactorModel, MAX_QUALITY, Skin};
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
    let mut series = Vec::new();
    for quality in [40.0, MAX_QUALITY] {
        for method in StepMethod::ALL {
            let limits: Vec<[f64; 2]> = stiffnesses
                .iter()
                .map(|&ks| [ks, limit_s(&contactor(ks, quality), method)])
                .collect();
            findings
                .rows
                .extend(limits.iter().map(|limit| row(method, quality, *limit)));
            if method == StepMethod::RungeKutta4 {
                series.push(line(&format!("{}, Q {quality}", method.name()), limits));
            }
        }
    }
    let [least, most] = [1.0, 1e5];
    let flat = |name: &str, step_s: f64| Series {
        style: Style::Dashed,
        ..line(name, vec![[least, step_s], [most, step_s]])
    };
    series.push(flat("a sample of the DAC", SAMPLE_S));
    let all_steps = "the others: every step";
    series.push(flat(all_steps, STEPS_S[1]));
    findings
        .plots
        .push(("bimorph-limits".to_owned(), plot(series)));
}

fn line(name: &str, points: Vec<[f64; 2]>) -> Series {
    // Free skin has no place on a logarithmic axis; it stands in the table.
    let is_placed = |point: &[f64; 2]| point[0] > 0.0;
    Series {
        name: name.to_owned(),
        points: points.into_iter().filter(is_placed).collect(),
        style: Style::Line,
        ..Series::default()
    }
}

fn plot(series: Vec<Series>) -> Chart {
    Chart {
        title: "Longest stable step".to_owned(),
        x: Axis::log("stiffness of the skin, N/m"),
        y: Axis::log("step, s"),
        series,
        footnote: format!(
            "Skin without damping. Steps up to {} were looked at.",
            time_span(STEPS_S[1])
        ),
        ..Chart::default()
    }
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
    Row {
        method: method.name().to_owned(),
        setting,
        case: format!("limit of stability, Q {quality}"),
        size: Some(stiffness),
        more: vec![
            ("quality", quality.to_string()),
            ("skin_n_per_m", stiffness.to_string()),
            ("stable_up_to_s", format!("{limit_s:e}")),
        ],
        ..Row::default()
    }
}
