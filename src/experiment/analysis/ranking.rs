//! Ranking against a target (Philpott & Summers 2012): how often and how nearly the target was
//! found, what was taken for what, and the map that follows.

use super::answers::{CHANCE_PERCENT, Rankings, rankings};
use super::draw::{Bar, share_bars};
use super::included_trials::Experiment;
use super::map::Mapping;
use super::model::{Cell, Section, Table, cells, or_undefined, percent_interval};
use super::options::Options;
use super::pairs::{NOTE, Pairs};
use super::properties::Measures;
use super::tables::{D_PRIME_NOTE, group_d_prime, tests};
use super::{ranking_confusions, ranking_scale};
use crate::design::Standard;
use selvedge_foundation::progress::{Cancelled, Progress};
use selvedge_statistics::detection::{Choice, Correction, Relation};
use selvedge_statistics::mds::{Loss, Ties};
use selvedge_statistics::ranking::{MeanRanks, Preferences, RankTrial};
use selvedge_statistics::{
    Computed, Outcome, Sides, Summary, exact_binomial, one_sample_t, wilcoxon_signed_rank,
};

/// The target among four.
const FOUR: Relation = Relation::Alternatives(4);
/// The mean rank that guesses give the target.
const CHANCE_RANK: f64 = 2.5;

pub(super) fn sections(
    experiment: &Experiment<'_>,
    options: &Options,
    progress: &mut Progress<'_>,
) -> Result<Vec<Section>, Cancelled> {
    let all = rankings(experiment);
    let names = experiment.ids();
    let trials: Vec<RankTrial> = all.iter().flat_map(|r| r.trials.iter().cloned()).collect();
    let mut sections = vec![identification(experiment, &all, options)];
    let ranks = match MeanRanks::of(names.len(), &trials) {
        Ok(ranks) => ranks,
        Err(why) => {
            sections[0].note(format!("No matrices: {}.", why.reason));
            return Ok(sections);
        }
    };
    sections.push(ranking_confusions::section(experiment, &ranks, &names));
    sections.push(ranking_scale::section(experiment, &all, progress)?);
    sections.push(pairs_section(experiment, &all, options));
    let measures = Measures::of(experiment, options, progress)?;
    let of_subject = |r: &Rankings<'_>| {
        let ranks = MeanRanks::of(names.len(), &r.trials).ok()?;
        Some(ranks.dissimilarities())
    };
    let mapping = Mapping {
        key: experiment.key("map"),
        title: experiment.titled("map"),
        values: ranks.dissimilarities(),
        subjects: all.iter().filter_map(of_subject).collect(),
        names,
        loss: Loss::SStress,
        ties: Ties::Secondary,
        measures: &measures,
    };
    let mut map = mapping.section(options, progress)?;
    map.note("S-stress and secondary ties are what ALSCAL makes small by default.");
    if experiment.design.composition.presentation.reference == Standard::RealCloth {
        map.note(
            "**The target is real, the alternatives are virtual**: their ranks are not symmetric, \
             and a map of the symmetric part leaves the difference out. See the asymmetry.",
        );
    }
    sections.push(map);
    Ok(sections)
}

const SUBJECTS: &str = "subject; trials; first: target first; percent: %; ci_low_percent: 95 % CI \
    from; ci_high_percent: to; p_one_sided: exact binomial p, above ¼; p_two_sided: two-sided p; \
    effect_h: Cohen's h; d_prime: d′, 4-AFC; d_prime_ci_low: 95 % CI from; d_prime_ci_high: to; \
    correction; mean_rank: mean rank of the target; at_chance: below chance";

fn identification(experiment: &Experiment<'_>, all: &[Rankings<'_>], options: &Options) -> Section {
    let mut section = experiment.section("identification", "identification");
    section.note(
        "Identified: the target was ranked first, chance 25 %. Intervals of shares are Wilson's, p \
         is exact (binomial); d′ of four alternatives without bias, its interval from Wilson's.",
    );
    section.note(D_PRIME_NOTE);
    let mut table = Table::new("subjects", "Identification by subject", SUBJECTS);
    let mut d_primes = Vec::new();
    let mut shown = Vec::new();
    for one in all {
        let (hits, n) = (one.n_first(), one.trials.len() as u64);
        let choice = FOUR.choice(hits, n, Correction::LogLinear);
        table.push(subject_row(one, &choice));
        d_primes.extend(choice.ok().map(|c| c.d_prime));
        shown.push(Bar::share(one.subject, hits, n));
    }
    section.table(table);
    let percents: Vec<f64> = all.iter().map(Rankings::percent).collect();
    let ranks: Vec<f64> = all.iter().map(Rankings::mean_rank).collect();
    let means = [
        ("targets identified, %", percents.clone()),
        ("mean rank of the target", ranks.clone()),
    ];
    let counts: Vec<[u64; 2]> = all
        .iter()
        .map(|one| [one.n_first(), one.trials.len() as u64])
        .collect();
    section.over_subjects(
        &means,
        Some(group_d_prime(counts.len(), FOUR.group(&counts))),
        options,
    );
    let found = against_chance(all, [&percents, &d_primes, &ranks]);
    section.table(tests("tests", "Against chance", &found));
    shown.extend(Bar::mean("mean", "", &percents));
    let title = experiment.titled("targets identified");
    let words = (title.as_str(), "targets identified, %");
    let rule = (CHANCE_PERCENT, "chance");
    section.figure(share_bars("subjects-bars", words, &shown, rule));
    section
}

