//! How often 95 % intervals hold the truth, and tests at 5 % find what is not there, in seeded
//! studies of eight subjects and of single subjects.

use selvedge_foundation::numerics::Random;

use crate::adaptive::{Procedure as _, QuestGrid, QuestPlus, Stop};
use crate::detection::{Answers, Correction, Relation, YesNo, choice_share};
use crate::procrustes::Procrustes;
use crate::properties::{BestTurn, PropertyVector};
use crate::psychometric::stevens::{Estimate, Stevens};
use crate::psychometric::{Block, Family, Guess, Model, Psychometric};
use crate::variance::{
    Answer, Comparison, Crossed, Effect, Repeated, Sphericity, friedman, kruskal_wallis, one_way,
    welch,
};
use crate::{
    Bootstrap, Computed, Equivalence, Interval, Outcome, Resampling, Sides, Summary, TwoSamples,
    exact_binomial, f_upper, mean, normal_lower, one_sample_t, paired_t, pearson, pearson_r,
    sign_flip, spearman, wilcoxon_signed_rank,
};

const LEVEL: f64 = 0.95;
const ALPHA: f64 = 0.05;
const N: usize = 8;

/// A name, how many studies are simulated, and one study: whether the interval holds the truth, or
/// the test rejects.
type Trial = (&'static str, u32, fn(&mut Random) -> Computed<bool>);

/// Refuses shares of studies outside a band, in percent, give or take two standard errors.
fn assert_within(band: [f64; 2], seed: u64, trials: &[Trial]) {
    for (name, n_studies, study) in trials {
        let mut random = Random::new(seed).branch(name);
        let n_held = (0..*n_studies)
            .filter(|_| study(&mut random).unwrap())
            .count();
        let percent = 100.0 * n_held as f64 / f64::from(*n_studies);
        let error = (percent * (100.0 - percent) / f64::from(*n_studies)).sqrt();
        let [low, high] = [band[0] - 2.0 * error, band[1] + 2.0 * error];
        assert!(
            (low..=high).contains(&percent),
            "{name}: {percent} ± {error}"
        );
    }
}

/// Studies without an effect that every test is tried on.
const N_NULL: u32 = 2000;

/// A test, in what share of studies without an effect it is to find one, and such a study: whether
/// it does.
type Null = (&'static str, f64, fn(&mut Random) -> Computed<bool>);

/// Refuses tests that find more or less of what is not there than is stated: beyond the interval
/// that 999 of 1000 binomials of so many studies lie in.
fn assert_false_positives(seed: u64, tests: &[Null]) {
    let mut wrong = Vec::new();
    for (name, expected, study) in tests {
        let mut random = Random::new(seed).branch(name);
        let n_found = (0..N_NULL).filter(|_| study(&mut random).unwrap()).count() as u64;
        let chance = exact_binomial(n_found, N_NULL.into(), *expected, Sides::Two);
        let chance = chance.unwrap().p;
        println!("{name}: {n_found} of {N_NULL} studies, {expected} stated; p = {chance:.3}");
        if chance < 0.001 {
            wrong.push(*name);
        }
    }
    assert!(wrong.is_empty(), "{wrong:?}");
}

#[test]
fn intervals_of_means_shares_and_correlations_hold_the_truth() {
    let trials: &[Trial] = &[
        ("mean, Student t", 1000, |random| {
            let sample = Summary::of(&normals::<N>(random, 41.3, 4.5))?;
            Ok(sample.interval(LEVEL)?.holds(41.3))
        }),
        ("share, Wilson", 1000, |random| {
            let hits = successes(random, 40, 0.413);
            Ok(Interval::wilson(u64::from(hits), 40, LEVEL)?.holds(0.413))
        }),
        ("median, Wilcoxon", 1000, |random| {
            let outcome = wilcoxon_signed_rank(&normals::<N>(random, 3.0, 1.0), 0.0)?;
            Ok(outcome.interval?.holds(3.0))
        }),
        ("correlation, Fisher z", 1000, |random| {
            let x = normals::<16>(random, 0.0, 1.0);
            let rest = (1.0 - 0.55_f64 * 0.55).sqrt();
            let y = x.map(|x| 0.55 * x + rest * random.normal());
            Ok(Interval::fisher_z(pearson_r(&x, &y)?, 16, LEVEL)?.holds(0.55))
        }),
        ("mean of 24 subjects, bootstrap BCa", 150, |random| {
            let values = normals::<24>(random, 41.3, 4.5);
            let of_drawn =
                |drawn: &[usize]| mean(&drawn.iter().map(|&i| values[i]).collect::<Vec<_>>());
            Ok(Bootstrap::of(24, of_drawn, resampling(random))?
                .bca?
                .holds(41.3))
        }),
        ("exponent, t over subjects", 300, |random| {
            let found = Stevens::fit(&magnitudes(random), LEVEL)?;
            Ok(found.interval?.holds(0.7))
        }),
    ];
    assert_within([90.0, 98.0], 1, trials);
}

#[test]
fn intervals_of_d_primes_and_of_thresholds_hold_the_truth() {
    let trials: &[Trial] = &[
        ("d′ of yes and no", 1000, |random| {
            let (hits, false_alarms) = (normal_lower(0.75), normal_lower(-0.75));
            let answers = Answers {
                hits: u64::from(successes(random, 100, hits)),
                n_signal: 100,
                false_alarms: u64::from(successes(random, 100, false_alarms)),
                n_noise: 100,
            };
            Ok(YesNo::of(answers, Correction::LogLinear)?
                .interval
                .holds(1.5))
        }),
        ("d′ of four alternatives", 60, |random| {
            let correct = successes(random, 80, choice_share(1.0, 4)?);
            let four = Relation::Alternatives(4);
            let found = four.choice(u64::from(correct), 80, Correction::LogLinear)?;
            Ok(found.interval?.holds(1.0))
        }),
        ("threshold, posterior", 150, |random| {
            let model = Model::alternatives(Family::Gumbel, 3, [10.0, 0.5]);
            let fit = model.fit(&answered(&about_zero(0.0), random, 4.0))?;
            Ok(fit.own.holds(0.0))
        }),
        ("threshold after 80 trials of QUEST+", 24, after_quest),
    ];
    assert_within([90.0, 99.0], 1, trials);
}

/// Of exact tests so few results are possible that none has 5 %: what the next below has is stated.
const TESTS: &[Null] = &[
    ("t, one sample", ALPHA, |random| {
        let sample = Summary::of(&normals::<N>(random, 25.0, 8.0))?;
        rejects(one_sample_t(&sample, 25.0))
    }),
    ("t, paired", ALPHA, |random| {
        let [a, b] = correlated(random);
        rejects(paired_t(&a, &b))
    }),
    ("t, Welch, spreads 1 : 3", ALPHA, |random| {
        let a = Summary::of(&normals::<N>(random, 0.0, 1.0))?;
        let b = Summary::of(&normals::<N>(random, 0.0, 3.0))?;
        rejects(TwoSamples::of(&a, &b).map(|tests| tests.welch))
    }),
    ("t, Student, two samples", ALPHA, |random| {
        let [a, b] = [(); 2].map(|()| Summary::of(&normals::<N>(random, 0.0, 1.0)));
        rejects(TwoSamples::of(&a?, &b?).map(|tests| tests.student))
    }),
    ("equivalence, at its bound", ALPHA, |random| {
        let sample = Summary::of(&normals::<12>(random, 1.0, 0.5))?;
        Ok(Equivalence::of(&sample, [-1.0, 1.0], ALPHA)?.p < ALPHA)
    }),
    ("Wilcoxon, differences of pairs", 10.0 / 256.0, |random| {
        let [a, b] = correlated(random);
        let differences: Vec<f64> = a.iter().zip(&b).map(|(a, b)| a - b).collect();
        rejects(wilcoxon_signed_rank(&differences, 0.0))
    }),
    ("binomial, 80 trials", 0.0499, |random| {
        // 27 hits or more have a probability of 0.0499.
        let hits = u64::from(successes(random, 80, 0.25));
        rejects(exact_binomial(hits, 80, 0.25, Sides::Greater))
    }),
    ("PROTEST", ALPHA, |random| {
        let [a, b] = [(); 2].map(|()| clouds(random));
        Ok(Procrustes::protest(&a, &b, 39, random)? <= ALPHA)
    }),
    ("sign flips", 12.0 / 256.0, |random| {
        rejects(sign_flip(&normals::<N>(random, 0.0, 1.0), 0, 0))
    }),
    ("property of a map, F", ALPHA, |random| {
        let (map, property) = (clouds(random), normals::<7>(random, 0.0, 1.0));
        let found = PropertyVector::of(&map, &property)?;
        let [df, df_error] = found.df.map(|df| df as f64);
        Ok(f_upper(found.f, df, df_error)? < ALPHA)
    }),
    ("turn of a map", ALPHA, |random| {
        let map = clouds(random);
        let [x, y] = [(); 2].map(|()| normals::<7>(random, 0.0, 1.0));
        let turn = BestTurn::of(&map, [&x, &y])?;
        Ok(turn.p_values(&map, [&x, &y], 39, random)?[0] <= ALPHA)
    }),
    ("correlation, Spearman", ALPHA, |random| {
        let [x, y] = [(); 2].map(|()| normals::<16>(random, 0.0, 1.0));
        rejects(spearman(&x, &y))
    }),
    ("correlation, Pearson", ALPHA, |random| {
        let [x, y] = [(); 2].map(|()| normals::<16>(random, 0.0, 1.0));
        rejects(pearson(&x, &y))
    }),
];

#[test]
fn tests_find_no_more_than_their_level_where_nothing_is() {
    assert_false_positives(2, TESTS);
}

const ANALYSES_OF_VARIANCE: &[Null] = &[
    ("one way", ALPHA, |random| rejects(one_way(&groups(random)))),
    ("Welch", ALPHA, |random| rejects(welch(&groups(random)))),
    ("Kruskal–Wallis", ALPHA, |random| {
        rejects(kruskal_wallis(&groups(random)))
    }),
    ("Friedman", ALPHA, |random| {
        let rows = (0..N).map(|_| normals::<4>(random, 0.0, 1.0).to_vec());
        rejects(friedman(&rows.collect::<Vec<_>>()))
    }),
    ("two way, spherical, Huynh–Feldt", ALPHA, |random| {
        two_way(random, (1, false), |s| s.p_huynh_feldt.clone())
    }),
    ("two way, of two levels", ALPHA, |random| {
        two_way(random, (0, true), |s| s.p_greenhouse_geisser.clone())
    }),
    (
        "two way, both together, Greenhouse–Geisser",
        ALPHA,
        |random| two_way(random, (2, true), |s| s.p_greenhouse_geisser.clone()),
    ),
    (
        "two way, not spherical, Greenhouse–Geisser",
        ALPHA,
        |random| two_way(random, (1, true), |s| s.p_greenhouse_geisser.clone()),
    ),
    (
        "within subjects, one way, Greenhouse–Geisser",
        ALPHA,
        |random| {
            let table = table(random, &[("material", 4)], true)?;
            let p = |s: &Sphericity| s.p_greenhouse_geisser.clone();
            Ok(corrected(&Repeated::one_way(&table)?.effects[0], p)? < ALPHA)
        },
    ),
    ("within subjects, one way, Huynh–Feldt", ALPHA, |random| {
        let table = table(random, &[("material", 4)], false)?;
        let p = |s: &Sphericity| s.p_huynh_feldt.clone();
        Ok(corrected(&Repeated::one_way(&table)?.effects[0], p)? < ALPHA)
    }),
    ("Holm, any of six pairs", ALPHA, |random| {
        let rows: Vec<Vec<f64>> = groups(random);
        let any = Comparison::every_pair(&rows)?
            .into_iter()
            .any(|pair| pair.p_holm.is_ok_and(|p| p < ALPHA));
        Ok(any)
    }),
];

#[test]
fn analyses_of_variance_find_no_more_than_their_level_where_nothing_is() {
    assert_false_positives(2, ANALYSES_OF_VARIANCE);
}

fn normals<const M: usize>(random: &mut Random, mean: f64, sd: f64) -> [f64; M] {
    std::array::from_fn(|_| mean + sd * random.normal())
}

fn successes(random: &mut Random, n: u32, p: f64) -> u32 {
    (0..n).map(|_| u32::from(random.uniform() < p)).sum()
}

fn resampling(random: &mut Random) -> Resampling {
    Resampling {
        n_resamples: 500,
        seed: u64::try_from(random.index(1 << 30)).unwrap_or(0),
        level: LEVEL,
    }
}

/// An observer of three alternatives; decibels.
fn about_zero(threshold: f64) -> Psychometric {
    Psychometric {
        family: Family::Gumbel,
        threshold,
        width: 10.0,
        guess: 1.0 / 3.0,
        lapse: 0.02,
    }
}

/// Twenty answers to each of seven stimuli about 0.
fn answered(truth: &Psychometric, random: &mut Random, step: f64) -> Vec<Block> {
    let block = |i: i32| {
        let x = step * f64::from(i);
        Block {
            x,
            n: 20,
            n_right: successes(random, 20, truth.at(x)),
        }
    };
    (-3..=3).map(block).collect()
}

fn after_quest(random: &mut Random) -> Computed<bool> {
    let truth = about_zero(random.uniform_in(-6.0, 6.0));
    let grid = QuestGrid {
        family: Family::Gumbel,
        guess: Guess::Share(1.0 / 3.0),
        stimuli: (-10..=10).map(|i| 2.0 * f64::from(i)).collect(),
        thresholds: (-24..=24).map(|i| 0.5 * f64::from(i)).collect(),
        widths: vec![5.0, 7.0, 10.0, 14.0, 20.0],
        lapses: vec![0.0, 0.02, 0.04],
    };
    let mut quest = QuestPlus::new(grid, Stop::Trials(80))?;
    while let Some(stimulus) = quest.stimulus() {
        quest.answer(stimulus, random.uniform() < truth.at(stimulus))?;
    }
    let found = quest.summary().threshold;
    Ok((found.mean - truth.threshold).abs() <= 1.96 * found.sd)
}

/// Numbers given to five stimuli three times by subjects whose exponents and moduli differ.
fn magnitudes(random: &mut Random) -> Vec<Estimate> {
    let mut estimates = Vec::new();
    for subject in 0..N {
        let (exponent, modulus) = (0.7 + 0.1 * random.normal(), random.normal().exp());
        for stimulus in [1.0, 2.0, 5.0, 10.0, 20.0_f64] {
            for _ in 0..3 {
                let scatter = (0.2 * random.normal()).exp();
                estimates.push(Estimate {
                    subject: format!("S{subject}"),
                    stimulus,
                    value: modulus * stimulus.powf(exponent) * scatter,
                });
            }
        }
    }
    estimates
}

fn rejects(outcome: Computed<Outcome>) -> Computed<bool> {
    Ok(outcome?.p < ALPHA)
}

fn correlated(random: &mut Random) -> [[f64; N]; 2] {
    let subjects = normals::<N>(random, 50.0, 10.0);
    [(); 2].map(|()| subjects.map(|s| s + 5.0 * random.normal()))
}

fn groups(random: &mut Random) -> Vec<Vec<f64>> {
    (0..4)
        .map(|_| normals::<N>(random, 10.0, 2.0).to_vec())
        .collect()
}

/// Seven points of a plane.
fn clouds(random: &mut Random) -> Vec<Vec<f64>> {
    (0..7)
        .map(|_| normals::<2>(random, 0.0, 1.0).to_vec())
        .collect()
}

fn corrected(effect: &Effect, p: fn(&Sphericity) -> Computed) -> Computed {
    effect
        .sphericity
        .as_ref()
        .map_or_else(|| effect.p.clone(), p)
}

/// The first factor, of two levels, the second, of four, or both together.
fn two_way(
    random: &mut Random,
    (effect, is_uneven): (usize, bool),
    p: fn(&Sphericity) -> Computed,
) -> Computed<bool> {
    let table = table(random, &[("signal", 2), ("material", 4)], is_uneven)?;
    Ok(corrected(&Repeated::two_way(&table)?.effects[effect], p)? < ALPHA)
}

/// Subjects who differ, cells that do not but, if uneven, in how much they vary.
fn table(random: &mut Random, factors: &[(&str, u32)], is_uneven: bool) -> Computed<Crossed> {
    let names: Vec<&str> = factors.iter().map(|(name, _)| *name).collect();
    let counts: Vec<u32> = factors.iter().map(|(_, n)| *n).collect();
    let mut answers = Vec::new();
    for subject in 0..N {
        let own = 3.0 * random.normal();
        for cell in 0..counts.iter().product::<u32>() {
            let levels = match counts[..] {
                [_, inner] => vec![cell / inner, cell % inner],
                _ => vec![cell],
            };
            let last = levels.last().copied().unwrap_or(0);
            let sd = if is_uneven && last == 0 { 4.0 } else { 1.0 };
            answers.push(Answer {
                subject: format!("S{subject}"),
                levels: levels.iter().map(u32::to_string).collect(),
                value: own + sd * random.normal(),
            });
        }
    }
    Crossed::of_answers(&names, &answers)
}
