//! The device in virtual time: sessions, arming, silence, STOP, counters, faults, random bytes.

use proptest::prelude::*;

use super::*;
use crate::bridge::message::{
    Ack, AckCode, Arm, Caps, ChannelMask, Clear, DeviceMessage, Hello, Ident, MAGIC, NEXT_TICK,
    Ping, Stop, StopHow, frame, kind,
};

const SESSION: u32 = 0x00c0_ffee;

/// A device on a bench: what it sends and logs, decoded.
struct Bench {
    core: DeviceCore,
    sink: Collected,
    seq: u16,
}

#[derive(Default)]
struct Collected {
    bytes: Vec<u8>,
    applied: Vec<(u32, u16)>,
    changes: Vec<(u64, DeviceState)>,
}

impl DeviceSink for Collected {
    fn packet(&mut self, bytes: &[u8]) {
        self.bytes.extend_from_slice(bytes);
    }

    fn applied(&mut self, frame: &AppliedFrame<'_>) {
        self.applied.push((frame.moment.tick, frame.seq));
    }

    fn changed(&mut self, moment: &Moment) {
        self.changes.push((moment.dev_us, moment.state));
    }
}

fn wish() -> Config {
    Config {
        mode: 0,
        flags: 0,
        hold_ms: 60,
        ramp_ms: 40,
        slew: 0,
        hv_dv: 500,
        comp_limit: [65535; 2],
        mask: ChannelMask::first(24),
    }
}

impl Bench {
    fn new() -> Self {
        Self::of(DeviceModel::default())
    }

    fn of(model: DeviceModel) -> Self {
        Self {
            core: DeviceCore::new(model),
            sink: Collected::default(),
            seq: 0,
        }
    }

    fn ready() -> Self {
        let mut bench = Self::new();
        bench.send(&Hello::new(SESSION));
        bench.configure(&wish());
        bench.take();
        bench
    }

    fn armed() -> Self {
        Self::armed_with(&wish())
    }

    fn armed_with(config: &Config) -> Self {
        let mut bench = Self::ready();
        bench.configure(config);
        assert_eq!(bench.ack_of(&Arm::new(SESSION)), Some(AckCode::Ok));
        bench
    }

    fn now(&self) -> u64 {
        self.core.now_us
    }

    fn bytes(&mut self, bytes: &[u8]) {
        let now = self.now();
        self.core.receive(now, bytes, &mut self.sink);
    }

    fn send(&mut self, message: &impl Message) -> u16 {
        self.seq += 1;
        let packet = message.packet(self.seq).unwrap();
        self.bytes(packet.as_bytes());
        self.seq
    }

    fn configure(&mut self, config: &Config) {
        self.seq += 1;
        let packet = config
            .request(self.seq, self.core.model.n_channels())
            .unwrap();
        self.bytes(packet.as_bytes());
    }

    fn frame(&mut self, tick: u32, codes: [u16; 2]) -> u16 {
        self.seq += 1;
        let packet = frame::packet(self.seq, tick, &[codes; 24]).unwrap();
        self.bytes(packet.as_bytes());
        self.seq
    }

    fn at(&mut self, now_us: u64) -> &mut Self {
        self.core.advance(now_us, &mut self.sink);
        self
    }

    fn take(&mut self) -> Vec<DeviceMessage> {
        let mut decoder = Decoder::new(1024);
        let mut messages = Vec::new();
        for byte in std::mem::take(&mut self.sink.bytes) {
            if let Some(packet) = decoder.push(byte) {
                messages.push(DeviceMessage::decode(&packet, 24).unwrap());
            }
        }
        assert_eq!(decoder.bad(), 0);
        messages
    }

    fn last_ack(&mut self) -> Option<Ack> {
        let acks = self.take().into_iter().filter_map(|message| match message {
            DeviceMessage::Ack(ack) => Some(ack),
            _ => None,
        });
        acks.last()
    }

    /// The code of the ACK for `message`, checking that it names it.
    fn ack_of<M: Message>(&mut self, message: &M) -> Option<AckCode> {
        self.take();
        let seq = self.send(message);
        let ack = self.last_ack()?;
        assert_eq!((ack.kind, ack.seq), (M::KIND, seq));
        Some(ack.code)
    }

