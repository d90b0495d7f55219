//! Real or generated (Cai et al. 2021, phase 2): sensitivity and bias by subject, confidence, and
//! whether material and condition matter to what is called real.

use super::Options;
use super::draw::{Bar, axis, bars, scatter};
use super::kept::{Experiment, Subject};
use super::map::undefined;
use super::model::{Cell, Section, Table, ends, resampled, summaries, tests};
use super::variance::effects;
use crate::experiment::design::{Judging, JudgingProtocol};
use crate::experiment::{Answer, Record, Task};
use crate::figure::{Series, Style};
use crate::statistics::detection::{Answers, Correction, Roc, forced_choice, roc, yes_no};
use crate::statistics::variance::{Answer as CellAnswer, Crossed, repeated_two_way};
use crate::statistics::{
    Computed, Outcome, Sides, Summary, Undefined, exact_binomial, one_sample_t, paired_t,
    sign_flip, tost,
};

/// Bounds within which a difference of percentages counts as none, points.
const BOUNDS_PERCENT: f64 = 10.0;

/// What was said of one stimulus: whether it was called real. A pair says it of both of its own.
struct Said {
    item: usize,
    is_real: bool,
    said_real: bool,
    confidence: Option<u8>,
}

fn said(record: &Record) -> Vec<Said> {
    match (&record.trial.task, record.answer()) {
        (
            Task::Judge { item, is_real },
            Some(Answer::Judged {
                is_real: said,
                confidence,
            }),
        ) => {
            vec![Said {
                item: *item,
                is_real: *is_real,
                said_real: *said,
                confidence: *confidence,
            }]
        }
        (
            Task::JudgePair { items, real },
            Some(Answer::Chosen {
                position,
                confidence,
            }),
        ) => {
            let of = |at: usize| Said {
                item: items[at],
                is_real: at == *real,
                said_real: at == *position,
                confidence: *confidence,
            };
            vec![of(0), of(1)]
        }
        _ => Vec::new(),
    }
}

pub(super) fn sections(
    experiment: &Experiment<'_>,
    judging: &Judging,
    options: &Options,
) -> Vec<Section> {
    let mut all = vec![sensitivity(experiment, judging, options)];
    if judging.confidence_grades > 1 && judging.protocol == JudgingProtocol::Single {
        all.push(confidence(experiment, judging));
    }
    all.push(percentages(experiment));
    all
}

fn right_of(subject: &Subject<'_>) -> (u64, u64) {
    let verdicts: Vec<bool> = subject.trials().filter_map(|r| r.is_correct).collect();
    (
        verdicts.iter().filter(|r| **r).count() as u64,
        verdicts.len() as u64,
    )
}

fn sensitivity(experiment: &Experiment<'_>, judging: &Judging, options: &Options) -> Section {
    let title = format!("{}: sensitivity and bias", experiment.design.title);
    let mut section = Section::new(experiment.key("sensitivity"), title);
    let (table, d_primes) = match judging.protocol {
        JudgingProtocol::Single => {
            section.note(
                "A hit is a real one called real, a false alarm a generated one called real. Rates \
                 enter z with the log-linear correction, (count + ½)/(n + 1); counts are as they \
                 were. c > 0: rather not called real.",
            );
            yes_no_table(experiment)
        }
        JudgingProtocol::Pair => {
            section
                .note("The real one of two was to be found: d′ of two alternatives without bias.");
            pair_table(experiment)
        }
    };
    section.tables.push(table);
    let percents: Vec<f64> = experiment
        .subjects
        .iter()
        .map(right_of)
        .map(|(right, n)| 100.0 * right as f64 / n as f64)
        .collect();
    let means = [
        ("right, %".to_owned(), percents.clone()),
        ("d′".to_owned(), d_primes.clone()),
    ];
    section
        .tables
        .push(summaries("group", "Over subjects", &means));
    section.tables.push(resampled(&means, options.resampling()));
    let t = |values: &[f64], at| Summary::of(values).and_then(|s| one_sample_t(&s, at));
    let from_half: Vec<f64> = percents.iter().map(|p| p - 50.0).collect();
    let pooled: (u64, u64) = experiment
        .subjects
        .iter()
        .map(right_of)
        .fold((0, 0), |(a, b), (right, n)| (a + right, b + n));
    let all = [
        ("right, % against 50".to_owned(), t(&percents, 50.0)),
        (
            "right, % less 50, signs flipped".to_owned(),
            sign_flip(&from_half, options.n_permutations, options.seed),
        ),
        ("d′ against 0".to_owned(), t(&d_primes, 0.0)),
        (
            "right, subjects pooled as if independent".to_owned(),
            exact_binomial(pooled.0, pooled.1, 0.5, Sides::Two),
        ),
    ];
    section
        .tables
        .push(tests("tests", "Against guessing", &all));
    section.tables.push(equivalence(&percents));
    section.note(format!(
        "No difference found is not equivalence: two one-sided tests ask whether the share of right \
         answers lies within 50 ± {BOUNDS_PERCENT} %."
    ));
    section
}

