//! The matrix exponential: balanced, scaled, the [13/13] Padé approximant, squared back.
//!
//! Higham, "The scaling and squaring method for the matrix exponential revisited", SIAM J. Matrix
//! Anal. Appl. 26 (2005). Balancing by powers of two (Osborne 1960) comes first: states in metres
//! and metres a second differ by many powers of ten, and every squaring that is spared is rounding
//! that is spared.

use super::matrix::{Matrix, combination, identity, norm, product, scaled, solve};

/// Coefficients of the numerator; the denominator has the same with alternating signs.
const PADE: [f64; 14] = [
    64_764_752_532_480_000.0,
    32_382_376_266_240_000.0,
    7_771_770_303_897_600.0,
    1_187_353_796_428_800.0,
    129_060_195_264_000.0,
    10_559_470_521_600.0,
    670_442_572_800.0,
    33_522_128_640.0,
    1_323_241_920.0,
    40_840_800.0,
    960_960.0,
    16_380.0,
    182.0,
    1.0,
];
/// The largest norm for which the approximant is exact to double precision.
const LARGEST_NORM: f64 = 5.371_920_351_148_152;
/// More squarings than this mean a matrix that no step of this program has.
const MAX_SQUARINGS: i32 = 200;
/// Sweeps of balancing; a few suffice.
const MAX_SWEEPS: usize = 20;

/// `e^matrix`; `None` when a number is not finite, in the matrix or in the result.
pub(crate) fn exponential<const N: usize>(matrix: &Matrix<N, N>) -> Option<Matrix<N, N>> {
    if !norm(matrix).is_finite() {
        return None;
    }
    let (balanced, scales) = balance(*matrix);
    let n_squarings = (norm(&balanced) / LARGEST_NORM).log2().ceil().max(0.0);
    #[expect(clippy::cast_possible_truncation, reason = "at most 1075, whole")]
    let n_squarings = n_squarings as i32;
    if n_squarings > MAX_SQUARINGS {
        return None;
    }
    let mut result = pade(&scaled(0.5_f64.powi(n_squarings), &balanced))?;
    for _ in 0..n_squarings {
        result = product(&result, &result);
    }
    for (row, scale) in result.iter_mut().zip(scales) {
        for (value, other) in row.iter_mut().zip(scales) {
            *value *= scale / other;
        }
    }
    norm(&result).is_finite().then_some(result)
}

/// The approximant `(V − U)⁻¹ (V + U)`, U the odd part and V the even.
fn pade<const N: usize>(a: &Matrix<N, N>) -> Option<Matrix<N, N>> {
    let one = identity();
    let two = product(a, a);
    let four = product(&two, &two);
    let six = product(&four, &two);
    let half = |from: usize| {
        let high = [
            (PADE[12 + from], &six),
            (PADE[10 + from], &four),
            (PADE[8 + from], &two),
        ];
        let high = product(&six, &combination(high));
        combination([
            (1.0, &high),
            (PADE[6 + from], &six),
            (PADE[4 + from], &four),
            (PADE[2 + from], &two),
            (PADE[from], &one),
        ])
    };
    let (odd, even) = (product(a, &half(1)), half(0));
    let below = combination([(1.0, &even), (-1.0, &odd)]);
    let above = combination([(1.0, &even), (1.0, &odd)]);
    solve(below, above)
}

/// The matrix with rows and columns of like size, and the scales D with `A = D · balanced · D⁻¹`.
fn balance<const N: usize>(mut a: Matrix<N, N>) -> (Matrix<N, N>, [f64; N]) {
    let mut scales = [1.0; N];
    for _ in 0..MAX_SWEEPS {
        let mut is_done = true;
        for i in 0..N {
            let others = || (0..N).filter(|j| *j != i);
            let column: f64 = others().map(|j| a[j][i].abs()).sum();
            let row: f64 = others().map(|j| a[i][j].abs()).sum();
            let Some(factor) = factor(column, row, norm(&a)) else {
                continue;
            };
            is_done = false;
            scales[i] *= factor;
            for row in &mut a {
                row[i] *= factor;
            }
            for value in &mut a[i] {
                *value /= factor;
            }
        }
        if is_done {
            break;
        }
    }
    (a, scales)
}

/// By which power of two a column should grow and its row shrink; `None` where that helps little.
///
/// A row of zeros (a held input) constrains nothing: its column then takes the size of the whole,
/// so that it is neither lost in rounding nor what decides the scaling.
fn factor(column: f64, row: f64, whole: f64) -> Option<f64> {
    if column <= 0.0 {
        return None;
    }
    let wanted = if row > 0.0 {
        (row / column).sqrt()
    } else {
        whole / column
    };
    let factor = wanted.log2().round().clamp(-200.0, 200.0).exp2();
    let gained = column * factor + row / factor;
    let is_better = if row > 0.0 {
        gained < 0.95 * (column + row)
    } else {
        !(0.5..=2.0).contains(&wanted)
    };
    (is_better && factor.is_finite()).then_some(factor)
}
