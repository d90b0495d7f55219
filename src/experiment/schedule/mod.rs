//! Which stimuli are shown in which trial: pure functions of a seed and a subject.
//!
//! Each purpose (relabelling, blocks, order, positions) draws from a branch of its own, so that a
//! change in one shifts none of the others.

mod blocks;
mod plane;
mod ranking;
mod rounds;
mod triads;

pub use plane::Lines;
pub use ranking::ScheduleError;
pub(crate) use ranking::{RankingSchedule, is_ranked};
pub use rounds::rounds;
pub use triads::Triad;
pub use triads::triads;

use selvedge_foundation::numerics::Random;

/// The generator of one subject in one experiment of a study.
pub(crate) fn subject_random(study_seed: u64, experiment: &str, subject: &str) -> Random {
    Random::new(study_seed).branch(experiment).branch(subject)
}
