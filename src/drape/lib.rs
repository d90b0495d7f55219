//! A hanging cloth under two fingers: what it does, and what they feel.
//!
//! ```text
//! kes (figures of testers) ─▶ fabric ─┐
//! scene (file) ─▶ mesh ───────────────┼─▶ sheet (membrane, plate, slip) ─┐
//! path (hands) ─▶ finger (pad, place) ┴──────────────────────────────────┴─▶ system
//! system ─▶ newton (precondition) ─▶ cloth (steps), statics ─▶ run (local: 1 kHz between steps)
//! refit (other figures where it hangs) ─▶ run
//! ```
//!
//! Lengths are metres inside and millimetres at the border. The added mass of air, which is more
//! than silk's own, and contact of the cloth with itself are left out.
//!
//! # Invariants
//! - no window, no clock; a step neither allocates, locks nor fails but for a limit that it tells
//! - the same scene and hands give the same bytes
//! - no step gains energy that no hand gave, within what is solved for
#![cfg_attr(
    test,
    expect(
        clippy::float_cmp,
        clippy::large_types_passed_by_value,
        reason = "tests compare exact results on purpose, and hand cloths over"
    )
)]

mod cloth;
mod coupling;
mod curve;
mod error;
mod fabric;
mod felt;
mod finger;
mod hands;
mod integrator;
mod kes;
mod local;
mod membrane;
mod mesh;
mod newton;
mod pad;
mod parts;
mod place;
mod plate;
mod precondition;
mod projective;
mod refit;
mod run;
mod scene;
mod sheet;
mod slip;
mod statics;
mod stencil;
mod stepping;
mod system;
mod tester;
mod xpbd;

pub use cloth::DrapeCounters;
pub use error::DrapeError;
pub use felt::{Felt, FeltTick};
pub use hands::{Hand, HandPath};
pub use integrator::Integrator;
pub use parts::StepParts;
pub use run::{Drape, FingerRow, Pad};
pub use scene::DrapeScene;
pub use tester::{TestedFigure, test_fabric};

/// Acceleration of gravity, m/s².
pub const GRAVITY: f64 = 9.806_65;

#[cfg(test)]
mod tests;
