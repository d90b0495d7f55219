//! Areal spectra against profiles, a direct sum, and closed forms.

use std::f64::consts::TAU;

use super::*;
use selvedge_foundation::numerics::Grid;

/// A map of `n` points, `step_mm` apart.
fn map(n: [u16; 2], step_mm: f64, mut height_um: impl FnMut(f64, f64) -> f64) -> HeightMap {
    let mut values = Vec::new();
    for row in 0..n[1] {
        for column in 0..n[0] {
            let (u_mm, w_mm) = (f64::from(column) * step_mm, f64::from(row) * step_mm);
            values.push(height_um(u_mm, w_mm));
        }
    }
    let grid = Grid::from_rows(usize::from(n[0]), values).unwrap();
    HeightMap::new(grid, [step_mm, step_mm]).unwrap()
}

fn rough(seed: u64) -> HeightMap {
    let mut random = Random::new(seed);
    map([180, 150], 0.05, |u, w| {
        4.0 * (TAU * (1.3 * u + 0.4 * w)).sin() * (1.0 + 0.5 * (0.7 * w).sin())
            + 0.3 * random.normal()
    })
}

fn of(map: &HeightMap) -> Surface {
    Surface::areal(map, 0.0).unwrap()
}

#[test]
fn a_map_that_does_not_vary_across_is_the_economical_surface() {
    let ripple = map([240, 200], 0.05, |u, _| {
        5.0 * (TAU * 1.7 * u).sin() + (2.9 * u * u).cos()
    });
    let probe = Probe::ideal();
    let [warp, _, weft, _] = ripple.strokes(&probe, [6.0, 5.0], &Random::new(1)).unwrap();
    let economical = Surface::from_profiles([warp, None, weft, None], 0.0).unwrap();
    let areal = of(&ripple);
    let (one, all) = (
        economical.spectra(Direction::WarpForward),
        areal.spectra(Direction::WarpForward),
    );
    assert_eq!(all.shape(), [8, 6], "12 × 10 mm less a window");
    assert_eq!(all.n_bins(), 43, "up to 10 cycles/mm");
    for point in 0..all.n_points() {
        let expected = one.powers_um2(point % 8);
        for (a, b) in all.powers_um2(point).iter().zip(expected) {
            assert!((a - b).abs() < 1e-10, "point {point}: {a} for {b}");
        }
        assert!(expected[43..].iter().all(|&power| power == 0.0));
    }
    let weft = areal.spectra(Direction::WeftReverse);
    assert_eq!(weft.shape(), [6, 8]);
    let total: f64 = weft.powers_um2(0).iter().sum();
    assert!(total < 1e-18, "nothing rises along w: {total}");
    assert_eq!(
        areal.taken_from(Direction::WeftReverse),
        Direction::WeftForward
    );
    assert_eq!(areal.representation(), Representation::Areal);
}

#[test]
fn spectra_vary_across_the_direction_too() {
    let areal = of(&rough(1));
    for direction in Direction::ALL {
        let spectra = areal.spectra(direction);
        let [n_along, n_across] = spectra.shape();
        for across in 1..n_across {
            assert_ne!(
                spectra.powers_um2(0),
                spectra.powers_um2(across * n_along),
                "{direction:?}"
            );
        }
    }
}

/// The wire's height over one place, and the powers there, written out anew.
fn naive(map: &HeightMap, is_weft: bool, at_mm: [f64; 2]) -> Vec<f64> {
    let step = map.step_mm()[0];
    let n = [map.heights_um().width(), map.heights_um().height()];
    let n_along = n[usize::from(is_weft)] as f64;
    let n_across = n[usize::from(!is_weft)];
    let height = |along: f64, across: usize| {
        let (a, b) = (along.clamp(0.0, n_along - 1.0), across);
        let a = (0..40_000_usize).find(|&i| i as f64 == a).unwrap();
        let (column, row) = if is_weft { (b, a) } else { (a, b) };
        map.heights_um().row(row)[column]
    };
    let middle_mm = at_mm[1] + 0.5 * WINDOW_LENGTH_MM;
    let is_under = |track: &usize| {
        let middle = (middle_mm / step).floor();
        (*track as f64 - middle).abs() <= (0.5 / step).floor()
    };
    let under: Vec<usize> = (0..n_across).filter(is_under).collect();
    let lift = |i: f64| {
        let rest = |track: usize| {
            let mut best = f64::NEG_INFINITY;
            for k in -5_i8..=5 {
                let s = f64::from(k) * step;
                let drop = 1000.0 * (0.25 - (0.0625 - s * s).max(0.0).sqrt());
                best = best.max(height(i + f64::from(k), track) - drop);
            }
            best
        };
        under.iter().map(|&track| rest(track)).sum::<f64>() / under.len() as f64
    };
    let n_window = 87;
    let start = (at_mm[0] / step + 0.5).floor();
    let z: Vec<f64> = (0..n_window).map(|i| lift(start + f64::from(i))).collect();
    let w = |i: usize| 0.54 - 0.46 * (TAU * i as f64 * step / WINDOW_LENGTH_MM).cos();
    let sum_w: f64 = (0..z.len()).map(w).sum();
    let mean = z.iter().enumerate().map(|(i, z)| w(i) * z).sum::<f64>() / sum_w;
    let squares: f64 = (0..z.len()).map(|i| w(i) * w(i)).sum();
    let power = |k: u16| {
        let (mut re, mut im) = (0.0, 0.0);
        for (i, z) in z.iter().enumerate() {
            let (sin, cos) = (TAU * 0.23 * f64::from(k) * i as f64 * step).sin_cos();
            re += w(i) * (z - mean) * cos;
            im -= w(i) * (z - mean) * sin;
        }
        2.0 * (re * re + im * im) / (z.len() as f64 * squares)
    };
    (1..=43).map(power).collect()
}