const YES_NO: [(&str, &str); 14] = [
    ("subject", "subject"),
    ("hits", "hits"),
    ("n_real", "of real"),
    ("false_alarms", "false alarms"),
    ("n_generated", "of generated"),
    ("hit_rate", "H, corrected"),
    ("false_alarm_rate", "F, corrected"),
    ("correction", "correction"),
    ("d_prime", "d′"),
    ("d_prime_ci_low", "95 % CI from"),
    ("d_prime_ci_high", "to"),
    ("criterion", "c"),
    ("ln_beta", "ln β"),
    ("uncorrected_d_prime", "d′ uncorrected"),
];

fn counts(subject: &Subject<'_>) -> Answers {
    let mut answers = Answers {
        hits: 0,
        n_signal: 0,
        false_alarms: 0,
        n_noise: 0,
    };
    for said in subject.trials().flat_map(said) {
        let (n, yes) = if said.is_real {
            (&mut answers.n_signal, &mut answers.hits)
        } else {
            (&mut answers.n_noise, &mut answers.false_alarms)
        };
        *n += 1;
        *yes += u64::from(said.said_real);
    }
    answers
}

fn yes_no_table(experiment: &Experiment<'_>) -> (Table, Vec<f64>) {
    let mut table = Table::new("subjects", "Sensitivity and bias by subject", &YES_NO);
    let mut d_primes = Vec::new();
    for subject in &experiment.subjects {
        let answers = counts(subject);
        let mut row = vec![
            Cell::from(subject.name),
            answers.hits.into(),
            answers.n_signal.into(),
            answers.false_alarms.into(),
            answers.n_noise.into(),
        ];
        match yes_no(answers, Correction::LogLinear) {
            Ok(found) => {
                d_primes.push(found.d_prime);
                row.extend([found.hit_rate.into(), found.false_alarm_rate.into()]);
                row.push(found.correction.name().into());
                row.extend(
                    [found.d_prime, found.interval.low, found.interval.high].map(Cell::from),
                );
                row.extend([found.criterion, found.ln_beta].map(Cell::from));
                row.push(Cell::of(&found.uncorrected_d_prime));
            }
            Err(why) => row.extend(undefined(&why, 9)),
        }
        table.push(row);
    }
    (table, d_primes)
}

fn pair_table(experiment: &Experiment<'_>) -> (Table, Vec<f64>) {
    let columns = [
        ("subject", "subject"),
        ("pairs", "pairs"),
        ("right", "right"),
        ("percent", "%"),
        ("p", "exact binomial p, two-sided"),
        ("d_prime", "d′, 2-AFC"),
        ("d_prime_ci_low", "95 % CI from"),
        ("d_prime_ci_high", "to"),
        ("correction", "correction"),
    ];
    let mut table = Table::new("subjects", "Right answers by subject", &columns);
    let mut d_primes = Vec::new();
    for subject in &experiment.subjects {
        let (right, n) = right_of(subject);
        let mut row = vec![Cell::from(subject.name), n.into(), right.into()];
        row.push((100.0 * right as f64 / n as f64).into());
        row.push(Cell::of(
            &exact_binomial(right, n, 0.5, Sides::Two).map(|o| o.p),
        ));
        match forced_choice(right, n, 2, Correction::LogLinear) {
            Ok(choice) => {
                d_primes.push(choice.d_prime);
                row.push(choice.d_prime.into());
                row.extend(ends(&choice.interval));
                row.push(choice.correction.map_or("none", Correction::name).into());
            }
            Err(why) => row.extend(undefined(&why, 4)),
        }
        table.push(row);
    }
    (table, d_primes)
}

