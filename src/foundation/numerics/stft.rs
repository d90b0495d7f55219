//! The short-time Fourier transform, and a signal from magnitudes alone (Griffin & Lim).
//!
//! Frames are centred: frame j stands around sample j·hop, and the signal is mirrored about its
//! ends. The window is a periodic Hamming window, not compensated: a sine of amplitude a in bin k
//! has the magnitude a·Σw/2 there, a constant c has c·Σw in bin 0.

use std::f64::consts::{PI, TAU};

use super::{Complex, Grid, Random, RealTransform};

/// Short-time spectra of real signals: one row a frame, one column a bin.
#[derive(Debug, Clone)]
pub struct Stft {
    transform: RealTransform,
    window: Vec<f64>,
    hop: usize,
}

/// The phases that [`Stft::griffin_lim`] begins with.
#[derive(Debug, Clone, Copy)]
pub enum StartPhases<'a> {
    /// Uniform from a generator, in every bin.
    Random(u64),
    /// Uniform, but 0 in bin 0 and π in bin 1, as a Hamming window leaves a constant: a signal
    /// about a large mean comes back with its sign.
    OfConstant(u64),
    /// Those of another signal's spectra, such as the heights that a finger was drawn over.
    Of(&'a Grid<Complex>),
}

/// How [`Stft::griffin_lim`] goes on.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GriffinLim {
    /// Rounds.
    pub n_iterations: usize,
    /// How far a round overshoots (Perraudin, Balazs & Søndergaard 2013); 0 is the original.
    pub momentum: f64,
}

impl Default for GriffinLim {
    fn default() -> Self {
        Self {
            n_iterations: 32,
            momentum: 0.99,
        }
    }
}

impl Stft {
    /// Spectra of `n_window` samples (a positive even number), `hop` samples apart.
    pub fn hamming(n_window: usize, hop: usize) -> Self {
        let angle = TAU / n_window as f64;
        let weight = |i: usize| 0.54 - 0.46 * (angle * i as f64).cos();
        Self {
            transform: RealTransform::new(n_window),
            window: (0..n_window).map(weight).collect(),
            hop: hop.max(1),
        }
    }

    /// Bins of a frame.
    pub fn n_bins(&self) -> usize {
        self.window.len() / 2 + 1
    }

    /// Frames of a signal.
    pub fn n_frames(&self, n_samples: usize) -> usize {
        1 + n_samples / self.hop
    }

    /// Σw: the magnitude in bin 0 of a constant 1.
    pub fn gain(&self) -> f64 {
        self.window.iter().sum()
    }

    /// The spectra of a signal that is longer than half a window; a shorter one is mirrored at its
    /// ends again and again.
    pub fn forward(&self, signal: &[f64]) -> Grid<Complex> {
        let n_frames = self.n_frames(signal.len());
        let mut spectra = Grid::filled(self.n_bins(), n_frames, Complex::default());
        self.forward_into(signal, &mut spectra, &mut self.room());
        spectra
    }

    /// The signal of `n_samples` whose spectra come closest (least squares over the overlaps).
    pub fn inverse(&self, spectra: &Grid<Complex>, n_samples: usize) -> Vec<f64> {
        let mut signal = vec![0.0; n_samples];
        let weights = self.weights(n_samples);
        self.inverse_into(spectra, (&weights, &mut signal), &mut self.room());
        signal
    }

    /// A signal whose spectra have these magnitudes as nearly as rounds of projection find
    /// (Griffin & Lim 1984, with overshoot). Same start, same bytes.
    pub fn griffin_lim(
        &self,
        magnitudes: &Grid<f64>,
        n_samples: usize,
        start: StartPhases<'_>,
        how: GriffinLim,
    ) -> Vec<f64> {
        let mut guess = Self::begun(magnitudes, start);
        let mut room = self.room();
        let mut signal = vec![0.0; n_samples];
        let weights = self.weights(n_samples);
        let [mut found, mut before] =
            [(); 2].map(|()| Grid::filled(guess.width(), guess.height(), Complex::default()));
        let overshoot = how.momentum / (1.0 + how.momentum);
        for round in 0..how.n_iterations {
            self.inverse_into(&guess, (&weights, &mut signal), &mut room);
            self.forward_into(&signal, &mut found, &mut room);
            let back = if round == 0 { 0.0 } else { overshoot };
            let bins = found.values().iter().zip(before.values());
            let wanted = magnitudes.values().iter();
            for ((guess, (found, before)), &magnitude) in
                guess.values_mut().iter_mut().zip(bins).zip(wanted)
            {
                *guess = with_magnitude(found - before * back, magnitude);
            }
            std::mem::swap(&mut found, &mut before);
        }
        self.inverse_into(&guess, (&weights, &mut signal), &mut room);
        signal
    }

