//! Fourier templates: closed forms of what is drawn, what is learnt back, what is refused.

use std::f64::consts::TAU;
use std::path::Path;

use super::*;
use crate::Manifest;
use crate::surface::Profile;

const BAND: [f64; 2] = [100.0, 1000.0];

/// Standard deviation of the heights of what is drawn from a template within the band, µm.
fn sd_um(template: &FourierTemplate) -> f64 {
    let harmonics = template.harmonics(BAND);
    let sum: f64 = harmonics.iter().map(|&n| template.variance_um2(n)).sum();
    sum.sqrt()
}

/// Standard deviations that differ between cosines and sines, means that are not 0.
fn material() -> FourierTemplate {
    let of = |f: fn(f64) -> f64| (1..=50).map(|n| f(f64::from(n))).collect();
    FourierTemplate {
        name: "made up".to_owned(),
        notes: String::new(),
        fundamental_per_m: 1000.0 / 50.5,
        mean_cos_um: of(|n| if n > 7.5 && n < 8.5 { 4.0 } else { 0.0 }),
        sd_cos_um: of(|n| 1.0 + n / 25.0),
        mean_sin_um: of(|_| 0.0),
        sd_sin_um: of(|n| 1.0 + n / 25.0),
    }
}

fn profile(series: &FourierSeries) -> Profile {
    let heights = (0..101)
        .map(|i| series.height_um(0.5 * f64::from(i)))
        .collect();
    Profile::new(0.5, heights).unwrap()
}

#[test]
fn a_wave_of_known_amplitude_is_learnt_with_2_over_n_and_the_sines_sign() {
    let heights = |x: f64| 3.0 * (TAU * 6.0 * x / 50.5).cos() + 5.0 * (TAU * 9.0 * x / 50.5).sin();
    let heights: Vec<f64> = (0..101).map(|i| heights(0.5 * f64::from(i))).collect();
    let profile = Profile::new(0.5, heights).unwrap();
    let learnt = FourierTemplate::learn("wave", &[profile.clone(), profile], 50).unwrap();
    assert!(
        (learnt.fundamental_per_m - 19.802).abs() < 1e-3,
        "{}",
        learnt.fundamental_per_m
    );
    assert!(
        (learnt.mean_cos_um[5] - 3.0).abs() < 1e-10,
        "{}",
        learnt.mean_cos_um[5]
    );
    assert!(
        (learnt.mean_sin_um[8] - 5.0).abs() < 1e-10,
        "{}",
        learnt.mean_sin_um[8]
    );
    let rest: f64 = learnt.mean_cos_um.iter().chain(&learnt.mean_sin_um).sum();
    assert!((rest - 8.0).abs() < 1e-9, "something else is there: {rest}");
    assert!(
        learnt.sd_cos_um.iter().all(|sd| sd.abs() < 1e-12),
        "they were the same"
    );
}

#[test]
fn what_is_drawn_has_the_templates_variance_at_every_place() {
    let template = material();
    let n_draws = 4000_u32;
    for x_mm in [0.0, 12.3, 31.4] {
        let (mut sum, mut squares) = (0.0, 0.0);
        for seed in 0..n_draws {
            let mut random = Random::new(u64::from(seed));
            let series = FourierSeries::draw(&template, BAND, Reading::Corrected, &mut random);
            let z = series.height_um(x_mm);
            sum += z / f64::from(n_draws);
            squares += z * z / f64::from(n_draws);
        }
        let spread: f64 = template
            .harmonics(BAND)
            .iter()
            .map(|&n| template.sd_cos_um[n - 1].powi(2))
            .sum();
        let found = squares - sum * sum;
        // Standard error of a variance over 4000 draws: 2.2 %.
        assert!(
            (found / spread - 1.0).abs() < 0.08,
            "{x_mm} mm: {found} for {spread}"
        );
    }
}

#[test]
fn the_literal_reading_is_not_stationary() {
    // Var f = ¼ Σ s² (1 + sin 2nω₀x): one harmonic shows it.
    let template = material();
    let band = [170.0, 180.0];
    let n = template.harmonics(band)[0];
    let (s, mean) = (template.sd_cos_um[n - 1], template.mean_cos_um[n - 1]);
    let per_mm = n as f64 / 50.5;
    for turns in [0.125, 0.375, 0.0] {
        let x_mm = turns / per_mm;
        let (mut sum, mut squares) = (0.0, 0.0);
        for seed in 0..4000 {
            let mut random = Random::new(seed);
            let series = FourierSeries::draw(&template, band, Reading::Literal, &mut random);
            let z = series.height_um(x_mm);
            sum += z / 4000.0;
            squares += z * z / 4000.0;
        }
        let expected = 0.25 * s * s * (1.0 + (2.0 * TAU * turns).sin());
        let found = squares - sum * sum;
        assert!(
            (found - expected).abs() < 0.08 * s * s,
            "{turns}: {found} for {expected}"
        );
        let phase = (TAU * turns).cos() + (TAU * turns).sin();
        assert!(
            (sum - 0.5 * mean * phase).abs() < 0.1,
            "{turns}: mean {sum}"
        );
    }
}

