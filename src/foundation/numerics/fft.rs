//! Discrete Fourier transforms: the one home of the FFT crate.
//!
//! [`RealTransform`] is the plain DFT of real samples; [`ChirpTransform`] evaluates it at any
//! uniform spacing, by Bluestein's identity. Neither scales: `X_k = Σ_i x_i e^{−2πi·k·δ·i}`.

use std::f64::consts::TAU;
use std::sync::Arc;

use rustfft::num_complex::Complex as AnyComplex;
use rustfft::{Fft, FftPlanner};

/// A complex number in double precision.
pub type Complex = AnyComplex<f64>;

/// The DFT of a fixed number of real samples, both ways. Plans are made once and can be cloned.
///
/// An even number of samples is transformed as half as many complex ones, `x_{2i} + i x_{2i+1}`,
/// whose spectrum is then taken apart: half the work of a complex transform.
#[derive(Clone)]
pub struct RealTransform {
    n: usize,
    forward: Arc<dyn Fft<f64>>,
    inverse: Arc<dyn Fft<f64>>,
    /// `e^{−2πi·k/n}` for the pairs of bins that are taken apart; none of an odd number.
    twiddles: Vec<Complex>,
}

impl RealTransform {
    /// The transform of `n` real samples.
    pub fn new(n: usize) -> Self {
        let n_complex = if n.is_multiple_of(2) { n / 2 } else { n };
        let mut planner = FftPlanner::new();
        let n_twiddles = if n.is_multiple_of(2) {
            n.div_ceil(4)
        } else {
            0
        };
        let step = -TAU / n as f64;
        let twiddle = |k: usize| {
            let angle = step * k as f64;
            Complex::new(angle.cos(), angle.sin())
        };
        Self {
            n,
            forward: planner.plan_fft_forward(n_complex),
            inverse: planner.plan_fft_inverse(n_complex),
            twiddles: (1..n_twiddles).map(twiddle).collect(),
        }
    }

    /// Number of samples.
    pub fn len(&self) -> usize {
        self.n
    }

    /// Whether it transforms no samples at all.
    pub fn is_empty(&self) -> bool {
        self.n == 0
    }

    /// `X_k`, k = 0 … ⌊n/2⌋, of the first `n` samples (missing ones count as 0).
    pub fn forward(&self, samples: &[f64]) -> Vec<Complex> {
        let given = &samples[..samples.len().min(self.n)];
        let mut spectrum = vec![Complex::default(); self.n / 2 + 1];
        self.forward_into(given, &mut spectrum, &mut self.room());
        spectrum
    }

    /// The samples whose forward transform is `spectrum` (with the factor 1/n).
    pub fn inverse(&self, spectrum: &[Complex]) -> Vec<f64> {
        let mut input = vec![Complex::default(); self.n / 2 + 1];
        let given = spectrum.len().min(input.len());
        input[..given].copy_from_slice(&spectrum[..given]);
        let mut samples = vec![0.0; self.n];
        self.inverse_into(&mut input, &mut samples, &mut self.room());
        samples
    }

    /// Room to work in for [`Self::forward_into`] and [`Self::inverse_into`], to be used again.
    pub fn room(&self) -> Vec<Complex> {
        let scratch = |fft: &Arc<dyn Fft<f64>>| {
            if self.is_halved() {
                fft.get_outofplace_scratch_len()
            } else {
                fft.get_inplace_scratch_len()
            }
        };
        let n = scratch(&self.forward).max(scratch(&self.inverse));
        vec![Complex::default(); self.forward.len() + n]
    }

    /// [`Self::forward`] without holding anything new. There are at most as many `samples` as the
    /// transform has; `spectrum` holds ⌊n/2⌋ + 1 bins.
    pub(crate) fn forward_into(
        &self,
        samples: &[f64],
        spectrum: &mut [Complex],
        room: &mut [Complex],
    ) {
        let (buffer, room) = room.split_at_mut(self.forward.len());
        if samples.len() < self.n {
            buffer.fill(Complex::default());
        }
        if !self.is_halved() {
            for (z, &x) in buffer.iter_mut().zip(samples) {
                *z = Complex::new(x, 0.0);
            }
            let room = &mut room[..self.forward.get_inplace_scratch_len()];
            self.forward.process_with_scratch(buffer, room);
            spectrum.copy_from_slice(&buffer[..spectrum.len()]);
        } else if self.n > 0 {
            let (pairs, rest) = samples.as_chunks();
            for (z, &[re, im]) in buffer.iter_mut().zip(pairs) {
                *z = Complex::new(re, im);
            }
            if let [last] = rest {
                buffer[pairs.len()] = Complex::new(*last, 0.0);
            }
            let room = &mut room[..self.forward.get_outofplace_scratch_len()];
            let half = &mut spectrum[..self.n / 2];
            self.forward
                .process_outofplace_with_scratch(buffer, half, room);
            self.take_apart(spectrum);
        }
        spectrum[0].im = 0.0;
    }

