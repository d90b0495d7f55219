//! Turning parameters until a stimulus is as asked.
//!
//! The observer turns, a stride at a time, whichever parameter brings the percept nearer to that
//! of the standard, and stops once it is satisfied or nothing helps; where a stride changes
//! nothing, as when neither end of it is felt, it turns farther. One look at the standard and one
//! at what is turned, as errors of the whole trial, are what makes it miss.

use super::answer::Participant;
use super::percept::look;
use super::scale::Jnd;
use crate::design::{Adaptation, Tunable, TunedParameter};
use crate::trial::{Adjustment, Answer, AnswerValue};
use selvedge_foundation::numerics::Random;

/// Strides that a range is crossed in, where a step is finer than that.
const MOST_STRIDES: f64 = 100.0;
/// How far is turned at once: the first that helps.
const STRIDES: [f64; 7] = [1.0, 2.0, 4.0, 8.0, 16.0, 32.0, 64.0];
/// Turns after which anybody stops.
const MOST_TURNS: usize = 1000;

impl Participant<'_> {
    pub(super) fn adjusted(
        &self,
        item: usize,
        starts: &[f64],
        response_s: f64,
        random: &Random,
    ) -> Answer {
        let mut looks = random.branch("percepts");
        let standard = look(&self.standards[item], self.explored, &mut looks);
        let standard = self.kept(&standard, &mut random.branch("memory"));
        let zeros = vec![0.0; standard.len()];
        // The same error of the turned one's percept all through the trial.
        let error = look(&zeros, self.explored, &mut looks);
        let off = |values: &[f64]| {
            let place = self.tuned_place(item, values);
            let percept: Vec<f64> = place.iter().zip(&error).map(|(x, e)| x + e).collect();
            self.apart(&percept, &standard) / self.root_n()
        };
        let mut values = starts.to_vec();
        let mut turned = Vec::new();
        let mut now = off(&values);
        while now > self.observer.habits.satisfied_jnd && turned.len() < MOST_TURNS {
            let farther = STRIDES.iter();
            let mut turns = farther.filter_map(|by| self.best_turn(&values, now, (*by, &off)));
            let Some((parameter, value, next)) = turns.next() else {
                break;
            };
            values[parameter] = value;
            turned.push((parameter, value));
            now = next;
        }
        let steps = spread_out(&turned, response_s);
        AnswerValue::Adjusted { values, steps }.into()
    }

    /// The turn by so many strides that brings the percept nearest: parameter, value, distance
    /// then.
    fn best_turn(
        &self,
        values: &[f64],
        now: f64,
        (strides, off): (f64, &impl Fn(&[f64]) -> f64),
    ) -> Option<(usize, f64, f64)> {
        let mut best = None;
        let mut nearest = now;
        for (at, parameter) in self.design.composition.parameters().iter().enumerate() {
            for way in [-1.0, 1.0] {
                let mut tried = values.to_vec();
                let to = values.get(at)? + way * strides * stride(parameter);
                *tried.get_mut(at)? = to.clamp(parameter.from, parameter.to);
                let then = off(&tried);
                if then < nearest {
                    nearest = then;
                    best = Some((at, tried[at], then));
                }
            }
        }
        best
    }

    /// Where a stimulus lies with the parameters at these values.
    fn tuned_place(&self, item: usize, values: &[f64]) -> Vec<f64> {
        let parameters = self.design.composition.parameters().iter();
        let values = parameters
            .map(|parameter| parameter.what)
            .zip(values.iter().copied());
        self.place_at(item, values)
    }

    /// Where a stimulus lies with these values of a tuning.
    fn place_at(&self, item: usize, values: impl Iterator<Item = (Tunable, f64)>) -> Vec<f64> {
        let mut tuning = self.stimuli.tuning();
        values.for_each(|(what, value)| what.set(&mut tuning, value));
        let gains_db = self.stimuli.gains_db(item, &tuning);
        let observer = self.observer;
        let levels = self.stimuli.levels(item);
        observer.strategy.place(observer.jnd, levels, gains_db)
    }

    /// How far what is adapted lies above nothing at a value, in just noticeable differences: of a
    /// vibration its level, of a turn and a length of time the number itself, else how far the
    /// stimulus moves from where the range begins. `None` is nothing.
    pub(super) fn adapted_jnd(&self, adaptation: &Adaptation, value: Option<f64>) -> f64 {
        let jnd: Jnd = self.observer.jnd;
        let habits = &self.observer.habits;
        match adaptation.parameter {
            Tunable::Level => {
                return jnd.steps(adaptation.band, value.unwrap_or(f64::NEG_INFINITY));
            }
            Tunable::Rotation => return value.unwrap_or(0.0) / habits.turn_jnd_deg,
            Tunable::Duration => {
                let tick_ms = *Tunable::Duration.bounds().start();
                let ms = value.unwrap_or(tick_ms).max(tick_ms);
                return ms.ln() / habits.duration_weber.ln_1p();
            }
            _ => {}
        }
        let place = |value: f64| self.place_at(0, [(adaptation.parameter, value)].into_iter());
        let least = adaptation.reference.unwrap_or(adaptation.range[0]);
        let value = value.unwrap_or(least);
        let away = self.apart(&place(value), &place(least)) / self.root_n();
        away.copysign(value - least)
    }

    /// Parameters left on any of their steps.
    pub(super) fn left_anywhere(&self, n: usize, random: &mut Random) -> Answer {
        let anywhere = |parameter: &TunedParameter| {
            let value = random.uniform_in(parameter.from, parameter.to);
            let steps = ((value - parameter.from) / parameter.step).round();
            (parameter.from + steps * parameter.step).min(parameter.to)
        };
        let parameters = self.design.composition.parameters().iter();
        let values = parameters.map(anywhere).take(n).collect();
        let steps = Vec::new();
        AnswerValue::Adjusted { values, steps }.into()
    }
}

/// A whole number of steps, of which a range has no more than [`MOST_STRIDES`].
fn stride(parameter: &TunedParameter) -> f64 {
    let n_steps = (parameter.to - parameter.from) / parameter.step;
    parameter.step * (n_steps / MOST_STRIDES).ceil().max(1.0)
}

/// Turns at even times, the last before the answer.
fn spread_out(turned: &[(usize, f64)], response_s: f64) -> Vec<Adjustment> {
    let between_ms = 1000.0 * response_s / (turned.len() + 1) as f64;
    let step = |(nth, &(parameter, value)): (usize, &(usize, f64))| Adjustment {
        at_ms: ((nth + 1) as f64 * between_ms).floor(),
        parameter,
        value,
    };
    turned.iter().enumerate().map(step).collect()
}
