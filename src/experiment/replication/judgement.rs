//! Real or generated (Cai et al. 2021, phase 2): what is called real, and its analysis of variance,
//! fabrics that the generator had seen and others apart.

use super::comparison::{DesignWithStimuli, Kind, Options, Replication, bar, by_levels, guessing};
use super::printed;
use super::studies::{Subjects, each_study, percents_right};
use crate::ExperimentError;
use crate::analysis::{Cell, Drawn, Section, Table, bars, called_real, cells};
use crate::design::{Design, Stimulus};
use selvedge_foundation::progress::Progress;
use selvedge_statistics::variance::{Answer, Crossed, Effect, Repeated};
use selvedge_statistics::{Computed, Undefined, mean};

const PAPER: &str = "Cai et al. 2021, phase 2";
/// A test at this level finds something.
const ALPHA: f64 = 0.05;

/// What one study came to.
struct Found {
    right_percent: f64,
    /// Called real, %: stimulus by stimulus.
    called_real: Vec<f64>,
    /// F and p of what is real and what is not: of each group of fabrics.
    signals: Vec<Computed<[f64; 2]>>,
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
         the library stand in for generated ones, felt through the array, five fabrics as seen by \
         the network and three as not seen: what can be compared is what an observer who cannot \
         tell would give, and what the test would find if observers could.",
    );
    section.note(
        "The paper's figure 9 is of what was called real by fabric and signal; its bars are not \
         known here, only the means over all fabrics, which the dashed lines are.",
    );
    let columns = "observer; fabrics; significant: studies with p < 0.05 of the signal, %; studies";
    let title = "How often the analysis of variance finds the signal";
    let mut table = Table::new("power", title, columns);
    let kinds = [guessing(), by_levels()];
    let cases = kinds.map(|kind| (laid, kind));
    let found = each_study(&cases, "judgements", options, progress, found)?;
    for (found, kind) in found.iter().zip(&kinds) {
        compare(found, (kind, &laid.design), all);
        for (nth, (_, fabrics, ..)) in printed::SIGNALS.iter().enumerate() {
            let p = found
                .iter()
                .filter_map(|one| one.signals.get(nth)?.as_ref().ok());
            let p: Vec<f64> = p.map(|[_, p]| *p).collect();
            let n_found = p.iter().filter(|p| **p < ALPHA).count();
            let share = if p.is_empty() {
                Cell::none("no study had an F")
            } else {
                (100.0 * n_found as f64 / p.len() as f64).into()
            };
            table.push(cells![kind.description, *fabrics, share, p.len()]);
        }
    }
    for (key, (found, kind)) in ["figure-9-guessing", "figure-9"]
        .into_iter()
        .zip(found.iter().zip(&kinds))
    {
        section.figure(figure_9(key, found, (kind, &laid.design)));
    }
    section.table(table);
    Ok(section)
}

fn found(subjects: &Subjects, laid: &DesignWithStimuli) -> Found {
    let answers = |group| {
        let rows = subjects.iter().enumerate();
        let rows = rows.map(|(nth, rows)| (format!("o{nth:02}"), rows.iter()));
        called_real(&laid.design, rows, group)
    };
    let all = answers(None);
    let of = |one: &Stimulus| {
        let is_its = |answer: &&Answer| answer.levels == [&*one.material, &*one.condition];
        mean(
            &all.iter()
                .filter(is_its)
                .map(|answer| answer.value)
                .collect::<Vec<f64>>(),
        )
    };
    let called_real = laid.design.stimuli.iter().map(of);
    let percents = percents_right(subjects);
    Found {
        right_percent: percents.iter().sum::<f64>() / percents.len() as f64,
        called_real: called_real.map(|share| share.unwrap_or(f64::NAN)).collect(),
        signals: printed::SIGNALS
            .map(|(group, ..)| signal(&answers(Some(group))))
            .into(),
    }
}

fn signal(answers: &[Answer]) -> Computed<[f64; 2]> {
    let table = Crossed::of_answers(&["material", "condition"], answers)?;
    let found = Repeated::two_way(&table)?;
    let is_it = |effect: &&Effect| effect.name == "condition";
    let effect = found.effects.iter().find(is_it);
    let effect = effect.ok_or_else(|| Undefined::because("no effect of the condition"))?;
    Ok([effect.f.clone()?, effect.p.clone()?])
}

fn compare(found: &[Found], (kind, design): (&Kind, &Design), all: &mut Replication) {
    let right = design.composition.right_condition().unwrap_or_default();
    let mut add = |quantity: &str, printed: Option<f64>, of: &dyn Fn(&Found) -> Option<f64>| {
        let values: Vec<f64> = found.iter().filter_map(of).collect();
        all.add((PAPER, kind), (quantity, printed), &values);
    };
    let [real, generated] = printed::CALLED_REAL;
    for (quantity, printed, is_real) in [
        ("measured called real, %", real, true),
        ("generated called real, %", generated, false),
    ] {
        add(quantity, Some(printed), &|one| {
            let all = design.stimuli.iter().zip(&one.called_real);
            let own = all.filter(|(stimulus, _)| (stimulus.condition == right) == is_real);
            mean(&own.map(|(_, percent)| *percent).collect::<Vec<f64>>()).ok()
        });
    }
    add("right answers, %", None, &|one| Some(one.right_percent));
    for (nth, (_, fabrics, value, ..)) in printed::SIGNALS.into_iter().enumerate() {
        let quantity = format!("F(1, 11) of the signal, {fabrics}");
        add(&quantity, Some(value), &|one| {
            one.signals.get(nth)?.as_ref().ok().map(|[f, _]| *f)
        });
    }
}

/// What was called real by fabric and signal.
fn figure_9(key: &str, found: &[Found], (kind, design): (&Kind, &Design)) -> Drawn {
    let of = |(at, stimulus): (usize, &Stimulus)| {
        let values: Vec<f64> = found.iter().map(|one| one.called_real[at]).collect();
        let name = format!("{}, {}", stimulus.material, stimulus.group);
        bar(&name, &stimulus.condition, &values)
    };
    let shown: Vec<_> = design.stimuli.iter().enumerate().filter_map(of).collect();
    let title = format!("As Cai et al. 2021, figure 9: {}", kind.description);
    let [real, generated] = printed::CALLED_REAL;
    bars(
        key,
        &title,
        "called real, % (95 of 100 studies)",
        (&shown, Some([0.0, 100.0])),
        &[
            (real, ""),
            (generated, "printed: 47.92 % real, 52.08 % generated"),
        ],
    )
}
