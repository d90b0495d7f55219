//! One model of all subjects: thresholds, widths and lapse rates are drawn from a population, and
//! all answers together say which.
//!
//! ```text
//! threshold_s ~ N(μ, τ)   ln width_s ~ N(ω, σ)   lapse_s ~ exponential of mean l, below 12 %
//! answers of s ~ binomial(g + (1 − g − lapse_s) F((x − threshold_s) / width_s))
//! ```
//!
//! Thresholds are on the family's scale. Subjects are summed out on their grids ([`Evidence`]). Of
//! the five numbers of the population the mode and the curvature there are found (Laplace); from
//! a t distribution of that shape they are drawn, each draw weighted by its own probability
//! (importance sampling), so that what is skewed or wide, as of few subjects, stays so. Expected
//! before any answer: μ anywhere; τ as gamma of shape 2, which keeps off 0 (Chung et al. 2013);
//! widths about the usual one; lapses about 2 %.

use nalgebra::{SMatrix, SVector};

use super::Model;
use super::evidence::Evidence;
use super::fit::{Drawn, Fit, LEVEL};
use super::model::{Expected, USUAL_LAPSE};
use crate::{Computed, Interval, Summary, mean, undefined};
use selvedge_foundation::numerics::{Lowest, Random, in_pieces, n_threads};

/// μ, ln τ, ω, ln σ, ln l.
const N: usize = 5;
type Point = [f64; N];
/// How much widths are expected to differ among subjects: the median, and the standard deviation
/// of its logarithm.
const WIDTHS_DIFFER: [f64; 2] = [0.2, 0.5];
/// Standard deviation of the logarithm of the mean lapse rate.
const LN_LAPSE_SD: f64 = 0.7;
/// Draws of the population.
const N_DRAWS: usize = 800;
/// Of these, so many stand for all where subjects are estimated.
const N_STANDING: usize = 64;
/// Degrees of freedom of what is drawn from: heavier tails than any that matter.
const DF: usize = 5;

/// A number of the population.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Estimate {
    /// Its median over the draws.
    pub value: f64,
    /// Its standard deviation.
    pub se: f64,
    /// Its central interval.
    pub interval: Interval,
}

/// What all subjects' answers say of the population, and of each subject in it.
#[derive(Debug, Clone, PartialEq)]
pub struct Population {
    /// The median of thresholds, in the unit of the stimulus.
    pub threshold: Estimate,
    /// How much thresholds differ among subjects: τ, on the family's scale.
    pub spread: Estimate,
    /// The median of widths.
    pub width: Estimate,
    /// The mean of lapse rates.
    pub lapse: Estimate,
    /// The subjects, in order.
    pub subjects: Vec<Fit>,
}

impl Population {
    /// The population that these subjects of one model come from. The seed decides on the draws;
    /// threads do not matter.
    ///
    /// # Errors
    /// Fewer than two subjects, which tell nothing of how subjects differ; a probability that is
    /// not curved at its mode.
    pub fn of(subjects: &[Evidence], seed: u64) -> Computed<Self> {
        if subjects.len() < 2 {
            return undefined("a population needs two subjects or more");
        }
        let joint = Joint::of(subjects)?;
        let draws = joint.draws(seed)?;
        let family = joint.subjects[0].model.family;
        let number = |of: &dyn Fn(&Point) -> f64| estimate(&draws, of);
        let standing = standing(&draws);
        let mut fits: Vec<Option<Fit>> = vec![None; subjects.len()];
        let each = |(): &mut (), at: usize, fit: &mut [Option<Fit>]| {
            fit[0] = Some(Fit::among(&subjects[at], &standing));
        };
        in_pieces(&mut fits, 1, n_threads(), || (), each);
        Ok(Self {
            threshold: number(&|point| family.stimulus(point[0])),
            spread: number(&|point| point[1].exp()),
            width: number(&|point| point[2].exp()),
            lapse: number(&|point| point[4].exp()),
            subjects: fits.into_iter().flatten().collect(),
        })
    }
}

