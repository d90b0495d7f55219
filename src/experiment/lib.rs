//! Experiments on people: schedules, procedures, logs that lose nothing, and their analysis.
//!
//! ```text
//! design, seed, subject ─▶ schedule ─▶ procedure ─▶ log ─▶ analysis
//!                                       │    ▲
//!                                     trial  answer
//!                                       ▼    │
//!                                 participant, or simulated observer
//! ```
//!
//! # Invariants
//! - a schedule is a pure function of design, seed and subject, and a procedure of these and the
//!   answers: what was not yet answered can always be found again
//! - no window here, and no clock that a caller does not hand in
#![cfg_attr(
    test,
    expect(clippy::float_cmp, reason = "tests compare exact results on purpose")
)]

pub mod analysis;
mod bids;
pub mod by_hand;
mod course;
pub mod design;
mod error;
pub mod layout;
mod limits;
mod named;
mod noise;
pub mod observer;
mod participants;
mod plan;
mod presentation;
mod preview;
mod procedure;
mod record;
pub mod replication;
mod schedule;
pub mod session;
mod simulate;
mod stimulus_hash;
mod trial;
pub mod visits;

pub use bids::write_bids;
pub use course::{Course, Step};
pub use error::ExperimentError;
pub use noise::{Colour, MaskingNoise, NoiseSound};
pub use participants::{Participant, Participants, Particulars};
pub(crate) use plan::FrozenPlan;
pub use plan::Plan;
pub use presentation::{Presentation, PresentedTick, Proof, Standing, Validity, Watch};
pub use preview::{Balance, Power, Preview, PreviewOptions};
pub use procedure::Procedure;
pub use record::{Apparatus, Outcome, Record, Timing};
pub use schedule::ScheduleError;
pub use simulate::Simulation;
pub(crate) use simulate::simulated_subject;
pub use stimulus_hash::StimulusHashes;
pub use trial::{Adjustment, Answer, AnswerError, AnswerValue, Grade, Task, Trial};
