//! A model of what amplitudes feel like: levels above threshold, intensity, balance, differences
//! that are just noticed.
//!
//! It is a model, read off published averages, not a measurement of anybody's finger: thresholds
//! ±3 dB (after Verrillo and Gescheider), spatial summation of 3 dB a doubling of area in the
//! Pacinian channel alone, exponents of loudness 0.95 and 0.58 (after Stevens), half the weaker
//! channel added to the stronger (Hollins and Roy 1996), amplitude thresholds after Israr, Tan and
//! Reed (2006).

use super::Band;
use super::filters::threshold_db;
use selvedge_foundation::quantity::level_db;

/// Area of the contactor that thresholds were measured with, mm².
const MEASURED_AREA_MM2: f64 = 290.0;
/// Area of one contactor, mm²: a pin of 1 mm².
const CONTACTOR_AREA_MM2: f64 = 1.0;
/// How the threshold falls when the area doubles in the Pacinian channel, dB.
const SUMMATION_DB: f64 = 3.0;
/// Exponents of loudness over amplitude.
const EXPONENTS: [f64; 2] = [0.95, 0.58];
/// How much of the weaker channel's loudness is added to the stronger's.
const WEAKER_SHARE: f64 = 0.5;
/// Levels above threshold for which amplitude thresholds were measured, and these, dB: the means of
/// what was found between 2 and 300 Hz.
const JND_DB: [[f64; 2]; 2] = [[20.0, 2.40], [35.0, 2.18]];
/// The amplitude threshold at and near the detection threshold, dB.
const JND_AT_THRESHOLD_DB: f64 = 6.0;

/// What the amplitudes of a display feel like, by the model.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Perception {
    /// Levels of both bands above the threshold of the channel that each speaks to, dB; −∞ for
    /// silence.
    pub perceptual_level_db: [f64; 2],
    /// Loudness of the two channels; 0 below threshold, 1 at it.
    pub(crate) loudness: [f64; 2],
}

impl Band {
    /// The threshold of a band where `n_active` contactors sound, dB re 1 µm peak.
    pub fn detection_threshold_db(self, n_active: usize) -> f64 {
        let measured_db = threshold_db(self, self.carrier_hz());
        match self {
            Self::Low => measured_db,
            Self::High => {
                let area_mm2 = CONTACTOR_AREA_MM2 * n_active.max(1) as f64;
                measured_db + SUMMATION_DB * (MEASURED_AREA_MM2 / area_mm2).log2()
            }
        }
    }
}

/// The difference of level that is just noticed at a level above threshold, dB.
pub fn just_noticeable_db(perceptual_level_db: f64) -> f64 {
    let [[low_at, low], [high_at, high]] = JND_DB;
    let points = [[0.0, JND_AT_THRESHOLD_DB], [low_at, low], [high_at, high]];
    let at = perceptual_level_db.clamp(0.0, high_at).max(0.0);
    let (from, to) = if at < low_at {
        (points[0], points[1])
    } else {
        (points[1], points[2])
    };
    from[1] + (to[1] - from[1]) * (at - from[0]) / (to[0] - from[0])
}

/// How many contactors vibrate in either band, and their mean amplitudes [A40, A320], µm; zeros
/// when none does. What is no positive number is silence.
pub fn vibrating_mean_um(amplitudes_um: impl Iterator<Item = [f64; 2]>) -> (usize, [f64; 2]) {
    let (mut n, mut sum_um) = (0_usize, [0.0_f64; 2]);
    for um in amplitudes_um {
        let heard = um.map(|um| if um > 0.0 && um.is_finite() { um } else { 0.0 });
        if heard.iter().any(|um| *um > 0.0) {
            n += 1;
            sum_um = [sum_um[0] + heard[0], sum_um[1] + heard[1]];
        }
    }
    (n, sum_um.map(|sum| sum / n.max(1) as f64))
}

