//! The maxima that count: those about as high as the highest that are as far out.
//!
//! A textile that is bent or irregular agrees with itself less and less with distance. So a maximum
//! is measured by the highest one at its distance or beyond, not by a fixed height.

use super::autocorrelation::Autocorrelation;
use super::basis::{Place, length};
use super::maxima::{Maxima, is_half};

/// Most maxima that are looked at; the nearest.
const MOST: usize = 400;
/// Of the highest at their distance or beyond, the share that counts.
const MIN_SHARE: f64 = 0.5;
/// Maxima from this share of a distance on are "at that distance".
const AT_LEAST: f64 = 0.7;
/// Shifts shorter than this are no repeat: less than two pixels cannot hold a thread and a gap.
pub(super) const SHORTEST_PX: f64 = 1.9;

/// A maximum that counts.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Significant {
    /// The shift, px.
    pub place: Place,
    /// The correlation there.
    pub height: f64,
    /// That height over the largest at this distance or beyond, 0.5 to 1.
    pub share: f64,
    /// Distance to the nearest higher maximum, px.
    pub dominance_px: f64,
}

/// The maxima that count, one of d and −d each, nearest first.
#[derive(Debug, Clone)]
pub struct SignificantMaxima {
    all: Vec<Significant>,
    fading_px: f64,
}

impl SignificantMaxima {
    /// Chooses them.
    pub fn of(maxima: &Maxima, rho: &Autocorrelation) -> Self {
        let max = 0.98 * rho.radius();
        let is_candidate = |place: Place| {
            let distance = length(place);
            is_half(place) && (SHORTEST_PX..=max).contains(&distance)
        };
        let chosen = maxima.all().iter().filter(|m| is_candidate(m.place));
        let mut near: Vec<_> = chosen.collect();
        near.sort_by(|a, b| length(a.place).total_cmp(&length(b.place)));
        let mut highest_beyond = vec![0.0_f64; near.len()];
        let mut highest = 0.0_f64;
        for (maximum, beyond) in near.iter().zip(&mut highest_beyond).rev() {
            highest = highest.max(maximum.height);
            *beyond = highest;
        }
        let mut fading_px = 0.0;
        let mut all = Vec::new();
        for maximum in &near {
            let distance = length(maximum.place);
            let from = near.partition_point(|m| length(m.place) < AT_LEAST * distance);
            let envelope = highest_beyond[from];
            if envelope >= 0.4 * highest {
                fading_px = distance;
            }
            let share = maximum.height / envelope;
            if share >= MIN_SHARE && all.len() < MOST {
                all.push(Significant {
                    place: maximum.place,
                    height: maximum.height,
                    share,
                    dominance_px: maximum.dominance_px,
                });
            }
        }
        Self { all, fading_px }
    }

    /// All of them, nearest first.
    pub fn all(&self) -> &[Significant] {
        &self.all
    }

    /// The distance of the farthest, px.
    pub(crate) fn reach_px(&self) -> f64 {
        self.all.last().map_or(0.0, |m| length(m.place))
    }

    /// The distance beyond which no maximum is 0.4 times as high as the highest, px.
    pub(crate) fn fading_px(&self) -> f64 {
        self.fading_px
    }
}
