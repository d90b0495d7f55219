//! Tsai & Shah against a plain transcript of the published scheme, and against sums by hand.

use super::super::shape::Edges;
use super::super::tsai_shah::State;
use super::*;
use selvedge_foundation::numerics::Random;

/// The scheme as published, line by line, on lists of rows; `is_tile`: differences go round.
fn transcript(e: &[Vec<f64>], ps: f64, qs: f64, n: usize, is_tile: bool) -> Vec<Vec<f64>> {
    let (height, width) = (e.len(), e[0].len());
    let mut z = vec![vec![0.0; width]; height];
    let mut s = vec![vec![0.01; width]; height];
    for _ in 0..n {
        let (z1, s1) = (z.clone(), s.clone());
        for i in 0..height {
            for j in 0..width {
                let (mut p, mut q) = (0.0, 0.0);
                if is_tile || (i > 0 && j > 0) {
                    p = z1[i][j] - z1[i][if j > 0 { j - 1 } else { width - 1 }];
                    q = z1[i][j] - z1[if i > 0 { i - 1 } else { height - 1 }][j];
                }
                let pq: f64 = 1.0 + p * p + q * q;
                let pqs: f64 = 1.0 + ps * ps + qs * qs;
                let r = f64::max(0.0, (1.0 + p * ps + q * qs) / (pq.sqrt() * pqs.sqrt()));
                let fz = -(e[i][j] - r);
                let dfz = -((ps + qs) / (pq.sqrt() * pqs.sqrt())
                    - (p + q) * (1.0 + p * ps + q * qs) / ((pq * pq * pq).sqrt() * pqs.sqrt()));
                let y = fz + dfz * z1[i][j];
                let k = s1[i][j] * dfz / (1e-8 + dfz * s1[i][j] * dfz);
                s[i][j] = (1.0 - k * dfz) * s1[i][j];
                z[i][j] = z1[i][j] + k * (y - dfz * z1[i][j]);
            }
        }
    }
    z
}

#[test]
fn the_iteration_is_the_published_one_with_both_kinds_of_edge() {
    let mut random = Random::new(5);
    let rows: Vec<Vec<f64>> = (0..7)
        .map(|_| {
            (0..9)
                .map(|_| (0.5 + 0.2 * random.normal()).clamp(0.0, 1.0))
                .collect()
        })
        .collect();
    let e = Grid::from_rows(9, rows.concat()).unwrap();
    for (ps, qs) in [(1.0, 0.0), (0.5, 0.5), (-0.3, 1.2), (0.01, 0.01)] {
        for edges in [Edges::Repeat, Edges::Published] {
            for n in [1, 2, 10, 60] {
                let mut state = State::flat(9, 7);
                for _ in 0..n {
                    state.step(&e, [ps, qs], edges);
                }
                let golden = transcript(&rows, ps, qs, n, edges == Edges::Repeat).concat();
                for (a, b) in state.depth.values().iter().zip(&golden) {
                    assert!((a - b).abs() <= 1e-9 * (1.0 + b.abs()), "{a} and {b}, {n}");
                }
            }
        }
    }
}

#[test]
fn the_first_step_of_one_pixel_is_the_sum_by_hand() {
    // Ps = 1, Qs = 0, E = 0.5, flat: f = 0.5 − 1/√2, f' = −1/√2, so Z = −f/f' = √½ − 1 but for
    // W/(S f'²) = 2e-6 of it.
    let e = Grid::filled(1, 1, 0.5);
    let mut state = State::flat(1, 1);
    let residual = state.step(&e, [1.0, 0.0], Edges::Repeat);
    assert!((residual - (0.5_f64.sqrt() - 0.5)).abs() < 1e-12);
    let by_hand = (0.5_f64.sqrt() - 1.0) * (1.0 - 2e-6);
    assert!(
        (state.depth.values()[0] - by_hand).abs() < 1e-9,
        "{state:?}"
    );
}

