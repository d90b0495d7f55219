//! The stylus: what a surface does to a tip that a force-feedback device holds, stiff and stable.
//!
//! ```text
//! relief ─▶ patch (tip, law, friction) ─┬─▶ stepper (at all times) ──┬─▶ run: rows
//!                                       └─▶ controller ─▶ device ────┘
//! limits: what can be held, and why     passivity, crossover: on the way of a force
//! ```
//!
//! [`StylusRun`] simulates a device in a hand; [`HapticLoop`] drives a [`StylusDevice`], simulated
//! or real. Along z the tip is stepped by the method that is chosen; along the surface it is where
//! the path is, or a mass that a hand leads by a spring, by velocities at the step's end, which is
//! stable at any step. Both share one step: where the surface is at its start and end is known.
//!
//! For a window: [`StylusSetup::case`] with [`WallCase::standing`] and [`WallCase::advice`] before
//! a setting is applied, [`StylusSetup::stiffness_limits`] for lines in a chart,
//! [`StylusRun::step`] for rows, [`Relief::height_mm`] for a cross-section.
//!
//! Places are mm in the textile's frame, z up; forces N; within a step all is SI.

mod controller;
mod crossover;
mod device;
mod exact;
mod felt;
mod friction;
mod kernel;
mod law;
mod limits;
mod passivity;
mod patch;
mod relief;
mod rolling;
mod row;
mod run;
mod setup;
mod stepper;
mod tip;

pub use controller::{HapticLoop, LoopTick, Sampling};
pub use crossover::Crossover;
pub use device::{DeviceSpec, Hand, SimulatedDevice, StylusDevice};
pub use felt::FeltSurface;
pub use friction::Friction;
pub use law::{Compression, ContactLaw, ForceParts};
pub use limits::{Standing, StiffnessLimits, WallCase};
pub use passivity::Passivity;
pub use patch::Contact;
pub use relief::Relief;
pub use row::StylusRow;
pub use run::{StylusRun, StylusStart};
pub use setup::StylusSetup;
pub use stepper::Stepper;
pub use tip::Tip;

#[cfg(test)]
mod tests;
