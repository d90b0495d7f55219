//! What drives a contactor: the waveform between ticks, and its spectrum.
//!
//! `s(t) = A40 sin(2π·40 t) + A320 sin(2π·320 t)`, new amplitudes at ticks t = n/40 s, where both
//! sines cross zero upwards.

use std::f64::consts::TAU;

use crate::bench::signals::history::History;
use crate::bench::signals::rows::{RowEdges, Rows};
use selvedge_foundation::numerics::{RealTransform, to_index, to_single};
use selvedge_textile::tactile::Band;

/// Samples a second: enough for 1 kHz.
const RATE_HZ: f64 = 2000.0;
/// Samples in a tick of 25 ms.
const N_TICK: usize = 50;
/// Ticks in a window of 100 ms.
const N_TICKS: usize = 4;
/// Samples of the transform: the window, zero-padded to bins 2.5 Hz apart.
const N_TRANSFORM: usize = 800;

/// The amplitudes [A40, A320] that drove a contactor at a tick, µm: after gains and before output
/// limits; 0 where the device was silent, another contactor was watched, or nothing is known.
pub(crate) fn drive_um(history: &History, contactor: u32, tick: u64) -> [f64; 2] {
    let entries = history.entries();
    let place = entries.partition_point(|entry| entry.tick_sample.tick < tick);
    let tick_sample = entries.get(place).map(|entry| entry.tick_sample);
    let drives = tick_sample.filter(|tick_sample| {
        tick_sample.tick == tick && tick_sample.watched == contactor && !tick_sample.is_silent
    });
    let known = drives.map_or([0.0; 2], |tick_sample| {
        tick_sample.watched_um.map(f64::from)
    });
    known.map(|um| if um.is_finite() { um } else { 0.0 })
}

/// The wave `A_b sin(2π·b·t)` of both bands, µm.
pub(crate) fn wave_um(amplitudes_um: [f64; 2], t_s: f64) -> [f64; 2] {
    Band::ALL.map(|band| amplitudes_um[band.index()] * (TAU * band.carrier_hz() * t_s).sin())
}

/// Spectra of the drive: the last 100 ms at 2 kHz under a Hann window (periodic).
///
/// One-sided amplitude spectrum, µm peak, the window's gain compensated: a steady amplitude reads
/// as itself at its carrier.
#[derive(Debug, Clone)]
pub(crate) struct DriveSpectrum {
    edges: RowEdges,
    transform: RealTransform,
    window: Vec<f64>,
    samples: Vec<f64>,
    amplitudes_um: Vec<f64>,
}

impl Default for DriveSpectrum {
    fn default() -> Self {
        let n_window = N_TICK * N_TICKS;
        let hann = |i: usize| 0.5 - 0.5 * (TAU * i as f64 / n_window as f64).cos();
        Self {
            edges: RowEdges::default(),
            transform: RealTransform::new(N_TRANSFORM),
            window: (0..n_window).map(hann).collect(),
            samples: vec![0.0; n_window],
            amplitudes_um: Vec::new(),
        }
    }
}

impl DriveSpectrum {
    /// The largest amplitude in every row of frequency, µm, of the four ticks up to `tick`.
    pub(crate) fn rows_um(
        &mut self,
        history: &History,
        contactor: u32,
        tick: u64,
        rows_um: &mut Rows,
    ) {
        for (ago, samples) in (0..N_TICKS as u64)
            .rev()
            .zip(self.samples.chunks_mut(N_TICK))
        {
            let then = tick.checked_sub(ago);
            let drive = then.map_or([0.0; 2], |tick| drive_um(history, contactor, tick));
            for (i, sample) in samples.iter_mut().enumerate() {
                *sample = wave_um(drive, i as f64 / RATE_HZ).iter().sum();
            }
        }
        self.transform();
        for (row, [low_hz, high_hz]) in rows_um.iter_mut().zip(self.edges.each()) {
            *row = to_single(self.largest_um(low_hz, high_hz));
        }
    }

