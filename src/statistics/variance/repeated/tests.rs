//! Repeated measures against published data, whole-number sums, and t tests.

use super::*;
use crate::{Summary, one_sample_t, paired_t};
use selvedge_foundation::numerics::Random;

/// Maxwell & Delaney, Designing Experiments and Analyzing Data, table 12.1: reaction times in ms
/// of ten subjects, noise absent and then present, at 0, 4 and 8 degrees each.
const REACTION_MS: [[i64; 6]; 10] = [
    [420, 420, 480, 480, 600, 780],
    [420, 480, 480, 360, 480, 600],
    [480, 480, 540, 660, 780, 780],
    [420, 540, 540, 480, 780, 900],
    [540, 660, 540, 480, 660, 720],
    [360, 420, 360, 360, 480, 540],
    [480, 480, 600, 540, 720, 840],
    [480, 600, 660, 540, 720, 900],
    [540, 600, 540, 480, 720, 780],
    [480, 420, 540, 540, 660, 780],
];

fn factor(name: &str, levels: &[&str]) -> Factor {
    Factor {
        name: name.to_owned(),
        levels: levels.iter().map(|&l| l.to_owned()).collect(),
    }
}

fn subjects(n: usize) -> Vec<String> {
    (1..=n).map(|i| format!("S{i:02}")).collect()
}

fn reaction(offset: f64) -> Crossed {
    let value = |&ms: &i64| Some(ms as f64 + offset);
    Crossed {
        subjects: subjects(10),
        factors: vec![
            factor("noise", &["absent", "present"]),
            factor("angle", &["0", "4", "8"]),
        ],
        values: REACTION_MS.iter().flatten().map(value).collect(),
    }
}

/// Sums of squares of totals, in whole numbers: each total squared, times 60/(values in a total),
/// so that nothing is rounded; in units of 1/60.
fn squares_of_totals(key: impl Fn(usize, usize, usize) -> usize) -> i64 {
    let mut totals = [(0_i64, 0_i64); 64];
    for (subject, row) in REACTION_MS.iter().enumerate() {
        for (cell, ms) in row.iter().enumerate() {
            let total = &mut totals[key(subject, cell / 3, cell % 3)];
            *total = (total.0 + ms, total.1 + 1);
        }
    }
    let used = totals.iter().filter(|(_, count)| *count > 0);
    used.map(|(sum, count)| sum * sum * (60 / count)).sum()
}

fn assert_close(found: f64, expected: f64, tolerance: f64) {
    assert!(
        (found - expected).abs() <= tolerance,
        "{found} for {expected}"
    );
}

#[test]
fn sums_of_squares_are_those_of_whole_number_totals() -> Computed<()> {
    let all = squares_of_totals(|_, _, _| 0);
    let s = squares_of_totals(|s, _, _| s);
    let a = squares_of_totals(|_, a, _| a);
    let b = squares_of_totals(|_, _, b| b);
    let ab = squares_of_totals(|_, a, b| a * 3 + b);
    let a_s = squares_of_totals(|s, a, _| s * 2 + a);
    let b_s = squares_of_totals(|s, _, b| s * 3 + b);
    let each = squares_of_totals(|s, a, b| s * 6 + a * 3 + b);
    let expected = [
        [a - all, a_s - a - s + all],
        [b - all, b_s - b - s + all],
        [ab - a - b + all, each - ab - a_s - b_s + a + b + s - all],
    ];
    let found = Repeated::two_way(&reaction(0.0))?;
    let sixtieth = |whole: i64| whole as f64 / 60.0;
    assert_close(found.ss_subjects, sixtieth(s - all), 1e-6);
    for (effect, [ss, ss_error]) in found.effects.iter().zip(expected) {
        assert_close(effect.ss, sixtieth(ss), 1e-6);
        assert_close(effect.ss_error, sixtieth(ss_error), 1e-6);
    }
    Ok(())
}

