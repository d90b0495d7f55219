//! How small a picture may be before the lattice of the cloth is lost.

use super::drawings::{BINDINGS, Binding};
use super::spoilt::Spoilt;
use super::{RIGHT, analysed, share_off};
use crate::chart::chart;
use crate::readable::whole;
use crate::{Bench, Findings, ReportError, Row, Study};
use selvedge_chart::{Axis, Series, Style};
use selvedge_foundation::numerics::Random;

/// Periods that a side of the picture holds, however small it is.
const N_PERIODS: f64 = 22.0;

/// Threads of plain weaves and twills that are so far apart, px, have their lattice within so many
/// % of a period.
const RESOLVED_PX: f64 = 4.0;
const RESOLVED_PERCENT: f64 = 1.0;

/// Lattices of pictures that are reduced until nothing is left of the threads.
pub(crate) const STUDY: Study = Study {
    name: "picture-scale",
    chapter: "pictures",
    question: "How far may the picture of a cloth be reduced before its lattice is lost?",
    reference: "The two vectors that the picture was drawn by, whichever pair spans the same \
                lattice.",
    error: ("lattice error", "% of a period"),
    cost_of: "picture",
    run,
};

fn run(bench: &mut Bench<'_>) -> Result<Findings, ReportError> {
    let periods_px = bench.effort.pick(
        vec![9.5, 4.0, 1.5],
        vec![
            20.0, 14.0, 10.0, 7.0, 5.0, 4.0, 3.5, 3.0, 2.7, 2.4, 2.2, 2.0, 1.8, 1.5,
        ],
    );
    let weaves = &BINDINGS[..bench.effort.pick(2, BINDINGS.len())];
    let mut findings = Findings::default();
    let mut lines = Vec::new();
    // What a picture costs hangs on its size: that of the first weave is timed.
    let n_weaves = if bench.wants_errors() {
        weaves.len()
    } else {
        1
    };
    for (done, &weave) in weaves[..n_weaves].iter().enumerate() {
        bench.step(done as f64 / weaves.len() as f64, weave.name)?;
        let mut points = Vec::new();
        for &period_px in &periods_px {
            let row = row((weave, done == 0), period_px, bench, &mut points);
            findings.rows.push(row);
        }
        findings.notes.push(least(weave.name, &points));
        lines.push(Series::of(weave.name, Style::LineAndDots, points));
    }
    findings.notes.push(
        "The period is the shorter lattice vector, from a crossing to the next one like it; \
         threads lie nearer together by √2 (plain, twills), √5 (satin of 5) and √8 or so \
         (satin of 8). Every picture holds 22 periods a side, 20 dB over the noise, pixels \
         as means of what they cover, threads turned anyhow. Below about two pixels no \
         lattice is reported, on purpose. Promised of plain weaves and twills while \
         threads are 4 px apart or more."
            .to_owned(),
    );
    let plot = chart(
        "Pictures reduced: share whose lattice is right",
        Axis::log("shorter lattice vector, px"),
        Axis::linear("right, %").within([0.0, 100.0]),
        lines,
        format!(
            "{N_PERIODS} periods a side, 20 dB over the noise. Right: within {:.0} % of the \
             shorter vector.",
            100.0 * RIGHT
        ),
    );
    findings.plots.push(("right".to_owned(), plot));
    Ok(findings)
}

/// A row of pictures of a weave; whether they are timed, too.
fn row(
    (weave, is_timed): (Binding, bool),
    period_px: f64,
    bench: &Bench<'_>,
    points: &mut Vec<[f64; 2]>,
) -> Row {
    let n_trials: u8 = bench.effort.pick(2, 4);
    let pitch_px = period_px / weave.period_threads();
    let n_px = whole((N_PERIODS * period_px).ceil());
    let spoilt = Spoilt {
        snr_db: 20.0,
        blur_px: 0.0,
        bend_px: 0.0,
        light_ratio: 1.0,
        ..Spoilt::usual(n_px)
    };
    let random = Random::new(bench.seed).branch(weave.name);
    let (mut sum, mut n_right) = (0.0, 0.0);
    let mut first = None;
    for number in 0..n_trials {
        if first.is_some() && !bench.wants_errors() {
            break;
        }
        let mut random = random.branch(&format!("trial {number}"));
        let turn = random.uniform_in(0.0, std::f64::consts::PI);
        let uneven = random.uniform_in(0.95, 1.05);
        let drawing = weave.drawing([pitch_px, pitch_px * uneven], turn);
        let picture = spoilt.taken(&drawing, &mut random);
        let found = analysed(&picture).and_then(|a| Some(a.found.ok()?.lattice.basis()));
        let off = share_off(&drawing.lattice(), found);
        sum += off;
        n_right += if off <= RIGHT { 1.0 } else { 0.0 };
        first.get_or_insert(picture);
    }
    let share = 100.0 * n_right / f64::from(n_trials);
    // The lattice of a satin is now and then taken for another of its threads'.
    let is_promised = pitch_px >= RESOLVED_PX && weave.period_threads() < 2.0;
    points.push([period_px, share]);
    let n_repeats = bench.effort.pick(1, 3);
    let cost = first
        .filter(|_| is_timed)
        .map(|picture| bench.time_repeated(n_repeats, 1, || analysed(&picture)));
    Row::of(
        "whole pipeline",
        format!("{period_px} px a period"),
        weave.name,
    )
    .size((n_px * n_px) as f64)
    .error(100.0 * sum / f64::from(n_trials))
    .promised(is_promised.then_some(RESOLVED_PERCENT))
    .cost(cost)
    .with("period_px", period_px)
    .number("thread_px", 3, pitch_px)
    .number("right_percent", 1, share)
}

/// The shortest period down to which every picture was right.
fn least(name: &str, points: &[[f64; 2]]) -> String {
    let right = points.iter().take_while(|point| point[1] >= 99.9);
    right.last().map_or_else(
        || {
            format!(
                "{name}: not right at {:.1} px a period either.",
                points[0][0]
            )
        },
        |[period_px, _]| format!("{name}: every picture is right down to {period_px} px a period."),
    )
}
