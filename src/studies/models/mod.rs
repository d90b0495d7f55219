//! Studies of surfaces that are made from numbers: Brownian generators, Fourier coefficients,
//! restoration, resampling, and the virtual probe that is drawn over any of them.
//!
//! Each is set beside a truth that is known: an exponent, a sum of waves, a formula.

mod brownian;
mod fourier;
mod probe;
mod resampling;
mod restoration;
#[cfg(test)]
mod tests;

pub(crate) use brownian::BrownianStudy;
pub(crate) use fourier::FourierStudy;
pub(crate) use probe::ProbeStudy;
pub(crate) use resampling::ResamplingStudy;
pub(crate) use restoration::RestorationStudy;

/// Root mean square.
fn rms(values: impl Iterator<Item = f64>) -> f64 {
    let (n, sum) = values.fold((0.0, 0.0), |(n, sum), x| (n + 1.0, sum + x * x));
    (sum / f64::max(n, 1.0)).sqrt()
}

/// Rms of the difference of two series as a share of the second's rms, %.
fn apart_percent(found: &[f64], truth: &[f64]) -> f64 {
    let pairs = found.iter().zip(truth);
    100.0 * rms(pairs.map(|(a, b)| a - b)) / rms(truth.iter().copied())
}