#[test]
fn the_textbook_example_has_its_published_values() -> Computed<()> {
    let found = Repeated::two_way(&reaction(0.0))?;
    let [noise, angle, both] = found.effects.as_slice() else {
        return undefined("three effects");
    };
    let f = |e: &Effect| e.f.clone();
    assert_close(f(noise)?, 33.77, 5e-3);
    assert_close(f(angle)?, 40.72, 5e-3);
    assert_close(f(both)?, 45.31, 5e-3);
    let degrees = |e: &Effect| [e.df, e.df_error];
    assert_eq!(degrees(noise), [1.0, 9.0]);
    assert_eq!(degrees(angle), [2.0, 18.0]);
    assert_eq!(degrees(both), [2.0, 18.0]);
    // Generalised η² and the ε as the R package afex prints them for these data.
    for (effect, ges) in [(noise, 0.387), (angle, 0.390), (both, 0.188)] {
        assert_close(effect.generalised_eta_squared.clone()?, ges, 5e-4);
    }
    assert!(noise.sphericity.is_none(), "two levels have no sphericity");
    for (effect, w, epsilon) in [(angle, 0.960, 0.962), (both, 0.894, 0.904)] {
        let Some(sphericity) = &effect.sphericity else {
            return undefined("a row of sphericity");
        };
        assert_close(sphericity.mauchly_w.clone()?, w, 5e-4);
        assert_close(sphericity.greenhouse_geisser, epsilon, 5e-4);
        assert!(sphericity.huynh_feldt.clone()? > 1.0, "{sphericity:?}");
        assert_eq!(sphericity.p_huynh_feldt, effect.p, "capped at 1");
        let corrected = sphericity.p_greenhouse_geisser.clone()?;
        assert!(corrected > effect.p.clone()?, "{sphericity:?}");
    }
    Ok(())
}

#[test]
fn epsilon_agrees_with_the_formula_of_double_centred_covariances() -> Computed<()> {
    // Box 1954: k²(mean of diagonal − grand mean)² /
    //   ((k − 1)(Σ c² − 2k Σ row mean² + k² grand mean²)), of covariances c between levels.
    let angle_ms = |row: &[i64; 6], b: usize| (row[b] + row[b + 3]) as f64 / 2.0;
    let levels: Vec<Vec<f64>> = (0..3)
        .map(|b| centred(&REACTION_MS.map(|row| angle_ms(&row, b))).1)
        .collect();
    let covariance = |i: usize, j: usize| -> f64 {
        let products = levels[i].iter().zip(&levels[j]).map(|(a, b)| a * b);
        products.sum::<f64>() / 9.0
    };
    let c: Vec<f64> = (0..9).map(|i| covariance(i / 3, i % 3)).collect();
    let diagonal = (c[0] + c[4] + c[8]) / 3.0;
    let grand = c.iter().sum::<f64>() / 9.0;
    let rows: f64 = c
        .chunks(3)
        .map(|r| (r.iter().sum::<f64>() / 3.0).powi(2))
        .sum();
    let squares: f64 = c.iter().map(|x| x * x).sum();
    let box_epsilon =
        9.0 * (diagonal - grand).powi(2) / (2.0 * (squares - 6.0 * rows + 9.0 * grand * grand));
    let found = Repeated::two_way(&reaction(0.0))?;
    let epsilon = found.effects[1]
        .sphericity
        .as_ref()
        .map(|s| s.greenhouse_geisser);
    assert_close(epsilon.unwrap_or(0.0), box_epsilon, 1e-12);
    Ok(())
}

#[test]
fn an_offset_of_a_million_million_changes_nothing() -> Computed<()> {
    let near = Repeated::two_way(&reaction(0.0))?;
    let far = Repeated::two_way(&reaction(1e12))?;
    for (near, far) in near.effects.iter().zip(&far.effects) {
        assert_close(far.f.clone()? / near.f.clone()?, 1.0, 1e-10);
    }
    Ok(())
}

