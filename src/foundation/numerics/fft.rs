//! Discrete Fourier transforms: the one home of the FFT crate.
//!
//! [`RealTransform`] is the plain DFT of real samples; [`ChirpTransform`] evaluates it at any
//! uniform spacing, by Bluestein's identity. Neither scales: `X_k = Σ_i x_i e^{−2πi·k·δ·i}`.

use std::f64::consts::TAU;
use std::sync::Arc;

use realfft::num_complex::Complex as AnyComplex;
use realfft::{ComplexToReal, RealFftPlanner, RealToComplex};

/// A complex number in double precision.
pub type Complex = AnyComplex<f64>;

/// The DFT of a fixed number of real samples, both ways. Plans are made once and can be cloned.
#[derive(Clone)]
pub struct RealTransform {
    forward: Arc<dyn RealToComplex<f64>>,
    inverse: Arc<dyn ComplexToReal<f64>>,
}

impl RealTransform {
    /// The transform of `n` real samples.
    pub fn new(n: usize) -> Self {
        let mut planner = RealFftPlanner::new();
        Self {
            forward: planner.plan_fft_forward(n),
            inverse: planner.plan_fft_inverse(n),
        }
    }

    /// Number of samples.
    pub fn len(&self) -> usize {
        self.forward.len()
    }

    /// Whether it transforms no samples at all.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// `X_k`, k = 0 … ⌊n/2⌋, of the first `n` samples (missing ones count as 0).
    pub fn forward(&self, samples: &[f64]) -> Vec<Complex> {
        let mut input = self.forward.make_input_vec();
        let given = samples.len().min(input.len());
        input[..given].copy_from_slice(&samples[..given]);
        let mut output = self.forward.make_output_vec();
        let done = self.forward.process(&mut input, &mut output);
        debug_assert!(done.is_ok(), "buffers come from the plan");
        output
    }

    /// The samples whose forward transform is `spectrum` (with the factor 1/n).
    pub fn inverse(&self, spectrum: &[Complex]) -> Vec<f64> {
        let mut input = self.inverse.make_input_vec();
        let given = spectrum.len().min(input.len());
        input[..given].copy_from_slice(&spectrum[..given]);
        input[0].im = 0.0;
        if self.len().is_multiple_of(2)
            && let Some(last) = input.last_mut()
        {
            last.im = 0.0;
        }
        let mut output = self.inverse.make_output_vec();
        let done = self.inverse.process(&mut input, &mut output);
        debug_assert!(done.is_ok(), "buffers come from the plan");
        let scale = 1.0 / self.len() as f64;
        for x in &mut output {
            *x *= scale;
        }
        output
    }

    /// Room to work in for [`Self::forward_into`] and [`Self::inverse_into`], to be used again.
    pub fn room(&self) -> Vec<Complex> {
        let n = self
            .forward
            .get_scratch_len()
            .max(self.inverse.get_scratch_len());
        vec![Complex::default(); n]
    }

    /// [`Self::forward`] without holding anything new. `samples` (as many as the transform has) are
    /// destroyed; `spectrum` holds ⌊n/2⌋ + 1 bins.
    pub(crate) fn forward_into(
        &self,
        samples: &mut [f64],
        spectrum: &mut [Complex],
        room: &mut [Complex],
    ) {
        let room = &mut room[..self.forward.get_scratch_len()];
        let done = self.forward.process_with_scratch(samples, spectrum, room);
        debug_assert!(done.is_ok(), "the caller's buffers have the plan's lengths");
    }

    /// [`Self::inverse`] without holding anything new. `spectrum` is destroyed.
    pub(crate) fn inverse_into(
        &self,
        spectrum: &mut [Complex],
        samples: &mut [f64],
        room: &mut [Complex],
    ) {
        spectrum[0].im = 0.0;
        if self.len().is_multiple_of(2)
            && let Some(last) = spectrum.last_mut()
        {
            last.im = 0.0;
        }
        let room = &mut room[..self.inverse.get_scratch_len()];
        let done = self.inverse.process_with_scratch(spectrum, samples, room);
        debug_assert!(done.is_ok(), "the caller's buffers have the plan's lengths");
        let scale = 1.0 / self.len() as f64;
        for x in samples {
            *x *= scale;
        }
    }
}

impl std::fmt::Debug for RealTransform {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("RealTransform")
            .field("len", &self.len())
            .finish()
    }
}

/// The Fourier sum of `n_samples` real samples at `n_bins` frequencies k·δ, k = 0 … `n_bins` − 1,
/// where δ is any number of cycles a sample.
///
/// Bluestein: `ki = (k² + i² − (k − i)²)/2` turns the sum into a convolution with a chirp, done by
/// FFTs of at least `n_samples + n_bins` points: O((n + b) log (n + b)) instead of O(n b).
/// Error: about 1e-13 of Σ|x| for up to 10⁴ samples, from the phases `δk²/2 mod 1`.
#[derive(Debug, Clone)]
pub struct ChirpTransform {
    n_samples: usize,
    n_bins: usize,
    chirp: Vec<Complex>,
    kernel: (Vec<Complex>, Vec<Complex>),
    transform: RealTransform,
}

