//! Real or generated (Cai et al. 2021, phase 2): what is called real, and its analysis of variance.

use super::comparison::{DesignWithStimuli, Kind, Options, Replication, by_levels, guessing};
use super::printed;
use super::studies::{Studies, Subjects, percent_right};
use crate::ExperimentError;
use crate::analysis::{Cell, Section, Table, cells, judgements};
use crate::design::Design;
use selvedge_foundation::progress::Progress;
use selvedge_statistics::variance::{Answer, Crossed, Effect, repeated_two_way};
use selvedge_statistics::{Computed, Undefined};

const PAPER: &str = "Cai et al. 2021, phase 2";
/// A test at this level finds something.
const ALPHA: f64 = 0.05;

/// What one study came to.
struct Found {
    right_percent: f64,
    /// Called real, %: the measured ones, the others.
    called_real: [f64; 2],
    /// F and p of what is real and what is not.
    signal: Computed<[f64; 2]>,
}

/// Shares called real, and the main effect of the signal.
///
/// # Errors
/// A study cannot be held, or it was cancelled.
pub(super) fn section(
    laid: &DesignWithStimuli,
    options: &Options,
    all: &mut Replication,
    progress: &mut Progress<'_>,
) -> Result<Section, ExperimentError> {
    let title = "Real or generated: what is called real";
    let mut section = Section::new("judgement", title);
    section.note(
        "The paper's signals were made by a network for a friction screen. Here near relatives of \
         the library stand in for generated ones, felt through the array: what can be compared is \
         what an observer who cannot tell would give, and what the test would find if observers \
         could.",
    );
    let columns = [
        ("observer", "observer"),
        ("significant", "studies with p < 0.05 of the signal, %"),
        ("studies", "studies"),
    ];
    let title = "How often the analysis of variance finds the signal";
    let mut table = Table::new("power", title, &columns);
    for (nth, kind) in [guessing(), by_levels()].into_iter().enumerate() {
        let studies = Studies::of(laid, kind.observer, 1, options);
        let n = options.n_studies;
        let part = [0.5 * nth as f64, 0.5 * (nth + 1) as f64];
        let found = progress.within(part, |part| {
            studies.each((n, "judgements"), part, |s| found(s, &laid.design))
        })?;
        compare(&found, &kind, all);
        let p: Vec<f64> = found
            .iter()
            .filter_map(|one| one.signal.as_ref().ok().map(|[_, p]| *p))
            .collect();
        let n_found = p.iter().filter(|p| **p < ALPHA).count();
        let share = if p.is_empty() {
            Cell::none("no study had an F")
        } else {
            (100.0 * n_found as f64 / p.len() as f64).into()
        };
        table.push(cells![kind.description, share, p.len()]);
    }
    section.table(table);
    Ok(section)
}

fn found(subjects: &Subjects, design: &Design) -> Found {
    let mut answers = Vec::new();
    let mut called = [[0.0; 2]; 2];
    for (nth, rows) in subjects.iter().enumerate() {
        for judged in rows.iter().flat_map(judgements) {
            let stimulus = &design.stimuli[judged.item];
            let which = usize::from(!judged.is_real);
            called[which][0] += f64::from(u8::from(judged.called_real));
            called[which][1] += 1.0;
            answers.push(Answer {
                subject: format!("o{nth:02}"),
                levels: vec![stimulus.material.clone(), stimulus.condition.clone()],
                value: if judged.called_real { 100.0 } else { 0.0 },
            });
        }
    }
    let percents: Vec<f64> = subjects.iter().map(|own| percent_right(own)).collect();
    Found {
        right_percent: percents.iter().sum::<f64>() / percents.len() as f64,
        called_real: called.map(|[n, of]| 100.0 * n / of),
        signal: signal(&answers),
    }
}

fn signal(answers: &[Answer]) -> Computed<[f64; 2]> {
    let table = Crossed::of_answers(&["material", "condition"], answers)?;
    let found = repeated_two_way(&table)?;
    let is_it = |effect: &&Effect| effect.name == "condition";
    let effect = found.effects.iter().find(is_it);
    let effect = effect.ok_or_else(|| Undefined::because("no effect of the condition"))?;
    Ok([effect.f.clone()?, effect.p.clone()?])
}

fn compare(found: &[Found], kind: &Kind, all: &mut Replication) {
    let [real, generated] = printed::CALLED_REAL;
    let of = |of: &dyn Fn(&Found) -> Option<f64>| found.iter().filter_map(of).collect();
    let f = || of(&|one| one.signal.as_ref().ok().map(|[f, _]| *f));
    let mut add = |quantity: &str, printed: Option<f64>, values: Vec<f64>| {
        all.add((PAPER, kind), (quantity, printed), &values);
    };
    let [of_real, of_generated] = [0, 1].map(|which| of(&|one| Some(one.called_real[which])));
    add("measured called real, %", Some(real), of_real);
    add("generated called real, %", Some(generated), of_generated);
    add("right answers, %", None, of(&|one| Some(one.right_percent)));
    for (materials, value, ..) in printed::SIGNALS {
        add(
            &format!("F(1, 11) of the signal, {materials}"),
            Some(value),
            f(),
        );
    }
}
