//! A linear system, and one step of it by different methods.

use std::array::from_fn;

use super::exponential;
use super::matrix::{Matrix, combination, identity, norm, product, scaled, solve};
use crate::named;

/// Squarings after which the growth of a matrix's powers is known to all digits.
const SQUARINGS: i32 = 40;

/// `x' = A x + B u` with `N` states and `M` inputs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LinearSystem<const N: usize, const M: usize> {
    /// `A`, 1/s between states.
    pub a: Matrix<N, N>,
    /// `B`, what inputs add to the rates of states.
    pub b: Matrix<N, M>,
}

named! {
    /// A way to take a step. Orders and stability stand at the top of the module.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
    pub enum StepMethod {
        /// The solution itself, by the matrix exponential.
        ExactHold = "exact hold",
        /// The classical method of four stages.
        RungeKutta4 = "Runge–Kutta 4",
        /// The trapezoidal rule (Crank–Nicolson, Tustin).
        Trapezoid = "trapezoid",
        /// The implicit Euler rule.
        BackwardEuler = "backward Euler",
    }
    /// Its name, for people.
    pub fn name;
}

/// One step: `x⁺ = P x + Q u`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Propagator<const N: usize, const M: usize> {
    /// `P`.
    pub state: Matrix<N, N>,
    /// `Q`.
    pub input: Matrix<N, M>,
}

impl<const N: usize, const M: usize> LinearSystem<N, M> {
    /// The rates of the states.
    pub fn rates(&self, x: &[f64; N], u: &[f64; M]) -> [f64; N] {
        apply(&self.a, x, &self.b, u)
    }

    /// A step of `step_s` seconds by `method`, with the input held. `K` is `N + M`.
    ///
    /// `None` when a number is not finite or an implicit step has no solution.
    pub fn propagator<const K: usize>(
        &self,
        method: StepMethod,
        step_s: f64,
    ) -> Option<Propagator<N, M>> {
        let a = scaled(step_s, &self.a);
        let b = scaled(step_s, &self.b);
        let one = identity();
        let step = match method {
            StepMethod::ExactHold => return self.exact_hold::<K>(step_s),
            StepMethod::RungeKutta4 => {
                let (a2, a3) = (product(&a, &a), product(&a, &product(&a, &a)));
                let mean =
                    combination([(1.0, &one), (0.5, &a), (1.0 / 6.0, &a2), (1.0 / 24.0, &a3)]);
                Propagator {
                    state: combination([(1.0, &one), (1.0, &product(&a, &mean))]),
                    input: product(&mean, &b),
                }
            }
            StepMethod::Trapezoid => {
                let below = combination([(1.0, &one), (-0.5, &a)]);
                Propagator {
                    state: solve(below, combination([(1.0, &one), (0.5, &a)]))?,
                    input: solve(below, b)?,
                }
            }
            StepMethod::BackwardEuler => {
                let below = combination([(1.0, &one), (-1.0, &a)]);
                Propagator {
                    state: solve(below, one)?,
                    input: solve(below, b)?,
                }
            }
        };
        step.is_finite().then_some(step)
    }

    /// The exact step: `e^{[[A, B], [0, 0]] h}` holds P and Q in its upper rows.
    fn exact_hold<const K: usize>(&self, step_s: f64) -> Option<Propagator<N, M>> {
        const { assert!(K == N + M, "the augmented system has N + M states") };
        let augmented: Matrix<K, K> = from_fn(|row| {
            from_fn(|column| match (row < N, column < N) {
                (true, true) => step_s * self.a[row][column],
                (true, false) => step_s * self.b[row][column - N],
                (false, _) => 0.0,
            })
        });
        let grown = exponential(&augmented)?;
        Some(Propagator {
            state: from_fn(|row| from_fn(|column| grown[row][column])),
            input: from_fn(|row| from_fn(|column| grown[row][N + column])),
        })
    }

    /// One classical Runge–Kutta step, stage by stage: what works for any right-hand side.
    pub fn runge_kutta_4(&self, x: &[f64; N], u: &[f64; M], step_s: f64) -> [f64; N] {
        let along = |by_s: f64, rates: &[f64; N]| from_fn(|i| x[i] + by_s * rates[i]);
        let first = self.rates(x, u);
        let second = self.rates(&along(0.5 * step_s, &first), u);
        let third = self.rates(&along(0.5 * step_s, &second), u);
        let fourth = self.rates(&along(step_s, &third), u);
        from_fn(|i| x[i] + step_s / 6.0 * (first[i] + 2.0 * (second[i] + third[i]) + fourth[i]))
    }
}

impl<const N: usize, const M: usize> Propagator<N, M> {
    /// The states one step later.
    pub fn step(&self, x: &[f64; N], u: &[f64; M]) -> [f64; N] {
        apply(&self.state, x, &self.input, u)
    }

    /// `count` steps with the same input as one; no steps change nothing.
    #[must_use]
    pub fn repeated(&self, mut count: u32) -> Self {
        let mut result = Self {
            state: identity(),
            input: [[0.0; M]; N],
        };
        let mut power = *self;
        while count > 0 {
            if count % 2 == 1 {
                result = result.then(&power);
            }
            power = power.then(&power);
            count /= 2;
        }
        result
    }

    /// This step and then another, the input held over both.
    #[must_use]
    pub fn then(&self, next: &Self) -> Self {
        let carried = product(&next.state, &self.input);
        Self {
            state: product(&next.state, &self.state),
            input: combination([(1.0, &carried), (1.0, &next.input)]),
        }
    }

    /// The factor by which what is left to itself grows a step in the long run: the largest |λ| of
    /// P, from its powers (Gelfand). Above 1 the method is unstable.
    pub fn growth(&self) -> f64 {
        let (mut power, mut log_size) = (self.state, 0.0);
        for squaring in 0..=SQUARINGS {
            let size = norm(&power);
            if !(size > 0.0 && size.is_finite()) {
                return if size > 0.0 { f64::INFINITY } else { 0.0 };
            }
            log_size += size.ln() * 0.5_f64.powi(squaring);
            let even = scaled(1.0 / size, &power);
            power = product(&even, &even);
        }
        log_size.exp()
    }

    /// Whether every number is finite.
    pub fn is_finite(&self) -> bool {
        norm(&self.state).is_finite() && norm(&self.input).is_finite()
    }
}

/// `P x + Q u`.
fn apply<const N: usize, const M: usize>(
    p: &Matrix<N, N>,
    x: &[f64; N],
    q: &Matrix<N, M>,
    u: &[f64; M],
) -> [f64; N] {
    from_fn(|row| {
        let from_states: f64 = p[row].iter().zip(x).map(|(p, x)| p * x).sum();
        let from_inputs: f64 = q[row].iter().zip(u).map(|(q, u)| q * u).sum();
        from_states + from_inputs
    })
}
