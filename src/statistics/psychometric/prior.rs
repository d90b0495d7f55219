//! What is taken for likely before any answer.

use super::answers::Block;
use super::{Family, Psychometric};

/// No lapse rate above this is believed.
pub(super) const MAX_LAPSE: f64 = 0.06;

/// How the lower end of the function is known.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Guess {
    /// This share: 1/m of m alternatives, 0 of a yes that is never guessed.
    Share(f64),
    /// As large as the lapse rate: two-sided answers, wrong as often at either end.
    EqualToLapse,
}

impl Guess {
    /// The rate beside a lapse rate.
    pub fn rate(self, lapse: f64) -> f64 {
        match self {
            Self::Share(share) => share,
            Self::EqualToLapse => lapse,
        }
    }
}

/// a·ln x, and 0 where a is 0.
pub(super) fn times_ln(a: f64, x: f64) -> f64 {
    if a > 0.0 { a * x.ln() } else { 0.0 }
}

/// Priors of threshold and width as of psignifit (Schütt et al. 2016), on the family's scale:
/// natural logarithms for Weibull, stimuli as they are for the others.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Priors {
    /// Flat between these; to either side half a cosine down to nothing, half the range beyond.
    pub threshold: [f64; 2],
    /// Flat between these; nothing below half of the one and above three times the other.
    pub width: [f64; 2],
}

impl Priors {
    /// From the stimuli: thresholds within their range, widths from twice their smallest distance
    /// (but at most half the range) to the range.
    pub(super) fn of(family: Family, blocks: &[Block]) -> Self {
        let places: Vec<f64> = blocks.iter().map(|b| family.place(b.x)).collect();
        let [low, high] = [places[0], places[places.len() - 1]];
        let apart = places.windows(2).map(|pair| pair[1] - pair[0]);
        let gap = apart.fold(f64::INFINITY, f64::min);
        let range = high - low;
        Self {
            threshold: [low, high],
            width: [(2.0 * gap).min(0.5 * range), range],
        }
    }

    /// Where a threshold can be.
    pub(super) fn threshold_support(&self) -> [f64; 2] {
        let [low, high] = self.threshold;
        let beyond = 0.5 * (high - low);
        [low - beyond, high + beyond]
    }

    /// Where a width can be.
    pub(super) fn width_support(&self) -> [f64; 2] {
        [0.5 * self.width[0], 3.0 * self.width[1]]
    }

    /// The logarithm of the density of threshold and width, but for a constant.
    pub(super) fn ln_prior(&self, threshold: f64, width: f64) -> f64 {
        let [low, high] = self.threshold;
        let beyond = (low - threshold).max(threshold - high).max(0.0);
        let [narrow, wide] = self.width;
        let off_width = if width < narrow {
            (narrow - width) / (0.5 * narrow)
        } else {
            (width - wide).max(0.0) / (2.0 * wide)
        };
        falling(beyond / (0.5 * (high - low))) + falling(off_width)
    }

    /// What is at the edge of its prior rather than inside.
    pub(super) fn edges(&self, curve: &Psychometric) -> Vec<String> {
        let place = curve.family.place(curve.threshold);
        let [low, high] = self.threshold;
        let [narrow, wide] = self.width;
        let mut notes = Vec::new();
        if place < low || place > high {
            notes.push("the threshold lies outside the stimuli: it is not bracketed".to_owned());
        }
        if curve.width < narrow || curve.width > wide {
            notes.push("the width is where its prior falls: the stimuli hardly tell it".to_owned());
        }
        notes
    }
}

/// ln(½ + ½ cos πx): 0 at 0, −∞ from 1 on.
fn falling(x: f64) -> f64 {
    if x >= 1.0 || x.is_nan() {
        f64::NEG_INFINITY
    } else {
        (0.5 + 0.5 * (std::f64::consts::PI * x).cos()).ln()
    }
}
