//! What the axes of a map have to do with what was measured: vectors of properties, the best turn
//! towards two of them, and how sure each point is over subjects.

use std::f64::consts::TAU;

use nalgebra::{DMatrix, DVector};

use super::procrustes::Procrustes;
use super::summary::dot;
use crate::{Undefined, undefined};
use selvedge_foundation::numerics::Random;

/// Turns tried before the best is refined.
const N_TURNS: u32 = 180;

/// A measured property fitted into a map: the direction in which it rises.
#[derive(Debug, Clone, PartialEq)]
pub struct PropertyVector {
    /// Its direction in the map, of length 1.
    pub direction: Vec<f64>,
    /// Multiple correlation of the property with the coordinates, 0…1.
    pub multiple_r: f64,
    /// F of that regression; infinite where it is exact.
    pub f: f64,
    /// Its degrees of freedom: (k, n − k − 1).
    pub df: [usize; 2],
}

impl PropertyVector {
    /// Regression of the property on the coordinates, a row an object. Turning the map turns the
    /// direction and changes nothing else.
    ///
    /// # Errors
    /// Too few points (n ≤ k + 1), unequal numbers, a property without spread, points that do not
    /// fill the axes.
    pub fn of(points: &[Vec<f64>], property: &[f64]) -> Result<Self, Undefined> {
        let n = points.len();
        let k = points.first().map_or(0, Vec::len);
        if n != property.len() || n <= k + 1 || k == 0 {
            let m = property.len();
            let what =
                format!("{n} points in {k} dimensions and {m} measures: too few, or unequal");
            return undefined(what);
        }
        let mut x = DMatrix::from_fn(n, k, |i, axis| points[i][axis]);
        for mut axis in x.column_iter_mut() {
            let mean = axis.mean();
            axis.add_scalar_mut(-mean);
        }
        let mut y = DVector::from_column_slice(property);
        let (mean, size) = (y.mean(), y.amax());
        y.add_scalar_mut(-mean);
        if !y.amax().is_finite() || y.amax() <= 1e-12 * size {
            return undefined("the property is the same for all");
        }
        let svd = x.clone().svd(true, true);
        if svd.singular_values.min() <= 1e-10 * svd.singular_values.max() {
            return undefined("the points do not fill the dimensions of the map");
        }
        let no_fit = |why: &str| Undefined::because(why);
        let slopes = svd.solve(&y, 0.0).map_err(no_fit)?;
        let fitted = &x * &slopes;
        let (explained, whole) = (fitted.norm_squared(), y.norm_squared());
        let left = (&y - fitted).norm_squared();
        let length = slopes.norm();
        let direction = slopes.iter().map(|slope| slope / length).collect();
        Ok(Self {
            direction,
            multiple_r: (explained / whole).clamp(0.0, 1.0).sqrt(),
            f: (explained / k as f64) / (left / (n - k - 1) as f64),
            df: [k, n - k - 1],
        })
    }
}

/// A plane map turned, and mirrored if need be, towards two properties.
#[derive(Debug, Clone, PartialEq)]
pub struct BestTurn {
    /// The turned map.
    pub points: Vec<Vec<f64>>,
    /// Counter-clockwise, rad, after mirroring.
    pub angle_rad: f64,
    /// Whether the second axis was mirrored before.
    pub is_mirrored: bool,
    /// Correlations of the first axis with the first property, of the second with the second.
    pub r: [f64; 2],
}

impl BestTurn {
    /// The turn that makes r(axis 1, first) + r(axis 2, second) largest: a grid over the whole
    /// circle with and without mirroring, refined by golden section.
    ///
    /// # Errors
    /// No plane map, unequal numbers, a property or an axis without spread.
    pub fn of(points: &[Vec<f64>], properties: [&[f64]; 2]) -> Result<Self, Undefined> {
        if points.len() < 3 || points.iter().any(|p| p.len() != 2) {
            return undefined("a turn needs three points of a plane map");
        }
        let unit = [standardised(properties[0])?, standardised(properties[1])?];
        if unit.iter().any(|property| property.len() != points.len()) {
            return undefined("points and measures are not as many");
        }
        let x = [0, 1].map(|axis| centred(points.iter().map(|p| p[axis])));
        let moments = Moments::of(&x, &unit);
        let mut best = (f64::NEG_INFINITY, 0.0, 1.0);
        for mirror in [1.0, -1.0] {
            for step in 0..N_TURNS {
                let angle = f64::from(step) * TAU / f64::from(N_TURNS);
                let sum = moments.correlations(angle, mirror).iter().sum::<f64>();
                if sum > best.0 {
                    best = (sum, angle, mirror);
                }
            }
        }
        let (_, angle, mirror) = best;
        let step = TAU / f64::from(N_TURNS);
        let sum = |angle: f64| moments.correlations(angle, mirror).iter().sum::<f64>();
        let angle = golden([angle - step, angle + step], sum);
        let r = moments.correlations(angle, mirror);
        if r.iter().any(|r| !r.is_finite()) {
            return undefined("the points stand on a line or on one place");
        }
        let (sin, cos) = angle.sin_cos();
        let turned = |p: &Vec<f64>| {
            let y = mirror * p[1];
            vec![cos * p[0] - sin * y, sin * p[0] + cos * y]
        };
        Ok(Self {
            points: points.iter().map(turned).collect(),
            angle_rad: angle.rem_euclid(TAU),
            is_mirrored: mirror < 0.0,
            r,
        })
    }

