//! Stability: what comes back when something extreme goes in, against what is promised.
//!
//! Every case runs for real on the library's own functions, on a thread of its own: one that panics
//! or never ends is reported as such and harms no other. None of them may panic, hang, or give a
//! number that is not finite to a device.
#![expect(
    clippy::float_cmp,
    reason = "silence is exactly 0, and what must not change must not change by a bit"
)]

mod case;
mod contactor;
#[cfg(test)]
mod tests;

mod device;
mod input;
mod link_faults;
mod motion;
mod picture;
mod pointer;
mod scene;
mod shading;
mod stylus;
mod sweeps;
mod tuning;

pub(crate) use sweeps::SWEEPS;

use std::sync::mpsc::{RecvTimeoutError, sync_channel};
use std::thread;
use std::time::Duration;

use super::runner::message_of;
use super::{Bench, Findings, ReportError, Row, Study};
use case::{Case, Verdict};
use selvedge_foundation::quantity::time_span;

/// A case that says nothing for longer hangs.
const PATIENCE: Duration = Duration::from_secs(30);

/// The study.
pub(crate) const STUDY: Study = Study {
    name: "stability",
    chapter: "stability",
    question: "What comes back when something extreme goes in?",
    reference: "what is promised for each case.",
    error: ("cases that came out otherwise", "cases"),
    cost_of: "case",
    run,
};

fn run(bench: &mut Bench<'_>) -> Result<Findings, ReportError> {
    let cases = [
        motion::cases(),
        tuning::cases(),
        input::cases(),
        pointer::cases(),
        picture::cases(),
        shading::cases(),
        device::cases(),
        contactor::cases(),
        stylus::cases(),
        link_faults::cases(),
    ];
    try_all(cases.into_iter().flatten().collect(), PATIENCE, bench)
}

/// Tries every case and reports what came back.
fn try_all(
    cases: Vec<Case>,
    patience: Duration,
    bench: &mut Bench<'_>,
) -> Result<Findings, ReportError> {
    let n_cases = cases.len();
    let mut findings = Findings::default();
    for (nth, case) in cases.into_iter().enumerate() {
        bench.step(nth as f64 / n_cases as f64, &case.tried)?;
        let verdict = alone(case.run, patience);
        let is_otherwise = verdict.is_err();
        let came_back = verdict.unwrap_or_else(|otherwise| otherwise);
        let row = Row::of(case.area, "", case.tried)
            .error(f64::from(u8::from(is_otherwise)))
            .promised(0.0)
            .with("came_back", came_back)
            .with("should", case.should);
        findings.rows.push(row);
    }
    let n_broken = findings.n_broken();
    findings.notes = vec![format!(
        "{n_cases} cases, each on a thread of its own; {n_broken} came out otherwise than promised."
    )];
    Ok(findings)
}

/// Runs a case on a thread of its own: what panics or hangs there is reported here.
fn alone(run: Box<dyn FnOnce() -> Verdict + Send>, patience: Duration) -> Verdict {
    let (sender, receiver) = sync_channel(1);
    let thread = thread::Builder::new()
        .name("extreme case".to_owned())
        .spawn(move || drop(sender.send(run())))
        .map_err(|error| format!("no thread for it: {error}"))?;
    match receiver.recv_timeout(patience) {
        Ok(verdict) => verdict,
        Err(RecvTimeoutError::Timeout) => {
            let waited = time_span(patience.as_secs_f64());
            Err(format!("nothing came back within {waited}"))
        }
        Err(RecvTimeoutError::Disconnected) => match thread.join() {
            Err(panic) => Err(format!("it panicked: {}", message_of(panic.as_ref()))),
            Ok(()) => Err("nothing came back".to_owned()),
        },
    }
}
