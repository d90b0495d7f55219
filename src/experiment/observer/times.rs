//! How long answers take: log-normal times about a median of each task. All assumed, but that a
//! ranking takes 30 to 90 s.

use super::answer::Participant;
use crate::trial::Task;
use selvedge_foundation::numerics::Random;

/// Median time of a task, s; intervals come on top.
fn median_s(task: &Task) -> f64 {
    match task {
        Task::Rank { .. } => 50.0,
        Task::OddOne { .. } | Task::Rate { .. } => 20.0,
        Task::Adjust { .. } => 30.0,
        Task::Judge { .. } => 8.0,
        Task::JudgePair { .. } => 12.0,
        Task::Interval { .. } => 1.0,
        Task::Estimate { .. } => 5.0,
    }
}

/// How long a subject takes for a trial, s. A subject that is quick is quick in all.
pub(super) fn response_s(participant: &Participant<'_>, task: &Task, random: &Random) -> f64 {
    let spread = participant.observer.habits.time_spread;
    let own = participant.person.branch("quickness").normal();
    let now = random.branch("time").normal();
    // As much between subjects as within one.
    let share = std::f64::consts::FRAC_1_SQRT_2 * (own + now);
    let shown_s = participant.levels().map_or(0.0, |levels| {
        f64::from(levels.interval_ms) * levels.intervals as f64 / 1000.0
    });
    shown_s + median_s(task) * (spread * share).exp()
}
