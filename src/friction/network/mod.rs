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

mod checkpoint;
mod critic;
mod frictgan;
mod gan;
mod learn;
mod lesson;
mod ours;
mod registered;
mod weights;

pub use critic::AdversarialLoss;
pub(crate) use learn::{Learning, Losses};
pub use lesson::{Lesson, Method};
pub(crate) use ours::OurNetwork;
pub(crate) use registered::Size;
pub(crate) use weights::Weights;

#[cfg(test)]
mod tests;