fn equivalence(percents: &[f64]) -> Table {
    let columns = [
        ("n", "n"),
        ("mean_percent", "mean, %"),
        ("low_percent", "bounds from"),
        ("high_percent", "to"),
        ("t_low", "t against the lower"),
        ("t_high", "against the upper"),
        ("df", "df"),
        ("p", "p"),
        ("ci_low_percent", "90 % CI from"),
        ("ci_high_percent", "to"),
        ("power", "power if it were 50 %"),
    ];
    let mut table = Table::new(
        "equivalence",
        "Equivalence to guessing (two one-sided tests)",
        &columns,
    );
    let bounds = [50.0 - BOUNDS_PERCENT, 50.0 + BOUNDS_PERCENT];
    table.push(
        match Summary::of(percents).and_then(|s| tost(&s, bounds, 0.05)) {
            Ok(found) => vec![
                found.n.into(),
                found.mean.into(),
                bounds[0].into(),
                bounds[1].into(),
                found.t[0].into(),
                found.t[1].into(),
                found.df.into(),
                found.p.into(),
                found.interval.low.into(),
                found.interval.high.into(),
                Cell::of(&found.power),
            ],
            Err(why) => {
                let mut row = vec![Cell::from(percents.len())];
                row.extend(undefined(&why, 10));
                row
            }
        },
    );
    table
}

/// How often each rating from `surely generated` to `surely real` was given, of real ones and of
/// the others.
fn ratings(answers: impl Iterator<Item = Said>, grades: u8) -> [Vec<u64>; 2] {
    let n = usize::from(grades);
    let mut counts = [vec![0; 2 * n], vec![0; 2 * n]];
    for said in answers {
        let Some(sure) = said
            .confidence
            .map(usize::from)
            .filter(|c| (1..=n).contains(c))
        else {
            continue;
        };
        let at = if said.said_real {
            n + sure - 1
        } else {
            n - sure
        };
        counts[usize::from(!said.is_real)][at] += 1;
    }
    counts
}

fn confidence(experiment: &Experiment<'_>, judging: &Judging) -> Section {
    let title = format!("{}: confidence", experiment.design.title);
    let mut section = Section::new(experiment.key("confidence"), title);
    section.note(
        "Ratings run from surely generated to surely real. The area under the curve is the \
         probability that a real one is rated higher than a generated one; d_a = √2 z(area). All \
         together: pooled ratings, which make the area too small where subjects differ.",
    );
    let columns = [
        ("subject", "subject"),
        ("n_real", "real"),
        ("n_generated", "generated"),
        ("area", "area"),
        ("se", "SE"),
        ("ci_low", "95 % CI from"),
        ("ci_high", "to"),
        ("d_a", "d_a"),
    ];
    let mut table = Table::new("areas", "Areas under the curve", &columns);
    let grades = judging.confidence_grades;
    let mut areas = Vec::new();
    for subject in &experiment.subjects {
        let [real, others] = ratings(subject.trials().flat_map(said), grades);
        let found = roc(&real, &others);
        areas.extend(found.as_ref().ok().map(|r| r.area));
        table.push(roc_row(subject.name, &found));
    }
    let everyone = experiment
        .subjects
        .iter()
        .flat_map(Subject::trials)
        .flat_map(said);
    let [real, others] = ratings(everyone, grades);
    let pooled = roc(&real, &others);
    table.push(roc_row("all together", &pooled));
    section.tables.push(table);
    let t = Summary::of(&areas).and_then(|s| one_sample_t(&s, 0.5));
    section
        .tables
        .push(tests("tests", "Areas against ½", &[("area".to_owned(), t)]));
    if let Ok(pooled) = &pooled {
        let points = pooled
            .points
            .iter()
            .map(|p| [p.false_alarm_rate, p.hit_rate]);
        let series = vec![
            Series {
                name: "all together".to_owned(),
                points: points.collect(),
                style: Style::LineAndDots,
                ..Series::default()
            },
            Series {
                name: "guessing".to_owned(),
                points: vec![[0.0, 0.0], [1.0, 1.0]],
                style: Style::Dashed,
                ..Series::default()
            },
        ];
        let axes = ["false alarms", "hits"].map(|label| {
            let mut axis = axis(label);
            axis.range = Some([0.0, 1.0]);
            axis
        });
        let title = format!(
            "{}: receiver operating characteristic",
            experiment.design.title
        );
        section.figures.push(scatter("roc", &title, axes, series));
    }
    section
}

