//! What came of series of levels, trial by trial: the reversals of staircases, the posterior of
//! QUEST+.

use super::draw::scatter;
use super::included_trials::{Experiment, Subject};
use super::levels::readable_percent;
use super::model::{Cell, Section, Table, cells, or_undefined};
use super::tables::summaries;
use crate::Record;
use crate::design::{Adaptation, Design, QuestPlusTrack, StaircaseTrack};
use crate::procedure::quest_plus;
use selvedge_chart::{Axis, Series, Style};
use selvedge_statistics::adaptive::{Procedure as _, ReversalMean, Staircase, Stop};
use selvedge_statistics::{Computed, Undefined, mean};

/// A trial: which series, the number that the function is of, whether more was said of it: where
/// answers are right or wrong, whether it was right.
#[derive(Debug, Clone, Copy)]
pub(super) struct Answered {
    track: usize,
    pub(super) value: f64,
    pub(super) is_right: bool,
}

pub(super) fn answered(design: &Design, record: &Record) -> Option<Answered> {
    let task = &record.trial.task;
    let adapted = task.adapted?;
    Some(Answered {
        track: adapted.track,
        value: adapted.value,
        is_right: design.composition.says_more(task, record.answer()?),
    })
}

/// A series run again on the answers of its log.
pub(super) fn run_again(
    levels: &Adaptation,
    track: &StaircaseTrack,
    nth: usize,
    trials: &[Answered],
) -> Computed<Staircase> {
    let start = track.starts.get(nth).copied();
    let none = || Undefined::because("a series that the design does not have");
    let stop = Stop::Trials(u32::MAX);
    let mut staircase = Staircase::new(track.plan(start.ok_or_else(none)?, levels.range, stop))?;
    for trial in trials {
        staircase.answer(trial.value, trial.is_right)?;
    }
    Ok(staircase)
}

const REVERSALS: &str = "subject; session; track: series; trials; reversals; averaged; mean_db: \
    mean of the last; sd_db: sd; remarks";

pub(super) fn staircases_section(
    experiment: &Experiment<'_>,
    levels: &Adaptation,
    track: &StaircaseTrack,
) -> Section {
    let mut section = experiment.section("staircases", "staircases");
    let target = track.rule().target(track.up_over_down, 1.0);
    let percent = target.map(|share| readable_percent(100.0 * share));
    let percent = percent.unwrap_or_else(|why| why.reason);
    section.note(format!(
        "{} up, {} down; the mean of the last {} reversals at the last step size aims at {percent} \
         right, which is another level than the threshold of the psychometric functions.",
        track.up, track.down, track.reversals_averaged,
    ));
    let what = match levels.reference {
        None => levels.with_own_unit(&format!("{} of {percent} right", levels.noun())),
        Some(_) => levels.with_unit(&format!("difference of {percent} right")),
    };
    let mut table = Table::new("reversals", &what, &levels.columns(REVERSALS));
    let (mut means, mut series) = (Vec::new(), Vec::new());
    for subject in &experiment.subjects {
        let own = of_subject(subject, (levels, track), (&mut table, &mut series));
        means.extend(mean(&own));
    }
    section.table(table);
    let what = format!("{what}, mean of reversals");
    let title = "Over subjects, series averaged";
    section.table(summaries("group", title, &[(what, means)]));
    if !series.is_empty() {
        let title = experiment.titled(&format!("{}s from trial to trial", levels.noun()));
        let axes = [
            Axis::linear("trial of the series"),
            Axis::linear(levels.value_words()),
        ];
        section.figure(scatter("tracks", &title, axes, series));
    }
    section
}

/// Rows of a subject's series; the means of their reversals.
fn of_subject(
    subject: &Subject<'_>,
    (levels, track): (&Adaptation, &StaircaseTrack),
    (table, series): (&mut Table, &mut Vec<Series>),
) -> Vec<f64> {
    let mut means = Vec::new();
    for session in &subject.sessions {
        let design = &session.found.design;
        let all = session.trials.iter();
        let all: Vec<Answered> = all.filter_map(|r| answered(design, r)).collect();
        let number = session.found.subject.session;
        for nth in 0..track.starts.len() {
            let own: Vec<Answered> = all.iter().filter(|t| t.track == nth).copied().collect();
            let staircase = run_again(levels, track, nth, &own);
            let found =
                staircase.map(|staircase| reversal_cells(&staircase, track, levels, &mut means));
            let found = or_undefined(found, table.columns.len() - 4);
            table.push(cells![subject.name, number, nth + 1, own.len(), found]);
            let name = format!("{}, session {number}, series {}", subject.name, nth + 1);
            let at = own
                .iter()
                .zip(1_u32..)
                .map(|(t, i)| [f64::from(i), t.value]);
            series.push(Series::of(name, Style::LineAndDots, at));
        }
    }
    means
}

fn reversal_cells(
    staircase: &Staircase,
    track: &StaircaseTrack,
    levels: &Adaptation,
    means: &mut Vec<f64>,
) -> Vec<Cell> {
    let found: Computed<ReversalMean> = staircase.reversal_mean(track.reversals_averaged);
    let found = found.map(|found| {
        let mean = levels.stimulus(found.threshold);
        means.push(mean);
        cells![found.n_reversals, mean, found.sd]
    });
    let warnings = staircase.warnings().join("; ");
    cells![
        staircase.reversals().len(),
        or_undefined(found, 3),
        warnings
    ]
}

/// The posterior of every session after every trial, from its answers.
pub(super) fn quest_plus_section(
    experiment: &Experiment<'_>,
    levels: &Adaptation,
    track: &QuestPlusTrack,
) -> Section {
    let mut section = experiment.section("quest-plus", "QUEST+ from trial to trial");
    section.note(
        "The posterior that the levels were chosen by, from each session's answers: every \
         threshold, width and lapse rate of the design's grid as likely as another before. What \
         the group is told by stands above.",
    );
    let title = levels.with_unit("Posterior of the threshold after every trial");
    let columns = format!(
        "subject; session; trial; level_db: {}; is_right: right; mean_db: mean; sd_db: sd",
        levels.value_words()
    );
    let mut table = Table::new("posterior", &title, &levels.columns(&columns));
    let mut series = Vec::new();
    for subject in &experiment.subjects {
        for session in &subject.sessions {
            let number = session.found.subject.session;
            let name = format!("{}, session {number}", subject.name);
            let mut means = Vec::new();
            let mut quest = quest_plus(levels, track);
            for (nth, trial) in session
                .trials
                .iter()
                .filter_map(|r| answered(experiment.design, r))
                .enumerate()
            {
                let summary = quest.as_mut().map_err(|why| why.clone()).and_then(|quest| {
                    quest.answer(levels.stimulus(trial.value), trial.is_right)?;
                    Ok(quest.summary().threshold)
                });
                means.extend(summary.as_ref().map(|found| [nth as f64 + 1.0, found.mean]));
                let found = or_undefined(summary.map(|found| cells![found.mean, found.sd]), 2);
                let said = cells![nth + 1, trial.value, trial.is_right];
                table.push(cells![subject.name, number, said, found]);
            }
            series.push(Series::of(name, Style::Line, means));
        }
    }
    section.table(table);
    let title = experiment.titled("mean of the posterior from trial to trial");
    let axes = [
        Axis::linear("trial"),
        Axis::linear(levels.with_unit("threshold")),
    ];
    section.figure(scatter("means", &title, axes, series));
    section
}
