//! Thresholds and just noticeable differences: the mean of the last reversals and a fit to all
//! trials, track by track and subject by subject.

use super::draw::{Bar, bars, scatter};
use super::included_trials::{Experiment, Subject};
use super::model::{Cell, Drawn, Section, Table, cells, or_undefined};
use super::options::Options;
use super::tables::{summaries, tests};
use crate::design::{Levels, StaircaseTrack, Track};
use crate::{Record, Task};
use selvedge_chart::{Axis, Series, Style};
use selvedge_foundation::quantity::fixed;
use selvedge_statistics::adaptive::{Procedure as _, ReversalMean, Staircase, Stop};
use selvedge_statistics::psychometric::{Block, Fit, Model, blocks};
use selvedge_statistics::{Computed, Summary, Undefined, mean, one_sample_t};

/// Points of a drawn curve.
const N_DRAWN: u32 = 100;

/// A trial: which series, the number that the function is of, whether it was right.
#[derive(Debug, Clone, Copy)]
pub(super) struct Answered {
    track: usize,
    level_db: f64,
    is_right: bool,
}

fn answered(record: &Record) -> Option<Answered> {
    let Task::Interval {
        track, level_db, ..
    } = record.trial.task
    else {
        return None;
    };
    Some(Answered {
        track,
        level_db,
        is_right: record.is_correct?,
    })
}

impl Levels {
    fn quantity(&self) -> &'static str {
        match self.reference_db {
            None => "threshold, dB re 1 µm",
            Some(_) => "just noticeable difference, dB",
        }
    }
}

pub(super) fn sections(
    experiment: &Experiment<'_>,
    levels: &Levels,
    options: &Options,
) -> Vec<Section> {
    let mut section = experiment.section("thresholds", "psychometric functions");
    section.note(format!(
        "{} at {} Hz, {} intervals, chance 1/{}. The function is {} of {}; all trials of a subject \
         are fitted with lapses of 0 to 6 %. Its threshold is where half of what guesses \
         and lapses leave is right. Intervals are central ones of the posterior.",
        levels.quantity(),
        levels.band.carrier_hz(),
        levels.intervals,
        levels.intervals,
        levels.family().name(),
        if levels.reference_db.is_some() {
            "the difference in dB"
        } else {
            "the level in dB"
        },
    ));
    let (table, thresholds, fits) = fitted(experiment, levels);
    section.table(table);
    section.over_subjects(&[(levels.quantity(), thresholds.clone())], options);
    if levels.reference_db.is_some() {
        let t = Summary::of(&thresholds).and_then(|s| one_sample_t(&s, 0.0));
        section.table(tests(
            "tests",
            "Over subjects",
            &[("difference against 0 dB", t)],
        ));
    }
    section.figures.extend(curves(experiment, levels, &fits));
    let mut all = vec![section];
    if let Track::Staircase(track) = &levels.track {
        all.push(reversals(experiment, levels, track));
    }
    all
}

const FITS: [(&str, &str); 12] = [
    ("subject", "subject"),
    ("trials", "trials"),
    ("levels", "levels"),
    ("threshold_db", "threshold"),
    ("ci_low_db", "95 % CI from"),
    ("ci_high_db", "to"),
    ("at_75_percent_db", "75 % right at"),
    ("width", "width, 5 to 95 %"),
    ("lapse", "lapses"),
    ("deviance", "deviance"),
    ("df", "levels less 2"),
    ("remarks", "remarks"),
];

type Fits<'a> = Vec<(&'a str, Fit)>;

fn fitted<'a>(experiment: &Experiment<'a>, levels: &Levels) -> (Table, Vec<f64>, Fits<'a>) {
    let title = format!("{}, fits of all trials", levels.quantity());
    let mut table = Table::new("fits", &title, &FITS);
    let (mut thresholds, mut fits) = (Vec::new(), Vec::new());
    let m = u32::try_from(levels.intervals).unwrap_or(2);
    let model = Model::alternatives(levels.family(), m);
    for subject in &experiment.subjects {
        let trials = subject.trials().filter_map(answered);
        let of_levels = blocks(trials.map(|t| (levels.stimulus(t.level_db), t.is_right)));
        let n: u32 = of_levels.iter().map(|b| b.n).sum();
        let n_levels = of_levels.len();
        let fit = model.fit(&of_levels);
        let found = fit.as_ref().map(|fit| fit_cells(fit, n_levels));
        table.push(cells![
            subject.name,
            n,
            n_levels,
            or_undefined(found, FITS.len() - 3)
        ]);
        if let Ok(fit) = fit {
            thresholds.push(fit.curve.threshold);
            fits.push((subject.name, fit));
        }
    }
    (table, thresholds, fits)
}

fn fit_cells(fit: &Fit, n_levels: usize) -> Vec<Cell> {
    cells![
        fit.curve.threshold,
        fit.posterior().interval(|curve| Ok(curve.threshold), 0.95),
        fit.curve.stimulus_at(0.75),
        [fit.curve.width, fit.curve.lapse, fit.deviance],
        n_levels.saturating_sub(2),
        fit.notes.join("; "),
    ]
}

