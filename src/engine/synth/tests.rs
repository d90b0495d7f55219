//! Amplitudes to samples to a device that plays them, in virtual time.

use std::f64::consts::TAU;
use std::time::{Duration, Instant};

use super::*;
use crate::bridge::{
    ArrayProfile, BridgeEvent, BridgeState, Caps, Decoder, DeviceCore, DeviceMessage, DeviceModel,
    DeviceSink, DeviceState, HostSession, Sequence,
};

/// What a device says, and what it played.
#[derive(Default)]
struct Heard {
    bytes: Vec<u8>,
    first: Option<u64>,
    samples: Vec<i16>,
}

impl DeviceSink for Heard {
    fn packet(&mut self, bytes: &[u8]) {
        self.bytes.extend_from_slice(bytes);
    }

    fn played(&mut self, first: u64, samples: &[i16]) {
        self.first.get_or_insert(first);
        self.samples.extend_from_slice(samples);
    }
}

/// Session and device on one clock, ms by ms.
struct Pair {
    host: HostSession,
    device: DeviceCore,
    synth: SampleSynth,
    heard: Heard,
    decoder: Decoder,
    start: Instant,
    us: u64,
    is_mute: bool,
}

impl Pair {
    fn new(modes: u16) -> Self {
        let model = DeviceModel {
            modes,
            max_body: 1024,
            ..DeviceModel::default()
        };
        let start = Instant::now();
        let mut host = HostSession::new(7, ArrayProfile::default(), 24, Sequence::default());
        host.prefer_samples();
        host.opened(start);
        Self {
            host,
            device: DeviceCore::new(model),
            synth: SampleSynth::prepare(8000, 24).unwrap(),
            heard: Heard::default(),
            decoder: Decoder::new(1024),
            start,
            us: 0,
            is_mute: false,
        }
    }

    fn armed() -> Self {
        let mut pair = Self::new(Caps::MODE_A | Caps::MODE_B);
        pair.run(60);
        assert!(pair.host.arm(pair.now()));
        pair
    }

    fn now(&self) -> Instant {
        self.start + Duration::from_micros(self.us)
    }

    fn run(&mut self, ms: u64) {
        for _ in 0..ms {
            self.us += 1000;
            self.device.advance(self.us, &mut self.heard);
            for byte in std::mem::take(&mut self.heard.bytes) {
                if let Some(packet) = self.decoder.push(byte) {
                    let message = DeviceMessage::decode(&packet, 24).unwrap();
                    self.host.on_message(self.now(), &message);
                }
            }
            self.host.on_time(self.now());
            while let Some(event) = self.host.next_event() {
                if matches!(event, BridgeEvent::Tick { .. }) && !self.is_mute {
                    self.answer();
                }
            }
            while let Some(packet) = self.host.take_stop().or_else(|| self.host.next_packet()) {
                self.device
                    .receive(self.us, packet.as_bytes(), &mut self.heard);
            }
        }
    }

    fn answer(&mut self) {
        let now = self.now();
        let um = [[10.0, 20.0]; 24];
        assert!(self.host.frame(now, &um).is_none(), "no frames in mode B");
        let per_packet = self.host.samples_per_packet();
        let Some((sent, codes)) = self.host.codes_to_play(now, &um) else {
            return;
        };
        let first = self.synth.first_of(sent.apply_tick);
        let samples = self.synth.tick(codes).to_vec();
        for (number, part) in (0_u32..).zip(samples.chunks(per_packet * 24)) {
            let first = first + number * u32::try_from(per_packet).unwrap();
            let packet = self.host.samples(now, first, part).unwrap();
            self.device
                .receive(self.us, packet.as_bytes(), &mut self.heard);
        }
    }
}

#[test]
fn a_device_plays_the_waveform_sample_for_sample() {
    let mut pair = Pair::armed();
    pair.run(2000);
    assert_eq!(pair.device.state(), DeviceState::Run);
    assert_eq!(pair.host.state(), BridgeState::Streaming);
    let counters = pair.device.counters();
    assert_eq!((counters.late, counters.clipped, counters.bad), (0, 0, 0));
    assert_eq!(counters.underrun, 0);
    // The last second is at full gain: codes 13107 and 26214 of 65535.
    let first = pair.heard.first.unwrap();
    let samples: Vec<&[i16]> = pair.heard.samples.chunks(24).collect();
    let n_before = samples.len() - 8000;
    for (number, sample) in (first..).zip(&samples).skip(n_before) {
        let t_s = number as f64 / 8000.0;
        let wave = 0.2 * (TAU * 40.0 * t_s).sin() + 0.4 * (TAU * 320.0 * t_s).sin();
        for value in *sample {
            let error = f64::from(*value) - 32767.0 * wave;
            assert!(error.abs() < 1.6, "{number}: {value} is off by {error}");
        }
    }
    assert!(pair.device.moment().amp_sum < 24 * 65535);
}

#[test]
fn samples_that_cease_are_held_and_ramped_to_silence_within_100_ms() {
    for phase_ms in [0, 7, 24] {
        let mut pair = Pair::armed();
        pair.run(1000 + phase_ms);
        pair.is_mute = true;
        pair.run(126);
        assert_eq!(pair.device.state(), DeviceState::Ready);
        assert!(pair.device.output().iter().all(|codes| *codes == [0, 0]));
        assert_eq!(pair.host.state(), BridgeState::Ready, "and nothing re-arms");
        pair.run(500);
        assert_eq!(pair.device.state(), DeviceState::Ready);
    }
}

#[test]
fn a_device_without_mode_b_gets_amplitudes() {
    let mut pair = Pair::new(Caps::MODE_A);
    pair.run(60);
    assert_eq!(pair.host.state(), BridgeState::Ready);
    assert!(!pair.host.plays_samples());
    assert!(pair.host.arm(pair.now()));
    let now = pair.now();
    assert!(pair.host.codes_to_play(now, &[[1.0, 1.0]; 24]).is_none());
    assert!(pair.host.samples(now, 0, &[0; 24]).is_none());
}

#[test]
fn a_rate_whose_ticks_are_no_whole_samples_is_refused() {
    let error = SampleSynth::prepare(44_110, 24).unwrap_err().to_string();
    assert!(error.contains("multiple of 40 Hz"), "{error}");
    assert!(SampleSynth::prepare(8000, 0).is_err());
}
