//! Intervals by the curvature of the log-posterior at its mode.

use nalgebra::DMatrix;

use super::target::{Point, point};
use super::{Fit, Psychometric};
use crate::distribution::normal_quantile;
use crate::{Computed, Interval, Undefined};

/// A lapse rate this near to an end of its range is held there.
const NEAR_END: f64 = 1e-3;

impl Fit {
    /// Standard error and interval of a quantity of the function by the delta method: the inverse
    /// of the observed information, and the quantity's own derivatives.
    ///
    /// A lapse rate at an end of its range is held there.
    ///
    /// # Errors
    /// A quantity that the function does not have, a log-posterior that is not curved.
    pub fn delta(
        &self,
        quantity: impl Fn(&Psychometric) -> Computed,
        level: f64,
    ) -> Computed<(f64, Interval)> {
        let target = self.target();
        let mode = point(&self.curve);
        let free = self.free();
        let steps = steps(mode);
        let information = self.information(mode, &free, steps);
        let moved = |axis: usize, by: f64| {
            let mut place = mode;
            place[axis] += by;
            quantity(&target.curve(place))
        };
        let mut gradient = Vec::with_capacity(free.len());
        for &axis in &free {
            let h = steps[axis];
            gradient.push((moved(axis, h)? - moved(axis, -h)?) / (2.0 * h));
        }
        let gradient = DMatrix::from_vec(free.len(), 1, gradient);
        let flat = || Undefined::because("the log-posterior is not curved at its mode");
        let solved = information.cholesky().ok_or_else(flat)?.solve(&gradient);
        let variance = gradient.dot(&solved);
        let se = (variance >= 0.0 && variance.is_finite()).then(|| variance.sqrt());
        let se = se.ok_or_else(flat)?;
        let (value, z) = (quantity(&self.curve)?, normal_quantile(0.5 + 0.5 * level)?);
        let [low, high] = [value - z * se, value + z * se];
        Ok((se, Interval { low, high, level }))
    }

    /// Likewise of a quantity above zero, with an interval that is symmetric in its logarithm:
    /// widths and what is a multiple of them.
    ///
    /// # Errors
    /// As [`Self::delta`], and a quantity that is not above zero.
    pub fn delta_positive(
        &self,
        quantity: impl Fn(&Psychometric) -> Computed,
        level: f64,
    ) -> Computed<(f64, Interval)> {
        let ln_quantity = |curve: &Psychometric| {
            let value = quantity(curve)?;
            (value > 0.0).then(|| value.ln()).ok_or_else(|| {
                Undefined::because(format!("{value} has no logarithm to be symmetric in"))
            })
        };
        let (se, Interval { low, high, level }) = self.delta(ln_quantity, level)?;
        let [low, high] = [low.exp(), high.exp()];
        Ok((se * quantity(&self.curve)?, Interval { low, high, level }))
    }

    /// The axes along which the mode can move.
    fn free(&self) -> Vec<usize> {
        let (most, is_fixed) = self.model.lapses();
        let lapse = self.curve.lapse;
        let is_inside = lapse > NEAR_END && lapse < most - NEAR_END;
        if is_fixed || !is_inside {
            vec![0, 1]
        } else {
            vec![0, 1, 2]
        }
    }

    /// Minus the second derivatives of the log-posterior.
    fn information(&self, mode: Point, free: &[usize], steps: Point) -> DMatrix<f64> {
        let target = self.target();
        let at = |moves: &[(usize, f64)]| {
            let mut place = mode;
            for (axis, by) in moves {
                place[*axis] += by * steps[*axis];
            }
            target.ln_posterior(place)
        };
        let middle = at(&[]);
        DMatrix::from_fn(free.len(), free.len(), |i, j| {
            let (a, b) = (free[i], free[j]);
            let bent = if a == b {
                at(&[(a, 1.0)]) - 2.0 * middle + at(&[(a, -1.0)])
            } else {
                let along = at(&[(a, 1.0), (b, 1.0)]) + at(&[(a, -1.0), (b, -1.0)]);
                let across = at(&[(a, 1.0), (b, -1.0)]) + at(&[(a, -1.0), (b, 1.0)]);
                0.25 * (along - across)
            };
            -bent / (steps[a] * steps[b])
        })
    }
}

/// How far to either side differences are taken.
fn steps(mode: Point) -> Point {
    let width = mode[1].exp();
    [1e-3 * width, 1e-3, 0.2 * NEAR_END]
}
