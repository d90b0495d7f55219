//! A height profile: heights at a uniform step along one stroke.
//!
//! No tilt is removed here: importers do that once, where they know the whole stroke.

use super::SurfaceError;
use super::band::without_long_waves;
use super::error::MAX_HEIGHT_UM;
use super::friction::mean_deviation;

/// The step of a Kawabata recording at 230 samples a mm; steps within 0.1 % of it count as it.
const KES_STEP_MM: f64 = 1.0 / 230.0;

/// Heights in µm at a uniform step in mm, in the order of travel.
#[derive(Debug, Clone, PartialEq)]
pub struct Profile {
    step_mm: f64,
    heights_um: Vec<f64>,
}

/// The profiles of a surface that were measured, by [`super::Direction::index`].
pub type ProfileSet = [Option<Profile>; 4];

impl Profile {
    /// A profile of heights in µm, `step_mm` apart. A step within 0.1 % of 1/230 mm is taken as
    /// exactly that.
    ///
    /// # Errors
    /// A step outside 0.0005–0.5 mm, a height that is not finite or beyond
    /// ten thousand kilometres.
    pub fn new(step_mm: f64, heights_um: Vec<f64>) -> Result<Self, SurfaceError> {
        if !(0.0005..=0.5).contains(&step_mm) {
            return Err(SurfaceError::Step { step_mm });
        }
        let is_wrong = |height: &f64| !(-MAX_HEIGHT_UM..=MAX_HEIGHT_UM).contains(height);
        if let Some(index) = heights_um.iter().position(is_wrong) {
            let (row, n_rows, height_um) = (index + 1, heights_um.len(), heights_um[index]);
            return Err(if height_um.is_finite() {
                SurfaceError::TooHigh {
                    row,
                    n_rows,
                    height_um,
                }
            } else {
                SurfaceError::NotFinite {
                    row,
                    n_rows,
                    height_um,
                }
            });
        }
        let is_kes_step = (step_mm - KES_STEP_MM).abs() <= 0.001 * KES_STEP_MM;
        let step_mm = if is_kes_step { KES_STEP_MM } else { step_mm };
        Ok(Self {
            step_mm,
            heights_um,
        })
    }

    /// A profile of heights in µm at places in mm that rise evenly (each step within 1 % of the
    /// mean step).
    ///
    /// # Errors
    /// As [`Profile::new`]; uneven places; fewer than two samples.
    pub(crate) fn from_positions(x_mm: &[f64], heights_um: Vec<f64>) -> Result<Self, SurfaceError> {
        let n_samples = x_mm.len().min(heights_um.len());
        let too_short = SurfaceError::TooShort {
            n_samples,
            n_window: 1000,
        };
        let mean_mm = even_step_mm(x_mm, n_samples)?.ok_or(too_short)?;
        Self::new(mean_mm, heights_um)
    }

    /// The distance between neighbouring samples, mm.
    pub fn step_mm(&self) -> f64 {
        self.step_mm
    }

    /// The heights, µm, in the order of travel.
    pub fn heights_um(&self) -> &[f64] {
        &self.heights_um
    }

    /// The KES roughness figure: the mean absolute deviation from the mean height,
    /// `SMD = (1/n) Σ |T_i − T̄|`, µm. NaN of no samples.
    pub fn smd_um(&self) -> f64 {
        mean_deviation(&self.heights_um)
    }

    /// SMD without what varies over more than 1 mm, as the tester's circuit does: see
    /// [`without_long_waves`].
    pub fn smd_official_um(&self) -> f64 {
        mean_deviation(&without_long_waves(self.step_mm, &self.heights_um))
    }
}

/// The mean roughness SMD of strokes, µm.
pub fn smd_um(profiles: &ProfileSet) -> f64 {
    let smd_um: Vec<f64> = profiles.iter().flatten().map(Profile::smd_um).collect();
    smd_um.iter().sum::<f64>() / smd_um.len().max(1) as f64
}

/// The mean step of places in mm that rise evenly; `None` of less than two samples.
///
/// # Errors
/// A step more than 1 % off the mean.
pub(super) fn even_step_mm(x_mm: &[f64], n_samples: usize) -> Result<Option<f64>, SurfaceError> {
    let (&[first, .., last], true) = (x_mm, n_samples >= 2) else {
        return Ok(None);
    };
    let mean_mm = (last - first) / (n_samples - 1) as f64;
    let is_even = |pair: &[f64]| (pair[1] - pair[0] - mean_mm).abs() <= 0.01 * mean_mm;
    match x_mm.windows(2).position(|pair| !is_even(pair)) {
        None => Ok(Some(mean_mm)),
        Some(index) => Err(SurfaceError::Uneven {
            row: index + 2,
            n_rows: n_samples,
            step_mm: x_mm[index + 1] - x_mm[index],
            mean_mm,
        }),
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::{PI, TAU};

    use super::*;

    #[test]
    fn smd_of_a_sine_is_two_over_pi_of_its_amplitude() {
        let heights = (0..4600)
            .map(|i| 10.0 * (TAU * f64::from(i) / 230.0).sin() + 3.0)
            .collect();
        let profile = Profile::new(KES_STEP_MM, heights).unwrap();
        assert!(
            (profile.smd_um() - 20.0 / PI).abs() < 1e-3,
            "{}",
            profile.smd_um()
        );
    }

    #[test]
    fn a_step_near_the_kes_step_is_the_kes_step() {
        let x_mm: Vec<f64> = (0..1000)
            .map(|i| (f64::from(i) / 230.0 * 1e6).round() / 1e6)
            .collect();
        let profile = Profile::from_positions(&x_mm, vec![0.0; 1000]).unwrap();
        assert_eq!(profile.step_mm(), KES_STEP_MM);
        assert_eq!(Profile::new(0.005, vec![]).unwrap().step_mm(), 0.005);
    }

    #[test]
    fn what_is_wrong_is_refused_with_its_row() {
        let heights = vec![0.0, 1.0, f64::NAN];
        let error = Profile::new(0.01, heights).unwrap_err();
        assert!(
            error
                .to_string()
                .starts_with("row 3 of 3: the height is NaN"),
            "{error}"
        );
        for height in [1.1e13, -3.4e38, 1e300] {
            let error = Profile::new(0.01, vec![0.0, height]).unwrap_err();
            let text = error.to_string();
            assert!(
                text.starts_with("row 2 of 2: the height is ") && text.contains("check its unit"),
                "{text}"
            );
        }
        assert!(Profile::new(0.01, vec![1e13, -1e13]).is_ok());
        for step_mm in [0.0, 0.0004, 0.51, -1.0, f64::NAN, f64::INFINITY] {
            let error = Profile::new(step_mm, vec![]).unwrap_err();
            assert!(matches!(error, SurfaceError::Step { .. }), "{error}");
        }
        for x_mm in [
            [0.0, 0.1, 0.3],
            [0.0, 0.0, 0.0],
            [0.2, 0.1, 0.0],
            [0.0, f64::NAN, 0.2],
        ] {
            assert!(
                Profile::from_positions(&x_mm, vec![0.0; 3]).is_err(),
                "{x_mm:?}"
            );
        }
        assert!(
            Profile::from_positions(&[0.0], vec![0.0]).is_err(),
            "one sample has no step"
        );
    }
}
