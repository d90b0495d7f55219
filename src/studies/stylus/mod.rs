//! The stylus: how a stiff surface should be stepped, and what a sampled one can be.
//!
//! `steppers` sets error against run time on three surfaces; `limits` sets textbook limits beside
//! eigenvalues, and says what sampling does to a texture and what a tick costs.

mod limits;
mod surfaces;

#[cfg(test)]
mod tests;

pub(crate) use limits::STUDY as LIMITS;
pub(crate) use surfaces::relief_of;

use super::chart::{chart, lines_by};
use super::readable::{largest, whole};
use super::{Bench, Findings, ReportError, Row, Study};
use selvedge_chart::{Axis, Chart};
use selvedge_render::RenderError;
use selvedge_render::contact::{Standing, Stepper, StylusRow, StylusRun, StylusSetup, StylusStart};
use surfaces::Surface;

/// Heights every 4 ms by surface and stiffness, as `tests/truth/stylus.py` computes them.
const TRUTH: &str = include_str!("../../../tests/truth/stylus.csv");
/// What exact steps keep within on a plane, as a share of the drop.
const EXACT: f64 = 1e-9;
/// And those of a microsecond on a sine, which they take as straight in between.
const STRAIGHT: f64 = 1e-8;
/// How long a run lasts, s.
const SECONDS: f64 = 0.1;
/// Rate of the reference, Hz.
const REFERENCE_HZ: f64 = 1e6;
/// Rate at which places are compared, Hz: every other is a multiple of it.
const COMPARED_HZ: f64 = 250.0;
/// Steps of a run that is timed.
const TIMED_STEPS: usize = 200;

/// Error and cost of six steppers on three surfaces.
pub(crate) const STUDY: Study = Study {
    name: "stylus",
    chapter: "contact",
    question: "How should a stylus on a stiff surface be stepped?",
    reference: "On the wall and on the sine closed forms of 40 digits by mpmath; on the random \
                relief the exact stepper in steps of 1 µs, which has a row of its own on the two.",
    error: ("error of the height", "of 2 mm"),
    cost_of: "second of a stylus",
    run,
};

fn run(bench: &mut Bench<'_>) -> Result<Findings, ReportError> {
    let stiffnesses = bench
        .effort
        .pick(&[1e3, 1e9][..], &[10.0, 1e3, 1e5, 1e7, 1e9]);
    let rates = bench.effort.pick(&[1e3, 4e4][..], &[250.0, 1e3, 4e3, 4e4]);
    let mut findings = Findings::default();
    for (nth, surface) in Surface::ALL.into_iter().enumerate() {
        let contact = surface.relief(bench.seed)?;
        for stiffness in stiffnesses {
            bench.step(nth as f64 / 3.0, surface.name())?;
            let truth = {
                let how = (*stiffness, Stepper::Exact, REFERENCE_HZ);
                let finest = surface.begin(surfaces::setup(&contact, how)?)?;
                if let Some(known) = known(surface, *stiffness) {
                    let made = (finest, Standing::Stable);
                    findings
                        .rows
                        .push(row((surface, how), &made, &known, bench));
                    known
                } else {
                    led(&finest)?.0
                }
            };
            for rate_hz in rates {
                for method in Stepper::ALL {
                    if method == Stepper::Auto {
                        continue;
                    }
                    let how = (*stiffness, method, *rate_hz);
                    let setup = surfaces::setup(&contact, how)?;
                    let standing = setup.case().standing();
                    let made = (surface.begin(setup)?, standing);
                    findings
                        .rows
                        .push(row((surface, how), &made, &truth, bench));
                }
            }
        }
    }
    findings.plots = plots(&findings.rows);
    findings.notes = notes(&findings);
    Ok(findings)
}

impl Surface {
    /// A run on it, before its first step.
    fn begin(self, setup: StylusSetup) -> Result<StylusRun, ReportError> {
        let start = match self {
            Self::Flat => StylusStart::Above(surfaces::DROP_MM),
            Self::Sine | Self::Broadband => StylusStart::Resting,
        };
        Ok(StylusRun::new(setup, surfaces::place_mm(0.0), start)?)
    }
}

/// The `nth` step of a run along its way.
fn step(run: &mut StylusRun, nth: usize) -> Result<StylusRow, RenderError> {
    let t_s = nth as f64 / run.rate_hz();
    run.step(surfaces::place_mm(t_s)).copied()
}