fn subject_row(one: &Rankings<'_>, choice: &Computed<Choice>) -> Vec<Cell> {
    let (hits, n) = (one.n_first(), one.trials.len() as u64);
    let greater = exact_binomial(hits, n, 0.25, Sides::Greater);
    let choice = choice.as_ref();
    let correction = choice.map(|c| cells![c.correction.map_or("none", Correction::name)]);
    cells![
        one.subject,
        n,
        hits,
        one.percent(),
        percent_interval(hits, n),
        greater.as_ref().map(|o| o.p),
        exact_binomial(hits, n, 0.25, Sides::Two).map(|o| o.p),
        greater.and_then(|o| o.effect).map(|effect| effect.value),
        choice.map(|c| c.d_prime),
        or_undefined(choice.map(|c| cells![&c.interval]), 2),
        or_undefined(correction, 1),
        one.mean_rank(),
        or_undefined(choice.map(|c| cells![c.is_below_chance]), 1),
    ]
}

fn against_chance(
    all: &[Rankings<'_>],
    [percents, d_primes, ranks]: [&[f64]; 3],
) -> [(&'static str, Computed<Outcome>); 6] {
    let t = |values: &[f64], chance| Summary::of(values).and_then(|s| one_sample_t(&s, chance));
    let hits: u64 = all.iter().map(Rankings::n_first).sum();
    let n: u64 = all.iter().map(|r| r.trials.len() as u64).sum();
    let pooled = exact_binomial(hits, n, 0.25, Sides::Greater).map(|mut outcome| {
        let note = "subjects pooled, as if trials were independent";
        outcome.notes.push(note.to_owned());
        outcome
    });
    let (share, rank) = (
        "targets identified, % against 25",
        "mean rank of the target against 2.5",
    );
    [
        (share, t(percents, CHANCE_PERCENT)),
        (share, wilcoxon_signed_rank(percents, CHANCE_PERCENT)),
        ("d′ against 0", t(d_primes, 0.0)),
        (rank, t(ranks, CHANCE_RANK)),
        (rank, wilcoxon_signed_rank(ranks, CHANCE_RANK)),
        ("targets identified, share against ¼", pooled),
    ]
}

/// The alternatives of a trial that are not its target, the nearest first.
fn others(trial: &RankTrial) -> Vec<usize> {
    let mut all = trial.best_first();
    all.retain(|item| *item != trial.target);
    all
}

/// Scales of all alternatives but the target, over all targets.
fn pairs_section(experiment: &Experiment<'_>, all: &[Rankings<'_>], options: &Options) -> Section {
    let mut section = experiment.section("pairs", "nearer to whatever the target was");
    section.note(
        "Every ranking is taken apart into its pairs of alternatives that were not the target, all \
         targets together: preferred is what was ranked nearer. Values that differ say that some \
         textiles are ranked near whatever the target is.",
    );
    section.note(NOTE);
    section.note(
        "**Pairs of one ranking are not independent**: errors that take them so are too small, and \
         so are their p. Errors over subjects, by drawing subjects again, are the ones to quote.",
    );
    let names = experiment.ids();
    let of = |one: &Rankings<'_>| {
        let rankings: Vec<Vec<usize>> = one.trials.iter().map(others).collect();
        Preferences::of_rankings(names.len(), &rankings)
    };
    let subjects = all.iter().map(|one| (one.subject, of(one)));
    match Pairs::of(&names, subjects) {
        Ok(pairs) => pairs.describe("alternatives", "alternatives", options, &mut section),
        Err(why) => section.note(format!("No pairs: {}.", why.reason)),
    }
    section
}