    fn transform(&mut self) {
        for (sample, w) in self.samples.iter_mut().zip(&self.window) {
            *sample *= w;
        }
        let scale = 2.0 / self.window.iter().sum::<f64>();
        let spectrum = self.transform.forward(&self.samples);
        self.amplitudes_um.clear();
        self.amplitudes_um
            .extend(spectrum.iter().map(|x| scale * x.norm()));
    }

    /// The largest amplitude between two frequencies, straight lines between bins.
    fn largest_um(&self, low_hz: f64, high_hz: f64) -> f64 {
        let spacing_hz = RATE_HZ / N_TRANSFORM as f64;
        let (low, high) = (low_hz / spacing_hz, high_hz / spacing_hz);
        let ends = self.between(low).max(self.between(high));
        let inside = to_index(low.ceil())..=to_index(high.floor());
        let bins = self.amplitudes_um.get(inside).unwrap_or(&[]);
        bins.iter().copied().fold(ends, f64::max)
    }

    fn between(&self, place: f64) -> f64 {
        let at = |i: usize| self.amplitudes_um.get(i).copied().unwrap_or(0.0);
        let below = to_index(place.floor());
        let share = place - place.floor();
        at(below) * (1.0 - share) + at(below + 1) * share
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bench::signals::rows::{N_ROWS, row_at};
    use selvedge_engine::TickSample;

    fn driven(ticks: std::ops::Range<u64>, watched_um: [f32; 2]) -> History {
        let mut history = History::default();
        for tick in ticks {
            history.take(TickSample {
                tick,
                watched: 7,
                watched_um,
                ..TickSample::default()
            });
        }
        history
    }

    #[test]
    fn steady_amplitudes_read_as_themselves_at_their_carriers() {
        let mut rows = [0.0; N_ROWS];
        DriveSpectrum::default().rows_um(&driven(0..9, [12.0, 3.0]), 7, 8, &mut rows);
        let near = |hz, um: f32| (rows[row_at(hz)] - um).abs() < 1e-4;
        assert!(near(40.0, 12.0), "{}", rows[row_at(40.0)]);
        assert!(near(320.0, 3.0), "{}", rows[row_at(320.0)]);
        assert!(rows[row_at(120.0)] < 0.1, "{}", rows[row_at(120.0)]);
        let largest = rows.iter().copied().fold(0.0, f32::max);
        assert!(largest < 12.001, "{largest}");
    }

    #[test]
    fn a_burst_shorter_than_the_window_reads_weaker_and_wider() {
        let (mut long, mut short) = ([0.0; N_ROWS], [0.0; N_ROWS]);
        let mut spectrum = DriveSpectrum::default();
        spectrum.rows_um(&driven(0..9, [10.0, 0.0]), 7, 8, &mut long);
        spectrum.rows_um(&driven(7..9, [10.0, 0.0]), 7, 8, &mut short);
        assert!(short[row_at(40.0)] < 0.6 * long[row_at(40.0)], "weaker");
        assert!(short[row_at(90.0)] > 2.0 * long[row_at(90.0)], "wider");
    }

    #[test]
    fn silence_other_contactors_and_what_is_no_number_drive_nothing() {
        let history = driven(5..6, [1.0, 2.0]);
        assert_eq!(drive_um(&history, 7, 5), [1.0, 2.0]);
        assert_eq!(drive_um(&history, 8, 5), [0.0; 2]);
        assert_eq!(drive_um(&history, 7, 4), [0.0; 2]);
        assert_eq!(drive_um(&driven(5..6, [f32::NAN, 2.0]), 7, 5), [0.0, 2.0]);
        let mut silent = History::default();
        let held = *history.newest().map(|entry| &entry.tick_sample).unwrap();
        silent.take(TickSample {
            is_silent: true,
            ..held
        });
        assert_eq!(drive_um(&silent, 7, 5), [0.0; 2]);
        let mut rows = [1.0; N_ROWS];
        DriveSpectrum::default().rows_um(&silent, 7, 5, &mut rows);
        assert_eq!(rows, [0.0; N_ROWS]);
    }
}
