//! The function of one subject: what its own answers say, and what they say as one of a
//! population.

use super::evidence::{AtThreshold, Evidence};
use super::model::Expected;
use super::{Block, Psychometric};
use crate::Interval;

/// Confidence of all intervals.
pub(super) const LEVEL: f64 = 0.95;

/// A psychometric function of one subject.
#[derive(Debug, Clone, PartialEq)]
pub struct Fit {
    /// Medians of threshold and width, mean of the lapse rate; the threshold by the subject's own
    /// answers.
    pub curve: Psychometric,
    /// Where the threshold lies by the subject's own answers, wherever those of others lie.
    pub own: Interval,
    /// The threshold as one of the population's, and where it lies; of a subject alone its own.
    pub pooled: (f64, Interval),
    /// The answers, stimuli ascending.
    pub blocks: Vec<Block>,
    /// What a reader has to know: a threshold that is not bracketed.
    pub notes: Vec<String>,
}

/// A population as one draw has it: its thresholds (mean, standard deviation; any, of a subject
/// alone), widths and lapse rates.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Drawn {
    pub thresholds: Option<[f64; 2]>,
    pub expected: Expected,
}

impl Fit {
    /// Of a subject of whom nothing is known but its answers.
    pub fn alone(evidence: &Evidence) -> Self {
        let drawn = Drawn {
            thresholds: None,
            expected: evidence.model.expected(),
        };
        Self::among(evidence, &[drawn])
    }

    /// Of a subject of a population, as each of several draws has it.
    pub(super) fn among(evidence: &Evidence, draws: &[Drawn]) -> Self {
        let mut own = vec![AtThreshold::default(); super::evidence::CELLS[0]];
        let mut pooled = vec![0.0; own.len()];
        for drawn in draws {
            let sums = evidence.over_thresholds(&drawn.expected);
            let total: f64 = sums.iter().map(|at| at.likelihood).sum();
            for (all, at) in own.iter_mut().zip(&sums) {
                all.likelihood += at.likelihood / total;
                all.ln_width += at.ln_width / total;
                all.lapse += at.lapse / total;
            }
            let flat = || sums.iter().map(|at| at.likelihood).collect();
            let masses: Vec<f64> = drawn.thresholds.map_or_else(flat, |normal| {
                let both = sums.iter().zip(evidence.normal(normal));
                both.map(|(at, density)| at.likelihood * density).collect()
            });
            let total = masses.iter().sum::<f64>().max(f64::MIN_POSITIVE);
            for (all, mass) in pooled.iter_mut().zip(masses) {
                *all += mass / total;
            }
        }
        Self::of(evidence, &own, &pooled)
    }

    fn of(evidence: &Evidence, own: &[AtThreshold], pooled: &[f64]) -> Self {
        let model = evidence.model;
        let masses: Vec<f64> = own.iter().map(|at| at.likelihood).collect();
        let total: f64 = masses.iter().sum();
        let ln_width = own.iter().map(|at| at.ln_width).sum::<f64>() / total;
        let lapse = own.iter().map(|at| at.lapse).sum::<f64>() / total;
        let (place, own) = located(evidence, &masses);
        let threshold = model.family.stimulus(place);
        Self {
            curve: model.curve(threshold, ln_width.exp(), lapse),
            own,
            pooled: {
                let (place, interval) = located(evidence, pooled);
                (model.family.stimulus(place), interval)
            },
            notes: notes(evidence, threshold),
            blocks: evidence.blocks.clone(),
        }
    }
}

fn notes(evidence: &Evidence, threshold: f64) -> Vec<String> {
    let [first, last] = [evidence.blocks.first(), evidence.blocks.last()];
    let is_below = first.is_some_and(|block| threshold < block.x);
    let is_above = last.is_some_and(|block| threshold > block.x);
    let note = "the threshold lies outside the stimuli: it is not bracketed";
    (is_below || is_above)
        .then(|| note.to_owned())
        .into_iter()
        .collect()
}

/// The median on the family's scale, and the central interval in the unit of the stimulus.
fn located(evidence: &Evidence, masses: &[f64]) -> (f64, Interval) {
    let [low, middle, high] =
        [0.5 * (1.0 - LEVEL), 0.5, 0.5 * (1.0 + LEVEL)].map(|share| place(evidence, masses, share));
    let [low, high] = [low, high].map(|place| evidence.model.family.stimulus(place));
    let level = LEVEL;
    (middle, Interval { low, high, level })
}

/// The place below which this share of the masses lies, each even over its cell.
fn place(evidence: &Evidence, masses: &[f64], share: f64) -> f64 {
    let wanted = share * masses.iter().sum::<f64>();
    let mut below = 0.0;
    for (i, mass) in masses.iter().enumerate() {
        if below + mass >= wanted && *mass > 0.0 {
            return evidence.threshold(i) + evidence.step * ((wanted - below) / mass - 0.5);
        }
        below += mass;
    }
    evidence.threshold(masses.len() - 1)
}