    /// How far a signal's magnitudes are from others: `‖|X| − M‖ / ‖M‖`; 0 where both are silent.
    pub fn spectral_error(&self, signal: &[f64], magnitudes: &Grid<f64>) -> f64 {
        let spectra = self.forward(signal);
        let pairs = spectra.values().iter().zip(magnitudes.values());
        let (miss, all) = pairs.fold((0.0, 0.0), |(miss, all), (x, m)| {
            (miss + (x.norm() - m).powi(2), all + m * m)
        });
        if miss == 0.0 {
            return 0.0;
        }
        (miss / all).sqrt()
    }

    fn begun(magnitudes: &Grid<f64>, start: StartPhases<'_>) -> Grid<Complex> {
        let (seed, is_constant) = match start {
            StartPhases::Random(seed) => (seed, false),
            StartPhases::OfConstant(seed) => (seed, true),
            StartPhases::Of(other) => {
                return Grid::from_fn(magnitudes.width(), magnitudes.height(), |bin, frame| {
                    with_magnitude(other.row(frame)[bin], magnitudes.row(frame)[bin])
                });
            }
        };
        let mut random = Random::new(seed);
        Grid::from_fn(magnitudes.width(), magnitudes.height(), |bin, frame| {
            let drawn = TAU * random.uniform();
            let phase = match bin {
                0 if is_constant => 0.0,
                1 if is_constant => PI,
                _ => drawn,
            };
            Complex::from_polar(magnitudes.row(frame)[bin], phase)
        })
    }

    fn room(&self) -> Room {
        Room {
            fft: self.transform.room(),
            samples: vec![0.0; self.window.len()],
            bins: vec![Complex::default(); self.n_bins()],
        }
    }

    /// Σ of the squared windows at every sample.
    fn weights(&self, n_samples: usize) -> Vec<f64> {
        let mut weights = vec![0.0; n_samples];
        for frame in 0..self.n_frames(n_samples) {
            for (i, w) in self.window.iter().enumerate() {
                if let Some(sum) = self.sample_of(frame, i).and_then(|at| weights.get_mut(at)) {
                    *sum += w * w;
                }
            }
        }
        weights
    }

    /// The sample under a weight of a frame's window, unless it lies before the first.
    fn sample_of(&self, frame: usize, weight: usize) -> Option<usize> {
        (frame * self.hop + weight).checked_sub(self.window.len() / 2)
    }

    fn forward_into(&self, signal: &[f64], spectra: &mut Grid<Complex>, room: &mut Room) {
        for frame in 0..spectra.height() {
            let half = self.window.len() / 2;
            for (i, (sample, w)) in room.samples.iter_mut().zip(&self.window).enumerate() {
                let at = mirrored((frame * self.hop + i, half), signal.len());
                *sample = w * at.map_or(0.0, |at| signal[at]);
            }
            let row = spectra.row_mut(frame);
            self.transform
                .forward_into(&room.samples, row, &mut room.fft);
        }
    }

    fn inverse_into(
        &self,
        spectra: &Grid<Complex>,
        (weights, signal): (&[f64], &mut [f64]),
        room: &mut Room,
    ) {
        signal.fill(0.0);
        for frame in 0..spectra.height() {
            room.bins.copy_from_slice(spectra.row(frame));
            self.transform
                .inverse_into(&mut room.bins, &mut room.samples, &mut room.fft);
            for (i, (sample, w)) in room.samples.iter().zip(&self.window).enumerate() {
                if let Some(sum) = self.sample_of(frame, i).and_then(|at| signal.get_mut(at)) {
                    *sum += w * sample;
                }
            }
        }
        for (sample, weight) in signal.iter_mut().zip(weights) {
            *sample /= weight.max(f64::MIN_POSITIVE);
        }
    }
}

/// What a round works in.
struct Room {
    fft: Vec<Complex>,
    samples: Vec<f64>,
    bins: Vec<Complex>,
}

/// A number turned like another, of a magnitude; real where the other has no direction.
fn with_magnitude(direction: Complex, magnitude: f64) -> Complex {
    let norm = direction.norm();
    if norm > 1e-300 {
        direction * (magnitude / norm)
    } else {
        Complex::new(magnitude, 0.0)
    }
}

