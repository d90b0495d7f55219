//! Networks that learn friction from pictures, and how they learn: the one home of the library of
//! networks.
//!
//! ```text
//! examples ─▶ learn ─┬─▶ registered (ours) ─┐
//!                    ├─▶ frictgan           ├─▶ predictions
//!                    └─▶ critic ────────────┘
//! ```
//!
//! Everything runs on one thread and draws from generators of its own: a lesson gives the same
//! bytes whatever else runs beside it.

mod critic;
mod frictgan;
mod learn;
mod registered;
mod weights;

pub use critic::AdversarialLoss;
pub(crate) use learn::{Learning, Losses, OurNetwork};
pub use learn::{Lesson, Method};
pub use registered::Size;
pub(crate) use weights::Weights;

#[cfg(test)]
mod tests;