/// The probability of the population's numbers given all answers.
struct Joint<'a> {
    subjects: &'a [Evidence],
    model: Model,
    /// Where a search begins.
    start: Point,
    /// How far each number is moved for differences.
    steps: Point,
}

impl<'a> Joint<'a> {
    fn of(subjects: &'a [Evidence]) -> Computed<Self> {
        let family = subjects[0].model.family;
        let alone: Vec<Fit> = subjects.iter().map(Fit::alone).collect();
        let places: Vec<f64> = alone
            .iter()
            .map(|fit| family.place(fit.curve.threshold))
            .collect();
        let half = |fit: &Fit| 0.25 * (family.place(fit.own.high) - family.place(fit.own.low));
        let errors: Vec<f64> = alone.iter().map(half).collect();
        let (seen, error) = (Summary::of(&places)?.sd, mean(&errors)?);
        let spread = (seen.powi(2) - error.powi(2))
            .max((0.3 * error).powi(2))
            .sqrt();
        let model = subjects[0].model;
        let n_root = (subjects.len() as f64).sqrt();
        let [median, _] = WIDTHS_DIFFER;
        Ok(Self {
            subjects,
            model,
            start: [
                mean(&places)?,
                spread.ln(),
                model.usual_width.ln(),
                median.ln(),
                USUAL_LAPSE.ln(),
            ],
            steps: [0.3 * error.hypot(spread) / n_root, 0.1, 0.05, 0.1, 0.1],
        })
    }

    /// Its logarithm, but for a constant.
    fn ln_probability(&self, point: &Point) -> f64 {
        let drawn = drawn(point);
        let Some(normal) = drawn.thresholds.filter(|[_, sd]| sd.is_finite()) else {
            return f64::NEG_INFINITY;
        };
        let weights = self.subjects[0].weights(&drawn.expected);
        let mut likelihoods = Vec::new();
        let mut ln_sum = self.ln_prior(point);
        for subject in self.subjects {
            subject.likelihoods(&weights, &mut likelihoods);
            let both = likelihoods.iter().zip(subject.normal(normal));
            ln_sum += both.map(|(l, density)| l * density).sum::<f64>().ln();
        }
        if ln_sum.is_nan() {
            f64::NEG_INFINITY
        } else {
            ln_sum
        }
    }

    fn ln_prior(&self, [_, ln_spread, ln_width, ln_differ, ln_lapse]: &Point) -> f64 {
        let normal = |x: f64, mean: f64, sd: f64| -0.5 * ((x - mean) / sd).powi(2);
        let [differ, differ_sd] = WIDTHS_DIFFER;
        // Gamma of shape 2 and mean one usual width, as a density of the logarithm.
        2.0 * ln_spread - 2.0 * ln_spread.exp() / self.model.usual_width
            + normal(
                *ln_width,
                self.model.usual_width.ln(),
                self.model.ln_width_sd,
            )
            + normal(*ln_differ, differ.ln(), differ_sd)
            + normal(*ln_lapse, USUAL_LAPSE.ln(), LN_LAPSE_SD)
    }

