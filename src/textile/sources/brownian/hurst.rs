//! The Hurst exponent of lines over a surface, by the structure function, and how sure it is.

use selvedge_foundation::numerics::{LineFit, structure_function};

/// Lags, in samples, that the exponent is taken from.
const LAGS: [usize; 5] = [1, 2, 4, 8, 16];
/// Parts that a line is cut into to estimate the error.
const N_PARTS: usize = 8;

/// An exponent with its standard error.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hurst {
    /// The exponent: half the slope of the logarithm of the structure function over that of the
    /// lag, from 1 to 16 samples.
    pub exponent: f64,
    /// Its standard error, from the scatter between eighths of the lines.
    pub error: f64,
}

impl Hurst {
    /// The exponent of some lines of even samples; `None` if they are too short (128 samples in
    /// all parts) or level.
    pub(crate) fn of_lines(lines: &[&[f64]]) -> Option<Self> {
        let exponent = exponent(lines)?;
        let part = |index: usize| {
            let cut = |line: &&[f64]| {
                let n = line.len() / N_PARTS;
                index * n..(index + 1) * n
            };
            let parts: Vec<&[f64]> = lines.iter().map(|line| &line[cut(line)]).collect();
            self::exponent(&parts)
        };
        let parts: Vec<f64> = (0..N_PARTS).filter_map(part).collect();
        let n = parts.len() as f64;
        let mean = parts.iter().sum::<f64>() / n;
        let variance = parts.iter().map(|h| (h - mean).powi(2)).sum::<f64>() / (n - 1.0);
        Some(Self {
            exponent,
            error: (variance / n).sqrt(),
        })
        .filter(|found| found.error.is_finite())
    }

    /// The exponent of some lines together, of 17 samples or more; `None` if they are level.
    pub fn of_lines_whole(lines: &[&[f64]]) -> Option<f64> {
        exponent(lines)
    }
}

/// Half the slope of the structure function of the lines together.
fn exponent(lines: &[&[f64]]) -> Option<f64> {
    let point = |&lag: &usize| {
        let rises = lines.iter().map(|line| structure_function(line, lag));
        let mean = rises.sum::<f64>() / lines.len() as f64;
        [(lag as f64).ln(), mean.ln()]
    };
    let points: Vec<[f64; 2]> = LAGS.iter().map(point).collect();
    let fit = LineFit::through(&points)?;
    Some(0.5 * fit.slope)
}

#[cfg(test)]
mod tests {
    use super::*;
    use selvedge_foundation::numerics::Random;

    #[test]
    fn a_slope_has_exponent_1_and_a_walk_a_half() {
        let slope: Vec<f64> = (0..1000).map(f64::from).collect();
        let found = Hurst::of_lines(&[&slope]).unwrap();
        assert!(
            (found.exponent - 1.0).abs() < 1e-12 && found.error < 1e-9,
            "{found:?}"
        );
        let mut random = Random::new(3);
        let mut height = 0.0;
        let walk: Vec<f64> = (0..20_000)
            .map(|_| {
                height += random.normal();
                height
            })
            .collect();
        let found = Hurst::of_lines(&[&walk]).unwrap();
        assert!((found.exponent - 0.5).abs() < 0.03, "{found:?}");
        assert!(
            (found.exponent - 0.5).abs() < 4.0 * found.error,
            "{found:?}"
        );
    }

    #[test]
    fn what_is_level_short_or_nothing_has_none() {
        for line in [
            vec![],
            vec![1.0],
            vec![2.0; 1000],
            (0..20).map(f64::from).collect(),
        ] {
            assert_eq!(Hurst::of_lines(&[&line]), None, "{} samples", line.len());
        }
        assert_eq!(Hurst::of_lines(&[]), None);
    }
}
