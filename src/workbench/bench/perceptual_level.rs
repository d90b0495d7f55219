//! What amplitudes feel like, in words and numbers for the screen: levels above the threshold of
//! detection, intensity, balance.
//!
//! All of it comes from the model of [`Perception`] and is marked as one. Nothing here ever reaches
//! what is rendered.

use crate::bench::gain_set::GainSet;
use crate::bench::mute_solo::MuteSolo;
use crate::bench::part::Part;
use crate::bench::view::{LibraryDot, SceneView};
use selvedge_foundation::quantity::{factor_of_gain, fixed, level_db, with_unit};
use selvedge_textile::tactile::{Band, Perception, Tuning, just_noticeable_db, vibrating_mean_um};

/// Where numbers above threshold come from, for tips.
pub(crate) const SOURCE: &str = "dB SL: above the threshold of detection. A model of published \
                                 averages, ±3 dB, not a measurement of anybody’s finger: “Above \
                                 threshold” in the guide to the workbench";

/// A level is matched by so much at most, dB.
const MOST_MATCH_DB: f64 = 60.0;
/// Halvings of that range: to a hundred-thousandth of a dB.
const N_HALVINGS: usize = 24;

/// What a display feels like at one tick.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct PerceptualLevel {
    /// Contactors that vibrate: the more, the lower the threshold at 320 Hz.
    pub n_vibrating: usize,
    /// Thresholds of detection of both bands, dB re 1 µm peak.
    pub threshold_db: [f64; 2],
    /// The display as a whole: of the mean over the contactors that vibrate.
    pub whole: Perception,
}

impl Default for PerceptualLevel {
    /// Of a display that is silent.
    fn default() -> Self {
        Self::of(std::iter::empty())
    }
}

impl PerceptualLevel {
    /// Of a display with these amplitudes [A40, A320], µm.
    pub(crate) fn of(amplitudes_um: impl Iterator<Item = [f64; 2]>) -> Self {
        let (n_vibrating, mean_um) = vibrating_mean_um(amplitudes_um);
        Self {
            n_vibrating,
            threshold_db: Band::ALL.map(|band| band.detection_threshold_db(n_vibrating)),
            whole: Perception::of(mean_um, n_vibrating),
        }
    }

    /// Levels of one contactor above the thresholds, dB; −∞ for silence.
    pub(crate) fn above_db(&self, amplitudes_um: [f64; 2]) -> [f64; 2] {
        [0, 1].map(|band| {
            let um = amplitudes_um[band];
            let level = if um > 0.0 {
                level_db(um)
            } else {
                f64::NEG_INFINITY
            };
            level - self.threshold_db[band]
        })
    }

    /// Whether each band of one contactor is too weak to be felt.
    pub(crate) fn is_below(&self, amplitudes_um: [f64; 2]) -> [bool; 2] {
        self.above_db(amplitudes_um).map(|above_db| above_db < 0.0)
    }

    /// A line for each band of one contactor: amplitude and level above threshold.
    pub(crate) fn band_lines(&self, amplitudes_um: [f64; 2]) -> String {
        let above = self.above_db(amplitudes_um).map(above_words);
        let [low, high] = amplitudes_um.map(|um| with_unit(um, 2, "µm"));
        let [above_low, above_high] = above;
        format!("40 Hz  {low}, {above_low}\n320 Hz  {high}, {above_high}\n(SL: a model)")
    }
}

/// A level above threshold: `−4.2 dB SL`; `silent` where there is none.
pub(crate) fn above_words(above_db: f64) -> String {
    if above_db.is_finite() {
        with_unit(above_db, 1, "dB SL")
    } else {
        "silent".to_owned()
    }
}

/// Intensity and balance: `intensity 4.2, 41 % of it at 320 Hz`.
pub(crate) fn felt_words(felt: &Perception) -> String {
    match felt.balance() {
        Some(balance) => {
            let share = with_unit(balance * 100.0, 0, "%");
            let intensity = fixed(felt.intensity(), 1);
            format!("intensity {intensity}, {share} at 320 Hz")
        }
        None => "nothing is felt".to_owned(),
    }
}

/// What a placed textile feels like on average at 100 mm/s with the gains in force, by all the
/// contactors of a display at once; `None` when nobody knows its level. What is muted is silent.
pub(crate) fn of_textile(
    scene: &SceneView,
    index: usize,
    (n_contactors, mute_solo): (usize, &MuteSolo),
) -> Option<Perception> {
    let gain_db = scene.cloths.get(index)?.gain_db;
    let mut tuned_um = mean_um(scene, index, (&scene.tuning, gain_db))?;
    for band in Band::ALL {
        let parts = [Part::Cloth(index), Part::Band(band)];
        if !parts.into_iter().all(|part| mute_solo.is_felt(part)) {
            tuned_um[band.index()] = 0.0;
        }
    }
    Some(Perception::of(tuned_um, n_contactors))
}

