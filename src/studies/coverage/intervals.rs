//! Intervals of numbers that are known.

use super::{Trial, normals, successes, unpromised};
use selvedge_foundation::numerics::Random;
use selvedge_statistics::adaptive::{Procedure as _, QuestGrid, QuestPlus, Stop};
use selvedge_statistics::detection::{
    Answers, Correction, forced_choice, share_of_d_prime, yes_no,
};
use selvedge_statistics::psychometric::stevens::{Estimate, stevens};
use selvedge_statistics::psychometric::{Block, Family, Fit, Guess, Model, Psychometric};
use selvedge_statistics::{
    Bootstrap, Computed, Interval, Resampling, Summary, bootstrap, fisher_z, mean, normal_lower,
    pearson_r, wilcoxon_signed_rank, wilson,
};

const LEVEL: f64 = 0.95;
const N: usize = 8;

const fn interval(
    name: &'static str,
    setting: &'static str,
    n_studies: [usize; 2],
    study: fn(&mut Random) -> Computed<bool>,
) -> Trial {
    Trial {
        name,
        setting,
        n_studies,
        is_promised: true,
        study,
    }
}

const MANY: [usize; 2] = [1000, 5000];
const SOME: [usize; 2] = [200, 1000];
const FEW: [usize; 2] = [24, 200];
const MIDDLE: [usize; 2] = [60, 500];

pub(super) const ALL: &[Trial] = &[
    interval("mean, Student t", "8 subjects", MANY, |random| {
        let sample = Summary::of(&normals::<N>(random, 41.3, 4.5))?;
        Ok(sample.interval(LEVEL)?.holds(41.3))
    }),
    interval("share, Wilson", "40 trials, 41.3 %", MANY, |random| {
        let hits = successes(random, 40, 0.413);
        Ok(wilson(u64::from(hits), 40, LEVEL)?.holds(0.413))
    }),
    interval("median, Wilcoxon", "8 subjects", MANY, |random| {
        let outcome = wilcoxon_signed_rank(&normals::<N>(random, 3.0, 1.0), 0.0)?;
        Ok(outcome.interval?.holds(3.0))
    }),
    interval(
        "correlation, Fisher z",
        "16 textiles, 0.55",
        MANY,
        |random| {
            let x = normals::<16>(random, 0.0, 1.0);
            let rest = (1.0 - 0.55_f64 * 0.55).sqrt();
            let y = x.map(|x| 0.55 * x + rest * random.normal());
            Ok(fisher_z(pearson_r(&x, &y)?, 16, LEVEL)?.holds(0.55))
        },
    ),
    unpromised(interval(
        "mean, bootstrap percentile",
        "8 subjects",
        SOME,
        |random| drawn_anew::<N>(random, |found| Ok(found.percentile)),
    )),
    unpromised(interval(
        "mean, bootstrap BCa",
        "8 subjects",
        SOME,
        |random| drawn_anew::<N>(random, |found| found.bca),
    )),
    interval("mean, bootstrap BCa", "24 subjects", SOME, |random| {
        drawn_anew::<24>(random, |found| found.bca)
    }),
    interval(
        "d′, yes/no (Gourevitch & Galanter)",
        "d′ 1.5, 100 + 100 trials",
        MANY,
        |random| {
            let (hits, false_alarms) = (normal_lower(0.75), normal_lower(-0.75));
            let answers = Answers {
                hits: u64::from(successes(random, 100, hits)),
                n_signal: 100,
                false_alarms: u64::from(successes(random, 100, false_alarms)),
                n_noise: 100,
            };
            Ok(yes_no(answers, Correction::LogLinear)?.interval.holds(1.5))
        },
    ),
    interval(
        "d′, four alternatives",
        "d′ 1, 80 trials",
        MIDDLE,
        |random| {
            let correct = successes(random, 80, share_of_d_prime(1.0, 4)?);
            let found = forced_choice(u64::from(correct), 80, 4, Correction::LogLinear)?;
            Ok(found.interval?.holds(1.0))
        },
    ),
    interval(
        "threshold, delta method",
        "7 stimuli × 20 trials",
        SOME,
        |random| {
            let found = of_alternatives(random)?.delta(threshold, LEVEL)?;
            Ok(found.1.holds(0.0))
        },
    ),
    interval(
        "threshold, posterior",
        "7 stimuli × 20 trials",
        MIDDLE,
        |random| {
            let found = of_alternatives(random)?
                .posterior()
                .interval(threshold, LEVEL)?;
            Ok(found.holds(0.0))
        },
    ),
    interval(
        "threshold, parametric bootstrap",
        "7 stimuli × 20 trials",
        FEW,
        |random| {
            let resamples = of_alternatives(random)?.resample(how(random, 200))?;
            Ok(resamples.interval(threshold)?.1.holds(0.0))
        },
    ),
    interval(
        "PSE, delta method",
        "two-sided, 7 stimuli × 20 trials",
        SOME,
        |random| {
            let found = of_comparison(random)?.delta(threshold, LEVEL)?;
            Ok(found.1.holds(0.0))
        },
    ),
    interval(
        "JND, delta method",
        "two-sided, 7 stimuli × 20 trials",
        SOME,
        |random| {
            let found = of_comparison(random)?.delta_positive(Psychometric::jnd, LEVEL)?;
            Ok(found.1.holds(comparison().jnd()?))
        },
    ),
    interval(
        "JND, posterior",
        "two-sided, 7 stimuli × 20 trials",
        MIDDLE,
        |random| {
            let posterior = of_comparison(random)?.posterior();
            let found = posterior.interval(Psychometric::jnd, LEVEL)?;
            Ok(found.holds(comparison().jnd()?))
        },
    ),
    interval(
        "threshold, QUEST+ mean ± 1.96 sd",
        "80 trials",
        FEW,
        after_quest,
    ),
    interval(
        "exponent, t over subjects",
        "8 subjects, 5 stimuli × 3",
        SOME,
        |random| {
            let found = stevens(&magnitudes(random), LEVEL)?;
            Ok(found.interval?.holds(0.7))
        },
    ),
];