/// A run along its whole way: heights at the rate that all are compared at, mm, and the energy that
/// came from nowhere, as a share of all that was there or put in.
fn led(run: &StylusRun) -> Result<(Vec<f64>, f64), RenderError> {
    let mut run = run.clone();
    let every = whole(run.rate_hz() / COMPARED_HZ);
    let n = whole((SECONDS * run.rate_hz()).round());
    let mut heights = Vec::new();
    for nth in 1..=n {
        let row = step(&mut run, nth)?;
        if nth % every == 0 {
            heights.push(row.place_mm[2]);
        }
    }
    Ok((heights, run.gained_j() / run.put_in_j()))
}

/// Heights that are known from elsewhere, mm.
fn known(surface: Surface, stiffness: f64) -> Option<Vec<f64>> {
    let name = format!("{},{stiffness:e},", surface.word());
    let cells = TRUTH.lines().find_map(|line| line.strip_prefix(&name))?;
    cells.split(',').map(|cell| cell.parse().ok()).collect()
}

fn row(
    (surface, (stiffness, method, rate_hz)): (Surface, (f64, Stepper, f64)),
    (run, standing): &(StylusRun, Standing),
    truth: &[f64],
    bench: &Bench<'_>,
) -> Row {
    let found = led(run).ok();
    let error = found.as_ref().map(|(found, _)| {
        let off = found.iter().zip(truth).map(|(a, b)| (a - b).abs());
        largest(off) / surfaces::DROP_MM
    });
    let gained = found.map_or_else(|| "grew".to_owned(), |(_, share)| format!("{share:.1e}"));
    let promised = match surface {
        _ if method != Stepper::Exact => None,
        Surface::Flat => Some(EXACT),
        Surface::Sine => (rate_hz >= REFERENCE_HZ).then_some(STRAIGHT),
        Surface::Broadband => None,
    };
    let cost = error.is_some().then(|| {
        let n_repeats = bench.effort.pick(3, 9);
        let timing = bench.time_repeated(n_repeats, TIMED_STEPS, || {
            let mut run = run.clone();
            (1..=TIMED_STEPS)
                .filter_map(|nth| step(&mut run, nth).ok())
                .last()
        });
        timing.times(rate_hz)
    });
    let setting = format!("{rate_hz} Hz");
    Row::of(
        method.name(),
        setting,
        format!("{}, {stiffness:e} N/m", surface.name()),
    )
    .error(error)
    .promised(promised)
    .cost(cost)
    .with("rate_hz", rate_hz)
    .with("stiffness_n_per_m", format!("{stiffness:e}"))
    .with("standing", standing.word())
    .with("gained_of_put_in", gained)
}

/// Error against rate on each surface, at the stiffness that hands meet.
fn plots(rows: &[Row]) -> Vec<(String, Chart)> {
    let plot = |surface: Surface| {
        let case = format!("{}, 1e3 N/m", surface.name());
        let of_case = rows.iter().filter(|row| row.case == case);
        let lines = lines_by(
            of_case,
            |row| &row.method,
            |row| Some([row.further_number("rate_hz")?, row.error?]),
        );
        let drawn = chart(
            format!("Error against rate: {case}"),
            Axis::log("rate, Hz"),
            Axis::log("error of the height, of 2 mm"),
            lines,
            "No dot where a method grows without end, or is exact to the last bit.",
        );
        (format!("stylus-{}", surface.word()), drawn)
    };
    Surface::ALL.map(plot).into()
}

fn notes(findings: &Findings) -> Vec<String> {
    let of = |method: Stepper| {
        let rows = findings
            .rows
            .iter()
            .filter(|row| row.method == method.name());
        let errors: Vec<Option<f64>> = rows.map(|row| row.error).collect();
        let n_grown = errors.iter().filter(|error| error.is_none()).count();
        let worst = largest(errors.iter().copied().flatten());
        format!(
            "{}: grows without end in {n_grown} of {} cases, at worst {worst:.1e} of 2 mm off \
             elsewhere.",
            method.name(),
            errors.len()
        )
    };
    let methods = Stepper::ALL.into_iter().filter(|one| *one != Stepper::Auto);
    let thrown = "On the random relief above 10⁵ N/m the tip is thrown off crests, and every error \
                  makes it another flight: no step of any method comes near there.";
    let bounces = "Exact steps cost most at 1 kHz and 10⁹ N/m on the sine: between steps the \
                   surface is taken as straight, a stiff tip bounces several times off every bend \
                   of it, and each bounce is followed; faster steps bend less and cost less.";
    methods
        .map(of)
        .chain([thrown, bounces].map(str::to_owned))
        .collect()
}
