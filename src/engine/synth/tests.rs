//! Amplitudes to samples to a device that plays them, in virtual time.

use std::f64::consts::TAU;

use super::*;
use selvedge_device::{BridgeState, Caps, DeviceModel, DeviceState, Simulation, StopHow};

const RATE_HZ: f64 = 8000.0;
const PER_TICK: usize = 200;
const N: usize = 24;

/// A device with these modes that streams for `ms`, asked for samples.
fn streaming(modes: u16, ms: u64) -> Simulation {
    let model = DeviceModel {
        modes,
        ..DeviceModel::default()
    };
    Simulation::playing(model, Box::new(DeviceWaveform::default()), ms)
}

fn by_samples(ms: u64) -> Simulation {
    let trial = streaming(Caps::MODE_A | Caps::MODE_B, ms);
    assert!(trial.host.plays_samples());
    assert_eq!(trial.host.no_samples(), None);
    trial
}

#[test]
fn what_is_played_is_what_mode_a_would_play_sample_for_sample() {
    let by_samples = by_samples(2000);
    let by_frames = streaming(Caps::MODE_A, 2000);
    assert_eq!(by_samples.host.state(), BridgeState::Streaming);
    let counters = by_samples.host.counters().device;
    assert_eq!(
        (counters.underrun, counters.late, counters.clipped),
        (0, 0, 0)
    );
    let (first, played) = &by_samples.log.played;
    let first = usize::try_from(first.unwrap()).unwrap();
    let mut synth = SampleSynth::prepare(8000, N).unwrap();
    let mut n_compared = 0;
    for (tick, _, codes) in &by_frames.log.frames {
        let at = usize::try_from(*tick).unwrap() * PER_TICK - first;
        let expected = synth.tick(codes);
        let Some(values) = played.get(N * at..N * (at + PER_TICK)) else {
            continue;
        };
        assert_eq!(values, expected, "tick {tick}");
        n_compared += 1;
    }
    assert!(n_compared >= 78, "soft start and all: {n_compared}");
    // The last second is at full gain, codes 13107 and 26214 of 65535: in closed form.
    let n_before = played.len() / N - 8000;
    for (number, sample) in (first..).zip(played.chunks(N)).skip(n_before) {
        let t_s = number as f64 / RATE_HZ;
        let wave = 0.2 * (TAU * 40.0 * t_s).sin() + 0.4 * (TAU * 320.0 * t_s).sin();
        for value in sample {
            let error = f64::from(*value) - 32767.0 * wave;
            assert!(error.abs() < 1.0, "{number}: {value} is off by {error}");
        }
    }
}

#[test]
fn every_sample_that_is_sent_is_counted_and_played_once() {
    let trial = by_samples(2000);
    let counts = &trial.log.sampled;
    let sum = |of: fn(&selvedge_device::SampleCount) -> u32| counts.iter().map(of).sum::<u32>();
    // What came in the tick that is not over yet is not counted.
    let n_sent = u32::try_from((trial.sent.len() - 1) * PER_TICK).unwrap();
    assert_eq!(sum(|count| count.received), n_sent);
    assert_eq!(
        (sum(|count| count.late), sum(|count| count.missing)),
        (0, 0)
    );
    let n_waiting = n_sent - sum(|count| count.played);
    assert_eq!(n_waiting, 200, "the last tick waits for its time");
    // A body of 256 bytes holds five samples of 24 channels.
    let packets: u32 = counts.iter().map(|count| u32::from(count.packets)).sum();
    assert_eq!(packets, n_sent / 5);
}

#[test]
fn samples_that_cease_are_held_and_ramped_to_silence_within_100_ms() {
    for phase_ms in [0, 7, 24] {
        let mut trial = by_samples(1000 + phase_ms);
        trial.run_without_frames(126);
        assert_eq!(trial.device.state(), DeviceState::Ready);
        assert!(trial.is_at_rest());
        assert!(trial.loudest_age_us <= 100_000, "{}", trial.loudest_age_us);
        assert_eq!(
            trial.host.state(),
            BridgeState::Ready,
            "and nothing re-arms"
        );
        trial.run_without_frames(500);
        assert_eq!(trial.device.state(), DeviceState::Ready);
    }
}

#[test]
fn a_stop_ends_samples_by_its_ramp_or_at_once() {
    for (how, within_ms) in [(StopHow::Ramp, 42), (StopHow::Now, 0)] {
        let mut trial = by_samples(1000);
        assert!(trial.is_loud());
        trial.host.stop(trial.now(), how);
        // What was made for the next tick already comes after STOP and changes nothing.
        trial.run(within_ms + 1);
        assert!(trial.is_at_rest(), "{how:?}");
        let (_, played) = &trial.log.played;
        let n_played = played.len();
        trial.run(200);
        assert_eq!(trial.log.played.1.len(), n_played, "{how:?}");
        assert_eq!(trial.host.state(), BridgeState::Ready);
    }
}

#[test]
fn a_device_without_mode_b_gets_amplitudes_and_says_why() {
    let trial = streaming(Caps::MODE_A, 200);
    assert_eq!(trial.host.state(), BridgeState::Streaming);
    assert!(!trial.host.plays_samples());
    assert!(
        trial
            .host
            .no_samples()
            .unwrap()
            .contains("offers no mode B")
    );
    assert!(!trial.log.frames.is_empty());
    let model = DeviceModel {
        modes: Caps::MODE_A | Caps::MODE_B,
        queue: 2,
        ..DeviceModel::default()
    };
    let trial = Simulation::playing(model, Box::new(DeviceWaveform::default()), 200);
    assert!(trial.host.no_samples().unwrap().contains("three ticks"));
    assert!(trial.log.sampled.is_empty());
}

#[test]
fn a_rate_whose_ticks_are_no_whole_samples_is_refused() {
    let error = SampleSynth::prepare(44_110, 24).unwrap_err().to_string();
    assert!(error.contains("multiple of 40 Hz"), "{error}");
    assert!(SampleSynth::prepare(8000, 0).is_err());
    assert!(!DeviceWaveform::default().prepare(44_110, 24));
}
