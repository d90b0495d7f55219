//! The amplitudes of both bands that a force has over two ticks.

use crate::scene::TICKS_PER_S;
use selvedge_textile::tactile::{Band, Filters};

/// The highest frequency that is felt, Hz.
const HIGHEST_HZ: f64 = 1000.0;
/// No amplitude is larger, µm: far above every limit.
const MAX_UM: f64 = 1e6;

/// The two bands of a force over the last two ticks.
#[derive(Debug)]
pub(super) struct Spectrum {
    /// The force, N, and the same under the window.
    samples: Vec<f64>,
    windowed: Vec<f64>,
    window: Vec<f64>,
    /// Cosine and sine of whole parts of a turn.
    turns: Vec<[f64; 2]>,
    /// What every bin from the first adds to the square of either amplitude, of `|X_k|²`.
    shares: Vec<[f64; 2]>,
}

impl Spectrum {
    pub(super) fn new(n_steps: usize, um_per_n: f64, filters: &Filters) -> Self {
        let n = 2 * n_steps;
        let angle = |i: usize| std::f64::consts::TAU * i as f64 / n as f64;
        let window: Vec<f64> = (0..n).map(|i| 0.5 - 0.5 * angle(i).cos()).collect();
        let power: f64 = window.iter().map(|w| w * w).sum();
        // A_b² = 2 c² Σ 2 |X_k|²/(n Σ w²) H_b².
        let scale = um_per_n * um_per_n * 4.0 / (n as f64 * power);
        let frequencies = (1..n_steps).map(|k| k as f64 * TICKS_PER_S / 2.0);
        let felt = frequencies.take_while(|hz| *hz < HIGHEST_HZ);
        let share = |hz: f64| Band::ALL.map(|band| scale * filters.power_gain(band, hz));
        Self {
            samples: vec![0.0; n],
            windowed: vec![0.0; n],
            window,
            turns: (0..n).map(|i| angle(i).sin_cos().into()).collect(),
            shares: felt.map(share).collect(),
        }
    }

    pub(super) fn clear(&mut self) {
        self.samples.fill(0.0);
    }

    /// Where the next tick's force is to be written.
    pub(super) fn next_tick(&mut self) -> &mut [f64] {
        let n_steps = self.samples.len() / 2;
        self.samples.copy_within(n_steps.., 0);
        &mut self.samples[n_steps..]
    }

    pub(super) fn amplitudes_um(&mut self) -> [f64; 2] {
        let weighed = self.samples.iter().zip(&self.window);
        let sum_n: f64 = weighed.clone().map(|(force_n, w)| force_n * w).sum();
        // Half of a periodic Hann window's samples are its sum.
        let mean_n = sum_n / (0.5 * self.window.len() as f64);
        for (to, (force_n, w)) in self.windowed.iter_mut().zip(weighed) {
            *to = (force_n - mean_n) * w;
        }
        let mut squares = [0.0; 2];
        for (k, shares) in (1..).zip(&self.shares) {
            let (mut sum, mut turn) = ([0.0; 2], 0);
            for force_n in &self.windowed {
                let [sin, cos] = self.turns[turn];
                sum = [sum[0] + force_n * cos, sum[1] + force_n * sin];
                turn += k;
                if turn >= self.turns.len() {
                    turn -= self.turns.len();
                }
            }
            let power = sum[0] * sum[0] + sum[1] * sum[1];
            squares = [0, 1].map(|band| squares[band] + shares[band] * power);
        }
        squares.map(|square| {
            if square.is_finite() {
                square.sqrt().min(MAX_UM)
            } else {
                0.0
            }
        })
    }
}