    fn frame_ack(&mut self, tick: u32) -> Option<AckCode> {
        self.take();
        self.frame(tick, [1, 1]);
        self.last_ack().map(|ack| ack.code)
    }

    fn last_status(&mut self) -> Option<Status> {
        let statuses = self.take().into_iter().filter_map(|message| match message {
            DeviceMessage::Status(status) => Some(status),
            _ => None,
        });
        statuses.last()
    }

    fn is_silent(&self) -> bool {
        self.core.output().iter().all(|codes| *codes == [0, 0])
    }
}

#[test]
fn the_handshake_leads_to_frames_at_their_ticks() {
    let mut bench = Bench::new();
    bench.send(&Hello::new(SESSION));
    let [DeviceMessage::Caps(caps)] = bench.take()[..] else {
        panic!("CAPS alone")
    };
    assert_eq!(
        (caps.session, caps.version, caps.n_ch, caps.tick_us),
        (SESSION, 1, 24, 25_000)
    );
    bench.configure(&Config {
        hold_ms: 90,
        ramp_ms: 90,
        slew: 0,
        hv_dv: 9999,
        ..wish()
    });
    let [DeviceMessage::Cfg(config)] = bench.take()[..] else {
        panic!("CFG alone")
    };
    assert_eq!((config.hold_ms, config.ramp_ms), (90, 10));
    assert_eq!((config.slew, config.hv_dv), (65535, 600));
    assert_eq!(bench.ack_of(&Arm::new(SESSION)), Some(AckCode::Ok));
    bench.frame(1, [1000, 2000]);
    assert!(bench.is_silent(), "not before its tick");
    bench.at(25_000);
    assert_eq!(bench.core.output(), vec![[1000, 2000]; 24]);
    let status = bench.last_status().unwrap();
    assert_eq!(
        (status.tick, status.amp_sum, status.hv_dv),
        (1, 24 * 3000, 600)
    );
    assert_eq!(status.device_state(), Some(DeviceState::Run));
}

#[test]
fn every_ack_code_is_given() {
    let mut bench = Bench::new();
    assert_eq!(
        bench.ack_of(&Arm::new(SESSION)),
        Some(AckCode::WrongState),
        "idle"
    );
    assert_eq!(
        bench.ack_of(&Stop {
            reason: 0,
            how: StopHow::Now
        }),
        Some(AckCode::Ok)
    );
    assert_eq!(bench.frame_ack(1), Some(AckCode::WrongState));
    bench.send(&Hello::new(SESSION));
    assert_eq!(
        bench.ack_of(&Arm::new(SESSION)),
        Some(AckCode::WrongState),
        "no CONFIG yet"
    );
    bench.configure(&wish());
    assert_eq!(bench.ack_of(&Arm::new(1)), Some(AckCode::BadSession));
    let key = Arm {
        session: SESSION,
        key: SESSION,
    };
    assert_eq!(bench.ack_of(&key), Some(AckCode::BadSession));
    let ident = Ident {
        channel: 3,
        ms: 10,
        amp: 77,
    };
    assert_eq!(bench.ack_of(&ident), Some(AckCode::WrongState));
    assert_eq!(bench.ack_of(&Arm::new(SESSION)), Some(AckCode::Ok));
    assert_eq!(
        bench.ack_of(&Arm::new(SESSION)),
        Some(AckCode::Ok),
        "repeated"
    );
    assert_eq!(
        bench.ack_of(&Ident {
            channel: 24,
            ..ident
        }),
        Some(AckCode::OutOfRange)
    );
    assert_eq!(
        bench.ack_of(&Ident { ms: 1001, ..ident }),
        Some(AckCode::OutOfRange)
    );
    assert_eq!(bench.ack_of(&ident), Some(AckCode::Ok));
    assert_eq!(bench.core.output()[3], [0, 77]);
    bench.at(10_000);
    assert!(bench.is_silent(), "10 ms are over");
    assert_eq!(bench.frame_ack(5), Some(AckCode::QueueFull));
    assert_eq!(bench.frame_ack(4), None, "an accepted FRAME has no ACK");
    assert_eq!(
        bench.ack_of(&Arm::new(SESSION)),
        Some(AckCode::WrongState),
        "running"
    );
    bench.bytes(
        Packet::encode(kind::FRAME, 900, &[0; 101])
            .unwrap()
            .as_bytes(),
    );
    assert_eq!(bench.last_ack().unwrap().code, AckCode::OutOfRange);
    for unknown in [0x00, 0x0a, 0x7f, kind::SAMPLES] {
        bench.bytes(Packet::encode(unknown, 9, &[0; 8]).unwrap().as_bytes());
        let ack = bench.last_ack().unwrap();
        assert_eq!((ack.kind, ack.code), (unknown, AckCode::UnknownType));
    }
    let mut sink = std::mem::take(&mut bench.sink);
    bench
        .core
        .raise_fault(fault_bit::OVER_CURRENT, 5, 42, &mut sink);
    bench.sink = sink;
    assert!(bench.is_silent());
    assert_eq!(bench.ack_of(&Arm::new(SESSION)), Some(AckCode::Faulted));
    assert_eq!(bench.frame_ack(NEXT_TICK), Some(AckCode::Faulted));
    assert_eq!(
        bench.ack_of(&Clear { bits: 0xffff }),
        Some(AckCode::Faulted),
        "cause persists"
    );
    bench.core.end_fault_cause(fault_bit::OVER_CURRENT);
    assert_eq!(bench.ack_of(&Clear { bits: 0xffff }), Some(AckCode::Ok));
    assert_eq!(bench.core.state(), DeviceState::Ready);
    let plain = DeviceModel {
        modes: Caps::MODE_A,
        ..DeviceModel::default()
    };
    assert_eq!(Bench::of(plain).ack_of(&ident), Some(AckCode::UnknownType));
}