#[test]
fn two_conditions_are_a_paired_t_squared() -> Computed<()> {
    let (a, b) = ([5.0, 7.0, 9.0, 4.0], [4.0, 4.0, 7.0, 4.0]);
    let table = Crossed {
        subjects: subjects(4),
        factors: vec![factor("signal", &["real", "made"])],
        values: a
            .iter()
            .zip(b)
            .flat_map(|(a, b)| [Some(*a), Some(b)])
            .collect(),
    };
    let found = Repeated::one_way(&table)?;
    let t = paired_t(&a, &b)?;
    assert_close(
        found.effects[0].f.clone()?,
        t.statistic.value.powi(2),
        1e-12,
    );
    assert_close(found.effects[0].p.clone()?, t.p, 1e-13);
    Ok(())
}

#[test]
fn complementary_answers_make_one_effect_nothing_by_nothing() -> Computed<()> {
    // Shares chosen as real, of a real and a made signal of each pair: together 100 %.
    let mut random = Random::new(2);
    let real: Vec<f64> = (0..96).map(|_| 100.0 * random.uniform()).collect();
    let names: Vec<String> = (1..=8).map(|i| format!("m{i}")).collect();
    let mut values = Vec::new();
    for subject in real.chunks(8) {
        values.extend(subject.iter().map(|&v| Some(v)));
        values.extend(subject.iter().map(|v| Some(100.0 - v)));
    }
    let material = Factor {
        name: "material".to_owned(),
        levels: names,
    };
    let table = Crossed {
        subjects: subjects(12),
        factors: vec![factor("signal", &["real", "made"]), material],
        values,
    };
    let found = Repeated::two_way(&table)?;
    let [signal, material, _] = found.effects.as_slice() else {
        return undefined("three effects");
    };
    let reason = material.f.clone().map_err(|e| e.reason);
    assert!(
        reason.is_err_and(|r| r.starts_with("material") && r.contains("0/0")),
        "said"
    );
    assert!(material.partial_eta_squared.is_err(), "0/0");
    // The effect of the signal is the one-sample t against 50 %, squared.
    let means: Vec<f64> = real
        .chunks(8)
        .map(|c| c.iter().sum::<f64>() / 8.0)
        .collect();
    let t = one_sample_t(&Summary::of(&means)?, 50.0)?;
    assert_close(signal.f.clone()?, t.statistic.value.powi(2), 1e-9);
    assert_close(signal.p.clone()?, t.p, 1e-12);
    assert_eq!([signal.df, signal.df_error], [1.0, 11.0]);
    Ok(())
}

#[test]
fn without_an_effect_one_study_of_twenty_finds_one() -> Computed<()> {
    let mut random = Random::new(5);
    let mut table = reaction(0.0);
    let mut n_found = [0; 3];
    for _ in 0..2000 {
        table.values.fill_with(|| Some(random.normal()));
        for (count, effect) in n_found.iter_mut().zip(Repeated::two_way(&table)?.effects) {
            *count += i32::from(effect.p? < 0.05);
        }
    }
    for count in n_found {
        let share = f64::from(count) / 2000.0;
        assert!((0.035..0.065).contains(&share), "{share}");
    }
    Ok(())
}

#[test]
fn tables_that_cannot_be_analysed_say_why() {
    let reason = |table: &Crossed| Repeated::two_way(table).map(|_| ()).map_err(|e| e.reason);
    let mut holes = reaction(0.0);
    holes.values[7] = None;
    holes.values[59] = Some(f64::INFINITY);
    let listed = "missing cells: S02 · absent · 4; S10 · present · 8";
    assert_eq!(reason(&holes), Err(listed.to_owned()));
    let mut alone = reaction(0.0);
    alone.subjects.truncate(1);
    alone.values.truncate(6);
    assert_eq!(reason(&alone), Err("one subject alone".to_owned()));
    assert!(Repeated::one_way(&reaction(0.0)).is_err(), "two factors");
    let mut same = reaction(0.0);
    same.values.fill(Some(0.1));
    let found = Repeated::two_way(&same).map(|r| r.effects);
    let is_said = |e: &Effect| e.f.is_err() && e.p.is_err() && e.sphericity.is_none();
    assert!(found.is_ok_and(|e| e.iter().all(is_said)), "all equal");
}
