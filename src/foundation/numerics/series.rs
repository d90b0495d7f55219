//! What a series of even samples says of itself: its line, its autocorrelation, its increments, and
//! where a straight line through points leads.

use super::RealTransform;

/// A straight line `y = offset + slope·x` by least squares, and how sure its slope is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LineFit {
    /// Height at x = 0.
    pub offset: f64,
    /// Rise a unit of x.
    pub slope: f64,
    /// Standard error of the slope if the points scatter independently; NaN of two points.
    pub slope_error: f64,
}

impl LineFit {
    /// The line through points with weights ≥ 0; `None` if they do not stand at two places.
    pub fn weighted(points: &[[f64; 2]], weights: &[f64]) -> Option<Self> {
        let both = || points.iter().zip(weights);
        let total: f64 = both().map(|(_, w)| w).sum();
        let mean = |of: usize| both().map(|(p, w)| p[of] * w).sum::<f64>() / total;
        let (x0, y0) = (mean(0), mean(1));
        let sxx: f64 = both().map(|(p, w)| w * (p[0] - x0).powi(2)).sum();
        let sxy: f64 = both().map(|(p, w)| w * (p[0] - x0) * (p[1] - y0)).sum();
        let is_placed = sxx > 0.0 && total > 0.0 && sxy.is_finite();
        let slope = is_placed.then(|| sxy / sxx)?;
        let rest = |p: &[f64; 2]| (p[1] - y0 - slope * (p[0] - x0)).powi(2);
        let left: f64 = both().map(|(p, w)| w * rest(p)).sum();
        let freedom = points.len() as f64 - 2.0;
        Some(Self {
            offset: y0 - slope * x0,
            slope,
            slope_error: (left / total * points.len() as f64
                / freedom
                / (sxx / total * points.len() as f64))
                .sqrt(),
        })
    }

    /// The line through points that all count alike.
    pub fn through(points: &[[f64; 2]]) -> Option<Self> {
        Self::weighted(points, &vec![1.0; points.len()])
    }
}

/// The series with its line of least squares taken off; a single sample becomes 0.
pub fn without_line(values: &[f64]) -> Vec<f64> {
    let points: Vec<[f64; 2]> = values
        .iter()
        .enumerate()
        .map(|(i, &y)| [i as f64, y])
        .collect();
    match LineFit::through(&points) {
        Some(fit) => points
            .iter()
            .map(|[x, y]| y - fit.offset - fit.slope * x)
            .collect(),
        None => vec![0.0; values.len()],
    }
}

/// The autocorrelation about the mean at lags 0 … n − 1, unbiased (divided by n − m), by
/// transforms of twice the length (Wiener–Khinchin): no end meets its beginning.
pub fn autocorrelation(values: &[f64]) -> Vec<f64> {
    let n = values.len();
    if n == 0 {
        return Vec::new();
    }
    let mean = values.iter().sum::<f64>() / n as f64;
    let mut padded = vec![0.0; (2 * n).next_power_of_two()];
    for (to, from) in padded.iter_mut().zip(values) {
        *to = from - mean;
    }
    let transform = RealTransform::new(padded.len());
    let mut spectrum = transform.forward(&padded);
    for x in &mut spectrum {
        *x = (x.norm_sqr()).into();
    }
    let sums = transform.inverse(&spectrum);
    let scaled = |(lag, sum): (usize, &f64)| sum / (n - lag) as f64;
    sums[..n].iter().enumerate().map(scaled).collect()
}

/// The structure function: mean square of the rise over `lag` samples. NaN where no pair is.
pub fn structure_function(values: &[f64], lag: usize) -> f64 {
    let pairs = values.iter().zip(values.iter().skip(lag));
    let (n, sum) = pairs.fold((0.0, 0.0), |(n, sum), (a, b)| {
        (n + 1.0, sum + (b - a).powi(2))
    });
    sum / n
}

/// Weights of the samples at −1, 0, 1 and 2 in the cubic between 0 and 1 (Catmull & Rom 1974).
pub fn catmull_rom(t: f64) -> [f64; 4] {
    let (t2, t3) = (t * t, t * t * t);
    [
        0.5 * (2.0 * t2 - t3 - t),
        0.5 * (3.0 * t3 - 5.0 * t2 + 2.0),
        0.5 * (4.0 * t2 - 3.0 * t3 + t),
        0.5 * (t3 - t2),
    ]
}

/// A sample between samples, by straight lines; beyond either end the end's. NaN of none.
pub fn at_place(values: &[f64], place: f64) -> f64 {
    let last = values.len().saturating_sub(1);
    let below = place.floor().clamp(0.0, last as f64);
    let i = super::to_index(below);
    let (Some(&a), b) = (values.get(i), values.get(i + 1)) else {
        return f64::NAN;
    };
    b.map_or(a, |b| a + (b - a) * (place - below).clamp(0.0, 1.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_is_found_and_taken_off() {
        let values: Vec<f64> = (0..50_u8).map(|i| 3.0 - 0.25 * f64::from(i)).collect();
        let points: Vec<[f64; 2]> = (0..50_u8)
            .map(|i| [f64::from(i), values[usize::from(i)]])
            .collect();
        let fit = LineFit::through(&points).unwrap();
        assert!(
            (fit.slope + 0.25).abs() < 1e-13 && (fit.offset - 3.0).abs() < 1e-12,
            "{fit:?}"
        );
        assert!(
            without_line(&values).iter().all(|y| y.abs() < 1e-12),
            "a line is left"
        );
        assert!(
            LineFit::through(&[[1.0, 2.0], [1.0, 3.0]]).is_none(),
            "one place"
        );
        assert_eq!(without_line(&[5.0]), [0.0]);
    }

    #[test]
    fn the_slopes_error_is_the_textbooks() {
        // y = 0, 1, 1, 2 at 0…3: slope 0.6, residual sum 0.2, error √(0.2/2/5).
        let points = [[0.0, 0.0], [1.0, 1.0], [2.0, 1.0], [3.0, 2.0]];
        let fit = LineFit::through(&points).unwrap();
        assert!((fit.slope - 0.6).abs() < 1e-14, "{fit:?}");
        assert!((fit.slope_error - 0.02_f64.sqrt()).abs() < 1e-14, "{fit:?}");
    }

    #[test]
    fn autocorrelation_is_the_mean_of_products() {
        let values = [1.0, -2.0, 4.0, 0.0, -3.0];
        let found = autocorrelation(&values);
        for (lag, r) in found.iter().enumerate() {
            let products: Vec<f64> = values
                .iter()
                .zip(&values[lag..])
                .map(|(a, b)| a * b)
                .collect();
            let mean = products.iter().sum::<f64>() / products.len() as f64;
            assert!((r - mean).abs() < 1e-12, "lag {lag}: {r} and {mean}");
        }
        assert!(autocorrelation(&[]).is_empty(), "nothing has no lags");
    }

    #[test]
    fn rises_over_a_lag_and_places_between_samples() {
        let values = [0.0, 1.0, 4.0, 9.0];
        assert_eq!(structure_function(&values, 1), (1.0 + 9.0 + 25.0) / 3.0);
        assert!(structure_function(&values, 4).is_nan(), "no pair");
        assert_eq!(at_place(&values, 1.5), 2.5);
        assert_eq!(at_place(&values, -1.0), 0.0);
        assert_eq!(at_place(&values, 7.0), 9.0);
        assert!(at_place(&[], 0.0).is_nan(), "no sample");
    }
}