#[test]
fn config_is_taken_in_ready_only() {
    let mut bench = Bench::armed();
    bench.take();
    bench.configure(&Config {
        hold_ms: 1,
        ..wish()
    });
    assert_eq!(bench.last_ack().unwrap().code, AckCode::WrongState);
    assert_eq!(bench.core.config.hold_ms, 60);
}

#[test]
fn silence_comes_within_100_ms_at_every_phase_and_depth() {
    for depth in 1..=3 {
        for phase_us in (0..25_000).step_by(457) {
            let mut bench = Bench::armed();
            for tick in 0..8 {
                bench.at(tick * 25_000 + phase_us);
                bench.frame(u32::try_from(tick).unwrap() + depth, [30_000, 20_000]);
            }
            let last_us = bench.now();
            bench.at(last_us + 60_000);
            assert!(!bench.is_silent(), "held at first");
            bench.at(last_us + 100_000);
            assert!(bench.is_silent(), "depth {depth}, phase {phase_us}");
            assert_eq!(bench.core.state(), DeviceState::Ready);
            assert_eq!(bench.core.moment().amp_sum, 0);
        }
    }
}

#[test]
fn the_ramp_falls_by_equal_steps_on_the_ms_clock() {
    let mut bench = Bench::armed();
    bench.frame(1, [40_000, 0]);
    for ms in 0..=60 {
        bench.at(ms * 1000);
    }
    for ms in 61..100_u16 {
        bench.at(u64::from(ms) * 1000);
        let expected = u32::from(100 - ms) * 1000;
        assert_eq!(u32::from(bench.core.output()[0][0]), expected, "{ms} ms");
    }
    bench.at(100_000);
    assert!(bench.is_silent());
}

#[test]
fn a_frame_in_the_ramp_raises_the_gain_without_a_jump() {
    let mut bench = Bench::armed();
    bench.frame(1, [40_000, 0]);
    bench.at(80_000);
    assert_eq!(bench.core.output()[0][0], 20_000);
    bench.frame(NEXT_TICK, [40_000, 0]);
    assert_eq!(bench.core.state(), DeviceState::Run);
    assert_eq!(bench.core.output()[0][0], 20_000);
    bench.at(90_000);
    assert_eq!(bench.core.output()[0][0], 30_000);
    bench.at(110_000);
    assert_eq!(bench.core.output()[0][0], 40_000);
}

#[test]
fn a_ramp_of_zero_is_silence_at_once() {
    let mut bench = Bench::armed_with(&Config {
        hold_ms: 20,
        ramp_ms: 0,
        ..wish()
    });
    bench.frame(NEXT_TICK, [40_000, 0]);
    bench.at(20_000);
    assert_eq!(bench.core.state(), DeviceState::Run);
    bench.at(21_000);
    assert_eq!(bench.core.state(), DeviceState::Ready);
}

