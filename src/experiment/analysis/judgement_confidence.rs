//! Confidence in judgements: the receiver operating characteristic.

use super::answers::{Judgement, judgements};
use super::draw::scatter;
use super::included_trials::{Experiment, Subject};
use super::model::{Cell, Drawn, Section, Table, cells, or_undefined};
use super::tables::tests;
use selvedge_chart::{Axis, Series, Style};
use selvedge_statistics::detection::Roc;
use selvedge_statistics::{Computed, Summary, one_sample_t};

/// How often each rating from `surely generated` to `surely real` was given, of real ones and of
/// the others.
fn ratings(answers: impl Iterator<Item = Judgement>, grades: u8) -> [Vec<u64>; 2] {
    let n = usize::from(grades);
    let mut counts = [vec![0; 2 * n], vec![0; 2 * n]];
    for judged in answers {
        let Some(sure) = judged
            .confidence
            .map(usize::from)
            .filter(|c| (1..=n).contains(c))
        else {
            continue;
        };
        let at = if judged.called_real {
            n + sure - 1
        } else {
            n - sure
        };
        counts[usize::from(!judged.is_real)][at] += 1;
    }
    counts
}

/// Areas under the curves of subjects, and the curve of all together.
pub(super) fn section(experiment: &Experiment<'_>, grades: u8) -> Section {
    let mut section = experiment.section("confidence", "confidence");
    section.note(
        "Ratings run from surely generated to surely real. The area under the curve is the \
         probability that a real one is rated higher than a generated one; d_a = √2 z(area). All \
         together: pooled ratings, which make the area too small where subjects differ.",
    );
    let columns = "subject; n_real: real; n_generated: generated; area; se: SE; ci_low: 95 % CI \
        from; ci_high: to; d_a";
    let mut table = Table::new("areas", "Areas under the curve", columns);
    let mut areas = Vec::new();
    for subject in &experiment.subjects {
        let [real, others] = ratings(subject.trials().flat_map(judgements), grades);
        let found = Roc::of(&real, &others);
        areas.extend(found.as_ref().ok().map(|r| r.area));
        table.push(roc_row(subject.name, &found));
    }
    let everyone = experiment
        .subjects
        .iter()
        .flat_map(Subject::trials)
        .flat_map(judgements);
    let [real, others] = ratings(everyone, grades);
    let pooled = Roc::of(&real, &others);
    table.push(roc_row("all together", &pooled));
    section.table(table);
    let t = Summary::of(&areas).and_then(|s| one_sample_t(&s, 0.5));
    section.table(tests("tests", "Areas against ½", &[("area", t)]));
    if let Ok(pooled) = &pooled {
        section.figure(curve(experiment, pooled));
    }
    section
}

fn curve(experiment: &Experiment<'_>, pooled: &Roc) -> Drawn {
    let all = vec![
        Series::of("all together", Style::LineAndDots, pooled.points.clone()),
        Series::of("guessing", Style::Dashed, [[0.0, 0.0], [1.0, 1.0]]),
    ];
    let axes = ["false alarms", "hits"].map(|label| Axis::linear(label).within([0.0, 1.0]));
    let title = experiment.titled("receiver operating characteristic");
    scatter("roc", &title, axes, all)
}

fn roc_row(name: &str, found: &Computed<Roc>) -> Vec<Cell> {
    let found = found.as_ref();
    let found = found.map(|roc| cells![roc.n, roc.area, &roc.se, &roc.interval, &roc.d_a]);
    cells![name, or_undefined(found, 7)]
}
