//! Mode B, interpolation and LOG, packet by packet.

use super::*;
use crate::message::samples;

const MODE_B: u16 = Caps::MODE_A | Caps::MODE_B | Caps::INTERPOLATES;

fn with(config: Config) -> Bench {
    let mut bench = Bench::of(DeviceModel {
        modes: MODE_B,
        max_body: 1024,
        ..DeviceModel::default()
    });
    bench.send(&Hello::new(SESSION));
    bench.configure(&config);
    bench.take();
    assert_eq!(bench.ack_of(&Arm::new(SESSION)), Some(AckCode::Ok));
    bench
}

fn in_mode_b() -> Bench {
    with(Config {
        mode: Config::SAMPLES,
        ..wish()
    })
}

/// Sends samples that are all the same; gives the code of the ACK, if one came.
fn play(bench: &mut Bench, first: u32, n: usize, value: i16) -> Option<AckCode> {
    bench.take();
    bench.seq += 1;
    let packet = samples::packet(bench.seq, first, 24, &vec![value; 24 * n]).unwrap();
    bench.bytes(packet.as_bytes());
    bench.last_ack().map(|ack| ack.code)
}

#[test]
fn unsupported_modes_and_flags_become_zero() {
    let asked = Config {
        mode: 7,
        flags: 0xff,
        ..wish()
    };
    let plain = DeviceModel::default().clamp(&asked);
    assert_eq!((plain.mode, plain.flags), (0, 0));
    let able = DeviceModel {
        modes: MODE_B,
        ..DeviceModel::default()
    };
    let given = able.clamp(&asked);
    assert_eq!((given.mode, given.flags), (0, Config::INTERPOLATE));
}

#[test]
fn each_mode_refuses_the_other_ones_packets() {
    let mut bench = in_mode_b();
    assert_eq!(bench.frame_ack(1), Some(AckCode::WrongState));
    assert_eq!(play(&mut bench, 8, 20, 100), None);
    assert_eq!(bench.core.state(), DeviceState::Run);
    let mut bench = with(wish());
    assert_eq!(play(&mut bench, 8, 20, 100), Some(AckCode::WrongState));
    let mut bench = Bench::armed();
    assert_eq!(play(&mut bench, 8, 4, 1), Some(AckCode::UnknownType));
}

#[test]
fn samples_of_odd_lengths_or_too_far_ahead_change_nothing() {
    let mut bench = in_mode_b();
    for (n, format, n_values) in [(2, 0, 24), (1, 0, 25), (1, 1, 24), (0, 0, 0)] {
        let mut payload = vec![8, 0, 0, 0, n, format, 0, 0];
        payload.extend(std::iter::repeat_n(1, 2 * n_values));
        let packet = Packet::encode(kind::SAMPLES, 900, &payload).unwrap();
        bench.take();
        bench.bytes(packet.as_bytes());
        let code = bench.last_ack().map(|ack| ack.code);
        assert_eq!(code, Some(AckCode::OutOfRange), "{n} {format} {n_values}");
    }
    assert_eq!(play(&mut bench, 790, 20, 5), Some(AckCode::QueueFull));
    assert_eq!(bench.core.state(), DeviceState::Armed);
    assert_eq!(bench.core.counters().bad, 0);
    let short = Packet::encode(kind::SAMPLES, 901, &[0; 7]).unwrap();
    bench.bytes(short.as_bytes());
    assert_eq!(bench.core.counters().bad, 1);
}

#[test]
fn samples_are_bounded_in_peak_and_step_and_late_ones_are_dropped() {
    let mut bench = with(Config {
        mode: Config::SAMPLES,
        comp_limit: [10_000, 10_000],
        slew: 2000,
        mask: ChannelMask::from_first_word(0b1),
        ..wish()
    });
    assert_eq!(play(&mut bench, 8, 20, 32_000), None);
    assert_eq!(
        bench.core.counters().clipped,
        20,
        "the one channel that is on"
    );
    bench.at(2000);
    let output = bench.core.output();
    assert_eq!(output[0], [2 * 8000, 0], "eight steps of 1000");
    assert_eq!(output[1], [0, 0]);
    bench.at(3500);
    assert_eq!(bench.core.output()[0], [2 * 10_000, 0], "the peak");
    assert_eq!(play(&mut bench, 10, 20, 0), None);
    assert_eq!(bench.core.counters().late, 1);
    bench.at(4000);
    assert_eq!(bench.core.state(), DeviceState::Run);
}

#[test]
fn stop_ends_samples_at_once_or_over_the_ramp() {
    for (how, after_ms) in [(StopHow::Now, 0), (StopHow::Ramp, 41)] {
        let mut bench = in_mode_b();
        play(&mut bench, 8, 20, 20_000);
        bench.at(5000);
        assert!(!bench.is_silent());
        bench.send(&Stop { reason: 0, how });
        let now = bench.now();
        bench.at(now + after_ms * 1000);
        assert!(bench.is_silent());
        assert_eq!(bench.core.state(), DeviceState::Ready);
    }
}

#[test]
fn amplitudes_move_linearly_inside_the_tick_if_asked_to() {
    let mut bench = with(Config {
        flags: Config::INTERPOLATE,
        ..wish()
    });
    bench.frame(1, [1000, 2000]);
    bench.at(25_000);
    assert_eq!(bench.core.output()[0], [0, 0]);
    assert_eq!(
        bench.last_status().unwrap().amp_sum,
        24 * 3000,
        "where it goes"
    );
    bench.at(37_500);
    assert_eq!(bench.core.output()[5], [500, 1000]);
    bench.frame(2, [0, 2000]);
    bench.at(50_000);
    assert_eq!(bench.core.output()[5], [1000, 2000]);
    bench.at(62_500);
    assert_eq!(bench.core.output()[5], [500, 2000]);
    let mut plain = Bench::armed();
    plain.frame(1, [1000, 2000]);
    plain.at(25_000);
    assert_eq!(plain.core.output()[0], [1000, 2000]);
}

#[test]
fn a_host_that_wants_to_is_told_why_output_ends() {
    for (flags, n_expected) in [(Hello::WANT_STATUS, 0), (3, 1)] {
        let mut bench = Bench::new();
        bench.send(&Hello {
            host_flags: flags,
            ..Hello::new(SESSION)
        });
        bench.configure(&wish());
        bench.send(&Arm::new(SESSION));
        bench.frame(1, [9, 9]);
        bench.at(200_000);
        let lines: Vec<String> = bench
            .take()
            .into_iter()
            .filter_map(|message| match message {
                DeviceMessage::Log(text) => Some(text.to_line()),
                _ => None,
            })
            .collect();
        assert_eq!(lines.len(), n_expected, "{lines:?}");
        assert_eq!(
            lines.iter().any(|line| line.contains("silent")),
            n_expected > 0
        );
    }
}
