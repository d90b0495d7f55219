//! What a system or a method does to a sine in the long run, without running it.

use std::array::from_fn;

use super::matrix::{Matrix, solve};
use super::{LinearSystem, Propagator};
use crate::numerics::Complex;

impl<const N: usize, const M: usize> LinearSystem<N, M> {
    /// `(iω − A)⁻¹ B`: states over inputs for a sine of `omega_per_s` rad/s. `None` at a pole.
    pub fn response(&self, omega_per_s: f64) -> Option<[[Complex; M]; N]> {
        resolvent(Complex::new(0.0, omega_per_s), &self.a, &self.b)
    }
}

impl<const N: usize, const M: usize> Propagator<N, M> {
    /// `(e^{iθ} − P)⁻¹ Q`: states over inputs at the steps, for a sine that turns by
    /// `angle_rad` a step and is sampled and held at each. `None` at a pole.
    pub fn response(&self, angle_rad: f64) -> Option<[[Complex; M]; N]> {
        resolvent(
            Complex::from_polar(1.0, angle_rad),
            &self.state,
            &self.input,
        )
    }
}

fn resolvent<const N: usize, const M: usize>(
    z: Complex,
    a: &Matrix<N, N>,
    b: &Matrix<N, M>,
) -> Option<[[Complex; M]; N]> {
    let left = from_fn(|row| {
        from_fn(|column| {
            let value = Complex::from(-a[row][column]);
            if row == column { value + z } else { value }
        })
    });
    solve(left, b.map(|row| row.map(Complex::from)))
}
