//! Restoration: periods in noise, what is kept, what strokes over the composition read.

use std::f64::consts::TAU;
use std::path::Path;

use super::*;
use crate::Manifest;
use crate::surface::Profile;

const STEP_MM: f64 = 1.0 / 230.0;

/// 20 mm of a wave with two overtones, and white noise as strong as asked for.
fn measured(period_mm: f64, snr_db: f64, seed: u64) -> Profile {
    let mut random = Random::new(seed);
    let wave = |x: f64| {
        let phase = TAU * x / period_mm;
        10.0 * (phase + 0.4).cos() + 4.0 * (2.0 * phase).sin() + 2.0 * (5.0 * phase).cos()
    };
    let signal: f64 = (100.0 + 16.0 + 4.0) / 2.0;
    let noise = signal.sqrt() * 10.0_f64.powf(-snr_db / 20.0);
    let heights = (0..4600).map(|i| {
        let x = f64::from(i) * STEP_MM;
        wave(x) + 3.0 * x + noise * random.normal()
    });
    Profile::new(STEP_MM, heights.collect()).unwrap()
}

fn restored(profile: &Profile, rule: Rule) -> Restoration {
    let reduced = Reduced::of(profile, 10).unwrap();
    Restoration::new(reduced, None, rule, 1)
}

#[test]
fn the_period_is_found_within_1_percent_at_0_db() {
    let mut worst = 0.0_f64;
    for seed in 0..20 {
        for period_mm in [0.35, 0.617, 1.31, 3.9] {
            let reduced = Reduced::of(&measured(period_mm, 0.0, seed), 10).unwrap();
            let found = reduced.period_mm.unwrap_or(0.0);
            worst = worst.max((found / period_mm - 1.0).abs());
            assert!(
                (found / period_mm - 1.0).abs() < 0.01,
                "{period_mm} mm: {found}"
            );
        }
    }
    println!("worst period error {:.4} %", 100.0 * worst);
}

#[test]
fn without_noise_the_three_waves_come_back() {
    let reduced = Reduced::of(&measured(0.8, 300.0, 1), 10).unwrap();
    assert_eq!(reduced.harmonics[..3], [1, 2, 5], "{reduced:?}");
    for (found, said) in reduced.amplitude_um.iter().zip([10.0, 4.0, 2.0]) {
        assert!(
            (found - said).abs() < 0.05 * said,
            "{:?}",
            reduced.amplitude_um
        );
    }
    assert!(
        (reduced.phase_deg[0] - 0.4_f64.to_degrees()).abs() < 3.0,
        "{:?}",
        reduced.phase_deg
    );
}

#[test]
fn the_restored_profile_is_as_rough_as_the_measured() {
    for snr_db in [-6.0, 0.0, 10.0, 60.0] {
        for seed in 0..5 {
            let profile = measured(0.617, snr_db, seed);
            let recipe = restored(&profile, Rule::Additive);
            let flat = selvedge_foundation::numerics::without_line(profile.heights_um());
            let truth = crate::surface::mean_deviation(&flat);
            for restored in recipe.profiles_um() {
                let ratio = crate::surface::mean_deviation(&restored) / truth;
                assert!((ratio - 1.0).abs() < 0.05, "{snr_db} dB: {ratio}");
            }
        }
    }
}

#[test]
fn the_additive_rule_alone_keeps_both_marginals() {
    let (a, b) = (measured(0.617, 10.0, 1), measured(1.1, 10.0, 2));
    let [warp, weft] = [&a, &b].map(|profile| Reduced::of(profile, 10).unwrap());
    for rule in [Rule::Additive, Rule::Product, Rule::Max, Rule::Gated] {
        let recipe = Restoration::new(warp.clone(), Some(weft.clone()), rule, 1);
        let [along, across] = recipe.profiles_um();
        let drawn = recipe.sample().unwrap();
        let apart = |stroke: &[f64], profile: &[f64]| {
            let mean = profile.iter().sum::<f64>() / profile.len() as f64;
            let pairs = stroke.iter().zip(profile);
            pairs
                .map(|(a, b)| (a - (b - mean)).abs())
                .fold(0.0, f64::max)
        };
        let worst = apart(&drawn.strokes_um[0], &along).max(apart(&drawn.strokes_um[2], &across));
        println!("{rule:?}: {worst:.3} µm apart");
        assert_eq!(worst < 1e-9, rule == Rule::Additive, "{rule:?}: {worst}");
    }
}

