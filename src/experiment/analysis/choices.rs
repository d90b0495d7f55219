//! One of several chosen, right or wrong: shares and d′ by subject, by the relation that belongs to
//! how stimuli came together.

use super::draw::{Bar, share_bars};
use super::included_trials::{Experiment, Subject};
use super::model::{Cell, Section, Table, cells, or_undefined, percent_interval, percent_of};
use super::options::Options;
use super::tables::{D_PRIME_NOTE, group_d_prime, tests};
use selvedge_statistics::detection::{Choice, Correction, Relation};
use selvedge_statistics::{
    Computed, Sides, Summary, exact_binomial, one_sample_t, wilcoxon_signed_rank,
};

const SUBJECTS: &str = "subject; trials; right; percent: %; ci_low_percent: 95 % CI from; \
    ci_high_percent: to; p: exact binomial p, above chance; d_prime: d′; d_prime_ci_low: 95 % CI \
    from; d_prime_ci_high: to; correction";

/// Right answers of a subject: all, and those of pairs of the same one.
struct Counts {
    right: u64,
    n: u64,
    /// Pairs of different ones called different, and how many there were.
    hits: [u64; 2],
    /// Pairs of the same one called different, and how many there were.
    false_alarms: [u64; 2],
}

impl Counts {
    fn of(subject: &Subject<'_>) -> Self {
        let mut counts = Self {
            right: 0,
            n: 0,
            hits: [0; 2],
            false_alarms: [0; 2],
        };
        for record in subject.trials() {
            let Some(is_right) = record.is_correct else {
                continue;
            };
            counts.n += 1;
            counts.right += u64::from(is_right);
            let is_same = record.trial.task.right == Some(0);
            let (of, is_called) = if is_same {
                (&mut counts.false_alarms, !is_right)
            } else {
                (&mut counts.hits, is_right)
            };
            of[0] += u64::from(is_called);
            of[1] += 1;
        }
        counts
    }
}

/// What subjects came to.
pub(super) struct BySubject {
    pub(super) table: Table,
    percents: Vec<f64>,
    pub(super) d_primes: Vec<f64>,
    /// The row of d′ over subjects, where a relation gives it.
    pub(super) group: Option<Vec<Cell>>,
    shown: Vec<Bar>,
}

/// Shares of right answers and d′, subject by subject.
pub(super) fn by_subject(experiment: &Experiment<'_>) -> BySubject {
    let chance = 1.0 / experiment.design.composition.n_choices() as f64;
    let mut found = BySubject {
        table: Table::new("subjects", "Right answers by subject", SUBJECTS),
        percents: Vec::new(),
        d_primes: Vec::new(),
        group: None,
        shown: Vec::new(),
    };
    let mut of_all = Vec::new();
    for subject in &experiment.subjects {
        let counts = Counts::of(subject);
        let (right, n) = (counts.right, counts.n);
        of_all.push([right, n]);
        let choice = sensitivity(experiment, &counts);
        found.percents.push(100.0 * right as f64 / n.max(1) as f64);
        found
            .d_primes
            .extend(choice.as_ref().ok().map(|choice| choice.d_prime));
        found.shown.push(Bar::share(subject.name, right, n));
        found.table.push(cells![
            subject.name,
            n,
            right,
            percent_of(right, n, "no trials"),
            percent_interval(right, n),
            exact_binomial(right, n, chance, Sides::Greater).map(|o| o.p),
            or_undefined(choice.map(|choice| choice_cells(&choice)), 4)
        ]);
    }
    let relation = experiment.design.composition.relation();
    found.group = relation.map(|relation| group_d_prime(of_all.len(), relation.group(&of_all)));
    found
}

/// Shares and d′ by subject and over them.
pub(super) fn sections(experiment: &Experiment<'_>, options: &Options) -> Vec<Section> {
    let composition = &experiment.design.composition;
    let chance = 1.0 / composition.n_choices() as f64;
    let mut section = experiment.section("choices", "right answers");
    section.note(format!(
        "Chance is {} %. {} Intervals of shares are Wilson's, p is exact (binomial).",
        selvedge_foundation::quantity::fixed(100.0 * chance, 1),
        described(composition.relation())
    ));
    let BySubject {
        table,
        percents,
        d_primes,
        group,
        shown,
    } = by_subject(experiment);
    section.table(table);
    let mut means = vec![("right, %", percents.clone())];
    if group.is_none() {
        means.push(("d′", d_primes));
    } else {
        section.note(D_PRIME_NOTE);
    }
    section.over_subjects(&means, group, options);
    let t = |values: &[f64], at| Summary::of(values).and_then(|s| one_sample_t(&s, at));
    let what = "right, % against chance";
    let found = [
        (what, t(&percents, 100.0 * chance)),
        (what, wilcoxon_signed_rank(&percents, 100.0 * chance)),
    ];
    section.table(tests("tests", "Against guessing", &found));
    let title = experiment.titled("right answers");
    let rule = (100.0 * chance, "chance");
    section.figure(share_bars("bars", (&title, "right, %"), &shown, rule));
    vec![section]
}

fn choice_cells(choice: &Choice) -> Vec<Cell> {
    let correction = choice.correction.map_or("none", Correction::name);
    cells![choice.d_prime, choice.interval.clone(), correction]
}

/// What d′ is here.
fn described(relation: Option<Relation>) -> &'static str {
    match relation {
        None => {
            "d′ is that of an observer who goes by the difference of both, from pairs called \
             different where they are and where they are not."
        }
        Some(Relation::Triangle) => "d′ is that of the triangle test; below chance it is 0.",
        Some(Relation::Abx) => {
            "d′ is that of ABX without bias, by independent looks at each; below chance it is 0."
        }
        Some(Relation::Alternatives(_)) => "d′ is that of forced choice without bias.",
    }
}

fn sensitivity(experiment: &Experiment<'_>, counts: &Counts) -> Computed<Choice> {
    match experiment.design.composition.relation() {
        Some(relation) => relation.choice(counts.right, counts.n, Correction::LogLinear),
        None => Choice::of_same_different(counts.hits, counts.false_alarms),
    }
}
