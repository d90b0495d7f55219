//! What the drive waveform costs: a sample of a channel, the slowest blocks of 48 frames, and
//! whole clips of 1, 10 and 100 s as files.

#![expect(clippy::print_stdout, reason = "a bench prints its figures")]

use std::hint::black_box;
use std::time::Instant;

use selvedge_foundation::numerics::{median, quantile};
use selvedge_foundation::progress::{CancelFlag, Progress};
use selvedge_render::array::DriveSynth;
use selvedge_studies::{Bench, ClipsStudy, Effort, Study as _};

const ROUNDS: usize = 15;

fn main() {
    for (n_channels, rate_hz) in [
        (24, 48_000),
        (24, 44_100),
        (24, 8_000),
        (1, 48_000),
        (100, 48_000),
    ] {
        let Ok(mut synth) = DriveSynth::prepare(rate_hz, n_channels, 50.0) else {
            continue;
        };
        let per_sample = per_sample_ns(&mut synth);
        let mut blocks_us = block_times_us(&mut synth);
        let p99 = quantile(&mut blocks_us, 0.99);
        println!(
            "{n_channels:>3} channels at {rate_hz} Hz: {per_sample:>6.3} ns a sample a channel; \
             48 frames: median {:.2} µs, p99 {p99:.2} µs",
            median(&mut blocks_us)
        );
    }
    print_clips();
}

/// What the study of clips finds, without its plots.
fn print_clips() {
    let mut report = |_: f64, _: &str| {};
    let mut progress = Progress::new(&mut report, CancelFlag::new());
    let mut bench = Bench::new(Effort::Full, 1, &mut progress);
    let findings = match ClipsStudy.run(&mut bench) {
        Ok(findings) => findings,
        Err(error) => return println!("clips: {error}"),
    };
    for row in &findings.rows {
        let (Some(length_s), Some(cost)) = (row.size, row.cost) else {
            continue;
        };
        println!(
            "{:<16} {length_s:>4} s: {:>9.3} ms CPU, {:>9.3} ms wall",
            row.method,
            1e3 * cost.cpu_s,
            1e3 * cost.wall_s
        );
    }
    for note in &findings.notes {
        println!("{note}");
    }
}

/// Median over rounds of a second of waveform, new amplitudes at every tick.
fn per_sample_ns(synth: &mut DriveSynth) -> f64 {
    let n_channels = synth.n_channels();
    let mut block = vec![0.0; 1200 * n_channels];
    let mut round = |_| {
        let start = Instant::now();
        for tick in 0..40_u8 {
            synth.set_amplitudes(&amplitudes(n_channels, tick));
            synth.fill(&mut block);
            black_box(&block);
        }
        start.elapsed().as_secs_f64() * 1e9 / (40.0 * block.len() as f64)
    };
    median(&mut (0..ROUNDS).map(&mut round).collect::<Vec<f64>>())
}

fn block_times_us(synth: &mut DriveSynth) -> Vec<f64> {
    let mut block = vec![0.0; 48 * synth.n_channels()];
    let mut time = |n: u32| {
        if n.is_multiple_of(25) {
            synth.set_amplitudes(&amplitudes(synth.n_channels(), 1));
        }
        let start = Instant::now();
        synth.fill(&mut block);
        black_box(&block);
        start.elapsed().as_secs_f64() * 1e6
    };
    (0..20_000).map(&mut time).collect()
}

fn amplitudes(n_channels: usize, tick: u8) -> Vec<[f32; 2]> {
    vec![[f32::from(tick), 0.5]; n_channels]
}
