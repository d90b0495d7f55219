//! The one scale on which amplitudes are drawn: 0.5 to 50 µm, logarithmic.
//!
//! Heatmaps, dots and colour bar share it, so that a colour or a size always means the same. It
//! never moves: 50 µm is the full scale of the output, 40 dB below it is hardly felt.

/// Lower end, µm.
const LEAST_UM: f64 = 0.5;
/// Upper end, µm.
const MOST_UM: f64 = 50.0;

/// The amplitudes that a colour bar names, µm.
pub(crate) const MARKS_UM: [f64; 7] = [0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 50.0];

/// Where an amplitude stands on the scale, 0…1; beyond its ends the nearest end, NaN at the lower.
pub(crate) fn share(amplitude_um: f64) -> f64 {
    let share = (amplitude_um / LEAST_UM).ln() / (MOST_UM / LEAST_UM).ln();
    share.clamp(0.0, 1.0).max(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_ends_of_the_scale_are_its_ends() {
        assert_eq!(share(LEAST_UM), 0.0);
        assert_eq!(share(MOST_UM), 1.0);
        assert!((share(5.0) - 0.5).abs() < 1e-12, "half way in dB");
        for silent in [0.0, f64::NAN, -1.0] {
            assert_eq!(share(silent), 0.0, "{silent}");
        }
        assert_eq!(share(f64::INFINITY), 1.0);
    }
}
