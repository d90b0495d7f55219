//! What is assumed of psychometric functions before any answer.

use super::{Block, Family, Fit, Guess, Psychometric};
use super::{answers::checked, evidence::Evidence};
use crate::Computed;

/// The mean lapse rate that is expected.
pub(super) const USUAL_LAPSE: f64 = 0.02;

/// What is assumed of a psychometric function: shape, lower end and how wide it usually is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Model {
    /// Its shape.
    pub family: Family,
    /// Its lower end.
    pub guess: Guess,
    /// Its usual width from 5 to 95 %, on the family's scale: the median of what is expected.
    pub usual_width: f64,
    /// How well that is known: standard deviation of its logarithm.
    pub ln_width_sd: f64,
}

/// What is known of a subject's width and lapse rate besides its own answers.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Expected {
    /// Mean and standard deviation of the logarithm of the width.
    pub ln_width: [f64; 2],
    /// Mean of the lapse rate, which is the rarer the larger (exponential).
    pub lapse: f64,
}

impl Model {
    /// Of one of `m` alternatives that is right, of this usual width so well known.
    pub fn alternatives(family: Family, m: u32, [usual_width, ln_width_sd]: [f64; 2]) -> Self {
        Self {
            family,
            guess: Guess::Share(1.0 / f64::from(m.max(1))),
            usual_width,
            ln_width_sd,
        }
    }

    /// What the answers of one subject say.
    ///
    /// # Errors
    /// No trials, one stimulus alone, all answers equal, more right than trials, a stimulus that
    /// is not finite (of Weibull: not above 0), a width or rates that are none.
    pub fn evidence(&self, blocks: &[Block]) -> Computed<Evidence> {
        let middle = self.family.stimulus(0.0);
        self.curve(middle, self.usual_width, 0.0).checked()?;
        let blocks = checked(self.family, blocks)?;
        Ok(Evidence::of(*self, blocks))
    }

    /// The function of a subject by itself: threshold as likely anywhere as elsewhere.
    ///
    /// # Errors
    /// As [`Self::evidence`].
    pub fn fit(&self, blocks: &[Block]) -> Computed<Fit> {
        Ok(Fit::alone(&self.evidence(blocks)?))
    }

    pub(super) fn expected(&self) -> Expected {
        Expected {
            ln_width: [self.usual_width.ln(), self.ln_width_sd],
            lapse: USUAL_LAPSE,
        }
    }

    pub(super) fn curve(&self, threshold: f64, width: f64, lapse: f64) -> Psychometric {
        Psychometric {
            family: self.family,
            threshold,
            width,
            guess: self.guess.rate(lapse),
            lapse,
        }
    }
}