fn roc_row(name: &str, found: &Computed<Roc>) -> Vec<Cell> {
    let mut row = vec![Cell::from(name)];
    match found {
        Ok(roc) => {
            row.extend([
                roc.n[0].into(),
                roc.n[1].into(),
                Cell::from(roc.area),
                Cell::of(&roc.se),
            ]);
            row.extend(ends(&roc.interval));
            row.push(Cell::of(&roc.d_a));
        }
        Err(why) => row.extend(undefined(why, 7)),
    }
    row
}

/// What was called real, by material and condition (Table 3 and Fig. 9 of the paper).
fn percentages(experiment: &Experiment<'_>) -> Section {
    let title = format!(
        "{}: called real, by material and condition",
        experiment.design.title
    );
    let mut section = Section::new(experiment.key("called-real"), title);
    section.note(
        "Percentages of trials in which it was called real. Of few trials a cell they take few \
         values, so the analysis of variance is approximate; see the test by flipped signs.",
    );
    let answers = cell_answers(experiment);
    let crossed = Crossed::of_answers(&["material", "condition"], &answers);
    let (materials, conditions) = match &crossed {
        Ok(table) => (
            table.factors[0].levels.clone(),
            table.factors[1].levels.clone(),
        ),
        Err(_) => Default::default(),
    };
    let of = |material: Option<&str>, condition: Option<&str>| -> Vec<f64> {
        experiment
            .subjects
            .iter()
            .filter_map(|subject| {
                let own = answers.iter().filter(|a| {
                    a.subject == subject.name
                        && material.is_none_or(|m| a.levels[0] == m)
                        && condition.is_none_or(|c| a.levels[1] == c)
                });
                let values: Vec<f64> = own.map(|a| a.value).collect();
                crate::statistics::mean(&values).ok()
            })
            .collect()
    };
    let mut rows: Vec<(String, Vec<f64>)> = Vec::new();
    let mut shown = Vec::new();
    for condition in &conditions {
        for material in &materials {
            let values = of(Some(material), Some(condition));
            if let Ok(s) = Summary::of(&values) {
                shown.push(Bar {
                    name: material.clone(),
                    group: condition.clone(),
                    value: s.mean,
                    interval: Some([s.mean - s.se, s.mean + s.se]),
                });
            }
            rows.push((format!("{material}, {condition}, %"), values));
        }
        rows.push((
            format!("all materials, {condition}, %"),
            of(None, Some(condition)),
        ));
    }
    section.tables.push(summaries(
        "cells",
        "Called real (as Table 3 of the paper)",
        &rows,
    ));
    let variance = crossed.and_then(|table| repeated_two_way(&table));
    section.tables.push(effects(
        "anova",
        "Two-way analysis of variance, both factors within subjects",
        &variance,
    ));
    let all = differences(&conditions, |condition| of(None, Some(condition)));
    section
        .tables
        .push(tests("differences", "Conditions, subject by subject", &all));
    let title = format!("{}: called real by material", experiment.design.title);
    let label = "called real, % (± SE)";
    section.figures.push(bars(
        "materials",
        &title,
        label,
        (&shown, Some([0.0, 100.0])),
        &[(50.0, "half")],
    ));
    section
}

fn cell_answers(experiment: &Experiment<'_>) -> Vec<CellAnswer> {
    let mut all = Vec::new();
    for subject in &experiment.subjects {
        for said in subject.trials().flat_map(said) {
            let stimulus = &experiment.design.stimuli[said.item];
            all.push(CellAnswer {
                subject: subject.name.to_owned(),
                levels: vec![stimulus.material.clone(), stimulus.condition.clone()],
                value: if said.said_real { 100.0 } else { 0.0 },
            });
        }
    }
    all
}

fn differences(
    conditions: &[String],
    of: impl Fn(&str) -> Vec<f64>,
) -> Vec<(String, Computed<Outcome>)> {
    let mut all = Vec::new();
    for (i, first) in conditions.iter().enumerate() {
        for second in &conditions[i + 1..] {
            let (a, b) = (of(first), of(second));
            let outcome = if a.len() == b.len() {
                paired_t(&a, &b)
            } else {
                Err(Undefined::because("a subject lacks one of the conditions"))
            };
            all.push((format!("{first} less {second}, %"), outcome));
        }
    }
    all
}
