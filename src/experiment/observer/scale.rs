//! Levels on the scale of just noticeable differences.
//!
//! Fechner's sum over [`just_noticeable_db`] (Israr, Tan & Reed 2006; 6 dB at threshold): on this
//! scale one step is one just noticeable difference wherever it is taken, so that noise is the
//! same everywhere. A level is a whole step above nothing at its threshold, where two intervals
//! are told apart three times in four; one step below it nothing is felt.

use selvedge_textile::tactile::{Band, just_noticeable_db};

/// Contactors that vibrate together: all of the array that the studies used.
pub(super) const N_ACTIVE: usize = 24;
/// Standard deviation of one look in just noticeable differences: two looks one difference apart
/// are then in the right order three times in four, 1/(√2 Φ⁻¹(¾)).
pub(crate) const NOISE_JND: f64 = 1.048_358_082_507_530_5;
/// Levels above this are no longer told apart better, nor felt, dB above threshold.
const MOST_DB: f64 = 80.0;
/// Width of a cell of the sum, dB; the knots of the published curve lie between cells.
const CELL_DB: f64 = 0.5;

/// How small a difference of level is just noticed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Jnd {
    /// As published, by the level above threshold: 6 dB at it, 2.40 dB 20 dB and 2.18 dB 35 dB
    /// above it ([`just_noticeable_db`]).
    Published,
    /// The same at all levels, dB, at 40 and 320 Hz.
    Fixed([f64; 2]),
}

impl Jnd {
    /// The just noticeable difference so far above threshold, dB.
    pub(crate) fn at_db(self, band: Band, perceptual_level_db: f64) -> f64 {
        match self {
            Self::Published => just_noticeable_db(perceptual_level_db),
            Self::Fixed(db) => db[band.index()],
        }
    }

    /// How many just noticeable differences a level lies above nothing; 0 for what is not felt.
    pub fn steps(self, band: Band, level_db: f64) -> f64 {
        let perceptual_level_db = level_db - band.detection_threshold_db(N_ACTIVE);
        let at_threshold_db = self.at_db(band, 0.0);
        if perceptual_level_db.is_nan() || perceptual_level_db <= 0.0 {
            return (1.0 + perceptual_level_db / at_threshold_db).max(0.0);
        }
        let above_db = perceptual_level_db.min(MOST_DB);
        1.0 + match self {
            Self::Fixed(_) => above_db / at_threshold_db,
            Self::Published => self.sum(band, above_db),
        }
    }

    /// ∫ dL / JND(L) from threshold, by Simpson's rule cell by cell.
    fn sum(self, band: Band, above_db: f64) -> f64 {
        let density = |db: f64| 1.0 / self.at_db(band, db);
        let (mut from, mut sum) = (0.0, 0.0);
        while from < above_db {
            let to = above_db.min(from + CELL_DB);
            let middle = density(0.5 * (from + to));
            sum += (to - from) / 6.0 * (density(from) + 4.0 * middle + density(to));
            from += CELL_DB;
        }
        sum
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use selvedge_statistics::{normal_lower, normal_quantile};

    #[test]
    fn one_difference_is_told_apart_three_times_in_four() {
        let z = normal_quantile(0.75).unwrap();
        assert!(
            (NOISE_JND - 1.0 / (z * 2.0_f64.sqrt())).abs() < 1e-12,
            "{z}"
        );
        let share = normal_lower(1.0 / (NOISE_JND * 2.0_f64.sqrt()));
        assert!((share - 0.75).abs() < 1e-12, "{share}");
    }

    #[test]
    fn a_threshold_is_one_step_above_nothing() {
        for jnd in [Jnd::Published, Jnd::Fixed([2.0, 3.0])] {
            for band in Band::ALL {
                let threshold_db = band.detection_threshold_db(N_ACTIVE);
                assert_eq!(jnd.steps(band, threshold_db), 1.0);
                assert_eq!(jnd.steps(band, threshold_db - 6.0), 0.0);
                assert_eq!(jnd.steps(band, f64::NEG_INFINITY), 0.0);
            }
        }
    }

    #[test]
    fn steps_follow_the_logarithm_where_the_difference_falls_on_a_line() {
        // From 6 dB at threshold to 2.4 dB 20 dB above it: ln(6/2.4)/0.18 steps.
        let level_db = Band::Low.detection_threshold_db(N_ACTIVE) + 20.0;
        let steps = Jnd::Published.steps(Band::Low, level_db);
        let expected = 1.0 + (6.0_f64 / 2.4).ln() / 0.18;
        assert!((steps - expected).abs() < 1e-6, "{steps} and {expected}");
        let constant = Jnd::Fixed([2.0, 1.0]).steps(Band::Low, level_db);
        assert!((constant - 11.0).abs() < 1e-12, "{constant}");
    }

    #[test]
    fn more_is_never_fewer_steps() {
        let steps: Vec<f64> = (-60..120)
            .map(|db| Jnd::Published.steps(Band::High, f64::from(db)))
            .collect();
        assert!(steps.windows(2).all(|pair| pair[0] <= pair[1]), "{steps:?}");
        assert!(Jnd::Published.steps(Band::Low, f64::NAN).is_finite());
    }
}
