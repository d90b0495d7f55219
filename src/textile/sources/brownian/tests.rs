//! Brownian recipes: the exponent that comes back, amplitudes, extremes.

use std::path::Path;

use super::*;
use crate::Manifest;

fn small(hurst: f64, generator: Generator, seed: u32) -> Brownian {
    Brownian {
        length_mm: 6.4,
        step_mm: 0.05,
        ..Brownian::new(hurst, 5.0, generator, seed)
    }
}

/// Rows and columns of a map.
fn lines(map: &HeightMap) -> Vec<Vec<f64>> {
    let z = map.heights_um();
    let rows = (0..z.height()).step_by(8).map(|row| z.row(row).to_vec());
    let columns = (0..z.width()).step_by(8);
    let column = |c: usize| (0..z.height()).map(|row| z.row(row)[c]).collect();
    rows.chain(columns.map(column)).collect()
}

fn mean_exponent(hurst: f64, generator: Generator) -> f64 {
    let of = |seed: u32| {
        let map = small(hurst, generator, seed).surface(1.0).unwrap();
        let lines = lines(&map);
        let lines: Vec<&[f64]> = lines.iter().map(Vec::as_slice).collect();
        Hurst::of_lines_whole(&lines).unwrap()
    };
    (0..20).map(of).sum::<f64>() / 20.0
}

#[test]
fn the_exact_generator_gives_h_back_within_0_05_over_20_seeds() {
    for hurst in [0.1, 0.5, 0.9] {
        let found = mean_exponent(hurst, Generator::Exact);
        println!("H {hurst}: {found:.4}");
        assert!((found - hurst).abs() < 0.05, "H {hurst}: {found}");
    }
}

#[test]
fn the_periodic_generator_is_close_at_high_h_and_too_smooth_at_low_h() {
    let [low, high] = [0.2, 0.8].map(|hurst| mean_exponent(hurst, Generator::Periodic));
    println!("periodic: {low:.3}, {high:.3}");
    assert!((0.25..0.45).contains(&low), "{low}");
    assert!((high - 0.8).abs() < 0.06, "{high}");
}

#[test]
fn rise_and_smd_are_what_was_asked_for() {
    for generator in [Generator::Exact, Generator::Periodic] {
        for tip in [Tip::Point, Tip::Wire] {
            let recipe = Brownian {
                tip,
                ..small(0.4, generator, 3)
            };
            let drawn = recipe.sample().unwrap();
            let smd = |heights: &Vec<f64>| {
                let mean = heights.iter().sum::<f64>() / heights.len() as f64;
                heights.iter().map(|h| (h - mean).abs()).sum::<f64>() / heights.len() as f64
            };
            let mean = drawn.strokes_um.iter().map(smd).sum::<f64>() / 4.0;
            assert!((mean - 5.0).abs() < 0.02, "{generator:?} {tip:?}: {mean}");
        }
        let (mut squares, mut n) = (0.0, 0.0);
        for seed in 0..40 {
            let map = small(0.4, generator, seed).surface(7.0).unwrap();
            for line in lines(&map) {
                squares += selvedge_foundation::numerics::structure_function(&line, 20);
                n += 1.0;
            }
        }
        squares /= n;
        assert!(
            (squares.sqrt() - 7.0).abs() < 0.5,
            "{generator:?}: {}",
            squares.sqrt()
        );
    }
}

#[test]
fn the_same_seed_gives_the_same_surface_and_another_another() {
    let of = |seed| small(0.5, Generator::Exact, seed).sample().unwrap();
    assert_eq!(of(1), of(1));
    assert_ne!(of(1), of(2));
}

#[test]
fn extremes_stay_finite() {
    for hurst in [0.01, 0.99] {
        for generator in [Generator::Exact, Generator::Periodic] {
            let drawn = small(hurst, generator, 1).sample().unwrap();
            let all = drawn.strokes_um.iter().flatten();
            assert!(all.clone().all(|h| h.is_finite()), "{hurst} {generator:?}");
        }
    }
    let flat = Brownian {
        smd_um: Some(0.0),
        ..small(0.5, Generator::Exact, 1)
    };
    let drawn = flat.sample().unwrap();
    assert!(
        drawn.strokes_um.iter().flatten().all(|&h| h == 0.0),
        "not level"
    );
    assert!(drawn.measured.is_empty(), "the level has no exponent");
}

const RECIPE: &str = "name = \"B\"\nconstruction = \"other\"\nfibre = \"none\"\n[source]\n\
    kind = \"brownian\"\nseed = 1\nhurst = 0.5\nsmd_um = 5.0\n";

#[test]
fn what_is_no_brownian_surface_is_refused_with_its_line() {
    let read = |text: &str| Manifest::from_toml(text, Path::new("b.toml"));
    assert!(read(RECIPE).is_ok(), "the recipe itself");
    for (from, to, expected) in [
        ("hurst = 0.5", "hurst = nan", "b.toml:7: hurst is NaN"),
        ("hurst = 0.5", "hurst = 0.0", "b.toml:7: hurst is 0"),
        ("hurst = 0.5", "hurst = 1.0", "b.toml:7: hurst is 1"),
        ("smd_um = 5.0", "smd_um = -1.0", "b.toml:8: smd_um is -1"),
        ("smd_um = 5.0\n", "", "b.toml:5: the amplitude is not clear"),
        (
            "smd_um = 5.0",
            "smd_um = 5.0\nrise_um = 1.0",
            "b.toml:9: the amplitude",
        ),
        (
            "smd_um = 5.0",
            "smd_um = 5.0\nshortest_mm = 1.0",
            "b.toml:9: shortest_mm with",
        ),
        (
            "smd_um = 5.0",
            "smd_um = 5.0\nstep_mm = 0.005",
            "b.toml:9: length_mm / step_mm is 4000",
        ),
        ("seed = 1", "sead = 1", "b.toml:6: unknown field `sead`"),
        (
            "seed = 1",
            "seed = 1\ngenerator = \"periodic\"\nshortest_mm = 3.0\nlongest_mm = 2.0",
            "b.toml:8: shortest_mm is 3",
        ),
    ] {
        let error = read(&RECIPE.replace(from, to)).unwrap_err().to_string();
        assert!(error.starts_with(expected), "{error}");
        assert!(error.contains("; ") && !error.contains('\n'), "{error}");
    }
}
