//! Reliefs that are known: how near the methods come.

use super::*;
use selvedge_foundation::numerics::Random;

fn reached(truth: &Truth, from: Light, method: Method) -> f64 {
    let e = truth.picture(from.slant_deg, from.tilt_deg);
    let found = shape(&e, from, method).unwrap();
    let r = correlation(&found.height_px, &truth.height_px());
    let amplitude = |grid: &Grid<f64>| {
        let sum: f64 = grid.values().iter().map(|z| z * z).sum();
        (sum / grid.values().len() as f64).sqrt()
    };
    let gain = amplitude(&found.height_px) / amplitude(&truth.height_px());
    println!(
        "{method:?} {from:?}: r {r:.4}, gain {gain:.3}, |E − R| {:.4} → {:.4}",
        found.residuals[0],
        found.residuals[found.n_iterations()]
    );
    r
}

#[test]
fn a_weave_in_suitable_light_is_found_to_ninety_five_percent_and_better() {
    for (rise, section) in [(0.1, 0.1), (0.15, 0.12)] {
        let weave = Truth::plain_weave(64, rise, section);
        for from in [light(45.0, 30.0), light(45.0, 60.0), light(55.0, 45.0)] {
            let linear = reached(&weave, from, Method::Linear);
            let better = reached(&weave, from, Method::Variational);
            let sketch = reached(&weave, from, Method::TsaiShah);
            assert!(better >= 0.95, "{from:?}: {better}");
            assert!(linear > 0.9 && better > linear - 0.01, "{from:?}: {linear}");
            assert!(sketch > 0.03 && sketch < linear, "{from:?}: {sketch}");
        }
    }
}

#[test]
fn a_fit_ends_when_more_would_not_help() {
    let weave = Truth::plain_weave(96, 0.1, 0.1);
    let found = shape(
        &weave.picture(45.0, 30.0),
        light(45.0, 30.0),
        Method::Variational,
    );
    let found = found.unwrap();
    // 224 rounds and 16 iterations without coarse tiles and without an end; r of 0.9990 either way.
    assert!((3..=10).contains(&found.n_iterations()), "{found:?}");
    assert!(
        found.n_rounds > 10 && found.n_rounds < 110,
        "{}",
        found.n_rounds
    );
    let r = correlation(&found.height_px, &weave.height_px());
    assert!(r > 0.995, "{r}");
}

#[test]
fn the_full_reflectance_finds_what_first_order_bends() {
    let steep = Truth::egg_crate(64, 6.0);
    let from = light(30.0, 20.0);
    let [linear, better] = [Method::Linear, Method::Variational].map(|m| reached(&steep, from, m));
    assert!(linear < 0.95 && better > 0.99, "{linear} and {better}");
}

#[test]
fn waves_across_the_light_are_told_to_be_unseen() {
    // One diagonal of an egg-crate runs across light from 45°: its picture is the other one alone.
    let crate_ = Truth::egg_crate(64, 1.0);
    let e = crate_.picture(45.0, 45.0);
    let found = shape(&e, light(45.0, 45.0), Method::Linear).unwrap();
    let r = correlation(&found.height_px, &crate_.height_px());
    assert!((r - 0.5_f64.sqrt()).abs() < 0.02, "half of the energy: {r}");
    assert!(found.blind.share_of_vectors > 0.01, "{:?}", found.blind);
    assert!(found.reliability.contains("Waves across the light"));
    // Noise lies there as everywhere else; a matt surface does not.
    assert!(found.blind.share_of_energy < 0.05, "{:?}", found.blind);
    let mut random = Random::new(1);
    let mut noise = Grid::filled(64, 64, 0.5);
    for value in noise.values_mut() {
        *value += 0.05 * random.normal();
    }
    let noisy = shape(&noise, light(45.0, 45.0), Method::Linear).unwrap();
    let [vectors, energy] = [noisy.blind.share_of_vectors, noisy.blind.share_of_energy];
    assert!(
        (energy / vectors - 1.0).abs() < 0.4,
        "{energy} of {vectors}"
    );
}

#[test]
fn noise_costs_little_and_the_albedo_does_not_matter() {
    let weave = Truth::plain_weave(64, 0.1, 0.1);
    let from = light(45.0, 30.0);
    let mut e = weave.picture(45.0, 30.0);
    let clean = shape(&e, from, Method::Variational).unwrap();
    let mut half = e.clone();
    half.values_mut().iter_mut().for_each(|value| *value *= 0.5);
    let dim = shape(&half, from, Method::Variational).unwrap();
    assert!((dim.albedo / clean.albedo - 0.5).abs() < 1e-3);
    assert!(correlation(&dim.height_px, &clean.height_px) > 0.9999);
    assert!((clean.albedo - 1.0).abs() < 0.05, "{}", clean.albedo);
    let mut random = Random::new(2);
    for value in e.values_mut() {
        *value = (*value + 0.03 * random.normal()).clamp(0.0, 1.0);
    }
    let noisy = shape(&e, from, Method::Variational).unwrap();
    let r = correlation(&noisy.height_px, &weave.height_px());
    assert!(r > 0.9, "{r}");
}

#[test]
fn an_even_surface_tells_the_axis_of_its_light_and_says_how_sure_it_is() {
    let mut random = Random::new(3);
    let waves: Vec<[f64; 4]> = (0..60)
        .map(|_| {
            let k = 2.0 + 4.0 * random.uniform();
            let way = TAU * random.uniform();
            [
                (k * way.cos()).round(),
                (k * way.sin()).round(),
                TAU * random.uniform(),
                0.3,
            ]
        })
        .collect();
    let even = Truth::of(64, |x, y| {
        let height = |[kx, ky, phase, a]: &[f64; 4]| a * (TAU * (kx * x + ky * y) + phase).cos();
        waves.iter().map(height).sum()
    });
    for tilt in [20.0, 60.0, 110.0] {
        let found = LightEstimate::of(&even.picture(50.0, tilt)).unwrap();
        let apart = (found.light.tilt_deg - tilt).rem_euclid(180.0);
        assert!(apart.min(180.0 - apart) < 15.0, "{tilt}: {found:?}");
        assert!(found.words.contains("180°"), "{found:?}");
        assert!(found.axis_coherence > 0.2, "{found:?}");
    }
}

#[test]
fn the_slant_of_a_ball_is_found() {
    // Normals as on a ball that fills the picture, as the estimator has it.
    let n = 128;
    for slant_deg in [30.0_f64, 50.0] {
        let slant = slant_deg.to_radians();
        let mut values = Vec::new();
        for row in 0..n {
            for column in 0..n {
                let at = |i: usize| (f64::from(u8::try_from(i).unwrap()) + 0.5) / 64.0 - 1.0;
                let (x, y) = (at(column), at(row));
                let z2 = 1.0 - x * x - y * y;
                if z2 > 0.0 {
                    values.push((x * slant.sin() + z2.sqrt() * slant.cos()).max(0.0));
                }
            }
        }
        let n_values = values.len();
        let e = Grid::from_rows(n_values, values).unwrap();
        let found = LightEstimate::of(&e).unwrap();
        println!("{slant_deg}: {found:?}");
        assert!(
            (found.light.slant_deg - slant_deg).abs() < 15.0,
            "{found:?}"
        );
    }
}
