//! The psychometric function that answers make most probable.

use super::answers::{Block, checked};
use super::prior::{Guess, MAX_LAPSE, Priors};
use super::target::{Point, Target, deviance, point};
use super::{Family, Psychometric};
use crate::{Computed, Undefined, undefined};
use selvedge_foundation::numerics::lowest;

/// Thresholds, widths and lapse rates where a search may begin.
const STARTS: [u32; 3] = [24, 12, 3];

/// What is assumed of a psychometric function.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Model {
    /// Its shape.
    pub family: Family,
    /// Its lower end.
    pub guess: Guess,
    /// The largest lapse rate; any from 0 to it is as likely as another.
    pub(crate) max_lapse: f64,
}

impl Model {
    /// Of one of `m` alternatives that is right, with lapses from 0 to 6 %.
    pub fn alternatives(family: Family, m: u32) -> Self {
        Self {
            family,
            guess: Guess::Share(1.0 / f64::from(m.max(1))),
            max_lapse: MAX_LAPSE,
        }
    }

    /// Of answers which of two is stronger, with lapses at either end.
    pub fn two_sided(family: Family) -> Self {
        Self {
            family,
            guess: Guess::EqualToLapse,
            max_lapse: MAX_LAPSE,
        }
    }

    /// Fits the function to answers, with priors of threshold and width from the stimuli.
    ///
    /// # Errors
    /// No trials, one stimulus alone, all answers equal, more right than trials, a stimulus that
    /// is not finite (of Weibull: not above 0), rates that are no rates.
    pub fn fit(self, blocks: &[Block]) -> Computed<Fit> {
        self.check()?;
        let blocks = checked(self.family, blocks)?;
        let priors = Priors::of(self.family, &blocks);
        self.fitted(priors, blocks)
    }

    /// The largest lapse rate, and whether it is the only one.
    pub(super) fn lapses(self) -> (f64, bool) {
        (self.max_lapse, self.max_lapse <= 0.0)
    }

    fn check(self) -> Computed<()> {
        let most = self.max_lapse;
        if !(0.0..0.5).contains(&most) {
            let reason = format!("a largest lapse rate of {most} is not below one half");
            return undefined(reason);
        }
        let guess = self.guess.rate(most);
        let is_rate = guess >= 0.0 && guess + most < 1.0;
        is_rate.then_some(()).ok_or_else(|| {
            Undefined::because(format!("guess rate {guess} with lapse rates up to {most}"))
        })
    }

    fn fitted(self, priors: Priors, blocks: Vec<Block>) -> Computed<Fit> {
        let target = Target::new(self, &priors, &blocks);
        let mode = mode(&target, start(&target))?;
        let curve = target.curve(mode);
        let ln_likelihood = target.ln_likelihood(mode);
        let ln_posterior = target.ln_posterior(mode);
        let notes = priors.edges(&curve);
        Ok(Fit {
            model: self,
            priors,
            curve,
            ln_likelihood,
            ln_posterior,
            deviance: deviance(&blocks, &curve),
            blocks,
            notes,
        })
    }
}

/// A fitted psychometric function.
#[derive(Debug, Clone, PartialEq)]
pub struct Fit {
    /// What was assumed.
    pub model: Model,
    /// What was taken for likely before.
    pub(crate) priors: Priors,
    /// The mode of the posterior of threshold, width and lapse rate.
    pub curve: Psychometric,
    /// Its log-likelihood.
    pub(crate) ln_likelihood: f64,
    /// Its log-posterior, but for a constant.
    pub(crate) ln_posterior: f64,
    /// Twice what a rate of its own for each stimulus gains in log-likelihood.
    pub deviance: f64,
    /// The answers, stimuli ascending.
    pub blocks: Vec<Block>,
    /// What a reader has to know: a threshold that is not bracketed.
    pub notes: Vec<String>,
}

impl Fit {
    /// Trials.
    pub fn n_trials(&self) -> u32 {
        self.blocks.iter().map(|b| b.n).sum()
    }

    /// The same model and priors for other answers at the same stimuli, searched from here.
    pub(super) fn again(&self, blocks: &[Block]) -> Computed<Psychometric> {
        checked(self.model.family, blocks)?;
        let target = Target::new(self.model, &self.priors, blocks);
        // As likely as the fit itself: near it, and one search is enough.
        Ok(target.curve(walked(&target, point(&self.curve), 0.5)))
    }

    pub(super) fn target(&self) -> Target<'_> {
        Target::new(self.model, &self.priors, &self.blocks)
    }
}

/// The best of an even grid over the priors.
fn start(target: &Target<'_>) -> Point {
    let [from, to] = target.priors.threshold_support();
    let widths = target.priors.width_support().map(f64::ln);
    let (most, is_fixed) = target.model.lapses();
    let within = |[low, high]: [f64; 2], i: u32, n: u32| {
        low + (high - low) * (f64::from(i) + 0.5) / f64::from(n)
    };
    let n_lapses = if is_fixed { 1 } else { STARTS[2] };
    let mut best = (
        [0.5 * (from + to), 0.5 * (widths[0] + widths[1]), most],
        f64::NEG_INFINITY,
    );
    for i in 0..STARTS[0] {
        for j in 0..STARTS[1] {
            for k in 0..n_lapses {
                let lapse = if is_fixed {
                    most
                } else {
                    within([0.0, most], k, n_lapses)
                };
                let tried = [
                    within([from, to], i, STARTS[0]),
                    within(widths, j, STARTS[1]),
                    lapse,
                ];
                let value = target.ln_posterior(tried);
                if value > best.1 {
                    best = (tried, value);
                }
            }
        }
    }
    best.0
}

/// The mode of the posterior near a point.
fn mode(target: &Target<'_>, start: Point) -> Computed<Point> {
    let found = walked(target, walked(target, start, 1.0), -0.3);
    let is_found = target.ln_posterior(found).is_finite();
    is_found.then_some(found).ok_or_else(|| {
        Undefined::because("these answers are impossible under the model: lapses or guesses")
    })
}

/// Uphill from a point with steps of this share of the usual ones.
fn walked(target: &Target<'_>, [threshold, ln_width, lapse]: Point, size: f64) -> Point {
    let (most, is_fixed) = target.model.lapses();
    let range = target.priors.threshold[1] - target.priors.threshold[0];
    let steps = [0.1 * range, 0.3, 0.3].map(|step| size * step);
    if is_fixed {
        let at = |p: &[f64; 2]| -target.ln_posterior([p[0], p[1], most]);
        let [threshold, ln_width] = lowest(at, [threshold, ln_width], [steps[0], steps[1]]).place;
        return [threshold, ln_width, most];
    }
    // The rate as an angle: its ends are no walls to a search.
    let rate = |angle: f64| most * angle.sin().powi(2);
    let at = |p: &[f64; 3]| -target.ln_posterior([p[0], p[1], rate(p[2])]);
    let angle = (lapse / most)
        .clamp(0.0, 1.0)
        .sqrt()
        .asin()
        .clamp(0.2, 1.37);
    let found = lowest(at, [threshold, ln_width, angle], steps).place;
    [found[0], found[1], rate(found[2])]
}
