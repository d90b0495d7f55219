//! Newton's method for concave log-likelihoods of scales that may be shifted as a whole.

use nalgebra::{DMatrix, DVector};

use crate::{Computed, Undefined};

/// Steps after which a search is given up; a dozen is usual.
const MOST_STEPS: usize = 200;
/// No difference changes by more in one step: within it curvatures change by a bounded factor,
/// beyond it a step may end where the likelihood is straight and the next one has no bounds.
const LONGEST: f64 = 1.5;
/// A step in no value larger than this, or than so many standard errors in all, ends the search;
/// the error left is about its square. So does a near one that is not much shorter than the last:
/// what is left is rounding.
const TOLERANCE: f64 = 1e-10;

/// A log-likelihood, concave, that does not change when all of its arguments are shifted alike.
pub(super) trait LogLikelihood {
    /// Its value.
    fn value(&self, x: &[f64]) -> f64;
    /// Its slopes, and its curvatures with the sign changed: the observed information.
    fn slopes(&self, x: &[f64]) -> (DVector<f64>, DMatrix<f64>);
    /// How much a step changes the differences of items that were compared, at most.
    fn span(&self, step: &[f64]) -> f64;
}

/// Where a log-likelihood is largest.
#[derive(Debug)]
pub(super) struct Peak {
    /// The arguments there, summing to zero.
    pub(super) at: Vec<f64>,
    /// The inverse of the information, under the same constraint.
    pub(super) covariance: DMatrix<f64>,
    /// Steps taken.
    pub(super) n_steps: usize,
}

/// The peak of a log-likelihood, uphill from `start` in steps that are halved until they do not
/// lead down.
///
/// # Errors
/// The search does not settle, or the peak is flat.
pub(super) fn maximise(model: &impl LogLikelihood, start: Vec<f64>) -> Computed<Peak> {
    let mut x = start;
    let mut value = model.value(&x);
    let mut last_errors = f64::INFINITY;
    for n_steps in 1..=MOST_STEPS {
        let (slopes, information) = model.slopes(&x);
        let step = &inverse(information)? * &slopes;
        let n_errors = slopes.dot(&step).max(0.0).sqrt();
        // Here the rise of the value drowns in rounding, and a whole step is sure to be the best.
        let span = model.span(step.as_slice());
        let is_near = n_errors < 1e-3 && span < 0.1;
        let mut share = (LONGEST / span).min(1.0);
        loop {
            let next: Vec<f64> = x.iter().zip(&step).map(|(x, s)| x + share * s).collect();
            let next_value = model.value(&next);
            if is_near || next_value >= value {
                (x, value) = (next, next_value);
                break;
            }
            share *= 0.5;
            if share < 1e-12 {
                return Err(unsettled());
            }
        }
        centre(&mut x);
        let is_rounding = n_errors < 1e-6 && n_errors > 0.5 * last_errors;
        last_errors = n_errors;
        if is_near && (is_rounding || step.amax().min(n_errors) <= TOLERANCE) {
            let information = model.slopes(&x).1;
            let covariance = inverse(information)?;
            return Ok(Peak {
                at: x,
                covariance,
                n_steps,
            });
        }
    }
    Err(unsettled())
}

fn unsettled() -> Undefined {
    Undefined::because(format!("the fit did not settle in {MOST_STEPS} steps"))
}

/// The inverse of an information whose arguments can be shifted alike, on the values that sum to
/// zero: the shift is filled in, inverted and taken out again.
fn inverse(mut information: DMatrix<f64>) -> Computed<DMatrix<f64>> {
    let n = information.nrows() as f64;
    let stiffness = information.diagonal().iter().sum::<f64>() / n;
    information.add_scalar_mut(stiffness / n);
    let flat = || Undefined::because("the likelihood is flat at its peak");
    let mut inverse = information.cholesky().ok_or_else(flat)?.inverse();
    inverse.add_scalar_mut(-1.0 / (stiffness * n));
    let is_finite = inverse.iter().all(|c| c.is_finite());
    is_finite.then_some(inverse).ok_or_else(flat)
}

fn centre(values: &mut [f64]) {
    let mean = values.iter().sum::<f64>() / values.len() as f64;
    for value in values {
        *value -= mean;
    }
}