#[test]
fn a_template_is_learnt_back_from_what_was_drawn_from_it() {
    let template = material();
    let draw = |seed| {
        let mut random = Random::new(seed);
        profile(&FourierSeries::draw(
            &template,
            [0.0, 1e4],
            Reading::Corrected,
            &mut random,
        ))
    };
    let profiles: Vec<Profile> = (0..2000).map(draw).collect();
    let learnt = FourierTemplate::learn("again", &profiles, 50).unwrap();
    assert_eq!(learnt.mean_cos_um.len(), 50);
    for i in 0..50 {
        let [a, b] = [
            learnt.sd_cos_um[i] / template.sd_cos_um[i],
            learnt.sd_sin_um[i] / template.sd_sin_um[i],
        ];
        assert!(
            (a - 1.0).abs() < 0.08 && (b - 1.0).abs() < 0.08,
            "harmonic {}: {a}, {b}",
            i + 1
        );
        assert!(
            (learnt.mean_cos_um[i] - template.mean_cos_um[i]).abs() < 0.3,
            "harmonic {}",
            i + 1
        );
    }
}

#[test]
fn both_surfaces_are_as_rough_as_the_template_says() {
    let template = FourierTemplate {
        mean_cos_um: vec![0.0; 50],
        ..material()
    };
    let places: Vec<f64> = (0..60).map(|i| f64::from(i) * 0.83).collect();
    for composition in [Composition::Independent, Composition::Product] {
        let mut squares = 0.0;
        for seed in 0..60 {
            let how = (composition, Reading::Corrected);
            let plane = series::Plane::draw([&template; 2], BAND, how, &Random::new(seed));
            let z = plane.heights_um(&places, &places);
            squares += z.values().iter().map(|z| z * z).sum::<f64>() / (3600.0 * 60.0);
        }
        let ratio = squares.sqrt() / sd_um(&template);
        assert!((ratio - 1.0).abs() < 0.05, "{composition:?}: {ratio}");
    }
}

#[test]
fn strokes_come_back_from_the_mirror_as_they_went() {
    for composition in [Composition::Independent, Composition::Product] {
        let recipe = Fourier {
            composition,
            ..Fourier::new(material(), 4)
        };
        let drawn = recipe.sample().unwrap();
        assert_eq!(drawn.strokes_um[0].len(), 2000);
        let warp = &drawn.strokes_um[0];
        for i in 1..1000 {
            assert!((warp[i] - warp[2000 - i]).abs() < 1e-9, "sample {i}");
        }
        assert_eq!(drawn, recipe.sample().unwrap());
        assert_ne!(drawn, Fourier::new(material(), 5).sample().unwrap());
    }
    assert_eq!(mirrored(-3.0, 50.0), 3.0);
    assert_eq!(mirrored(60.0, 50.0), 40.0);
}

#[test]
fn the_five_examples_have_the_published_spread() {
    let examples = FourierTemplate::examples().unwrap();
    let spreads: Vec<f64> = examples.iter().map(sd_um).collect();
    for (found, said) in spreads.iter().zip([11.0, 20.7, 34.8, 45.0, 59.0]) {
        assert!((found / said - 1.0).abs() < 0.003, "{spreads:?}");
    }
    assert_eq!(examples.len(), 5);
    assert!(
        examples.iter().all(|t| t.notes.starts_with("Invented")),
        "it must be said"
    );
    let path = Path::new("t.toml");
    let text = FourierTemplate::list_to_toml(&examples, path).unwrap();
    assert_eq!(
        FourierTemplate::list_from_toml(&text, path).unwrap(),
        examples
    );
}

