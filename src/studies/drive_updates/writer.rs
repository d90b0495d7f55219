//! The drive waveform with new amplitudes taking effect at any place of a tick: what the product
//! does not do, written as fast as what it does.

use std::f64::consts::TAU;

use selvedge_render::single;

/// Samples a second.
pub(super) const RATE_HZ: usize = 48_000;
/// Samples of a tick of 1/40 s.
pub(super) const TICK_SAMPLES: usize = RATE_HZ / 40;

/// How amplitudes go from one tick's to the next.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Change {
    /// At once, this many samples after the tick begins.
    At(usize),
    /// Along a line over the first samples of the tick, this many.
    Over(usize),
}

/// Writes interleaved samples tick by tick.
#[derive(Debug, Clone)]
pub(super) struct Writer {
    /// `[sin 2π40t, sin 2π320t]` over one tick.
    carriers: Vec<[f32; 2]>,
    /// The amplitudes that sound, by band.
    sounding: [Vec<f32>; 2],
    /// What a sample adds to them while they change.
    steps: [Vec<f32>; 2],
}

impl Writer {
    /// A writer of `n_channels` silent channels.
    pub(super) fn new(n_channels: usize) -> Self {
        let sines = |m: usize| {
            [1.0, 8.0].map(|cycles| single((TAU * cycles * m as f64 / TICK_SAMPLES as f64).sin()))
        };
        let silence = || [vec![0.0; n_channels], vec![0.0; n_channels]];
        Self {
            carriers: (0..TICK_SAMPLES).map(sines).collect(),
            sounding: silence(),
            steps: silence(),
        }
    }

    /// Writes one tick, whose amplitudes `[A40, A320]` are given for every channel.
    pub(super) fn write(&mut self, amplitudes: &[[f32; 2]], change: Change, out: &mut [f32]) {
        let n_channels = self.sounding[0].len();
        let n_before = match change {
            Change::At(sample) | Change::Over(sample) => sample.min(TICK_SAMPLES),
        };
        let (before, after) = out.split_at_mut(n_before * n_channels);
        let (early, late) = self.carriers.split_at(n_before);
        if let Change::Over(_) = change {
            let share = 1.0 / n_before.max(1) as f64;
            for (b, steps) in self.steps.iter_mut().enumerate() {
                for ((step, sounding), next) in
                    steps.iter_mut().zip(&self.sounding[b]).zip(amplitudes)
                {
                    *step = (next[b] - sounding) * single(share);
                }
            }
            write_changing(before, early, &mut self.sounding, &self.steps);
        } else {
            write_constant(before, early, &self.sounding);
        }
        for (b, sounding) in self.sounding.iter_mut().enumerate() {
            for (sounding, next) in sounding.iter_mut().zip(amplitudes) {
                *sounding = next[b];
            }
        }
        write_constant(after, late, &self.sounding);
    }
}

fn write_constant(out: &mut [f32], carriers: &[[f32; 2]], [low, high]: &[Vec<f32>; 2]) {
    for (frame, &[c_low, c_high]) in out.chunks_exact_mut(low.len()).zip(carriers) {
        for ((sample, low), high) in frame.iter_mut().zip(low).zip(high) {
            *sample = low * c_low + high * c_high;
        }
    }
}

fn write_changing(
    out: &mut [f32],
    carriers: &[[f32; 2]],
    [low, high]: &mut [Vec<f32>; 2],
    [low_steps, high_steps]: &[Vec<f32>; 2],
) {
    for (frame, &[c_low, c_high]) in out.chunks_exact_mut(low.len()).zip(carriers) {
        let bands = low.iter_mut().zip(high.iter_mut());
        let steps = low_steps.iter().zip(high_steps);
        for ((sample, (low, high)), (low_step, high_step)) in frame.iter_mut().zip(bands).zip(steps)
        {
            *low += low_step;
            *high += high_step;
            *sample = *low * c_low + *high * c_high;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use selvedge_render::array::DriveSynth;

    #[test]
    fn a_change_at_the_beginning_of_a_tick_is_what_the_product_does() {
        let mut writer = Writer::new(2);
        let mut synth = DriveSynth::prepare(48_000, 2, 1.0).unwrap();
        for tick in 0..5_u8 {
            let amplitudes = [[f32::from(tick), 3.0], [0.5, f32::from(tick * tick)]];
            synth.set_amplitudes(&amplitudes);
            let (mut ours, mut theirs) = (vec![0.0; 2 * TICK_SAMPLES], vec![0.0; 2 * TICK_SAMPLES]);
            writer.write(&amplitudes, Change::At(0), &mut ours);
            synth.fill(&mut theirs);
            for (a, b) in ours.iter().zip(&theirs) {
                assert!((a - b).abs() < 1e-5, "tick {tick}: {a} and {b}");
            }
        }
    }

    #[test]
    fn a_line_ends_at_the_amplitudes_given_and_has_half_of_the_step_midway() {
        let mut writer = Writer::new(1);
        let mut out = vec![0.0; TICK_SAMPLES];
        writer.write(&[[2.0, 0.0]], Change::Over(TICK_SAMPLES), &mut out);
        // A quarter of a cycle in, the carrier is 1 and the amplitude a quarter of the step.
        assert!(
            (out[TICK_SAMPLES / 4] - 0.5).abs() < 0.01,
            "{}",
            out[TICK_SAMPLES / 4]
        );
        writer.write(&[[2.0, 0.0]], Change::At(700), &mut out);
        assert!(
            (out[TICK_SAMPLES / 4] - 2.0).abs() < 1e-3,
            "{}",
            out[TICK_SAMPLES / 4]
        );
    }
}