impl ChirpTransform {
    /// The transform for a spacing of `cycles_per_sample` between bins.
    pub fn new(n_samples: usize, n_bins: usize, cycles_per_sample: f64) -> Self {
        let reach = n_samples.max(n_bins);
        let chirp: Vec<Complex> = (0..reach)
            .map(|i| {
                let half_square = (i as f64) * (i as f64) * 0.5 * cycles_per_sample;
                Complex::from_polar(1.0, -TAU * half_square.fract())
            })
            .collect();
        let size = (n_samples + n_bins).next_power_of_two();
        let transform = RealTransform::new(size);
        let mut kernel = vec![Complex::default(); size];
        for i in 0..n_bins {
            kernel[i] = chirp[i].conj();
        }
        for i in 1..n_samples {
            kernel[size - i] = chirp[i].conj();
        }
        let kernel = transform_parts(&transform, &kernel);
        Self {
            n_samples,
            n_bins,
            chirp,
            kernel,
            transform,
        }
    }

    /// `X_k = Σ_i x_i e^{−2πi·k·δ·i}`, k = 0 … `n_bins` − 1; missing samples count as 0.
    pub fn forward(&self, samples: &[f64]) -> Vec<Complex> {
        let mut turned = vec![Complex::default(); self.transform.len()];
        for (i, &x) in samples.iter().take(self.n_samples).enumerate() {
            turned[i] = self.chirp[i] * x;
        }
        let (re, im) = transform_parts(&self.transform, &turned);
        // The convolution of two complex sequences from the transforms of their real parts.
        let products = |a: &[Complex], b: &[Complex]| -> Vec<Complex> {
            a.iter().zip(b).map(|(x, y)| x * y).collect()
        };
        let part = |spectrum: &[Complex]| self.transform.inverse(spectrum);
        let real = minus(
            &products(&re, &self.kernel.0),
            &products(&im, &self.kernel.1),
        );
        let imaginary = plus(
            &products(&re, &self.kernel.1),
            &products(&im, &self.kernel.0),
        );
        let (real, imaginary) = (part(&real), part(&imaginary));
        (0..self.n_bins)
            .map(|k| self.chirp[k] * Complex::new(real[k], imaginary[k]))
            .collect()
    }
}

/// The transforms of the real and of the imaginary parts.
fn transform_parts(transform: &RealTransform, x: &[Complex]) -> (Vec<Complex>, Vec<Complex>) {
    let real: Vec<f64> = x.iter().map(|z| z.re).collect();
    let imaginary: Vec<f64> = x.iter().map(|z| z.im).collect();
    (transform.forward(&real), transform.forward(&imaginary))
}

fn minus(a: &[Complex], b: &[Complex]) -> Vec<Complex> {
    a.iter().zip(b).map(|(x, y)| x - y).collect()
}

fn plus(a: &[Complex], b: &[Complex]) -> Vec<Complex> {
    a.iter().zip(b).map(|(x, y)| x + y).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numerics::Random;

    fn sum_at(samples: &[f64], cycles_per_sample: f64) -> Complex {
        let term = |(i, &x): (usize, &f64)| {
            Complex::from_polar(1.0, -TAU * (cycles_per_sample * i as f64).fract()) * x
        };
        samples.iter().enumerate().map(term).sum()
    }

    #[test]
    fn forward_matches_the_sum_and_inverse_undoes_it() {
        let mut random = Random::new(3);
        let samples: Vec<f64> = (0..30).map(|_| random.normal()).collect();
        let transform = RealTransform::new(30);
        let spectrum = transform.forward(&samples);
        for (k, x) in spectrum.iter().enumerate() {
            assert!(
                (x - sum_at(&samples, k as f64 / 30.0)).norm() < 1e-12,
                "bin {k}"
            );
        }
        for (a, b) in transform.inverse(&spectrum).iter().zip(&samples) {
            assert!((a - b).abs() < 1e-13, "{a} against {b}");
        }
    }

    #[test]
    fn chirp_matches_the_sum_at_any_spacing() {
        let mut random = Random::new(4);
        for (n, bins, spacing) in [(870, 500, 0.001_149), (9, 500, 0.11), (4000, 501, 0.000_25)] {
            let samples: Vec<f64> = (0..n).map(|_| random.normal()).collect();
            let spectrum = ChirpTransform::new(n, bins, spacing).forward(&samples);
            assert_eq!(spectrum.len(), bins);
            for (k, x) in spectrum.iter().enumerate() {
                let error = (x - sum_at(&samples, k as f64 * spacing)).norm();
                assert!(error < 1e-10, "{n} samples, bin {k}: {error}");
            }
        }
    }
}