/// A placed textile's mean amplitudes at 100 mm/s by a tuning and a gain of the scene, µm; `None`
/// when nobody knows its level.
pub(crate) fn mean_um(
    scene: &SceneView,
    index: usize,
    (tuning, gain_db): (&Tuning, f64),
) -> Option<[f64; 2]> {
    let cloth = scene.cloths.get(index)?;
    let dot = scene.library.iter().find(|dot| dot.id == cloth.id)?;
    let factors = tuned_factors(scene, dot, (tuning, gain_db));
    let own = cloth.band_gains_db.map(factor_of_gain);
    Some([0, 1].map(|band| dot.mean_um[band] * factors[band] * own[band]))
}

/// What a tuning and a gain of the scene make of amplitudes of a textile of the library, by band.
pub(crate) fn tuned_factors(
    scene: &SceneView,
    dot: &LibraryDot,
    (tuning, gain_db): (&Tuning, f64),
) -> [f64; 2] {
    let compressed = |reference_db| tuning.compression_gain_db(Some(dot.level_db), reference_db);
    let own_db = dot.gain_db + gain_db + scene.reference_db.map_or(0.0, compressed);
    Band::ALL.map(|band| factor_of_gain(tuning.band_gain_db(band) + own_db))
}

/// The scene's textiles as strong as `like` makes them, by the master gain alone, by the
/// mean of the model's intensity over them. As they are, where nothing is felt.
pub(crate) fn as_strong(
    scene: &SceneView,
    mut gains: GainSet,
    like: &GainSet,
    n_contactors: usize,
) -> GainSet {
    let intensity = |gains: &GainSet| -> f64 {
        let own = gains.gains_db.iter().enumerate();
        let felt = own.filter_map(|(index, gain_db)| {
            let um = mean_um(scene, index, (&gains.tuning, *gain_db))?;
            Some(Perception::of(um, n_contactors).intensity())
        });
        felt.sum()
    };
    let wanted = intensity(like);
    if intensity(&gains) <= 0.0 || wanted <= 0.0 {
        return gains;
    }
    let asked_db = gains.tuning.gain_db;
    let (mut low_db, mut high_db) = (-MOST_MATCH_DB, MOST_MATCH_DB);
    for _ in 0..N_HALVINGS {
        let by_db = 0.5 * (low_db + high_db);
        gains.tuning.gain_db = asked_db + by_db;
        if intensity(&gains) < wanted {
            low_db = by_db;
        } else {
            high_db = by_db;
        }
    }
    gains
}

/// The change of gain that is just noticed: of one band, or of both at once, where the more
/// sensitive channel notices first, dB; `None` when nothing sounds.
pub(crate) fn noticed_db(felt: &Perception, band: Option<Band>) -> Option<f64> {
    let bands = Band::ALL
        .into_iter()
        .filter(|b| band.is_none_or(|band| band == *b));
    let heard = bands.map(|band| felt.perceptual_level_db[band.index()]);
    let heard = heard.filter(|above_db| above_db.is_finite());
    heard.map(just_noticeable_db).min_by(f64::total_cmp)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_contactor_is_below_threshold_where_its_level_is() {
        // Alone at 40 Hz the threshold is 8 dB re 1 µm: 2.51 µm.
        let perceptual_level = PerceptualLevel::of([[2.6, 0.0], [2.4, 0.0]].into_iter());
        assert_eq!(perceptual_level.n_vibrating, 2);
        assert_eq!(perceptual_level.is_below([2.6, 0.0]), [false, true]);
        assert_eq!(perceptual_level.is_below([2.4, 1.7]), [true, false]);
        assert_eq!(perceptual_level.is_below([f64::NAN, 0.0]), [true, true]);
        let lines = perceptual_level.band_lines([10.0, 0.0]);
        let expected = "40 Hz  10.00 µm, 12.0 dB SL\n320 Hz  0.00 µm, silent\n(SL: a model)";
        assert_eq!(lines, expected);
    }

    #[test]
    fn the_more_contactors_vibrate_the_less_each_needs_at_320_hz() {
        let few = PerceptualLevel::of(std::iter::repeat_n([1.0, 1.0], 3));
        let many = PerceptualLevel::of(std::iter::repeat_n([1.0, 1.0], 24));
        assert_eq!(few.threshold_db[0], many.threshold_db[0]);
        let fell_db = few.threshold_db[1] - many.threshold_db[1];
        assert!(
            (fell_db - 9.0).abs() < 1e-9,
            "{fell_db} dB: three doublings"
        );
    }

    #[test]
    fn silence_is_told_in_words() {
        let silent = PerceptualLevel::default();
        assert_eq!(felt_words(&silent.whole), "nothing is felt");
        assert_eq!(noticed_db(&silent.whole, None), None);
        assert_eq!(above_words(f64::NEG_INFINITY), "silent");
    }

    #[test]
    fn of_both_bands_the_more_sensitive_one_notices_first() {
        let felt = Perception::of([3.0, 30.0], 24);
        let [low, high] = Band::ALL.map(|band| noticed_db(&felt, Some(band)).unwrap());
        assert!(low > high, "40 Hz is weaker: {low} {high}");
        assert_eq!(noticed_db(&felt, None), Some(high));
        let words = felt_words(&felt);
        assert!(words.starts_with("intensity ") && words.ends_with("at 320 Hz"));
    }
}