#[test]
fn the_light_is_where_it_is_said_to_be() {
    // A bump is bright on its side towards the light: right at 0°, top (high y) at 90°.
    let bump = Truth::of(32, |x, y| {
        4.0 * (-((x - 0.5).powi(2) + (y - 0.5).powi(2)) / 0.02).exp()
    });
    let right = bump.picture(45.0, 0.0);
    assert!(right.row(16)[21] > right.row(16)[10] + 0.1);
    let top = bump.picture(45.0, 90.0);
    assert!(top.row(21)[16] > top.row(10)[16] + 0.1);
    for tilt in [0.0, 60.0, 90.0, 200.0, -70.0] {
        let e = bump.picture(45.0, tilt);
        for method in Method::OF_SHADING {
            let found = shape(&e, light(45.0, tilt), method).unwrap();
            let r = correlation(&found.height_px, &bump.height_px());
            // The published iteration is a sketch: right way round, and little more.
            let min = if method == Method::TsaiShah {
                0.01
            } else {
                0.7
            };
            assert!(r > min, "{method:?} at {tilt}°: {r}: a bump, not a dent");
        }
    }
}

#[test]
fn the_running_average_brings_the_residual_down_and_the_shape_nearer() {
    let truth = Truth::of(48, |x, y| {
        1.5 * (TAU * 2.0 * x).sin() * (0.3 + (TAU * y).cos())
    });
    let e = truth.picture(45.0, 0.0);
    let options = |n: usize| ShadingOptions {
        iterations: Some(n),
        albedo: Some(1.0),
        ..with(Method::TsaiShah)
    };
    let of = |n: usize| {
        let run = |progress: &mut Progress<'_>| {
            Shape::from_shading(&e, light(45.0, 0.0), &options(n), progress)
        };
        Progress::unheard(run).unwrap()
    };
    let (few, many) = (of(2), of(200));
    assert_eq!((few.n_iterations(), many.n_iterations()), (2, 200));
    assert!(
        many.residuals[200] < 0.8 * many.residuals[1],
        "{:?}",
        many.residuals
    );
    let [few, many] = [few, many].map(|s| correlation(&s.height_px, &truth.height_px()));
    assert!(many > few && many > 0.4, "{few} then {many}");
}

/// An egg-crate of period 24 px on 96 × 96 px, amplitude 1 px, and its picture under (1, 0) by
/// backward differences as the scheme takes them, or by central ones.
fn crate_and_its_picture(is_backward: bool) -> [Grid<f64>; 2] {
    let n = 96_usize;
    let height = |row: usize, column: usize| {
        let turn = |i: usize| (TAU * (i % n) as f64 / 24.0).sin();
        turn(row) * turn(column)
    };
    let [mut truth, mut e] = [Grid::filled(n, n, 0.0), Grid::filled(n, n, 0.0)];
    for row in 0..n {
        for column in 0..n {
            let here = height(row, column);
            let (before_x, before_y) = (height(row, column + n - 1), height(row + n - 1, column));
            let [p, q] = if is_backward {
                [here - before_x, here - before_y]
            } else {
                let (after_x, after_y) = (height(row, column + 1), height(row + 1, column));
                [0.5 * (after_x - before_x), 0.5 * (after_y - before_y)]
            };
            truth.row_mut(row)[column] = here;
            let bright = (1.0 + p) / ((1.0 + p * p + q * q).sqrt() * 2.0_f64.sqrt());
            e.row_mut(row)[column] = bright.max(0.0);
        }
    }
    [truth, e]
}

#[test]
fn pictures_drawn_by_its_own_differences_flatter_the_iteration() {
    // The first are the figures that others reckoned; half a pixel makes the difference.
    for (is_backward, expected) in [
        (true, [0.13, 0.22, 0.34, 0.42, 0.61, 0.74]),
        (false, [0.0, 0.09, 0.21, 0.30, 0.50, 0.65]),
    ] {
        let [truth, e] = crate_and_its_picture(is_backward);
        let mut state = State::flat(96, 96);
        let mut done = 0;
        for (n, expected) in [1, 2, 5, 10, 50, 200].into_iter().zip(expected) {
            while done < n {
                state.step(&e, [1.0, 0.0], Edges::Repeat);
                done += 1;
            }
            let r = correlation(&state.depth, &truth);
            assert!((r - expected).abs() < 0.011, "{is_backward}, {n}: {r}");
        }
    }
}