impl Perception {
    /// Of mean amplitudes [A40, A320] over `n_active` contactors, µm. What is no number is silence.
    pub fn of(mean_um: [f64; 2], n_active: usize) -> Self {
        let perceptual_level_db = Band::ALL.map(|band| {
            let um = mean_um[band.index()];
            let level = if um > 0.0 {
                level_db(um)
            } else {
                f64::NEG_INFINITY
            };
            level - band.detection_threshold_db(n_active)
        });
        let loudness = [0, 1].map(|band| {
            let above_db = perceptual_level_db[band];
            if above_db < 0.0 || above_db.is_nan() {
                0.0
            } else {
                10.0_f64.powf(EXPONENTS[band] * above_db / 20.0)
            }
        });
        Self {
            perceptual_level_db,
            loudness,
        }
    }

    /// How strong it feels as a whole: the stronger channel and half the weaker.
    pub fn intensity(&self) -> f64 {
        let [low, high] = self.loudness;
        low.max(high) + WEAKER_SHARE * low.min(high)
    }

    /// The share of the 320 Hz channel in what is felt, 0…1; `None` when nothing is.
    pub fn balance(&self) -> Option<f64> {
        let [low, high] = self.loudness;
        (low + high > 0.0).then(|| high / (low + high))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_pin_needs_more_at_320_hz_and_all_24_together_less() {
        let one = Band::High.detection_threshold_db(1);
        let all = Band::High.detection_threshold_db(24);
        assert!(
            (one - 5.5).abs() < 0.5,
            "{one} dB: −19 dB and 8.2 doublings of area"
        );
        assert!(
            (one - all - 3.0 * 24.0_f64.log2()).abs() < 1e-12,
            "{all} dB"
        );
        let low = [1, 24].map(|n| Band::Low.detection_threshold_db(n));
        assert_eq!(low, [8.0, 8.0], "no summation at 40 Hz");
    }

    #[test]
    fn the_mean_is_over_contactors_that_vibrate() {
        let amplitudes = [[2.0, 0.0], [4.0, 6.0], [0.0, 0.0], [f64::NAN, -1.0]];
        let mean = vibrating_mean_um(amplitudes.into_iter());
        assert_eq!(mean, (2, [3.0, 3.0]));
        assert_eq!(vibrating_mean_um(std::iter::empty()), (0, [0.0; 2]));
    }

    #[test]
    fn at_threshold_loudness_is_one_and_below_it_nothing_is_felt() {
        let threshold_um = Band::ALL.map(|b| 10.0_f64.powf(b.detection_threshold_db(24) / 20.0));
        let at = Perception::of(threshold_um.map(|um| um * (1.0 + 1e-9)), 24);
        for loudness in at.loudness {
            assert!((loudness - 1.0).abs() < 1e-6, "{at:?}");
        }
        assert!((at.intensity() - 1.5).abs() < 1e-6, "{at:?}");
        let below = Perception::of(threshold_um.map(|um| 0.9 * um), 24);
        assert_eq!((below.intensity(), below.balance()), (0.0, None));
        let nothing = Perception::of([f64::NAN, -1.0], 0);
        assert_eq!(nothing.intensity(), 0.0);
    }

    #[test]
    fn twenty_decibels_more_grow_by_the_exponents() {
        let quiet = Perception::of([10.0, 10.0], 24);
        let loud = Perception::of([100.0, 100.0], 24);
        let grown = [0, 1].map(|band| loud.loudness[band] / quiet.loudness[band]);
        assert!((grown[0] - 10.0_f64.powf(0.95)).abs() < 1e-9, "{grown:?}");
        assert!((grown[1] - 10.0_f64.powf(0.58)).abs() < 1e-9, "{grown:?}");
        assert!(
            quiet.balance().is_some_and(|share| share > 0.5),
            "{quiet:?}"
        );
    }

    #[test]
    fn differences_are_noticed_sooner_the_stronger_it_feels() {
        let noticed = [-10.0, 0.0, 10.0, 20.0, 35.0, 60.0].map(just_noticeable_db);
        assert!(
            noticed.windows(2).all(|pair| pair[0] >= pair[1]),
            "{noticed:?}"
        );
        assert_eq!((noticed[3], noticed[4], noticed[5]), (2.40, 2.18, 2.18));
        assert!(just_noticeable_db(f64::NAN).is_finite());
    }
}