fn how(random: &mut Random, n_resamples: usize) -> Resampling {
    let seed = u64::try_from(random.index(1 << 30)).unwrap_or(0);
    Resampling {
        n_resamples,
        seed,
        level: LEVEL,
    }
}

fn drawn_anew<const M: usize>(
    random: &mut Random,
    of: fn(Bootstrap) -> Computed<Interval>,
) -> Computed<bool> {
    let values = normals::<M>(random, 41.3, 4.5);
    let of_drawn = |drawn: &[usize]| mean(&drawn.iter().map(|&i| values[i]).collect::<Vec<_>>());
    let found = bootstrap(M, of_drawn, how(random, 500))?;
    Ok(of(found)?.holds(41.3))
}

fn threshold(curve: &Psychometric) -> Computed {
    curve.stimulus_at_shape(0.5)
}

/// Right answers of three alternatives; decibels about the threshold.
fn of_alternatives(random: &mut Random) -> Computed<Fit> {
    let truth = Psychometric {
        family: Family::Gumbel,
        threshold: 0.0,
        width: 10.0,
        guess: 1.0 / 3.0,
        lapse: 0.02,
    };
    Model::alternatives(Family::Gumbel, 3).fit(&answered(&truth, random, 4.0))
}

fn comparison() -> Psychometric {
    Psychometric {
        family: Family::Normal,
        threshold: 0.0,
        width: 8.0,
        guess: 0.01,
        lapse: 0.01,
    }
}

fn of_comparison(random: &mut Random) -> Computed<Fit> {
    Model::two_sided(Family::Normal).fit(&answered(&comparison(), random, 2.0))
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
    let truth = Psychometric {
        family: Family::Gumbel,
        threshold: random.uniform_in(-6.0, 6.0),
        width: 10.0,
        guess: 1.0 / 3.0,
        lapse: 0.02,
    };
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
