//! Real or generated (Cai et al. 2021, phase 2): sensitivity and bias by subject, confidence, and
//! whether material and condition matter to what is called real.

use super::answers::judgements;
use super::included_trials::{Experiment, Subject};
use super::model::{Section, Table, cells, or_undefined};
use super::options::Options;
use super::tables::{D_PRIME_NOTE, group_d_prime, tests};
use super::{choices, judgement_cells, judgement_confidence, judgement_pairs, judgement_power};
use crate::design::Sets;
use selvedge_statistics::detection::{Answers, Correction, GroupDPrime, YesNo};
use selvedge_statistics::{Sides, Summary, exact_binomial, one_sample_t, sign_flip};

pub(super) fn sections(experiment: &Experiment<'_>, options: &Options) -> Vec<Section> {
    let composition = &experiment.design.composition;
    let is_pair = composition.order.sets == Sets::Opposed;
    let mut all = vec![sensitivity(experiment, is_pair, options)];
    let n_grades = composition.response.confidence.n_grades();
    if n_grades > 1 && !is_pair {
        all.push(judgement_confidence::section(experiment, n_grades));
    }
    all.push(judgement_power::section(experiment, &percents(experiment)));
    all.extend(judgement_cells::sections(experiment));
    if is_pair {
        all.push(judgement_pairs::section(experiment, options));
    }
    all
}

/// Every subject's right answers, %.
fn percents(experiment: &Experiment<'_>) -> Vec<f64> {
    let all = experiment.subjects.iter();
    all.map(Subject::percent_right).collect()
}

fn sensitivity(experiment: &Experiment<'_>, is_pair: bool, options: &Options) -> Section {
    let mut section = experiment.section("sensitivity", "sensitivity and bias");
    let (table, d_primes, group) = if is_pair {
        section.note("The real one of two was to be found: d′ of two alternatives without bias.");
        let found = choices::by_subject(experiment);
        (found.table, found.d_primes, found.group)
    } else {
        section.note(
            "A hit is a real one called real, a false alarm a generated one called real. Rates \
             enter z with the log-linear correction, (count + ½)/(n + 1); counts are as they \
             were. c > 0: rather not called real.",
        );
        let (table, d_primes) = yes_no_table(experiment);
        let answers: Vec<Answers> = experiment.subjects.iter().map(counts).collect();
        let group = group_d_prime(answers.len(), GroupDPrime::of_yes_no(&answers));
        (table, d_primes, Some(group))
    };
    section.note(D_PRIME_NOTE);
    section.table(table);
    let percents = percents(experiment);
    section.over_subjects(&[("right, %", percents.clone())], group, options);
    let t = |values: &[f64], at| Summary::of(values).and_then(|s| one_sample_t(&s, at));
    let from_half: Vec<f64> = percents.iter().map(|p| p - 50.0).collect();
    let rights = experiment.subjects.iter().map(Subject::n_right);
    let (right, n) = rights.fold((0, 0), |(a, b), (right, n)| (a + right, b + n));
    let flipped = sign_flip(&from_half, options.n_permutations, options.seed);
    let all = [
        ("right, % against 50", t(&percents, 50.0)),
        ("right, % less 50, signs flipped", flipped),
        ("d′ against 0", t(&d_primes, 0.0)),
        (
            "right, subjects pooled as if independent",
            exact_binomial(right, n, 0.5, Sides::Two),
        ),
    ];
    section.table(tests("tests", "Against guessing", &all));
    section
}

const YES_NO: &str = "subject; hits; n_real: of real; false_alarms: false alarms; n_generated: of \
    generated; hit_rate: H, corrected; false_alarm_rate: F, corrected; correction; d_prime: d′; \
    d_prime_ci_low: 95 % CI from; d_prime_ci_high: to; criterion: c; ln_beta: ln β; \
    uncorrected_d_prime: d′ uncorrected";

fn counts(subject: &Subject<'_>) -> Answers {
    let mut answers = Answers {
        hits: 0,
        n_signal: 0,
        false_alarms: 0,
        n_noise: 0,
    };
    for judged in subject.trials().flat_map(judgements) {
        let (n, yes) = if judged.is_real {
            (&mut answers.n_signal, &mut answers.hits)
        } else {
            (&mut answers.n_noise, &mut answers.false_alarms)
        };
        *n += 1;
        *yes += u64::from(judged.called_real);
    }
    answers
}

fn yes_no_table(experiment: &Experiment<'_>) -> (Table, Vec<f64>) {
    let mut table = Table::new("subjects", "Sensitivity and bias by subject", YES_NO);
    let mut d_primes = Vec::new();
    for subject in &experiment.subjects {
        let answers = counts(subject);
        let found = YesNo::of(answers, Correction::LogLinear);
        d_primes.extend(found.as_ref().ok().map(|found| found.d_prime));
        let found = found.map(|found| {
            cells![
                [found.hit_rate, found.false_alarm_rate],
                found.correction.name(),
                [found.d_prime, found.interval.low, found.interval.high],
                [found.criterion, found.ln_beta],
                found.uncorrected_d_prime,
            ]
        });
        let [hits, alarms] = [answers.hits, answers.false_alarms];
        let counts = [hits, answers.n_signal, alarms, answers.n_noise];
        table.push(cells![subject.name, counts, or_undefined(found, 9)]);
    }
    (table, d_primes)
}
