//! How strong a textile is as a whole: mean amplitudes of both bands at a set speed, and how much
//! they vary from place to place and from direction to direction.

use super::{Band, Filters, SpeedResponse};
use crate::surface::{Direction, Surface};
use selvedge_foundation::quantity::level_db;

/// The speed along one axis at which levels are taken, mm/s.
pub const LEVEL_SPEED_MM_PER_S: f64 = 100.0;

/// Figures over all points of all four principal directions, by [`Band::index`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Levels {
    /// Mean amplitude, µm peak.
    pub mean_um: [f64; 2],
    /// Coefficient of variation: population standard deviation over mean; 0 when silent.
    pub cv: [f64; 2],
    /// `20 log₁₀` of the largest over the smallest of the four directional means, dB; 0 when all
    /// are silent.
    pub anisotropy_db: [f64; 2],
    /// Mean amplitude by [`Direction::index`], µm peak.
    pub direction_mean_um: [[f64; 2]; 4],
}

impl Levels {
    /// The levels of a surface heard through `filters`, at [`LEVEL_SPEED_MM_PER_S`].
    pub fn of(surface: &Surface, filters: &Filters) -> Self {
        Self::at(LEVEL_SPEED_MM_PER_S, surface, filters)
    }

    /// The same figures at another speed along one axis, mm/s; all zero at one that is not felt.
    pub fn at(speed_mm_per_s: f64, surface: &Surface, filters: &Filters) -> Self {
        let response = SpeedResponse::at(speed_mm_per_s, filters);
        let by_direction = Direction::ALL.map(|direction| {
            let spectra = surface.spectra(direction);
            let at = |point| response.squared_amplitudes_um2(spectra.powers_um2(point));
            (0..spectra.n_points())
                .map(|point| at(point).map(f64::sqrt))
                .collect::<Vec<_>>()
        });
        Self::of_amplitudes(&by_direction)
    }

    /// The figures of amplitudes `[A40, A320]` in µm along the four principal directions.
    pub fn of_amplitudes(by_direction: &[Vec<[f64; 2]>; 4]) -> Self {
        let mut levels = Self {
            mean_um: [0.0; 2],
            cv: [0.0; 2],
            anisotropy_db: [0.0; 2],
            direction_mean_um: [[0.0; 2]; 4],
        };
        for b in Band::ALL.map(Band::index) {
            let of_band = |points: &[[f64; 2]]| points.iter().map(|a| a[b]).collect::<Vec<_>>();
            let all: Vec<f64> = by_direction
                .iter()
                .flat_map(|points| of_band(points))
                .collect();
            let (mean, deviation) = mean_and_deviation(&all);
            levels.mean_um[b] = mean;
            let means = by_direction
                .each_ref()
                .map(|points| mean_and_deviation(&of_band(points)).0);
            for (of_direction, mean) in levels.direction_mean_um.iter_mut().zip(means) {
                of_direction[b] = mean;
            }
            if mean > 0.0 {
                levels.cv[b] = deviation / mean;
                let largest = means.into_iter().fold(0.0, f64::max);
                let smallest = means.into_iter().fold(f64::INFINITY, f64::min);
                levels.anisotropy_db[b] = level_db(largest / smallest);
            }
        }
        levels
    }

    /// The level `½(20 log₁₀ Ā40 + 20 log₁₀ Ā320)`, dB re 1 µm; `None` when either band is silent.
    pub fn level_db(&self) -> Option<f64> {
        level_of_means(self.mean_um)
    }
}

/// Speeds along one axis at which the loudest amplitudes are looked for, mm/s.
const PEAK_SPEEDS_MM_PER_S: [f64; 5] = [25.0, 50.0, 100.0, 200.0, 400.0];

/// The loudest pairs of amplitudes `[A40, A320]` of a surface, µm peak: over all points, the four
/// principal directions and speeds from 25 to 400 mm/s, those that no other pair beats in both.
pub fn loudest_um(surface: &Surface, filters: &Filters) -> Vec<[f64; 2]> {
    let mut loudest: Vec<[f64; 2]> = Vec::new();
    for speed_mm_per_s in PEAK_SPEEDS_MM_PER_S {
        let response = SpeedResponse::at(speed_mm_per_s, filters);
        for direction in Direction::ALL {
            let spectra = surface.spectra(direction);
            for point in 0..spectra.n_points() {
                let powers = spectra.powers_um2(point);
                let pair = response.squared_amplitudes_um2(powers).map(f64::sqrt);
                let beats =
                    |one: &[f64; 2], other: &[f64; 2]| one[0] >= other[0] && one[1] >= other[1];
                if !loudest.iter().any(|known| beats(known, &pair)) {
                    loudest.retain(|known| !beats(&pair, known));
                    loudest.push(pair);
                }
            }
        }
    }
    loudest
}

