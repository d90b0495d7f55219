//! Steps of small linear systems `x' = A x + B u` whose input is held during a step.
//!
//! Any one-step method is then a pair of matrices, `x⁺ = P x + Q u`: a [`Propagator`]. What tells
//! methods apart is how near P comes to `e^{Ah}`:
//!
//! | method | P | order | stable |
//! |---|---|---|---|
//! | exact hold | `e^{Ah}` | all | wherever the system is |
//! | Runge–Kutta 4 | `Σ_{k≤4} (Ah)ᵏ/k!` | 4 | while all R(hλ) ≤ 1 in magnitude: about hλ ≤ 2.8 |
//! | trapezoid | `(I − Ah/2)⁻¹ (I + Ah/2)` | 2 | always; stiff modes keep ringing |
//! | backward Euler | `(I − Ah)⁻¹` | 1 | always; damps what it should not |
//!
//! Sizes are fixed and on the stack: nothing here allocates. It knows nothing of what the states
//! mean.

mod exponential;
mod matrix;
mod propagator;
mod response;

pub(crate) use exponential::exponential;
pub use propagator::{LinearSystem, Propagator, StepMethod};

#[cfg(test)]
mod tests;
