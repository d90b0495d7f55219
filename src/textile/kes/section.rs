//! The evaluated section: the tester's manual takes the middle 20 mm of 30; here it is chosen on
//! the curve.
//!
//! Suggested is the most stationary 20 mm: of all sections 0.1 mm apart those with the fewest
//! marked samples, and of these the one whose ten pieces of 2 mm differ least, by
//! `Σ (σ² of the pieces' mean heights + σ² of their roughnesses)` over the strokes of the axis;
//! of equals the one nearest to the middle. Both strokes of an axis get the same piece of textile.

use super::marks::n_samples;
use super::{KesStroke, TextileAxis};
use crate::surface::mean_deviation;

/// The length of the evaluated section, mm.
pub(crate) const EVALUATED_MM: f64 = 20.0;
/// Pieces that a section is compared by.
const N_PIECES: usize = 10;
/// How far apart the sections lie that are tried, mm.
const STRIDE_MM: f64 = 0.1;

/// A section of the textile, along the forward axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct KesSection {
    /// Where it begins, mm.
    pub from_mm: f64,
    /// Where it ends, mm.
    pub to_mm: f64,
    /// Whether it was chosen by rule and not said.
    pub is_suggested: bool,
}

impl KesStroke {
    /// The axis it runs along.
    pub fn axis(&self) -> TextileAxis {
        if self.direction.is_weft() {
            TextileAxis::Weft
        } else {
            TextileAxis::Warp
        }
    }

    /// The samples of a section in the order of travel; `None` where the stroke does not reach.
    pub(crate) fn samples_of(&self, section: &KesSection) -> Option<std::ops::Range<usize>> {
        let n = n_samples(section.to_mm - section.from_mm, self.step_mm);
        // A section of n samples ends one step after the last.
        let last_mm = section.from_mm + (n - 1) as f64 * self.step_mm;
        let first_mm = if self.direction.is_reverse() {
            last_mm
        } else {
            section.from_mm
        };
        let travelled = (first_mm - self.start_mm).abs() / self.step_mm;
        let is_before = if self.direction.is_reverse() {
            first_mm > self.start_mm + 0.5 * self.step_mm
        } else {
            first_mm < self.start_mm - 0.5 * self.step_mm
        };
        if is_before || !travelled.is_finite() || travelled > self.heights_um.len() as f64 {
            return None;
        }
        let first = if travelled < 0.5 {
            0
        } else {
            n_samples(travelled, 1.0)
        };
        (first + n <= self.heights_um.len()).then_some(first..first + n)
    }
}

/// What all strokes of an axis cover, mm: from the lowest place to one step after the highest.
pub(crate) fn covered_mm(strokes: &[&KesStroke]) -> Option<[f64; 2]> {
    let ranges = strokes.iter().map(|stroke| {
        let [low, high] = stroke.range_mm();
        [low, high + stroke.step_mm]
    });
    ranges.reduce(|a, b| [a[0].max(b[0]), a[1].min(b[1])])
}

/// The section suggested for the strokes of an axis.
pub(crate) fn suggested(strokes: &[&KesStroke]) -> Option<KesSection> {
    let [low, high] = covered_mm(strokes)?;
    let length_mm = EVALUATED_MM.min(high - low);
    let step_mm = strokes
        .iter()
        .map(|stroke| stroke.step_mm)
        .fold(0.0, f64::max);
    let n_starts = n_samples((high - low - length_mm).max(0.0), STRIDE_MM.max(step_mm)) + 1;
    let at = |share: f64| {
        let from_mm = low + share * (high - low - length_mm).max(0.0);
        KesSection {
            from_mm,
            to_mm: from_mm + length_mm,
            is_suggested: true,
        }
    };
    let shares = (0..n_starts).map(|i| i as f64 / (n_starts - 1).max(1) as f64);
    let scored = shares.filter_map(|share| {
        let section = at(share);
        Some((badness(strokes, &section)?, (share - 0.5).abs(), section))
    });
    let better = |(a, from_a, _): &([f64; 2], f64, KesSection), (b, from_b, _): &(_, f64, _)| {
        let b: &[f64; 2] = b;
        a[0].total_cmp(&b[0])
            .then(a[1].total_cmp(&b[1]))
            .then(from_a.total_cmp(from_b))
    };
    scored.min_by(better).map(|(_, _, section)| section)
}

/// Marked samples, and how much the pieces differ.
fn badness(strokes: &[&KesStroke], section: &KesSection) -> Option<[f64; 2]> {
    let mut sum = [0.0, 0.0];
    for stroke in strokes {
        let samples = stroke.samples_of(section)?;
        let marked = stroke.marks.iter().map(|mark| {
            let first = mark.samples.start.max(samples.start);
            mark.samples.end.min(samples.end).saturating_sub(first)
        });
        sum[0] += marked.sum::<usize>() as f64;
        sum[1] += unsteadiness(&stroke.heights_um[samples]);
    }
    // Differences far below the instrument's resolution are none: the middle decides.
    Some([sum[0], (sum[1] * 1e6).round() / 1e6])
}

/// The variance of the pieces' mean heights and of their roughnesses, µm².
fn unsteadiness(heights: &[f64]) -> f64 {
    let n_piece = (heights.len() / N_PIECES).max(1);
    let pieces = heights.chunks_exact(n_piece).take(N_PIECES);
    let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
    let (means, roughnesses): (Vec<f64>, Vec<f64>) = pieces
        .map(|piece| (mean(piece), mean_deviation(piece)))
        .unzip();
    let variance = |values: &[f64]| {
        let middle = mean(values);
        let squares: Vec<f64> = values
            .iter()
            .map(|value| (value - middle).powi(2))
            .collect();
        mean(&squares)
    };
    variance(&means) + variance(&roughnesses)
}