#[test]
fn stop_ramps_or_ends_at_once_and_frames_meanwhile_are_refused() {
    let mut bench = Bench::armed();
    bench.frame(1, [40_000, 0]);
    bench.at(30_000);
    assert_eq!(
        bench.ack_of(&Stop {
            reason: 0,
            how: StopHow::Ramp
        }),
        Some(AckCode::Ok)
    );
    assert_eq!(bench.core.state(), DeviceState::Ramp);
    assert_eq!(bench.frame_ack(NEXT_TICK), Some(AckCode::WrongState));
    bench.at(50_000);
    assert_eq!(bench.core.output()[0][0], 20_000);
    bench.at(70_000);
    assert_eq!(bench.core.state(), DeviceState::Ready);
    assert!(bench.is_silent());
    assert_eq!(
        bench.core.counters().underrun,
        0,
        "a stopped device misses nothing"
    );

    bench.send(&Arm::new(SESSION));
    bench.frame(NEXT_TICK, [40_000, 0]);
    bench.at(80_000);
    assert!(!bench.is_silent());
    bench.send(&Stop {
        reason: 0,
        how: StopHow::Now,
    });
    assert!(bench.is_silent());
    assert_eq!(bench.core.state(), DeviceState::Ready);
}

#[test]
fn the_lease_ends_a_quiet_session_and_ramps_running_output_first() {
    let mut bench = Bench::armed();
    bench.at(900_000);
    bench.send(&Ping { token: 1 });
    bench.at(1_900_000);
    assert_eq!(
        bench.core.state(),
        DeviceState::Armed,
        "a PING renews the lease"
    );
    bench.take();
    bench.at(1_901_000);
    assert_eq!(bench.core.state(), DeviceState::Idle);
    bench.at(10_000_000);
    assert!(bench.take().is_empty(), "no STATUS without a session");
    assert_eq!(bench.core.tick(), 400);

    let mut bench = Bench::new();
    bench.send(&Hello {
        lease_ms: 30,
        ..Hello::new(SESSION)
    });
    bench.configure(&wish());
    bench.send(&Arm::new(SESSION));
    bench.frame(1, [40_000, 0]);
    bench.at(31_000);
    assert_eq!(bench.core.state(), DeviceState::Ramp);
    assert_eq!(bench.core.output()[0][0], 39_000);
    bench.at(50_000);
    assert_ne!(
        bench.last_status().unwrap().faults & fault_bit::LEASE_LOST,
        0
    );
    bench.at(70_000);
    assert_eq!(bench.core.state(), DeviceState::Idle);
    assert!(bench.is_silent());
}

#[test]
fn late_duplicate_and_missing_frames_are_counted() {
    let mut bench = Bench::armed();
    bench.at(30_000);
    bench.frame(1, [5, 0]);
    assert_eq!(bench.core.counters().late, 1);
    let packet = frame::packet(bench.seq, 2, &[[9, 9]; 24]).unwrap();
    bench.at(40_000).bytes(packet.as_bytes());
    assert_eq!(bench.core.counters().dup, 1);
    assert_eq!(
        bench.core.age_ms(),
        10,
        "a duplicate renews the lease, not the age"
    );
    bench.at(50_000);
    assert_eq!(
        bench.core.output()[0],
        [5, 0],
        "late frames take the next tick"
    );
    bench.at(75_000);
    assert_eq!(bench.core.counters().underrun, 1);
    assert_eq!(bench.core.state(), DeviceState::Hold);
    let last = bench.frame(4, [6, 0]);
    bench.at(100_000);
    assert_eq!(bench.core.state(), DeviceState::Run);
    assert_eq!(bench.last_status().unwrap().last_seq, last);
    assert_eq!(bench.sink.applied, [(2, last - 1), (4, last)]);
}

