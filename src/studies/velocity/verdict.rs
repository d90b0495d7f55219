//! What follows from the velocity study: error against delay, and which method to begin with.

use crate::chart::{chart, place};
use selvedge_chart::{Axis, Chart, Series, Style};
use selvedge_engine::VelocityMethod;
use selvedge_foundation::quantity::{factor_of_gain, fixed, time_span, with_unit};

use super::Outcome;
use super::candidates::setting;
use super::pointers::Pointer;
use super::tally::Tally;

/// A steady stroke should stay within this at the 99th percentile, dB: about what is just noticed.
const STEADY_DB: f64 = 1.0;
/// Methods that break are not drawn: beyond this the axis would show nothing else, mm/s.
const DRAWN_MM_PER_S: f64 = 1000.0;

/// The same as an error of the steady stroke's velocity, mm/s.
pub(super) fn steady_mm_per_s() -> f64 {
    100.0 * (factor_of_gain(STEADY_DB) - 1.0)
}

/// Error against delay, over all pointers and for each.
pub(super) fn plots(results: &[Outcome], pointers: &[Pointer]) -> Vec<(String, Chart)> {
    let overall = overall(results);
    let dots = overall.iter().map(|all| (all.method, &all.tally));
    let mut plots = vec![("delay".to_owned(), plot("all pointers", dots))];
    for (index, pointer) in pointers.iter().enumerate() {
        let of_pointer = results.iter().filter(|result| result.pointer == *pointer);
        let dots = of_pointer.map(|result| (result.method, &result.tally));
        plots.push((format!("delay-{}", index + 1), plot(pointer.label, dots)));
    }
    plots
}

fn plot<'a>(what: &str, dots: impl Iterator<Item = (VelocityMethod, &'a Tally)>) -> Chart {
    let mut all: Vec<Series> = Vec::new();
    let is_drawn = |tally: &Tally| tally.rms_mm_per_s() <= DRAWN_MM_PER_S;
    for (method, tally) in dots.filter(|dot| is_drawn(dot.1)) {
        let at = place(&mut all, method.label(), Style::Dots);
        let series = &mut all[at];
        if method == VelocityMethod::default() {
            series.marked.push(series.points.len());
        }
        series
            .points
            .push([1e3 * tally.delay_s(), tally.rms_mm_per_s()]);
    }
    chart(
        format!("Velocity error against delay, {what}"),
        Axis::linear("delay on strokes that vary, ms"),
        Axis::log("rms velocity error, mm/s"),
        all,
        "one dot a setting; marked: the default; settings beyond 1000 mm/s left out",
    )
}

/// Every method over all pointers: the dearest cost, and the worst pointer's steady stroke.
fn overall(results: &[Outcome]) -> Vec<Outcome> {
    let mut all: Vec<Outcome> = Vec::new();
    for result in results {
        // Bursts break the rhythm of the steady stroke itself; they count in the error.
        let is_counted = !result.pointer.is_bursty();
        let steady_db = if is_counted { result.steady_db } else { 0.0 };
        if let Some(known) = all.iter_mut().find(|known| known.method == result.method) {
            known.tally.add(&result.tally);
            known.cost.cpu_s = known.cost.cpu_s.max(result.cost.cpu_s);
            known.steady_db = known.steady_db.max(steady_db);
        } else {
            all.push(Outcome {
                steady_db,
                ..result.clone()
            });
        }
    }
    all
}

/// The numbers that the default was chosen by, a sentence each.
pub(super) fn notes(results: &[Outcome]) -> Vec<String> {
    let mut overall = overall(results);
    overall.sort_by(|a, b| a.tally.rms_mm_per_s().total_cmp(&b.tally.rms_mm_per_s()));
    let within = with_unit(STEADY_DB, 0, "dB");
    let is_default = |all: &&Outcome| all.method == VelocityMethod::default();
    let mut notes = Vec::new();
    for (what, found) in [
        (
            "Least rms error over all strokes and pointers".to_owned(),
            overall.first(),
        ),
        (
            format!("Least of those within {within} on a steady stroke"),
            overall.iter().find(|all| all.steady_db <= STEADY_DB),
        ),
        ("The default".to_owned(), overall.iter().find(is_default)),
    ] {
        notes.extend(found.map(|found| format!("{what}: {}.", describe(found))));
    }
    let mut seen: Vec<&str> = Vec::new();
    for all in &overall {
        let label = all.method.label();
        if !seen.contains(&label) {
            seen.push(label);
            notes.push(format!("Best setting of its kind: {}.", describe(all)));
        }
    }
    notes.push(
        "The error is taken at the tick that asks, so a delay counts as error; the delay holds \
         the age of the samples too. Levels are compared from 10 mm/s up."
            .to_owned(),
    );
    notes.push(format!(
        "Promised is {within}, rms, of the default on the steady stroke, unless samples come in \
         bursts."
    ));
    notes
}

fn describe(all: &Outcome) -> String {
    let tally = &all.tally;
    let name = [all.method.label(), &setting(all.method)].join(" ");
    format!(
        "{} has {} rms ({} at the 99th percentile), {} rms of level, {} on a steady \
         stroke at the 99th percentile, a delay of {} and costs {} a sample",
        name.trim_end(),
        with_unit(tally.rms_mm_per_s(), 2, "mm/s"),
        fixed(tally.p99_mm_per_s(), 1),
        with_unit(tally.rms_db(), 2, "dB"),
        with_unit(all.steady_db, 2, "dB"),
        with_unit(1e3 * tally.delay_s(), 1, "ms"),
        time_span(all.cost.cpu_s),
    )
}