#[test]
fn readings_become_a_profile_and_their_coarseness_is_told() {
    // 100 mm/min past a wave of 10 mm; a tracker in steps of 0.498 mm at 20 Hz.
    let speed = 5.0;
    let height = |x: f64| 40.0 * (TAU * x / 10.0).sin() + 3.0 * x;
    let t_s: Vec<f64> = (0..240).map(|i| f64::from(i) * 0.05).collect();
    let probe = Readings {
        values: t_s.iter().map(|t| height(speed * t)).collect(),
        t_s: t_s.clone(),
    };
    let tracker = Readings {
        values: t_s
            .iter()
            .map(|t| (speed * t / 0.498).floor() * 0.498)
            .collect(),
        t_s,
    };
    let imported = import(&probe, &tracker).unwrap();
    assert_eq!(imported.profile.heights_um().len(), 101);
    assert_eq!(imported.profile.step_mm(), 0.5);
    assert!(
        (0.498..=0.997).contains(&imported.worst_step_mm),
        "{}",
        imported.worst_step_mm
    );
    // Its line is off; the wave is there to within the tracker's step.
    let z = imported.profile.heights_um();
    let mean = z.iter().sum::<f64>() / 101.0;
    assert!(mean.abs() < 1e-9, "{mean}");
    let rms = (z.iter().map(|z| z * z).sum::<f64>() / 101.0).sqrt();
    assert!((rms - 40.0 / 2.0_f64.sqrt()).abs() < 2.0, "{rms}");
    let short = Readings {
        values: tracker.values.iter().map(|x| 0.5 * x).collect(),
        ..tracker
    };
    let error = import(&probe, &short).unwrap_err().to_string();
    assert!(
        error.starts_with("the readings cover 29.") && error.contains("; "),
        "{error}"
    );
}

#[test]
fn wrong_readings_and_too_few_profiles_are_refused_in_one_line() {
    let path = Path::new("p.csv");
    let error = Readings::from_csv("t_s,x_mm\n0,1\n0,2\n", path, "x_mm")
        .unwrap_err()
        .to_string();
    assert!(
        error.starts_with("p.csv:3: t_s is 0, not after 0; "),
        "{error}"
    );
    assert!(
        Readings::from_csv("t_s,x_mm\n0,nan\n", path, "x_mm").is_err(),
        "NaN"
    );
    let one = |t: f64| Readings {
        t_s: vec![t],
        values: vec![0.0],
    };
    let none = Readings {
        t_s: vec![],
        values: vec![],
    };
    for (a, b) in [(one(0.0), one(0.0)), (one(0.0), one(9.0)), (none, one(0.0))] {
        let error = import(&a, &b).unwrap_err().to_string();
        assert!(error.contains("; ") && !error.contains('\n'), "{error}");
    }
    let profile = Profile::new(0.5, vec![1.0; 101]).unwrap();
    let shorter = Profile::new(0.5, vec![1.0; 100]).unwrap();
    for profiles in [vec![], vec![profile.clone()], vec![profile, shorter]] {
        let error = FourierTemplate::learn("x", &profiles, 50)
            .unwrap_err()
            .to_string();
        assert!(error.contains("; ") && !error.contains('\n'), "{error}");
    }
}

const RECIPE: &str = "name = \"F\"\nconstruction = \"other\"\nfibre = \"none\"\n[source]\n\
    kind = \"fourier\"\nseed = 1\n[source.template]\nname = \"x\"\nfundamental_per_m = 100.0\n\
    mean_cos_um = [0.0, 0.0]\nsd_cos_um = [1.0, 2.0]\nmean_sin_um = [0.0, 0.0]\n\
    sd_sin_um = [1.0, 2.0]\n";

#[test]
fn recipes_that_make_no_sense_are_refused_with_their_line() {
    let read = |text: &str| Manifest::from_toml(text, Path::new("f.toml"));
    assert!(read(RECIPE).is_ok(), "{:?}", read(RECIPE));
    for (from, to, expected) in [
        (
            "sd_cos_um = [1.0, 2.0]",
            "sd_cos_um = [1.0]",
            "f.toml:11: sd_cos_um has 1 values",
        ),
        (
            "sd_cos_um = [1.0, 2.0]",
            "sd_cos_um = [1.0, nan]",
            "f.toml:11: sd_cos_um holds NaN",
        ),
        (
            "sd_sin_um = [1.0, 2.0]",
            "sd_sin_um = [1.0, -2.0]",
            "f.toml:13: sd_sin_um holds -2",
        ),
        (
            "_per_m = 100.0",
            "_per_m = nan",
            "f.toml:9: fundamental_per_m is NaN",
        ),
        (
            "seed = 1",
            "seed = 1\nhighest_per_m = 50.0",
            "f.toml:7: highest_per_m is 50",
        ),
        (
            "seed = 1",
            "seed = 1\nlowest_per_m = 300.0",
            "f.toml:7: no harmonic of",
        ),
        (
            "seed = 1",
            "seed = 1\nreading = \"literal\"",
            "f.toml:7: reading = ",
        ),
        (
            "seed = 1",
            "seed = 1\nstep_mm = 0.5\nhighest_per_m = 2000.0",
            "f.toml:8: highest_per_m",
        ),
        ("seed = 1", "sed = 1", "f.toml:6: unknown field `sed`"),
    ] {
        let error = read(&RECIPE.replace(from, to)).unwrap_err().to_string();
        assert!(error.starts_with(expected), "{error}");
        assert!(error.contains("; ") && !error.contains('\n'), "{error}");
    }
}