#[test]
fn apply_ticks_compare_across_the_wrap() {
    let mut bench = Bench::armed();
    bench.core.now_us = u64::from(u32::MAX - 1) * TICK;
    bench.core.session.as_mut().unwrap().last_valid_us = bench.core.now_us;
    // The next tick is FFFFFFFF, which as a stamp means "next"; 0 and 1 lie behind the wrap.
    bench.frame(NEXT_TICK, [1, 0]);
    bench.frame(0, [2, 0]);
    bench.frame(1, [3, 0]);
    assert_eq!(bench.core.counters().late, 0);
    assert_eq!(bench.core.queue.len(), 3);
    bench.frame(u32::MAX - 1, [4, 0]);
    assert_eq!(bench.core.counters().late, 1);
    let now = bench.now();
    bench.at(now + TICK);
    assert_eq!(bench.core.output()[0], [4, 0]);
    bench.at(now + 2 * TICK);
    assert_eq!((bench.core.tick(), bench.core.output()[0]), (0, [2, 0]));
}

#[test]
fn clipping_counts_values_and_channels_and_masked_channels_stay_silent() {
    let config = Config {
        comp_limit: [40_000, 65_535],
        mask: ChannelMask::from_first_word(0b111),
        ..wish()
    };
    let mut bench = Bench::armed_with(&config);
    bench.frame(1, [50_000, 50_000]);
    // Three channels: one value over the limit each, then 90000 shared.
    assert_eq!(bench.core.counters().clipped, 6);
    bench.at(25_000);
    let output = bench.core.output();
    assert_eq!(output[2], [29_126, 36_408]);
    assert_eq!(output[3], [0, 0]);
}

#[test]
fn slew_moves_every_component_a_step_a_tick_also_in_hold() {
    let mut bench = Bench::armed_with(&Config {
        slew: 1000,
        ..wish()
    });
    bench.frame(1, [2500, 800]);
    bench.at(25_000);
    assert_eq!(bench.core.output()[0], [1000, 800]);
    bench.at(50_000);
    assert_eq!(bench.core.output()[0], [2000, 800]);
    bench.frame(3, [0, 0]);
    bench.at(75_000);
    assert_eq!(bench.core.output()[0], [1000, 0]);
}

#[test]
fn hello_while_running_is_zero_at_once_and_a_foreign_one_changes_nothing() {
    let mut bench = Bench::armed();
    bench.frame(1, [40_000, 0]);
    bench.at(25_000);
    bench.send(&Hello {
        magic: *b"HBP2",
        ..Hello::new(7)
    });
    bench.send(&Hello::new(0));
    assert_eq!(bench.core.counters().bad, 2);
    assert_eq!(bench.core.state(), DeviceState::Run);
    bench.send(&Hello::new(7));
    assert_eq!(bench.core.state(), DeviceState::Ready);
    assert!(bench.is_silent());
    assert_eq!(
        bench.ack_of(&Arm::new(7)),
        Some(AckCode::WrongState),
        "a new session has no CONFIG"
    );
    bench.take();
    bench.send(&Hello {
        ver_min: 2,
        ver_max: 9,
        ..Hello::new(8)
    });
    let [DeviceMessage::Caps(caps)] = bench.take()[..] else {
        panic!("CAPS alone")
    };
    assert_eq!((caps.version, caps.magic), (0, MAGIC));
    assert_eq!(bench.core.state(), DeviceState::Idle);
}

#[test]
fn faults_are_told_every_100_ms_in_a_session() {
    let mut bench = Bench::ready();
    let mut sink = std::mem::take(&mut bench.sink);
    bench
        .core
        .raise_fault(fault_bit::HIGH_VOLTAGE, 0xffff, 7, &mut sink);
    bench.sink = sink;
    bench.at(350_000);
    let faults = bench
        .take()
        .into_iter()
        .filter(|m| matches!(m, DeviceMessage::Fault(_)))
        .count();
    assert_eq!(faults, 4);
    bench.send(&Hello::new(9));
    assert_eq!(
        bench.core.state(),
        DeviceState::Fault,
        "HELLO does not clear"
    );
}

#[test]
fn short_payloads_and_device_types_are_bad_and_do_not_renew_the_lease() {
    let mut bench = Bench::ready();
    let kinds = [1, 2, 3, 4, 5, 6, 7, 8, 9, 0x80, 0x84, 0xff];
    for kind in kinds {
        bench.at(500_000);
        bench.bytes(Packet::encode(kind, 1, &[0]).unwrap().as_bytes());
        assert!(bench.last_ack().is_none(), "{kind}");
    }
    assert_eq!(usize::from(bench.core.counters().bad), kinds.len());
    bench.at(1_001_000);
    assert_eq!(bench.core.state(), DeviceState::Idle);
}

