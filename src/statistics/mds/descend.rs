//! Ways downhill: majorisation, which is sure and slow in the end, and quasi-Newton steps (L-BFGS),
//! which finish.

use super::fit::{Fit, Loss};
use crate::summary::dot;

/// Steps that L-BFGS remembers.
const MEMORY: usize = 8;
/// Halvings before a step is given up.
const MOST_HALVINGS: usize = 20;
/// A squared loss below this is nothing but rounding.
const NOTHING: f64 = 1e-24;

/// When to stop.
#[derive(Debug, Clone, Copy)]
pub(super) struct Until {
    pub(super) n_steps: usize,
    /// Share of the squared loss by which a step must still lower it.
    pub(super) share: f64,
}

/// Majorisation from `x` (SMACOF); the square of stress-1 that it reached.
pub(super) fn majorise(fit: &mut Fit<'_>, x: &mut [f64], until: Until) -> f64 {
    fit.problem.normalise(x, fit.k);
    let mut f = fit.loss(Loss::Stress1, x);
    for _ in 0..until.n_steps {
        fit.guttman(x);
        let next = fit.loss(Loss::Stress1, x);
        let gain = f - next;
        f = next;
        if gain.abs() <= until.share * f || f < NOTHING {
            break;
        }
    }
    f
}

/// What a step and the change of the gradient along it were.
struct Remembered {
    step: Vec<f64>,
    change: Vec<f64>,
    rho: f64,
}

/// Quasi-Newton descent from `x`; the square of the loss that it reached. Never goes up.
pub(super) fn descend(fit: &mut Fit<'_>, loss: Loss, x: &mut [f64], until: Until) -> f64 {
    fit.problem.normalise(x, fit.k);
    let n = x.len();
    let mut gradient = vec![0.0; n];
    let mut f = fit.gradient(loss, x, &mut gradient);
    let (mut tried, mut new_gradient) = (vec![0.0; n], vec![0.0; n]);
    let mut memory: Vec<Remembered> = Vec::with_capacity(MEMORY);
    let mut n_small = 0;
    for _ in 0..until.n_steps {
        let steepness = dot(&gradient, &gradient);
        if f < NOTHING || steepness < 1e-28 {
            break;
        }
        let mut direction = towards(&gradient, &memory);
        let mut slope = dot(&direction, &gradient);
        if slope >= 0.0 {
            memory.clear();
            direction = gradient.iter().map(|g| -g).collect();
            slope = -steepness;
        }
        // Without a memory the length is a guess: a tenth of the configuration's.
        let guess = 0.1 * (dot(x, x) / dot(&direction, &direction)).sqrt();
        let mut length = if memory.is_empty() { guess } else { 1.0 };
        let mut reached = None;
        for _ in 0..MOST_HALVINGS {
            for ((new, old), along) in tried.iter_mut().zip(&*x).zip(&direction) {
                *new = old + length * along;
            }
            let next = fit.gradient(loss, &tried, &mut new_gradient);
            if next <= f + 1e-4 * length * slope {
                reached = Some(next);
                break;
            }
            // The lowest place of the parabola through what is known, within reason.
            let bend = next - f - length * slope;
            length *= (-0.5 * length * slope / bend).clamp(0.1, 0.5);
        }
        let Some(next) = reached else {
            if memory.is_empty() {
                break;
            }
            memory.clear();
            continue;
        };
        remember(&mut memory, [&tried, x], [&new_gradient, &gradient]);
        x.copy_from_slice(&tried);
        gradient.copy_from_slice(&new_gradient);
        // One small step may be a bad one; three in a row are the end.
        n_small = if f - next <= until.share * f {
            n_small + 1
        } else {
            0
        };
        f = next;
        if n_small >= 3 {
            break;
        }
    }
    fit.problem.normalise(x, fit.k);
    f
}

fn remember(memory: &mut Vec<Remembered>, x: [&[f64]; 2], gradient: [&[f64]; 2]) {
    let difference =
        |[new, old]: [&[f64]; 2]| -> Vec<f64> { new.iter().zip(old).map(|(a, b)| a - b).collect() };
    let (step, change) = (difference(x), difference(gradient));
    let curvature = dot(&step, &change);
    if curvature > 1e-12 * (dot(&step, &step) * dot(&change, &change)).sqrt() {
        if memory.len() == MEMORY {
            memory.remove(0);
        }
        let rho = 1.0 / curvature;
        memory.push(Remembered { step, change, rho });
    }
}

/// The direction that the remembered curvature asks for.
fn towards(gradient: &[f64], memory: &[Remembered]) -> Vec<f64> {
    let mut direction: Vec<f64> = gradient.iter().map(|g| -g).collect();
    let mut shares = Vec::with_capacity(memory.len());
    for past in memory.iter().rev() {
        let share = past.rho * dot(&past.step, &direction);
        add(&mut direction, -share, &past.change);
        shares.push(share);
    }
    if let Some(last) = memory.last() {
        let scale = 1.0 / (last.rho * dot(&last.change, &last.change));
        for value in &mut direction {
            *value *= scale;
        }
    }
    for (past, share) in memory.iter().zip(shares.iter().rev()) {
        let back = past.rho * dot(&past.change, &direction);
        add(&mut direction, share - back, &past.step);
    }
    direction
}

fn add(to: &mut [f64], factor: f64, what: &[f64]) {
    for (value, part) in to.iter_mut().zip(what) {
        *value += factor * part;
    }
}