fn curves(experiment: &Experiment<'_>, levels: &Levels, fits: &[(&str, Fit)]) -> Option<Drawn> {
    let x = fits
        .iter()
        .flat_map(|(_, fit)| fit.blocks.iter().map(|b| b.x));
    let (low, high) = (
        x.clone().fold(f64::INFINITY, f64::min),
        x.fold(f64::NEG_INFINITY, f64::max),
    );
    if low >= high || !low.is_finite() {
        return None;
    }
    let at = |i: u32| low + (high - low) * f64::from(i) / f64::from(N_DRAWN);
    let curve = |(name, fit): &(&str, Fit)| {
        Series::of(
            *name,
            Style::Line,
            (0..=N_DRAWN).map(|i| [at(i), fit.curve.at(at(i))]),
        )
    };
    let mut all: Vec<Series> = fits.iter().map(curve).collect();
    if let [(_, fit)] = fits {
        let share = |b: &Block| [b.x, f64::from(b.n_right) / f64::from(b.n)];
        all.push(Series::of(
            "share right",
            Style::Dots,
            fit.blocks.iter().map(share),
        ));
    }
    let x = match levels.reference_db {
        Some(_) => "difference, dB",
        None => "level, dB re 1 µm",
    };
    let axes = [
        Axis::linear(x),
        Axis::linear("share right").within([0.0, 1.0]),
    ];
    Some(scatter(
        "curves",
        &experiment.titled("psychometric functions"),
        axes,
        all,
    ))
}

/// A series run again on the answers of its log.
pub(super) fn run_again(
    levels: &Levels,
    track: &StaircaseTrack,
    nth: usize,
    trials: &[Answered],
) -> Computed<Staircase> {
    let start_db = track.starts_db.get(nth).copied();
    let none = || Undefined::because("a series that the design does not have");
    let stop = Stop::Trials(u32::MAX);
    let mut staircase =
        Staircase::new(track.plan(start_db.ok_or_else(none)?, levels.range_db, stop))?;
    for trial in trials {
        staircase.answer(trial.level_db, trial.is_right)?;
    }
    Ok(staircase)
}

const REVERSALS: [(&str, &str); 9] = [
    ("subject", "subject"),
    ("session", "session"),
    ("track", "series"),
    ("trials", "trials"),
    ("reversals", "reversals"),
    ("averaged", "averaged"),
    ("threshold_db", "mean of the last"),
    ("sd_db", "sd"),
    ("remarks", "remarks"),
];

fn reversals(experiment: &Experiment<'_>, levels: &Levels, track: &StaircaseTrack) -> Section {
    let mut section = experiment.section("staircases", "staircases");
    let target = track.rule().target(track.up_over_down, 1.0);
    section.note(format!(
        "{} up, {} down; the mean of the last {} reversals at the last step size aims at {} right.",
        track.up,
        track.down,
        track.reversals_averaged,
        target.map_or_else(
            |why| why.reason,
            |share| format!("{} %", fixed(100.0 * share, 1))
        )
    ));
    let mut table = Table::new("reversals", "Means of the last reversals", &REVERSALS);
    let (mut shown, mut means) = (Vec::new(), Vec::new());
    let mut series = Vec::new();
    for subject in &experiment.subjects {
        let own = of_subject(subject, (levels, track), (&mut table, &mut series));
        let mean = mean(&own);
        if let Ok(mean) = mean {
            means.push(mean);
            let ends = Summary::of(&own).ok().map(|s| [mean - s.sd, mean + s.sd]);
            shown.push(Bar::of(subject.name, "", mean, ends));
        }
    }
    section.table(table);
    let what = format!("{}, mean of reversals", levels.quantity());
    let title = "Over subjects, series averaged";
    section.table(summaries("group", title, &[(what, means)]));
    if !series.is_empty() {
        let title = experiment.titled("levels from trial to trial");
        let axes = [
            Axis::linear("trial of the series"),
            Axis::linear("level, dB re 1 µm"),
        ];
        section.figure(scatter("tracks", &title, axes, series));
    }
    if !shown.is_empty() {
        let title = experiment.titled("means of reversals");
        section.figure(bars("bars", &title, levels.quantity(), (&shown, None), &[]));
    }
    section
}

/// Rows of a subject's series; their thresholds.
fn of_subject(
    subject: &Subject<'_>,
    (levels, track): (&Levels, &StaircaseTrack),
    (table, series): (&mut Table, &mut Vec<Series>),
) -> Vec<f64> {
    let mut thresholds = Vec::new();
    for session in &subject.sessions {
        let all: Vec<Answered> = session.trials.iter().filter_map(|r| answered(r)).collect();
        let number = session.found.subject.session;
        for nth in 0..track.starts_db.len() {
            let own: Vec<Answered> = all.iter().filter(|t| t.track == nth).copied().collect();
            let staircase = run_again(levels, track, nth, &own);
            let found = staircase
                .map(|staircase| reversal_cells(&staircase, track, levels, &mut thresholds));
            let found = or_undefined(found, REVERSALS.len() - 4);
            table.push(cells![subject.name, number, nth + 1, own.len(), found]);
            let name = format!("{}, session {number}, series {}", subject.name, nth + 1);
            let at = own
                .iter()
                .zip(1_u32..)
                .map(|(t, i)| [f64::from(i), t.level_db]);
            series.push(Series::of(name, Style::LineAndDots, at));
        }
    }
    thresholds
}

fn reversal_cells(
    staircase: &Staircase,
    track: &StaircaseTrack,
    levels: &Levels,
    thresholds: &mut Vec<f64>,
) -> Vec<Cell> {
    let found: Computed<ReversalMean> = staircase.reversal_mean(track.reversals_averaged);
    let found = found.map(|mean| {
        let threshold = levels.stimulus(mean.threshold);
        thresholds.push(threshold);
        cells![mean.n_reversals, threshold, mean.sd]
    });
    let warnings = staircase.warnings().join("; ");
    cells![
        staircase.reversals().len(),
        or_undefined(found, 3),
        warnings
    ]
}
