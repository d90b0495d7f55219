//! Tests where nothing is to be found, with eight subjects.

use super::{Trial, normals, unpromised};
use selvedge_foundation::numerics::Random;
use selvedge_statistics::variance::{
    Answer, Crossed, friedman, kruskal_wallis, one_way, repeated_one_way, repeated_two_way, welch,
};
use selvedge_statistics::{
    Computed, Outcome, Summary, one_sample_t, paired_t, pearson, sign_flip, two_sample_t,
    wilcoxon_pairs,
};

const N: usize = 8;
const ALPHA: f64 = 0.05;

const fn null(
    name: &'static str,
    setting: &'static str,
    study: fn(&mut Random) -> Computed<bool>,
) -> Trial {
    Trial {
        name,
        setting,
        n_studies: [1000, 5000],
        is_promised: true,
        study,
    }
}

/// The interaction of two factors within subjects, in twice as many studies.
const fn interaction(setting: &'static str, study: fn(&mut Random) -> Computed<bool>) -> Trial {
    Trial {
        n_studies: [1000, 10_000],
        ..null("repeated measures, 2 × 4", setting, study)
    }
}

pub(super) const ALL: &[Trial] = &[
    null("t, one sample", "8 subjects", |random| {
        rejects(one_sample_t(
            &Summary::of(&normals::<N>(random, 25.0, 8.0))?,
            25.0,
        ))
    }),
    null("t, paired", "8 subjects", |random| {
        let [a, b] = correlated(random);
        rejects(paired_t(&a, &b))
    }),
    null("t, Welch", "8 and 8 subjects, equal spreads", |random| {
        two_groups(random, 1.0, |tests| tests.welch)
    }),
    null("t, Welch", "8 and 8 subjects, spreads 1 : 3", |random| {
        two_groups(random, 3.0, |tests| tests.welch)
    }),
    null("t, Student", "8 and 8 subjects, equal spreads", |random| {
        two_groups(random, 1.0, |tests| tests.student)
    }),
    unpromised(null(
        "t, Student",
        "8 and 8 subjects, spreads 1 : 3",
        |random| two_groups(random, 3.0, |tests| tests.student),
    )),
    null("ANOVA, one way", "4 groups of 8", |random| {
        Ok(one_way("group", &groups(random))?.p? < ALPHA)
    }),
    null("ANOVA, Welch", "4 groups of 8", |random| {
        rejects(welch(&groups(random)))
    }),
    null("Kruskal–Wallis", "4 groups of 8", |random| {
        rejects(kruskal_wallis(&groups(random)))
    }),
    null(
        "repeated measures, 2 × 4",
        "8 subjects, spherical; factor of 4, p as it is",
        |random| two_way(random, false, |effect| effect.p.clone()),
    ),
    null(
        "repeated measures, 2 × 4",
        "8 subjects, spherical; factor of 4, Huynh–Feldt",
        |random| two_way(random, false, huynh_feldt),
    ),
    unpromised(null(
        "repeated measures, 2 × 4",
        "8 subjects, spherical; factor of 4, Greenhouse–Geisser",
        |random| two_way(random, false, greenhouse_geisser),
    )),
    unpromised(null(
        "repeated measures, 2 × 4",
        "8 subjects, not spherical; factor of 4, p as it is",
        |random| two_way(random, true, |effect| effect.p.clone()),
    )),
    null(
        "repeated measures, 2 × 4",
        "8 subjects, not spherical; factor of 4, Greenhouse–Geisser",
        |random| two_way(random, true, greenhouse_geisser),
    ),
    interaction("8 subjects, spherical; interaction, p as it is", |random| {
        interacting(random, false, |effect| effect.p.clone())
    }),
    interaction(
        "8 subjects, spherical; interaction, Huynh–Feldt",
        |random| interacting(random, false, huynh_feldt),
    ),
    unpromised(interaction(
        "8 subjects, not spherical; interaction, p as it is",
        |random| interacting(random, true, |effect| effect.p.clone()),
    )),
    interaction(
        "8 subjects, not spherical; interaction, Greenhouse–Geisser",
        |random| interacting(random, true, greenhouse_geisser),
    ),
    null(
        "repeated measures, one way",
        "8 subjects, not spherical, Greenhouse–Geisser",
        |random| {
            let table = table(random, &[("material", 4)], true)?;
            Ok(greenhouse_geisser(&repeated_one_way(&table)?.effects[0])? < ALPHA)
        },
    ),
    null("Friedman", "8 subjects, 4 conditions", |random| {
        let rows: Vec<Vec<f64>> = (0..N)
            .map(|_| normals::<4>(random, 0.0, 1.0).to_vec())
            .collect();
        rejects(friedman(&rows))
    }),
    null("Wilcoxon, pairs", "8 subjects", |random| {
        let [a, b] = correlated(random);
        rejects(wilcoxon_pairs(&a, &b))
    }),
    null("sign-flip permutation", "8 subjects", |random| {
        rejects(sign_flip(&normals::<N>(random, 0.0, 1.0), 0, 0))
    }),
    null("correlation, Pearson", "16 textiles", |random| {
        rejects(pearson(
            &normals::<16>(random, 0.0, 1.0),
            &normals::<16>(random, 0.0, 1.0),
        ))
    }),
];

fn rejects(outcome: Computed<Outcome>) -> Computed<bool> {
    Ok(outcome?.p < ALPHA)
}

fn correlated(random: &mut Random) -> [[f64; N]; 2] {
    let subjects = normals::<N>(random, 50.0, 10.0);
    [(); 2].map(|()| subjects.map(|s| s + 5.0 * random.normal()))
}

fn two_groups(
    random: &mut Random,
    ratio: f64,
    of: fn(selvedge_statistics::TwoSamples) -> Outcome,
) -> Computed<bool> {
    let a = Summary::of(&normals::<N>(random, 0.0, 1.0))?;
    let b = Summary::of(&normals::<N>(random, 0.0, ratio))?;
    rejects(two_sample_t(&a, &b).map(of))
}

fn groups(random: &mut Random) -> Vec<Vec<f64>> {
    (0..4)
        .map(|_| normals::<N>(random, 10.0, 2.0).to_vec())
        .collect()
}

type Effect = selvedge_statistics::variance::Effect;

fn greenhouse_geisser(effect: &Effect) -> Computed {
    corrected(effect, |sphericity| sphericity.p_greenhouse_geisser.clone())
}

fn huynh_feldt(effect: &Effect) -> Computed {
    corrected(effect, |sphericity| sphericity.p_huynh_feldt.clone())
}

fn corrected(
    effect: &Effect,
    of: fn(&selvedge_statistics::variance::Sphericity) -> Computed,
) -> Computed {
    effect
        .sphericity
        .as_ref()
        .map_or_else(|| effect.p.clone(), of)
}

/// The second factor, of four levels, of a table of two by four.
fn two_way(random: &mut Random, is_uneven: bool, p: fn(&Effect) -> Computed) -> Computed<bool> {
    of_two_way(random, is_uneven, 1, p)
}

/// The interaction of both.
fn interacting(random: &mut Random, is_uneven: bool, p: fn(&Effect) -> Computed) -> Computed<bool> {
    of_two_way(random, is_uneven, 2, p)
}

fn of_two_way(
    random: &mut Random,
    is_uneven: bool,
    effect: usize,
    p: fn(&Effect) -> Computed,
) -> Computed<bool> {
    let table = table(random, &[("signal", 2), ("material", 4)], is_uneven)?;
    Ok(p(&repeated_two_way(&table)?.effects[effect])? < ALPHA)
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
