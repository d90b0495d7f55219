//! How fast each subject moved, from the recorded exploration of the trials that count, and what
//! textiles are at those speeds.
//!
//! A trial is stepped through as it was rendered, forty times a second. A tick counts when the
//! display moved faster than [`MOVING_MM_PER_S`]; ticks of all trials of a subject weigh alike, so
//! that trials weigh by how long they were moved in. What is felt at a subject's speeds is the mean
//! over those ticks, speeds taken to the nearest of a row whose steps are a tenth.

use std::collections::{BTreeMap, BTreeSet};

use super::included_trials::{Experiment, Subject};
use crate::session::path_file;
use selvedge_foundation::numerics::{in_pieces, n_threads, quantile, to_whole};
use selvedge_foundation::progress::{Cancelled, Progress};
use selvedge_render::scene::{ExplorationPath, TICKS_PER_S};
use selvedge_textile::Textile;
use selvedge_textile::tactile::{Filters, LEVEL_SPEED_MM_PER_S, Levels};

/// Slower than this a display rests, mm/s: nothing is felt, and a hand that rests trembles.
pub(super) const MOVING_MM_PER_S: f64 = 5.0;
/// Faster than this nobody strokes; it counts as this, mm/s.
const FASTEST_MM_PER_S: f64 = 1000.0;
/// From one speed at which levels are taken to the next.
const STEP: f64 = 1.1;

/// How one subject moved.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct OwnSpeeds {
    /// Trials with a recorded path.
    pub(super) n_paths: usize,
    /// Time of movement in them, s.
    pub(super) moving_s: f64,
    /// Speeds that were not reached in a tenth, a half and nine tenths of that time, mm/s.
    pub(super) tenths_mm_per_s: [f64; 3],
    /// Ticks by the step of their speed.
    ticks: BTreeMap<i32, usize>,
}

impl OwnSpeeds {
    /// Of a subject's trials that count; `None` where no path of theirs moves.
    pub(super) fn of(subject: &Subject<'_>) -> Option<Self> {
        let mut speeds: Vec<f64> = Vec::new();
        let mut n_paths = 0;
        for session in &subject.sessions {
            for record in &session.trials {
                let file = path_file(&session.found.log, &record.trial, record.attempt);
                let Ok(path) = ExplorationPath::read(&file) else {
                    continue;
                };
                n_paths += 1;
                let speed = path.ticks().map(|(_, pose)| {
                    let velocity = pose.velocity;
                    velocity.x_mm_per_s.hypot(velocity.y_mm_per_s)
                });
                speeds.extend(speed.filter(|speed| *speed > MOVING_MM_PER_S));
            }
        }
        if speeds.is_empty() {
            return None;
        }
        let mut ticks = BTreeMap::new();
        for speed in &speeds {
            *ticks.entry(step_of(*speed)).or_insert(0) += 1;
        }
        Some(Self {
            n_paths,
            moving_s: speeds.len() as f64 / TICKS_PER_S,
            tenths_mm_per_s: [0.1, 0.5, 0.9].map(|share| quantile(&mut speeds, share)),
            ticks,
        })
    }
}

/// The nearest step of speed, 0 at the speed of reference.
fn step_of(speed_mm_per_s: f64) -> i32 {
    let speed = speed_mm_per_s.clamp(MOVING_MM_PER_S, FASTEST_MM_PER_S);
    to_whole(((speed / LEVEL_SPEED_MM_PER_S).ln() / STEP.ln()).round())
}

/// The speed of a step, mm/s.
fn speed_of(step: i32) -> f64 {
    LEVEL_SPEED_MM_PER_S * STEP.powi(step)
}

/// Speeds of every subject, in the order of the experiment.
///
/// # Errors
/// It was cancelled.
pub(super) fn speeds(
    experiment: &Experiment<'_>,
    progress: &mut Progress<'_>,
) -> Result<Vec<Option<OwnSpeeds>>, Cancelled> {
    let n = experiment.subjects.len() as f64;
    let mut all = Vec::new();
    for (nth, subject) in experiment.subjects.iter().enumerate() {
        progress.step(nth as f64 / n, "recorded paths")?;
        all.push(OwnSpeeds::of(subject));
    }
    Ok(all)
}

/// Levels of every textile at the speeds of each subject.
///
/// # Errors
/// It was cancelled.
pub(super) fn levels(
    all: &[Option<OwnSpeeds>],
    textiles: &[impl AsRef<Textile> + Sync],
    progress: &mut Progress<'_>,
) -> Result<Vec<Option<Vec<Levels>>>, Cancelled> {
    let steps: BTreeSet<i32> = all
        .iter()
        .flatten()
        .flat_map(|own| own.ticks.keys().copied())
        .collect();
    let mut at_steps: Vec<(i32, Vec<Levels>)> =
        steps.into_iter().map(|step| (step, Vec::new())).collect();
    progress.step(0.6, "levels at own speeds")?;
    let filters = Filters::default();
    in_pieces(
        &mut at_steps,
        1,
        n_threads(),
        || (),
        |(), _, piece| {
            for (step, levels) in piece {
                let of = |t: &_| {
                    Levels::at(
                        speed_of(*step),
                        AsRef::<Textile>::as_ref(t).surface(),
                        &filters,
                    )
                };
                levels.extend(textiles.iter().map(of));
            }
        },
    );
    progress.step(0.9, "levels at own speeds")?;
    let at: BTreeMap<i32, Vec<Levels>> = at_steps.into_iter().collect();
    let own = |own: &OwnSpeeds| {
        (0..textiles.len())
            .map(|textile| mean(&own.ticks, &at, textile))
            .collect()
    };
    Ok(all
        .iter()
        .map(|subject| subject.as_ref().map(own))
        .collect())
}

/// The mean over ticks.
fn mean(ticks: &BTreeMap<i32, usize>, at: &BTreeMap<i32, Vec<Levels>>, textile: usize) -> Levels {
    let mut mean = Levels {
        mean_um: [0.0; 2],
        cv: [0.0; 2],
        anisotropy_db: [0.0; 2],
        direction_mean_um: [[0.0; 2]; 4],
    };
    let n_ticks: usize = ticks.values().sum();
    for (step, n) in ticks {
        let Some(levels) = at.get(step).and_then(|levels| levels.get(textile)) else {
            continue;
        };
        let weight = *n as f64 / n_ticks as f64;
        let add = |to: &mut [f64; 2], from: &[f64; 2]| {
            for (to, from) in to.iter_mut().zip(from) {
                *to += weight * from;
            }
        };
        add(&mut mean.mean_um, &levels.mean_um);
        add(&mut mean.cv, &levels.cv);
        add(&mut mean.anisotropy_db, &levels.anisotropy_db);
        for (to, from) in mean
            .direction_mean_um
            .iter_mut()
            .zip(&levels.direction_mean_um)
        {
            add(to, from);
        }
    }
    mean
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_lie_within_a_twentieth_of_their_speeds() {
        for speed in [5.0, 33.3, 100.0, 149.0, 1000.0] {
            let ratio = speed_of(step_of(speed)) / speed;
            assert!((0.95..1.05).contains(&ratio), "{speed}: {ratio}");
        }
        assert_eq!(step_of(LEVEL_SPEED_MM_PER_S), 0);
        assert_eq!(step_of(1e6), step_of(FASTEST_MM_PER_S), "nobody is faster");
    }
}
