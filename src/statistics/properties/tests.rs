//! Known directions, known turns, known scatter.

use super::*;

fn thrown(n: usize, seed: u64) -> Vec<Vec<f64>> {
    let mut random = Random::new(seed);
    (0..n)
        .map(|_| vec![random.normal(), random.normal()])
        .collect()
}

#[test]
fn a_property_along_a_direction_is_found_and_f_follows_from_r() {
    let points = thrown(16, 1);
    let mut random = Random::new(9);
    let rising = |p: &Vec<f64>| 3.0 + 2.0 * (0.6 * p[0] - 0.8 * p[1]);
    let exact: Vec<f64> = points.iter().map(rising).collect();
    let found = PropertyVector::of(&points, &exact).unwrap();
    assert!((found.multiple_r - 1.0).abs() < 1e-12, "{found:?}");
    assert!((found.direction[0] - 0.6).abs() < 1e-12, "{found:?}");
    let noisy: Vec<f64> = exact.iter().map(|y| y + random.normal()).collect();
    let found = PropertyVector::of(&points, &noisy).unwrap();
    let r2 = found.multiple_r.powi(2);
    let expected = r2 / (1.0 - r2) * 13.0 / 2.0;
    assert_eq!(found.df, [2, 13]);
    assert!(
        (found.f / expected - 1.0).abs() < 1e-9,
        "{found:?} {expected}"
    );
}

#[test]
fn properties_without_answer_say_why() {
    let points = thrown(5, 1);
    assert!(PropertyVector::of(&points, &[1.0; 5]).is_err(), "no spread");
    assert!(
        PropertyVector::of(&points[..3], &[1.0, 2.0, 3.0]).is_err(),
        "too few"
    );
    let line: Vec<Vec<f64>> = (0..5)
        .map(|i| vec![f64::from(i), 2.0 * f64::from(i)])
        .collect();
    let error = PropertyVector::of(&line, &[1.0, 4.0, 2.0, 5.0, 3.0]).unwrap_err();
    assert!(error.reason.contains("fill"), "{error}");
    assert!(
        BestTurn::of(&points, [&[1.0; 5], &[1.0; 5]]).is_err(),
        "no spread"
    );
    assert!(
        BestTurn::of(&points, [&[1.0, 2.0], &[2.0, 1.0]]).is_err(),
        "unequal"
    );
}

#[test]
fn a_turned_map_is_turned_back_to_its_properties() {
    let truth = thrown(12, 3);
    let first: Vec<f64> = truth.iter().map(|p| 5.0 + 40.0 * p[0]).collect();
    let second: Vec<f64> = truth.iter().map(|p| 0.1 * p[1]).collect();
    let (sin, cos) = 2.3_f64.sin_cos();
    let map: Vec<Vec<f64>> = truth
        .iter()
        .map(|p| vec![cos * p[0] + sin * p[1], sin * p[0] - cos * p[1]])
        .collect();
    let found = BestTurn::of(&map, [&first, &second]).unwrap();
    assert!(
        found.is_mirrored && found.r.iter().all(|r| *r > 1.0 - 1e-9),
        "{found:?}"
    );
    for (p, q) in found.points.iter().flatten().zip(truth.iter().flatten()) {
        assert!((p - q).abs() < 1e-4, "{p} or {q}");
    }
    let mut random = Random::new(1);
    let p = found
        .p_values(&map, [&first, &second], 99, &mut random)
        .unwrap();
    assert_eq!(p, [0.01; 3]);
}

#[test]
fn the_permutation_p_knows_that_the_turn_was_chosen() {
    let mut random = Random::new(12);
    let mut n_low = 0;
    for seed in 0..60 {
        let map = thrown(10, 1000 + seed);
        let own: Vec<f64> = (0..10).map(|_| random.normal()).collect();
        let other: Vec<f64> = (0..10).map(|_| random.normal()).collect();
        let found = BestTurn::of(&map, [&own, &other]).unwrap();
        let p = found
            .p_values(&map, [&own, &other], 39, &mut random)
            .unwrap();
        n_low += u32::from(p[0] <= 0.2);
    }
    // Expected 12 of 60, standard deviation 3.1.
    assert!((3..=21).contains(&n_low), "{n_low}");
}

#[test]
fn ellipses_hold_the_scatter_that_made_them() {
    let reference = thrown(30, 5);
    let mut random = Random::new(6);
    let maps: Vec<Vec<Vec<f64>>> = (0..400)
        .map(|_| {
            let moved = |p: &Vec<f64>| {
                let (x, y) = (p[0] + 0.10 * random.normal(), p[1] + 0.02 * random.normal());
                // Turned as a whole: Procrustes takes that out again.
                vec![2.0 * y, -2.0 * x]
            };
            reference.iter().map(moved).collect()
        })
        .collect();
    let ellipses = Ellipse::of_bootstrap(&reference, &maps, 0.95).unwrap();
    let factor = (-2.0 * 0.05_f64.ln()).sqrt();
    let mean = |of: fn(&Ellipse) -> f64| ellipses.iter().map(of).sum::<f64>() / 30.0;
    let long = mean(|e| e.half_axes[0]) / factor;
    assert!((long / 0.10 - 1.0).abs() < 0.1, "{long}");
    assert!(
        ellipses.iter().all(|e| e.angle_rad.sin().abs() < 0.3),
        "{ellipses:?}"
    );
    assert!(
        Ellipse::of_bootstrap(&reference, &maps[..2], 0.95).is_err(),
        "too few"
    );
}