    /// Draws of the population with their weights, 1 together.
    fn draws(&self, seed: u64) -> Computed<Vec<(Point, f64)>> {
        let mode = Lowest::of(
            |p| -self.ln_probability(p),
            self.start,
            self.steps.map(|s| 3.0 * s),
        );
        let root = self.shape(&mode.place)?;
        let mut random = Random::new(seed).branch("population");
        let mut draws: Vec<(Point, f64)> = Vec::with_capacity(N_DRAWS);
        for _ in 0..N_DRAWS {
            let z = SVector::<f64, N>::from_fn(|_, _| random.normal());
            let chi: f64 = (0..DF).map(|_| random.normal().powi(2)).sum::<f64>() / DF as f64;
            let place = SVector::from(mode.place) + root * z / chi.sqrt();
            let away = 1.0 + z.norm_squared() / chi / DF as f64;
            draws.push((place.into(), 0.5 * (DF + N) as f64 * away.ln()));
        }
        let weigh = |(): &mut (), _: usize, draw: &mut [(Point, f64)]| {
            let ln_weight = self.ln_probability(&draw[0].0) + mode.value + draw[0].1;
            draw[0].1 = ln_weight.exp();
        };
        in_pieces(&mut draws, 1, n_threads(), || (), weigh);
        let total: f64 = draws.iter().map(|(_, weight)| weight).sum();
        if !(total > 0.0 && total.is_finite()) {
            return undefined("no population is probable: the subjects have nothing in common");
        }
        for (_, weight) in &mut draws {
            *weight /= total;
        }
        Ok(draws)
    }

    /// A root of the covariance at the mode.
    fn shape(&self, mode: &Point) -> Computed<SMatrix<f64, N, N>> {
        let at = |moves: &[(usize, f64)]| {
            let mut place = *mode;
            for (axis, by) in moves {
                place[*axis] += by * self.steps[*axis];
            }
            self.ln_probability(&place)
        };
        let middle = at(&[]);
        let information = SMatrix::<f64, N, N>::from_fn(|i, j| {
            let bent = if i == j {
                at(&[(i, 1.0)]) - 2.0 * middle + at(&[(i, -1.0)])
            } else {
                let along = at(&[(i, 1.0), (j, 1.0)]) + at(&[(i, -1.0), (j, -1.0)]);
                0.25 * (along - at(&[(i, 1.0), (j, -1.0)]) - at(&[(i, -1.0), (j, 1.0)]))
            };
            -bent / (self.steps[i] * self.steps[j])
        });
        let covariance = information.cholesky().map(|root| root.inverse());
        let root = covariance.and_then(nalgebra::Matrix::cholesky);
        root.map_or_else(
            || undefined("the probability of the population is not curved at its mode"),
            |root| Ok(root.l()),
        )
    }
}

fn drawn(&[middle, ln_spread, ln_width, ln_differ, ln_lapse]: &Point) -> Drawn {
    Drawn {
        thresholds: Some([middle, ln_spread.exp()]),
        expected: Expected {
            ln_width: [ln_width, ln_differ.exp()],
            lapse: ln_lapse.exp(),
        },
    }
}

/// Draws that stand for all, each by its weight.
fn standing(draws: &[(Point, f64)]) -> Vec<Drawn> {
    let mut standing = Vec::with_capacity(N_STANDING);
    let mut below = 0.0;
    for (point, weight) in draws {
        below += weight;
        while standing.len() < N_STANDING
            && (standing.len() as f64 + 0.5) / N_STANDING as f64 <= below
        {
            standing.push(drawn(point));
        }
    }
    standing
}

fn estimate(draws: &[(Point, f64)], of: &dyn Fn(&Point) -> f64) -> Estimate {
    let mut values: Vec<[f64; 2]> = draws.iter().map(|(point, w)| [of(point), *w]).collect();
    values.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let over = |of: &dyn Fn(f64) -> f64| -> f64 { values.iter().map(|[v, w]| w * of(*v)).sum() };
    let mean = over(&|v| v);
    let quantile = |share: f64| {
        let mut below = 0.0;
        let found = values.iter().find(|[_, weight]| {
            below += weight;
            below >= share
        });
        found
            .or_else(|| values.last())
            .map_or(mean, |[value, _]| *value)
    };
    Estimate {
        value: quantile(0.5),
        se: over(&|v| (v - mean).powi(2)).sqrt(),
        interval: Interval::new(
            [quantile(0.5 * (1.0 - LEVEL)), quantile(0.5 * (1.0 + LEVEL))],
            LEVEL,
        ),
    }
}