    /// [`Self::inverse`] without holding anything new. `spectrum` is destroyed.
    pub(crate) fn inverse_into(
        &self,
        spectrum: &mut [Complex],
        samples: &mut [f64],
        room: &mut [Complex],
    ) {
        spectrum[0].im = 0.0;
        let (buffer, room) = room.split_at_mut(self.inverse.len());
        if !self.is_halved() {
            buffer[..spectrum.len()].copy_from_slice(spectrum);
            let mirrored = buffer.iter_mut().rev().take(self.n / 2);
            for (z, bin) in mirrored.zip(&spectrum[1..]) {
                *z = bin.conj();
            }
            let room = &mut room[..self.inverse.get_inplace_scratch_len()];
            self.inverse.process_with_scratch(buffer, room);
            for (x, z) in samples.iter_mut().zip(buffer.iter()) {
                *x = z.re;
            }
        } else if self.n > 0 {
            spectrum[self.n / 2].im = 0.0;
            self.put_together(spectrum);
            let room = &mut room[..self.inverse.get_outofplace_scratch_len()];
            let half = &mut spectrum[..self.n / 2];
            self.inverse
                .process_outofplace_with_scratch(half, buffer, room);
            for (pair, z) in samples.as_chunks_mut().0.iter_mut().zip(buffer.iter()) {
                *pair = [z.re, z.im];
            }
        }
        let scale = 1.0 / self.n as f64;
        for x in samples {
            *x *= scale;
        }
    }

    fn is_halved(&self) -> bool {
        self.n.is_multiple_of(2)
    }

    /// From the spectrum of the complex samples to that of the real ones.
    fn take_apart(&self, spectrum: &mut [Complex]) {
        let n_bins = spectrum.len();
        let first = spectrum[0];
        spectrum[0] = Complex::new(first.re + first.im, 0.0);
        spectrum[n_bins - 1] = Complex::new(first.re - first.im, 0.0);
        let (left, right) = spectrum.split_at_mut(n_bins / 2);
        let pairs = left[1..].iter_mut().zip(right.iter_mut().rev().skip(1));
        for (twiddle, (low, high)) in self.twiddles.iter().zip(pairs) {
            let (sum, difference) = (*low + *high, *low - *high);
            let turned = turned(sum, difference, *twiddle * 0.5);
            let [re, im] = [0.5 * sum.re, 0.5 * difference.im];
            *low = Complex::new(re + turned.re, im + turned.im);
            *high = Complex::new(re - turned.re, turned.im - im);
        }
        if !n_bins.is_multiple_of(2) {
            spectrum[n_bins / 2].im = -spectrum[n_bins / 2].im;
        }
    }

    /// The way back.
    fn put_together(&self, spectrum: &mut [Complex]) {
        let n_bins = spectrum.len();
        let (first, last) = (spectrum[0], spectrum[n_bins - 1]);
        let (sum, difference) = (first + last, first - last);
        spectrum[0] = Complex::new(sum.re - sum.im, difference.re - difference.im);
        let (left, right) = spectrum.split_at_mut(n_bins / 2);
        let pairs = left[1..].iter_mut().zip(right.iter_mut().rev().skip(1));
        for (twiddle, (low, high)) in self.twiddles.iter().zip(pairs) {
            let (sum, difference) = (*low + *high, *low - *high);
            let turned = turned(sum, difference, twiddle.conj());
            *low = Complex::new(sum.re - turned.re, difference.im - turned.im);
            *high = Complex::new(sum.re + turned.re, -turned.im - difference.im);
        }
        if !n_bins.is_multiple_of(2) {
            let middle = spectrum[n_bins / 2];
            spectrum[n_bins / 2] = (middle + middle).conj();
        }
    }
}

/// The part of a pair of bins that the twiddle factor turns: both bins share its products.
fn turned(sum: Complex, difference: Complex, twiddle: Complex) -> Complex {
    Complex::new(
        sum.im * twiddle.re + difference.re * twiddle.im,
        sum.im * twiddle.im - difference.re * twiddle.re,
    )
}

impl std::fmt::Debug for RealTransform {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("RealTransform")
            .field("len", &self.len())
            .finish()
    }
}

/// The DFT of a fixed number of complex samples, both ways, in place: of as many sequences, one
/// after the other, as are given at once.
#[derive(Clone)]
pub(super) struct ComplexTransform {
    forward: Arc<dyn Fft<f64>>,
    inverse: Arc<dyn Fft<f64>>,
}

impl ComplexTransform {
    /// The transform of `n` samples.
    pub(super) fn new(n: usize) -> Self {
        let mut planner = FftPlanner::new();
        Self {
            forward: planner.plan_fft_forward(n),
            inverse: planner.plan_fft_inverse(n),
        }
    }

    /// Samples of one sequence.
    pub(super) fn len(&self) -> usize {
        self.forward.len()
    }

    /// Room to work in, to be used again.
    pub(super) fn room(&self) -> Vec<Complex> {
        let both = [&self.forward, &self.inverse];
        let n = both.map(|fft| fft.get_inplace_scratch_len());
        vec![Complex::default(); n[0].max(n[1])]
    }

    /// `X_k = Σ_i x_i e^{−2πi·ki/n}`.
    pub(super) fn forward(&self, samples: &mut [Complex], room: &mut [Complex]) {
        self.forward.process_with_scratch(samples, room);
    }

    /// `x_i = Σ_k X_k e^{2πi·ki/n}`: without the factor 1/n.
    pub(super) fn inverse(&self, spectrum: &mut [Complex], room: &mut [Complex]) {
        self.inverse.process_with_scratch(spectrum, room);
    }
}

impl std::fmt::Debug for ComplexTransform {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("ComplexTransform")
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
