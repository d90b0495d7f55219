//! Numbers for strengths, and places on scales.

use super::answer::Participant;
use crate::design::{Form, Scale};
use crate::trial::Task;
use selvedge_foundation::numerics::Random;
use selvedge_statistics::Summary;
use selvedge_textile::tactile::Perception;

use super::scale::N_ACTIVE;

/// The number given to what is not felt, of what is felt at threshold.
const NOTHING: f64 = 0.1;
/// How steeply ratings rise in the middle of a scale, by standard deviation of the stimuli.
const RATING_SLOPE: f64 = 1.2;
/// Standard deviation of subjects' shifts of a scale, in standard deviations of the stimuli.
const RATING_SHIFT: f64 = 0.3;

impl Scale {
    /// So far on the way from its low to its high end, as the scale takes it.
    pub(super) fn at_share(&self, share: f64) -> f64 {
        let [low, high] = self.bounds();
        self.placed(low + share * (high - low))
    }

    /// A value as the scale takes it: within bounds, and on a point where it has points.
    pub(super) fn placed(&self, value: f64) -> f64 {
        let [low, high] = self.bounds();
        let within = value.clamp(low, high);
        if self.points > 0 {
            within.round()
        } else {
            within
        }
    }
}

impl Participant<'_> {
    /// A power of what the model of perception gives (exponents 0.95 and 0.58 after Stevens), by
    /// the subject's own exponent and modulus.
    pub(super) fn magnitude(&self, task: &Task, random: &Random) -> f64 {
        let item = task.item().unwrap_or(0);
        let habits = &self.observer.habits;
        let own = self.person.branch("exponent").normal();
        let exponent = (habits.exponent_spread * own).exp();
        let noise = habits.magnitude_noise * random.branch("percepts").normal();
        let felt = self.strength(item).powf(exponent);
        let said = match self.stated_modulus() {
            // The number was said to be that of the standard, or of the first stimulus.
            Some(_) => felt / self.strength(task.reference.unwrap_or(0)).powf(exponent),
            None => felt,
        };
        self.modulus() * said * noise.exp()
    }

    fn strength(&self, item: usize) -> f64 {
        let felt = Perception::of(self.stimuli.felt_um(item), N_ACTIVE);
        felt.intensity().max(NOTHING)
    }

    fn stated_modulus(&self) -> Option<f64> {
        match self.design.composition.response.form {
            Form::Number { modulus } => modulus,
            _ => None,
        }
    }

    /// The number of a unit of strength.
    pub(super) fn modulus(&self) -> f64 {
        let own = || {
            let spread = self.observer.habits.modulus_spread;
            (spread * self.person.branch("modulus").normal()).exp()
        };
        self.stated_modulus().unwrap_or_else(own)
    }

    /// Each scale is a monotone map of one direction through the places of the stimuli, drawn by
    /// the scale's name alone: assumed, since nothing is published that would say which.
    pub(super) fn ratings(&self, item: usize, random: &Random) -> Vec<f64> {
        let percept = self.seen(item, &mut random.branch("percepts"));
        let mut noise = random.branch("rating");
        let axes: Vec<Option<Summary>> = (0..percept.len()).map(|axis| self.spread(axis)).collect();
        let mut rate = |scale: &Scale| {
            let mut weights = Random::new(0).branch("scale").branch(&scale.key);
            let mut shift = self.person.branch("scale").branch(&scale.key);
            let (mut along, mut norm) = (0.0, 0.0_f64);
            for (x, axis) in percept.iter().zip(&axes) {
                let weight = weights.normal();
                if let Some(axis) = axis {
                    along += weight * (x - axis.mean) / axis.sd;
                    norm = norm.hypot(weight);
                }
            }
            let along = if norm > 0.0 { along / norm } else { 0.0 };
            let along = along + RATING_SHIFT * shift.normal();
            let share = 1.0 / (1.0 + (-RATING_SLOPE * along).exp());
            let share = share + self.observer.habits.rating_noise * noise.normal();
            scale.at_share(share)
        };
        self.design
            .composition
            .scales()
            .iter()
            .map(&mut rate)
            .collect()
    }

    /// How stimuli spread along a coordinate; `None` where they do not.
    fn spread(&self, axis: usize) -> Option<Summary> {
        let along: Vec<f64> = self.places.iter().map(|place| place[axis]).collect();
        Summary::of(&along).ok().filter(|summary| summary.sd > 0.0)
    }
}
