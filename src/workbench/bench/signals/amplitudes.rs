//! The spectrum of a stretch of a signal.

use std::f64::consts::TAU;

use selvedge_foundation::numerics::RealTransform;

/// Frequencies, Hz, and peak amplitudes of what changes in a signal of an even number of samples
/// that lasts so long, s, under a Hann window (periodic) whose gain is compensated.
pub(crate) fn hann_amplitudes(values: &[f64], span_s: f64) -> Vec<[f64; 2]> {
    let n = values.len();
    if n < 2 || span_s <= 0.0 {
        return Vec::new();
    }
    let mean = values.iter().sum::<f64>() / n as f64;
    let windowed: Vec<f64> = (values.iter().enumerate())
        .map(|(i, value)| (0.5 - 0.5 * (TAU * i as f64 / n as f64).cos()) * (value - mean))
        .collect();
    // The window's mean is a half.
    let scale = 4.0 / n as f64;
    let spectrum = RealTransform::new(n).forward(&windowed);
    let bins = spectrum.iter().enumerate();
    bins.map(|(bin, x)| [bin as f64 / span_s, scale * x.norm()])
        .collect()
}