#[test]
fn the_spectra_are_the_direct_sums_over_the_profile_through_the_point() {
    let map = rough(2);
    let areal = of(&map);
    for (direction, is_weft) in [
        (Direction::WarpForward, false),
        (Direction::WeftForward, true),
    ] {
        let spectra = areal.spectra(direction);
        let [n_along, n_across] = spectra.shape();
        for (i, j) in [(0, 0), (2, 1), (n_along - 1, 0), (1, n_across - 1)] {
            let expected = naive(&map, is_weft, [i as f64, j as f64]);
            let found = spectra.powers_um2(j * n_along + i);
            assert_eq!(found.len(), expected.len());
            for (a, b) in found.iter().zip(&expected) {
                assert!((a - b).abs() < 1e-9, "{direction:?} {i} {j}: {a} for {b}");
            }
        }
    }
}

#[test]
fn what_repeats_is_continued_and_what_does_not_is_refused_when_narrow() {
    let wave = |u: f64, w: f64| 3.0 * (TAU * u / 1.5).sin() + 2.0 * (TAU * w / 2.0).cos();
    let narrow = map([30, 40], 0.05, wave);
    let (direction, error) = Surface::areal(&narrow, 0.0).unwrap_err();
    assert_eq!(direction, Direction::WarpForward);
    assert!(
        error.to_string().starts_with("30 samples where one window"),
        "{error}"
    );
    let wide = map([240, 40], 0.05, wave);
    assert_eq!(
        Surface::areal(&wide, 0.0).unwrap_err().0,
        Direction::WeftForward
    );

    // 1.5 mm fits into 3 points, 2 mm into 2: the same as of a larger piece.
    let areal = of(&narrow.periodic());
    assert_eq!(areal.spectra(Direction::WarpForward).shape(), [3, 2]);
    assert_eq!(areal.spectra(Direction::WeftForward).shape(), [2, 3]);
    let large = of(&map([240, 240], 0.05, wave).periodic());
    for direction in Direction::ALL {
        let [small, large] = [&areal, &large].map(|surface| surface.spectra(direction));
        let [n_along, n_across] = large.shape();
        for (i, j) in [(0, 0), (4, 1), (n_along - 1, n_across - 1)] {
            let [wrap_along, wrap_across] = small.shape();
            let point = (j % wrap_across) * wrap_along + i % wrap_along;
            let pairs = small.powers_um2(point).iter();
            for (a, b) in pairs.zip(large.powers_um2(j * n_along + i)) {
                assert!((a - b).abs() < 1e-9, "{direction:?} {i} {j}: {a} for {b}");
            }
        }
    }
}

#[test]
fn the_points_of_what_repeats_meet_its_end() {
    for (n_samples, step_mm, n_points) in [
        (20, 0.05, 1),
        (26, 0.05, 13),
        (4600, 1.0 / 230.0, 20),
        (510, 0.04, 41),
        (200, 0.5, 100),
        (1, 0.01, 1),
    ] {
        let starts = starts_in_repeats(n_samples, step_mm);
        assert_eq!(starts.len(), n_points, "{n_samples} × {step_mm} mm");
        assert!(starts.iter().all(|&start| start < n_samples));
    }
}

#[test]
fn a_coarse_map_keeps_few_bins_and_a_fine_one_all() {
    assert_eq!(n_bins_below_nyquist(0.5), 4);
    assert_eq!(n_bins_below_nyquist(1.0 / 230.0), 500);
    assert_eq!(n_bins_below_nyquist(0.000_5), 500);
    let fine = map([1100, 2], 1.0 / 230.0, |u, _| (TAU * 115.0 * u).cos());
    let fine = of(&fine.periodic());
    assert_eq!(fine.spectra(Direction::WarpForward).n_bins(), 500);
}

#[test]
fn missing_heights_are_filled_and_a_noise_floor_is_taken_off() {
    let mut random = Random::new(3);
    let whole = |u: f64, w: f64| (TAU * u).sin() + 0.3 * w;
    let holes = map([120, 100], 0.05, |u, w| {
        if random.uniform() < 0.1 {
            f64::NAN
        } else {
            whole(u, w)
        }
    });
    let areal = of(&holes);
    let powers = areal.spectra(Direction::WarpForward).powers_um2(0).to_vec();
    assert!(powers.iter().all(|power| power.is_finite()));
    assert!(
        (powers.iter().sum::<f64>() / 0.5 - 1.0).abs() < 0.2,
        "{powers:?}"
    );
    let quiet = Surface::areal(&holes, 0.01).unwrap();
    let quiet = quiet.spectra(Direction::WarpForward).powers_um2(0);
    for (after, before) in quiet.iter().zip(&powers) {
        assert_eq!(*after, (before - 0.23 * 0.01).max(0.0));
    }
}