/// Where the sample `place − before` of a signal lies that is mirrored about both ends, without
/// the ends being doubled; nowhere in an empty signal.
fn mirrored((place, before): (usize, usize), n_samples: usize) -> Option<usize> {
    let last = n_samples.checked_sub(1)?;
    if last == 0 {
        return Some(0);
    }
    let there_and_back = 2 * last;
    let turns = before.div_ceil(there_and_back) * there_and_back;
    let place = (place + turns - before) % there_and_back;
    Some(place.min(there_and_back - place))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn friction_like(seed: u64) -> Vec<f64> {
        let mut random = Random::new(seed);
        let mut slow = 0.0;
        let sample = |i: i32| {
            slow = 0.98 * slow + 0.002 * random.normal();
            0.39 + slow + 0.01 * (0.21 * f64::from(i)).sin() + 0.002 * random.normal()
        };
        (0..1280).map(sample).collect()
    }

    fn magnitudes(stft: &Stft, signal: &[f64]) -> Grid<f64> {
        stft.forward(signal).map(Complex::norm)
    }

    #[test]
    fn a_sine_and_a_constant_have_the_stated_magnitudes() {
        let stft = Stft::hamming(512, 128);
        let wave = |i: i32| 0.5 + 0.1 * (TAU * 32.0 * f64::from(i) / 512.0).cos();
        let signal: Vec<f64> = (0..1280).map(wave).collect();
        let spectra = magnitudes(&stft, &signal);
        assert_eq!((spectra.width(), spectra.height()), (257, 11));
        assert!((stft.gain() - 276.48).abs() < 1e-9, "{}", stft.gain());
        // Frames that see no mirrored end.
        for frame in 2..9 {
            let row = spectra.row(frame);
            assert!((row[0] - 0.5 * 276.48).abs() < 1e-9, "{}", row[0]);
            assert!((row[1] - 0.5 * 0.23 * 512.0).abs() < 1e-9, "{}", row[1]);
            assert!((row[32] - 0.05 * 276.48).abs() < 1e-9, "{}", row[32]);
        }
    }

    #[test]
    fn spectra_give_their_signal_back() {
        for (n_window, hop, n_samples) in [(512, 128, 1280), (512, 128, 512), (64, 16, 1000)] {
            let stft = Stft::hamming(n_window, hop);
            let signal = &friction_like(1)[..n_samples];
            let back = stft.inverse(&stft.forward(signal), n_samples);
            for (a, b) in signal.iter().zip(&back) {
                assert!((a - b).abs() < 1e-12, "{a} came back as {b}");
            }
        }
    }

    #[test]
    fn a_constant_s_phases_bring_friction_back_from_magnitudes_and_random_ones_do_not() {
        let stft = Stft::hamming(512, 128);
        let mut n_failed = 0;
        for seed in 0..20 {
            let signal = friction_like(100 + seed);
            let wanted = magnitudes(&stft, &signal);
            let found = |start| {
                let found = stft.griffin_lim(&wanted, 1280, start, GriffinLim::default());
                stft.spectral_error(&found, &wanted)
            };
            let error = found(StartPhases::OfConstant(seed));
            assert!(error <= 0.01, "seed {seed}: {error}");
            n_failed += u32::from(found(StartPhases::Random(seed)) > 0.05);
        }
        assert!(n_failed >= 10, "only {n_failed} of 20 random starts failed");
    }

    #[test]
    fn the_phases_of_the_signal_itself_give_the_signal() {
        let stft = Stft::hamming(512, 128);
        let signal = friction_like(3);
        let spectra = stft.forward(&signal);
        let start = StartPhases::Of(&spectra);
        let wanted = spectra.map(Complex::norm);
        let found = stft.griffin_lim(&wanted, 1280, start, GriffinLim::default());
        for (a, b) in signal.iter().zip(&found) {
            assert!((a - b).abs() < 1e-9, "{a} came back as {b}");
        }
    }

    #[test]
    fn silence_and_the_shortest_signals_are_no_numbers_without_a_meaning() {
        let stft = Stft::hamming(64, 16);
        for n_samples in [0, 1, 2, 7, 31, 33] {
            let silent = vec![0.0; n_samples];
            let wanted = magnitudes(&stft, &silent);
            let start = StartPhases::Random(1);
            let found = stft.griffin_lim(&wanted, n_samples, start, GriffinLim::default());
            assert!(found.iter().all(|&x| x == 0.0), "{n_samples}: {found:?}");
            assert_eq!(stft.spectral_error(&found, &wanted), 0.0);
            let all = stft.forward(&vec![1.0; n_samples]);
            assert!(all.values().iter().all(|x| x.is_finite()), "{n_samples}");
        }
    }
}