#[test]
fn rules_are_what_their_names_say() {
    let profile = measured(1.0, 300.0, 1);
    let (a, b) = (vec![1.0, -2.0, 3.0], vec![0.5, 4.0, -1.0]);
    let at = |rule, i: usize, j: usize| {
        restored(&profile, rule)
            .composed_um([&a, &b], [&[i], &[j]])
            .values()[0]
    };
    assert_eq!(at(Rule::Additive, 0, 1), 5.0);
    assert_eq!(at(Rule::Max, 1, 0), 0.5);
    let rms = |z: &[f64]| (z.iter().map(|z| z * z).sum::<f64>() / 3.0).sqrt();
    let product = 3.0 * 4.0 / (rms(&a) * rms(&b)).sqrt();
    assert!(
        (at(Rule::Product, 2, 1) - product).abs() < 1e-12,
        "{product}"
    );
    assert_eq!(at(Rule::Gated, 0, 0), 1.0);
    let flat = vec![0.0; 3];
    let level = restored(&profile, Rule::Product).composed_um([&flat, &flat], [&[0], &[0]]);
    assert_eq!(level.values(), [0.0]);
}

#[test]
fn noise_and_the_level_have_no_period_and_stay_finite() {
    let mut random = Random::new(9);
    let noise = Profile::new(STEP_MM, (0..4600).map(|_| random.normal()).collect()).unwrap();
    let level = Profile::new(STEP_MM, vec![2.0; 4600]).unwrap();
    for profile in [noise, level] {
        let reduced = Reduced::of(&profile, 10).unwrap();
        assert_eq!(reduced.period_mm, None);
        let recipe = Restoration::new(reduced.clone(), None, Rule::Gated, 1);
        let drawn = recipe.sample().unwrap();
        assert!(
            drawn.strokes_um.iter().flatten().all(|z| z.is_finite()),
            "{reduced:?}"
        );
        let smd = crate::surface::mean_deviation(&recipe.profiles_um()[0]);
        assert!(
            (smd - reduced.smd_um).abs() <= 0.05 * reduced.smd_um + 1e-12,
            "{smd}"
        );
    }
    let one = Profile::new(STEP_MM, vec![1.0]).unwrap();
    let error = Reduced::of(&one, 10).unwrap_err().to_string();
    assert!(
        error.starts_with("1 samples are no profile") && error.contains("; "),
        "{error}"
    );
}

const RECIPE: &str = "name = \"R\"\nconstruction = \"other\"\nfibre = \"none\"\n[source]\n\
    kind = \"restoration\"\nseed = 1\n[source.warp]\nsmd_um = 3.0\nperiod_mm = 0.5\n\
    harmonics = [1, 2]\namplitude_um = [4.0, 1.0]\nphase_deg = [0.0, 90.0]\n\
    residual_from_per_mm = 0.025\nresidual_um = [0.1, 0.2]\n";

#[test]
fn recipes_that_make_no_sense_are_refused_with_their_line() {
    let read = |text: &str| Manifest::from_toml(text, Path::new("r.toml"));
    assert!(read(RECIPE).is_ok(), "{:?}", read(RECIPE));
    for (from, to, expected) in [
        (
            "[4.0, 1.0]",
            "[4.0]",
            "r.toml:11: amplitude_um has 1 values",
        ),
        (
            "[4.0, 1.0]",
            "[4.0, nan]",
            "r.toml:11: amplitude_um holds NaN",
        ),
        ("[1, 2]", "[0, 2]", "r.toml:10: harmonics holds 0"),
        ("period_mm = 0.5\n", "", "r.toml:9: harmonics of no period"),
        ("smd_um = 3.0", "smd_um = -3.0", "r.toml:8: smd_um holds -3"),
        (
            "seed = 1",
            "seed = 1\nstep_mm = inf",
            "r.toml:7: step_mm is inf",
        ),
        (
            "seed = 1",
            "seed = 1\ncomposition = \"sum\"",
            "r.toml:7: unknown variant `sum`",
        ),
    ] {
        let error = read(&RECIPE.replace(from, to)).unwrap_err().to_string();
        assert!(error.starts_with(expected), "{error}");
        assert!(error.contains("; ") && !error.contains('\n'), "{error}");
    }
}
