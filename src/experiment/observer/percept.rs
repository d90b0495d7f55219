//! Where a stimulus lies in what an observer feels, in just noticeable differences along each
//! coordinate, and what a look at it makes of that.

use super::scale::{Jnd, NOISE_JND};
use crate::named::named;
use selvedge_foundation::numerics::Random;
use selvedge_foundation::quantity::level_db;
use selvedge_statistics::Summary;
use selvedge_textile::surface::Direction;
use selvedge_textile::tactile::{Band, Levels};

named! { "strategy",
    /// What an observer goes by. Each cue has a noise of its own, as if it were looked at by
    /// itself.
    ///
    /// The array has two bands, so there are no others to go by. A coordinate that compares two
    /// levels is divided by √2, since the noise of a difference is √2 that of a level: all
    /// coordinates have the same noise. That cues beyond the levels are told apart by the same just
    /// noticeable difference is assumed: nothing is published for them.
    #[derive(Default)]
    pub enum Strategy {
        /// Nothing: guesses.
        None = "none",
        /// The mean levels of both bands.
        #[default]
        LevelOnly = "level",
        /// Levels, and the balance of the bands: one level over the other.
        Spectrum = "spectrum",
        /// Levels, and how they vary from place to place: the level a standard deviation above
        /// the mean amplitude over that of the mean, by band.
        Space = "space",
        /// Levels, and how they differ from direction to direction: warp over weft, by band.
        Direction = "direction",
        /// All of these.
        All = "all",
    }
}

impl Strategy {
    /// The place of a stimulus of these levels with so much added to both bands, dB: one number a
    /// coordinate, in just noticeable differences; none for [`Strategy::None`].
    pub fn place(self, jnd: Jnd, levels: &Levels, gains_db: [f64; 2]) -> Vec<f64> {
        let steps = |band: Band, um: f64| {
            let b = band.index();
            jnd.steps(band, level_db(um) + gains_db[b])
        };
        let mean = |band: Band| steps(band, levels.mean_um[band.index()]);
        let [low, high] = Band::ALL.map(mean);
        let goes_by = |cue: Self| self == cue || self == Self::All;
        let mut place = Vec::new();
        if self != Self::None {
            place.extend([low, high]);
        }
        if goes_by(Self::Spectrum) {
            place.push(compared(high, low));
        }
        if goes_by(Self::Space) {
            place.extend(Band::ALL.map(|band| {
                let b = band.index();
                let raised = steps(band, levels.mean_um[b] * (1.0 + levels.cv[b]));
                compared(raised, mean(band))
            }));
        }
        if goes_by(Self::Direction) {
            place.extend(Band::ALL.map(|band| {
                let along = |to: Direction, fro: Direction| {
                    let um = |direction: Direction| {
                        levels.direction_mean_um[direction.index()][band.index()]
                    };
                    steps(band, 0.5 * (um(to) + um(fro)))
                };
                let warp = along(Direction::WarpForward, Direction::WarpReverse);
                compared(warp, along(Direction::WeftForward, Direction::WeftReverse))
            }));
        }
        place
    }
}

fn compared(one: f64, other: f64) -> f64 {
    (one - other) * std::f64::consts::FRAC_1_SQRT_2
}

/// One look: the place with the noise of each coordinate, `times` that of a fresh look.
pub(super) fn look(place: &[f64], times: f64, random: &mut Random) -> Vec<f64> {
    let noisy = |x: &f64| x + times * NOISE_JND * random.normal();
    place.iter().map(noisy).collect()
}

/// How far apart two percepts are, in just noticeable differences, each coordinate by its weight.
pub(super) fn distance(one: &[f64], other: &[f64], weights: &[f64]) -> f64 {
    let squares = one.iter().zip(other).map(|(a, b)| (a - b).powi(2));
    let weighted = squares.zip(weights).map(|(square, weight)| square * weight);
    weighted.sum::<f64>().sqrt()
}

