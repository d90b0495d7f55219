//! Small matrices with sizes known at compile time, row by row.

use std::array::from_fn;
use std::ops::{Div, Mul, Sub};

use crate::numerics::Complex;

/// `R` rows of `C` numbers.
pub(crate) type Matrix<const R: usize, const C: usize> = [[f64; C]; R];

/// A number that elimination works with.
pub(super) trait Number:
    Copy + Default + Sub<Output = Self> + Mul<Output = Self> + Div<Output = Self>
{
    /// How large it is, for the choice of pivots.
    fn size(self) -> f64;
}

impl Number for f64 {
    fn size(self) -> f64 {
        self.abs()
    }
}

impl Number for Complex {
    fn size(self) -> f64 {
        self.norm()
    }
}

/// The matrix that changes nothing.
pub(super) fn identity<const N: usize>() -> Matrix<N, N> {
    from_fn(|row| from_fn(|column| if row == column { 1.0 } else { 0.0 }))
}

/// `left · right`.
pub(super) fn product<const R: usize, const N: usize, const C: usize>(
    left: &Matrix<R, N>,
    right: &Matrix<N, C>,
) -> Matrix<R, C> {
    let mut result = [[0.0; C]; R];
    for (out, row) in result.iter_mut().zip(left) {
        for (factor, from) in row.iter().zip(right) {
            for (sum, value) in out.iter_mut().zip(from) {
                *sum += factor * value;
            }
        }
    }
    result
}

/// `Σ factor · matrix`.
pub(super) fn combination<const R: usize, const C: usize, const K: usize>(
    terms: [(f64, &Matrix<R, C>); K],
) -> Matrix<R, C> {
    from_fn(|row| {
        from_fn(|column| {
            let of = |(factor, matrix): &(f64, &Matrix<R, C>)| factor * matrix[row][column];
            terms.iter().map(of).sum()
        })
    })
}

/// `factor · matrix`.
pub(super) fn scaled<const R: usize, const C: usize>(
    factor: f64,
    matrix: &Matrix<R, C>,
) -> Matrix<R, C> {
    combination([(factor, matrix)])
}

/// The largest sum of absolute values in a column.
pub(super) fn norm<const R: usize, const C: usize>(matrix: &Matrix<R, C>) -> f64 {
    let of_column = |column: usize| matrix.iter().map(|row| row[column].abs()).sum();
    // NaN must not get lost in a maximum.
    (0..C).map(of_column).fold(
        0.0,
        |largest: f64, sum: f64| {
            if sum <= largest { largest } else { sum }
        },
    )
}

/// Solves `left · X = right` by elimination with row pivots; `None` where `left` is singular or not
/// finite.
pub(super) fn solve<T: Number, const N: usize, const C: usize>(
    mut left: [[T; N]; N],
    mut right: [[T; C]; N],
) -> Option<[[T; C]; N]> {
    for column in 0..N {
        let by_size = |a: &usize, b: &usize| {
            let size = |row: usize| left[row][column].size();
            size(*a).total_cmp(&size(*b))
        };
        let pivot = (column..N).max_by(by_size)?;
        let size = left[pivot][column].size();
        if !(size > 0.0 && size.is_finite()) {
            return None;
        }
        left.swap(column, pivot);
        right.swap(column, pivot);
        let (row_left, row_right) = (left[column], right[column]);
        for row in (0..N).filter(|row| *row != column) {
            let factor = left[row][column] / row_left[column];
            for (value, from) in left[row].iter_mut().zip(row_left).skip(column) {
                *value = *value - factor * from;
            }
            for (value, from) in right[row].iter_mut().zip(row_right) {
                *value = *value - factor * from;
            }
        }
    }
    Some(from_fn(|row| {
        right[row].map(|value| value / left[row][row])
    }))
}