/// 400 frames at depth 2 with garbage, a repeated, a bit-flipped and a truncated frame: the counters of the C prototype.
#[test]
fn the_prototype_run_is_reproduced() {
    let mut bench = Bench::armed();
    for tick in 0..400_u32 {
        bench.at(u64::from(tick) * 25_000 + 3000);
        bench.seq += 1;
        let packet = frame::packet(bench.seq, tick + 2, &[[1000, 500]; 24]).unwrap();
        let mut wire = packet.as_bytes().to_vec();
        match tick {
            100 => wire = [b"AT+GCAP\r\n".as_slice(), &wire].concat(),
            150 => wire = [wire.clone(), wire].concat(),
            200 => wire[40] ^= 4,
            250 => wire.truncate(60),
            _ => {}
        }
        bench.bytes(&wire);
    }
    let expected = CoreCounters {
        underrun: 3,
        late: 0,
        dup: 1,
        bad: 3,
        clipped: 0,
    };
    assert_eq!(bench.core.counters(), expected);
    assert_eq!(bench.core.state(), DeviceState::Run, "the stream continued");
}

#[test]
fn deadlines_miss_nothing() {
    let mut stepped = Bench::armed();
    let mut waiting = Bench::armed();
    for bench in [&mut stepped, &mut waiting] {
        bench.at(3300);
        bench.frame(NEXT_TICK, [40_000, 0]);
    }
    for us in (3300..2_000_000).step_by(100) {
        stepped.at(us);
    }
    while let Some(deadline_us) = waiting.core.next_deadline_us() {
        assert!(deadline_us > waiting.now());
        waiting.at(deadline_us);
    }
    stepped.at(2_000_000);
    assert_eq!(stepped.sink.changes, waiting.sink.changes);
    assert_eq!(stepped.take(), waiting.take());
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    #[test]
    fn random_bytes_never_arm(
        chunks in prop::collection::vec((0u64..50_000, prop::collection::vec(any::<u8>(), 0..80)), 0..20),
    ) {
        let mut bench = Bench::ready();
        for (wait_us, bytes) in chunks {
            let now = bench.now() + wait_us;
            bench.core.receive(now, &bytes, &mut bench.sink);
            prop_assert!(!bench.core.state().is_live());
            prop_assert!(bench.is_silent());
        }
    }

    /// Valid packets with random contents: only the right ARM arms, and the bytes sent stay few.
    #[test]
    fn random_packets_never_arm_and_answers_are_bounded(
        packets in prop::collection::vec(
            (0u8..12, any::<u16>(), prop::collection::vec(any::<u8>(), 0..110)), 0..60),
    ) {
        let mut bench = Bench::ready();
        for (kind, seq, payload) in &packets {
            let packet = Packet::encode(*kind, *seq, payload).unwrap();
            let now = bench.now() + 1000;
            bench.core.receive(now, packet.as_bytes(), &mut bench.sink);
            prop_assert!(!bench.core.state().is_live());
        }
        prop_assert!(bench.sink.bytes.len() <= packets.len() * 110 + 200);
    }

    /// Whatever an armed device receives, its output keeps its bounds and dies with the frames.
    #[test]
    fn random_packets_to_an_armed_device_end_in_silence(
        packets in prop::collection::vec(
            (3u8..10, any::<u16>(), 0u64..40_000, prop::collection::vec(any::<u8>(), 100)), 0..40),
    ) {
        let mut bench = Bench::armed();
        for (kind, seq, wait_us, payload) in &packets {
            let packet = Packet::encode(*kind, *seq, payload).unwrap();
            let now = bench.now() + wait_us;
            bench.core.receive(now, packet.as_bytes(), &mut bench.sink);
            for [low, high] in bench.core.output() {
                prop_assert!(u32::from(low) + u32::from(high) <= 65535);
            }
        }
        let now = bench.now();
        bench.at(now + 1_000_000);
        prop_assert!(bench.is_silent());
    }
}