named! { "weighting",
    /// What each coordinate counts in a distance.
    #[derive(Default)]
    pub enum Weighting {
        /// As much as any other.
        #[default]
        Equal = "equal",
        /// As much as it tells, which who knows the stimuli has learnt: the variance of the
        /// stimuli along it over that of noisy looks at them. It is what the ratio of likelihoods
        /// of "the same" and "another of these" weighs squares with, were the stimuli spread
        /// normally.
        Learnt = "learnt",
    }
}

impl Weighting {
    /// By coordinate, for stimuli at these places and looks with `times` the noise of one.
    pub(super) fn weights(self, places: &[Vec<f64>], times: f64) -> Vec<f64> {
        let n = places.first().map_or(0, Vec::len);
        let noise = (times * NOISE_JND).powi(2);
        let weight = |axis: usize| {
            let along: Vec<f64> = places.iter().map(|place| place[axis]).collect();
            let spread = Summary::of(&along).map_or(0.0, |summary| summary.sd.powi(2));
            match self {
                Self::Equal => 1.0,
                Self::Learnt => spread / (spread + noise),
            }
        };
        (0..n).map(weight).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn levels() -> Levels {
        Levels {
            mean_um: [10.0, 5.0],
            cv: [0.5, 0.0],
            anisotropy_db: [0.0; 2],
            direction_mean_um: [[15.0, 5.0], [15.0, 5.0], [5.0, 5.0], [5.0, 5.0]],
        }
    }

    #[test]
    fn every_strategy_has_the_coordinates_of_its_cues() {
        let n = Strategy::ALL.map(|s| s.place(Jnd::Published, &levels(), [0.0; 2]).len());
        assert_eq!(n, [0, 2, 3, 4, 4, 7]);
    }

    #[test]
    fn with_a_constant_difference_coordinates_are_decibels_over_it() {
        let jnd = Jnd::Fixed([2.0, 2.0]);
        let place = |gains_db| Strategy::All.place(jnd, &levels(), gains_db);
        let (plain, louder) = (place([0.0; 2]), place([4.0, 0.0]));
        assert!((louder[0] - plain[0] - 2.0).abs() < 1e-12, "4 dB are two");
        assert_eq!(louder[1], plain[1]);
        let balance = (louder[2] - plain[2]) * 2.0_f64.sqrt();
        assert!((balance + 2.0).abs() < 1e-12, "{balance}");
        let raised_db = level_db(1.5) / 2.0 / 2.0_f64.sqrt();
        assert!((plain[3] - raised_db).abs() < 1e-12, "{plain:?}");
        assert_eq!(plain[4], 0.0, "the same everywhere");
        let across = level_db(3.0) / 2.0 / 2.0_f64.sqrt();
        assert!((plain[5] - across).abs() < 1e-12, "{plain:?}");
        assert_eq!(plain[6], 0.0, "the same both ways");
    }

    #[test]
    fn what_is_learnt_is_to_leave_out_what_tells_nothing() {
        let places = [[-10.0, 3.0], [0.0, 3.0], [10.0, 3.0]].map(Vec::from);
        assert_eq!(Weighting::Equal.weights(&places, 1.0), [1.0, 1.0]);
        let learnt = Weighting::Learnt.weights(&places, 1.0);
        assert_eq!(learnt[1], 0.0);
        let expected = 100.0 / (100.0 + NOISE_JND.powi(2));
        assert!((learnt[0] - expected).abs() < 1e-12, "{learnt:?}");
        assert_eq!(distance(&[0.0, 9.0], &[4.0, -9.0], &[0.25, 0.0]), 2.0);
    }

    #[test]
    fn silence_lies_at_nothing() {
        let silent = Levels {
            mean_um: [0.0; 2],
            cv: [0.0; 2],
            anisotropy_db: [0.0; 2],
            direction_mean_um: [[0.0; 2]; 4],
        };
        let place = Strategy::All.place(Jnd::Published, &silent, [f64::NEG_INFINITY, 20.0]);
        assert_eq!(place, [0.0; 7]);
    }
}
