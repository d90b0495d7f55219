//! What the drive waveform costs: a sample of a channel, the slowest blocks of 48 frames, and
//! whole clips of 1, 10 and 100 s as files.

#![expect(clippy::print_stdout, reason = "a bench prints its figures")]

use std::hint::black_box;
use std::path::Path;
use std::time::Instant;

use selvedge_device::ArrayProfile;
use selvedge_engine::{ClipKind, ClipWriter, EngineError};
use selvedge_foundation::numerics::{median, quantile};
use selvedge_foundation::progress::{Progress, thread_cpu_seconds};
use selvedge_render::array::DriveSynth;

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

/// What clips of three lengths cost, measured in turn, and how much a second from 10 to 100 s costs
/// beside one from 1 to 10 s.
fn print_clips() {
    let place = std::env::temp_dir().join(format!("selvedge-clip-{}.part", std::process::id()));
    for (name, kind) in [
        ("WAV, 8 kHz i16", ClipKind::ARCHIVE),
        ("WAV, 48 kHz f32", ClipKind::FLOAT),
        ("MPEG haptics", ClipKind::Hjif),
        ("frames as CSV", ClipKind::Frames),
    ] {
        // Half a gigabyte of floats is no business of a bench's disk.
        let place = match kind {
            ClipKind::FLOAT if cfg!(unix) => Path::new("/dev/null"),
            _ => &place,
        };
        let mut rounds_s = vec![[0.0; 3]; 9];
        for lengths_s in &mut rounds_s {
            for (length_s, cpu_s) in [1, 10, 100].into_iter().zip(lengths_s) {
                let start_s = thread_cpu_seconds();
                if let Err(error) = write_clip(place, kind, length_s) {
                    return println!("clips: {error}");
                }
                *cpu_s = thread_cpu_seconds() - start_s;
            }
        }
        let late_s = |[_, middle_s, last_s]: &[f64; 3]| (last_s - middle_s) / 90.0;
        let ratio = |round: &[f64; 3]| late_s(round) / ((round[1] - round[0]) / 9.0);
        let mut late: Vec<f64> = rounds_s.iter().map(late_s).collect();
        let mut ratios: Vec<f64> = rounds_s.iter().map(ratio).collect();
        println!(
            "{name:<16} a second costs {:.3} ms from 10 to 100 s, {:.2} times that from 1 to 10 s",
            1e3 * median(&mut late),
            median(&mut ratios)
        );
    }
    drop(std::fs::remove_file(&place));
}

/// Writes a clip in which every contactor sounds and no tick is like the one before.
fn write_clip(place: &Path, kind: ClipKind, length_s: u64) -> Result<(), EngineError> {
    let profile = ArrayProfile::default();
    let mut clip = ClipWriter::create(place, kind, (&profile, 24), "clip")?;
    let mut amplitudes_um = [[0.0_f32; 2]; 24];
    for tick in 0..40 * length_s {
        for (contactor, [low_um, high_um]) in amplitudes_um.iter_mut().enumerate() {
            let turn = (tick % 4099) as f32 * 0.37 + contactor as f32;
            *low_um = 12.5 + 12.0 * turn.sin();
            *high_um = 12.5 + 12.0 * turn.cos();
        }
        clip.take(tick, &amplitudes_um)?;
    }
    Progress::unheard(|progress| clip.finish(progress))?;
    Ok(())
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
