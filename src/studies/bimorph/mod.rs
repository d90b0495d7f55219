//! The study of the bimorph: how to step a contactor that is stiff, hardly damped and held by a
//! DAC.
//!
//! A sine, held from sample to sample, has an answer in closed form: its line and all its images
//! through |H|. The answer of a method is the steady state of its own recursion, solved for, so
//! that no transient of a sharp resonance stands in the way.

mod cases;
mod emulator;
mod limits;

pub(crate) use cases::{CARRIERS_HZ, ContactorStep, SAMPLE_S, held_response, propagator};

use super::chart::{chart, lines_by};
use super::readable::largest;
use super::{Bench, Findings, ReportError, Row, Study, Timing};
use cases::{Case, Step};
use selvedge_chart::{Axis, Chart};
use selvedge_device::ContactorModel;
use selvedge_foundation::numerics::ode::StepMethod;

/// What the exact method keeps within.
const EXACT: f64 = 1e-9;
/// Steps of a run that is timed.
const TIMED_STEPS: usize = 1000;
/// Error and cost of four ways to step a contactor, by step, stiffness and quality.
pub(crate) const STUDY: Study = Study {
    name: "bimorph",
    chapter: "waveforms",
    question: "How should a contactor be stepped, with any skin on it and however sharp its \
               resonance?",
    reference: "The closed form of |H| for a sine that a DAC holds, its images included.",
    error: ("error of the displacement", "of it"),
    cost_of: "second of a contactor",
    run,
};

fn run(bench: &mut Bench<'_>) -> Result<Findings, ReportError> {
    bench.step(0.0, "the cost of a step")?;
    let costs = StepMethod::ALL.map(|method| (method, cost_of_a_step(method, bench)));
    let cases = Case::all(bench.effort);
    let mut findings = Findings::default();
    for (n_done, case) in cases.iter().enumerate() {
        bench.step(0.1 + 0.6 * n_done as f64 / cases.len() as f64, &case.name)?;
        for (method, cost) in &costs {
            findings.rows.extend(rows(case, *method, *cost, bench));
        }
    }
    findings.plots = error_plots(&cases, &findings.rows);
    bench.step(0.7, "limits of stability")?;
    limits::find(bench, &mut findings);
    bench.step(0.8, "the emulator's contactors")?;
    emulator::find(bench, &mut findings);
    findings
        .plots
        .push(("bimorph-response".to_owned(), emulator::responses()));
    findings.notes = notes(&findings);
    Ok(findings)
}

/// What one step costs: stage by stage for Runge–Kutta, one product of matrices for the others.
fn cost_of_a_step(method: StepMethod, bench: &mut Bench<'_>) -> Option<Timing> {
    let model = ContactorModel::default();
    let system = model.system();
    let step = propagator(&model, method, 1e-6)?;
    let mut state = [0.0; 5];
    Some(bench.time(TIMED_STEPS, || {
        for nth in 0..TIMED_STEPS {
            let input = [(nth % 7) as f64, 1.0];
            state = match method {
                StepMethod::RungeKutta4 => system.runge_kutta_4(&state, &input, 1e-6),
                _ => step.step(&state, &input),
            };
        }
        state
    }))
}

/// A row a step.
fn rows(case: &Case, method: StepMethod, cost: Option<Timing>, bench: &Bench<'_>) -> Vec<Row> {
    let row = |step: &Step| {
        let error = error_of(case, method, step);
        Row::of(method.name(), step.label(), step.of_case(&case.name))
            .error(error)
            .promised((method == StepMethod::ExactHold).then_some(EXACT))
            .cost(cost.map(|cost| cost.times(1.0 / step.step_s())))
            .with("step_s", format!("{:e}", step.step_s()))
            .with("quality", case.model.quality)
            .with("skin_n_per_m", case.model.skin.stiffness_n_per_m)
            .with("is_stable", error.is_some())
    };
    Step::all(bench.effort).iter().map(row).collect()
}

/// The larger of the relative errors at both carriers; `None` of a method that grows without end.
fn error_of(case: &Case, method: StepMethod, step: &Step) -> Option<f64> {
    let one = propagator(&case.model, method, step.step_s())?;
    let whole = one.repeated(step.per_hold);
    // Exact steps of a stable system are stable, whatever rounding says of a growth of nearly 1.
    if method != StepMethod::ExactHold && whole.growth() > 1.0 {
        return None;
    }
    let errors = CARRIERS_HZ.map(|frequency_hz| {
        let truth = held_response(&case.model, frequency_hz, step.hold_s);
        let angle = std::f64::consts::TAU * frequency_hz * step.hold_s;
        let found = whole.response(angle)?[ContactorModel::PIN][0];
        Some((1e6 * found - truth).norm() / truth.norm())
    });
    Some(errors[0]?.max(errors[1]?))
}

/// Error against step for the usual contactor and the hardest.
fn error_plots(cases: &[Case], rows: &[Row]) -> Vec<(String, Chart)> {
    let ends = [("usual", cases.first()), ("hardest", cases.last())];
    let plots = ends.into_iter().filter_map(|(name, case)| {
        let case = &case?.name;
        let of_case = rows.iter().filter(|row| row.case.starts_with(case));
        let plot = chart(
            format!("Error against step: {case}"),
            Axis::log("step, s"),
            Axis::log("error of the displacement, of it"),
            lines_by(
                of_case,
                |row| &row.method,
                |row| Some([step_of(row)?, row.error?]),
            ),
            "The worse of 40 and 320 Hz; no dot where a method grows without end. Steps above 125 \
             µs hold their input as long as they last.",
        );
        Some((format!("bimorph-{name}"), plot))
    });
    plots.collect()
}

fn step_of(row: &Row) -> Option<f64> {
    row.further_number("step_s")
}

/// What the rows come to.
fn notes(findings: &Findings) -> Vec<String> {
    let worst = |method: StepMethod| {
        let is_one_sample =
            |row: &&Row| step_of(row).is_some_and(|s| (s / SAMPLE_S - 1.0).abs() < 1e-9);
        let rows = findings
            .rows
            .iter()
            .filter(|row| row.method == method.name());
        let errors: Vec<Option<f64>> = rows.filter(is_one_sample).map(|row| row.error).collect();
        let stable: Vec<f64> = errors.iter().copied().flatten().collect();
        let n_grown = errors.len() - stable.len();
        let error = if stable.is_empty() {
            String::new()
        } else {
            let largest = largest(stable);
            format!(", at worst {largest:.1e} of the displacement off where it does not")
        };
        let (name, n) = (method.name(), errors.len());
        format!(
            "One step a sample of 125 µs, {name}: grows without end in {n_grown} of {n} \
             cases{error}."
        )
    };
    let mut notes: Vec<String> = StepMethod::ALL.map(worst).into();
    notes.push(format!(
        "The exact hold needs one product of matrices a sample at any stiffness and any quality up \
         to {}; the emulator steps every contactor with it.",
        ContactorModel::MAX_QUALITY
    ));
    notes.push(
        "Where neither skin lifts off nor the amplifier reaches a limit the contactor is linear, \
         and every method is a product of matrices; Runge–Kutta is timed stage by stage, as it is \
         where it is needed."
            .to_owned(),
    );
    notes
}

#[cfg(test)]
mod tests;