    /// How often chance turns as well: objects are dealt to points anew and the turn is sought
    /// again each time. p = (b + 1)/(N + 1) for the sum of both, for the first, for the second.
    ///
    /// # Errors
    /// As [`Self::of`].
    pub fn p_values(
        &self,
        points: &[Vec<f64>],
        properties: [&[f64]; 2],
        n_permutations: usize,
        random: &mut Random,
    ) -> Result<[f64; 3], Undefined> {
        let figures = |turn: &Self| [turn.r[0] + turn.r[1], turn.r[0], turn.r[1]];
        let own = figures(self);
        let mut dealt = points.to_vec();
        let mut n_as_good = [0_u32; 3];
        for _ in 0..n_permutations {
            random.shuffle(&mut dealt);
            let chance = figures(&Self::of(&dealt, properties)?);
            for ((n, own), chance) in n_as_good.iter_mut().zip(own).zip(chance) {
                *n += u32::from(chance >= own - 1e-9);
            }
        }
        Ok(n_as_good.map(|n| f64::from(n + 1) / (n_permutations + 1) as f64))
    }
}

/// Products of axes and properties, from which every turn's correlations follow.
struct Moments {
    /// Σx², Σxy, Σy².
    axes: [f64; 3],
    /// Axis by property.
    products: [[f64; 2]; 2],
}

impl Moments {
    fn of(x: &[Vec<f64>; 2], unit: &[Vec<f64>; 2]) -> Self {
        Self {
            axes: [dot(&x[0], &x[0]), dot(&x[0], &x[1]), dot(&x[1], &x[1])],
            products: [0, 1].map(|axis| [0, 1].map(|which| dot(&x[axis], &unit[which]))),
        }
    }

    fn correlations(&self, angle: f64, mirror: f64) -> [f64; 2] {
        let (sin, cos) = angle.sin_cos();
        let r = |along: [f64; 2], which: usize| {
            let [xx, xy, yy] = self.axes;
            let [a, b] = along;
            let spread = a * a * xx + 2.0 * a * b * xy + b * b * yy;
            (a * self.products[0][which] + b * self.products[1][which]) / spread.sqrt()
        };
        [r([cos, -sin * mirror], 0), r([sin, cos * mirror], 1)]
    }
}

/// The largest value between two ends where it has one top.
fn golden([mut low, mut high]: [f64; 2], of: impl Fn(f64) -> f64) -> f64 {
    let ratio = 0.5 * (5.0_f64.sqrt() - 1.0);
    for _ in 0..60 {
        let (a, b) = (high - ratio * (high - low), low + ratio * (high - low));
        if of(a) < of(b) {
            low = a;
        } else {
            high = b;
        }
    }
    0.5 * (low + high)
}

fn centred(values: impl ExactSizeIterator<Item = f64> + Clone) -> Vec<f64> {
    let mean = values.clone().sum::<f64>() / values.len() as f64;
    values.map(|x| x - mean).collect()
}

/// About the mean, with a sum of squares of 1.
fn standardised(values: &[f64]) -> Result<Vec<f64>, Undefined> {
    let about = centred(values.iter().copied());
    let length = dot(&about, &about).sqrt();
    let size = values.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
    if !length.is_finite() || length <= 1e-12 * size * (values.len() as f64).sqrt() {
        return undefined("a property is the same for all, or not finite");
    }
    Ok(about.into_iter().map(|x| x / length).collect())
}

/// An ellipse around a point of a plane map.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ellipse {
    /// Its middle.
    pub middle: [f64; 2],
    /// Half axes, the longer first.
    pub half_axes: [f64; 2],
    /// Direction of the longer, rad counter-clockwise from the first axis.
    pub angle_rad: f64,
}

impl Ellipse {
    /// Ellipses of `share` (0…1) of normal scatter around the points of a plane map.
    ///
    /// `maps` are of resampled subjects; each is laid over `reference` by Procrustes first, so that
    /// only what moves within the map counts. Half axes: √(−2 ln(1 − share)) standard deviations.
    ///
    /// # Errors
    /// Fewer than three maps, other numbers of points or dimensions, maps on one place.
    pub fn of_bootstrap(
        reference: &[Vec<f64>],
        maps: &[Vec<Vec<f64>>],
        share: f64,
    ) -> Result<Vec<Self>, Undefined> {
        if maps.len() < 3 || !(share > 0.0 && share < 1.0) {
            return undefined("ellipses need three maps and a share between 0 and 1");
        }
        if reference
            .iter()
            .chain(maps.iter().flatten())
            .any(|p| p.len() != 2)
        {
            return undefined("ellipses are for plane maps");
        }
        let aligned: Result<Vec<_>, _> = maps
            .iter()
            .map(|map| Procrustes::of(map, reference).map(|found| found.moved))
            .collect();
        let aligned = aligned?;
        let factor = (-2.0 * (1.0 - share).ln()).sqrt();
        let around = |i: usize| {
            let n = aligned.len() as f64;
            let x = [0, 1].map(|axis| centred(aligned.iter().map(|map| map[i][axis])));
            let middle = [0, 1].map(|axis| aligned.iter().map(|map| map[i][axis]).sum::<f64>() / n);
            let [xx, xy, yy] = [dot(&x[0], &x[0]), dot(&x[0], &x[1]), dot(&x[1], &x[1])]
                .map(|sum| sum / (n - 1.0));
            let (half, apart) = (0.5 * (xx + yy), (0.25 * (xx - yy).powi(2) + xy * xy).sqrt());
            Self {
                middle,
                half_axes: [half + apart, half - apart].map(|v| factor * v.max(0.0).sqrt()),
                angle_rad: 0.5 * (2.0 * xy).atan2(xx - yy),
            }
        };
        Ok((0..reference.len()).map(around).collect())
    }
}

#[cfg(test)]
mod tests;