/// The level of two mean amplitudes in µm; `None` when either is 0 (or not a number).
pub(crate) fn level_of_means([low_um, high_um]: [f64; 2]) -> Option<f64> {
    let level = 0.5 * (level_db(low_um) + level_db(high_um));
    level.is_finite().then_some(level)
}

fn mean_and_deviation(values: &[f64]) -> (f64, f64) {
    let n = values.len() as f64;
    let mean = values.iter().sum::<f64>() / n;
    let variance = values.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / n;
    (mean, variance.sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::surface::{Profile, ProfileSet};

    fn surface(height: impl Fn(f64) -> f64) -> Surface {
        let heights = (0..4600).map(|i| height(f64::from(i) / 230.0)).collect();
        let mut profiles = ProfileSet::default();
        profiles[0] = Some(Profile::new(1.0 / 230.0, heights).unwrap());
        Surface::from_profiles(profiles, 0.0).unwrap()
    }

    #[test]
    fn a_sine_that_sounds_at_320_hz_has_its_amplitude_as_mean() {
        let sine = surface(|x_mm| 3.0 * (std::f64::consts::TAU * 3.2 * x_mm).sin());
        let levels = Levels::of(&sine, &Filters::default());
        // The main lobe is three bins of 23 Hz wide, so a little of it falls off the peak.
        assert!((levels.mean_um[1] / 3.0 - 1.0).abs() < 0.01, "{levels:?}");
        assert!(
            levels.cv[1] < 0.01 && levels.anisotropy_db[1] == 0.0,
            "{levels:?}"
        );
    }

    #[test]
    fn at_half_the_speed_a_finer_sine_sounds_at_the_same_frequency() {
        let sine =
            |per_mm: f64| surface(move |x_mm| 3.0 * (std::f64::consts::TAU * per_mm * x_mm).sin());
        let filters = Filters::default();
        let coarse = Levels::at(100.0, &sine(3.22), &filters);
        let fine = Levels::at(50.0, &sine(6.44), &filters);
        assert_eq!(coarse, Levels::of(&sine(3.22), &filters));
        assert!(
            (fine.mean_um[1] / coarse.mean_um[1] - 1.0).abs() < 0.01,
            "{fine:?} {coarse:?}"
        );
        assert_eq!(Levels::at(0.0, &sine(3.22), &filters).mean_um, [0.0; 2]);
    }

    #[test]
    fn the_loudest_pairs_are_of_the_speeds_at_which_each_band_hears_most() {
        let sine = surface(|x_mm| 3.0 * (std::f64::consts::TAU * 1.6 * x_mm).sin());
        let filters = Filters::default();
        let loudest = loudest_um(&sine, &filters);
        let most = |band: usize| loudest.iter().map(|pair| pair[band]).fold(0.0, f64::max);
        assert!(
            (most(0) / 3.0 - 1.0).abs() < 0.02,
            "40 Hz at 25 mm/s: {loudest:?}"
        );
        assert!(
            (most(1) / 3.0 - 1.0).abs() < 0.02,
            "320 Hz at 200 mm/s: {loudest:?}"
        );
        for at in [25.0, 50.0, 100.0, 200.0, 400.0] {
            let mean = Levels::at(at, &sine, &filters).mean_um;
            // No place is far from the mean of all.
            let is_under = |pair: &[f64; 2]| (0..2).all(|band| pair[band] >= 0.99 * mean[band]);
            assert!(loudest.iter().any(is_under), "{at} mm/s: {mean:?}");
        }
    }

    #[test]
    fn a_flat_textile_has_no_level() {
        let levels = Levels::of(&surface(|_| 4.0), &Filters::default());
        assert_eq!(levels.mean_um, [0.0; 2]);
        assert_eq!(levels.level_db(), None);
        assert_eq!(levels.cv, [0.0; 2]);
        assert_eq!(
            loudest_um(&surface(|_| 4.0), &Filters::default()),
            [[0.0; 2]]
        );
    }
}
