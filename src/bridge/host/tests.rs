//! The session in virtual time: alone against scripted messages, and end to end against the device.

use proptest::prelude::*;

use super::*;
use crate::bridge::device::{AppliedFrame, DeviceCore, DeviceModel, DeviceSink, Moment};
use crate::bridge::framing::Decoder;
use crate::bridge::message::{Ack, AckCode, DeviceMessage, DeviceState, Fault, fault_bit};

const NONCE: u32 = 0x1234_5678;

fn session() -> HostSession {
    HostSession::new(NONCE, ArrayProfile::default(), 24, Sequence::default())
}

/// Session and device on one virtual clock; the link delivers at once unless told to lose.
struct Pair {
    host: HostSession,
    device: DeviceCore,
    start: Instant,
    us: u64,
    decoder: Decoder,
    log: Log,
    events: Vec<BridgeEvent>,
    sent: Vec<(SentFrame, Vec<[f32; 2]>)>,
    amplitude_um: [f32; 2],
    cut: bool,
}

#[derive(Default)]
struct Log {
    bytes: Vec<u8>,
    frames: Vec<(u32, u16, Vec<[u16; 2]>)>,
}

impl DeviceSink for Log {
    fn packet(&mut self, bytes: &[u8]) {
        self.bytes.extend_from_slice(bytes);
    }

    fn applied(&mut self, frame: &AppliedFrame<'_>) {
        self.frames
            .push((frame.moment.tick, frame.seq, frame.codes.to_vec()));
    }

    fn changed(&mut self, _moment: &Moment) {}
}

impl Pair {
    fn new() -> Self {
        Self::of(DeviceModel::default())
    }

    fn of(model: DeviceModel) -> Self {
        let start = Instant::now();
        let mut host = session();
        host.opened(start);
        Self {
            host,
            device: DeviceCore::new(model),
            start,
            us: 0,
            decoder: Decoder::new(1024),
            log: Log::default(),
            events: Vec::new(),
            sent: Vec::new(),
            amplitude_um: [10.0, 20.0],
            cut: false,
        }
    }

    fn now(&self) -> Instant {
        self.start + Duration::from_micros(self.us)
    }

    /// Runs for `ms`, the host acting every ms and answering every tick with a frame.
    fn run(&mut self, ms: u64) {
        for _ in 0..ms {
            self.us += 1000;
            self.device.advance(self.us, &mut self.log);
            self.deliver();
            self.host.on_time(self.now());
            self.exchange();
        }
    }

    fn exchange(&mut self) {
        while let Some(event) = self.host.next_event() {
            if matches!(event, BridgeEvent::Tick { .. }) {
                let amplitudes = vec![self.amplitude_um; 24];
                if let Some((stamp, packet)) = self.host.frame(self.now(), &amplitudes) {
                    self.sent.push((stamp, amplitudes));
                    self.to_device(&packet);
                }
            } else {
                self.events.push(event);
            }
        }
        while let Some(packet) = self.host.take_stop().or_else(|| self.host.next_packet()) {
            self.to_device(&packet);
            self.deliver();
        }
    }

    fn to_device(&mut self, packet: &Packet) {
        if !self.cut {
            self.device
                .receive(self.us, packet.as_bytes(), &mut self.log);
        }
    }

    fn deliver(&mut self) {
        let bytes = std::mem::take(&mut self.log.bytes);
        if self.cut {
            return;
        }
        let now = self.now();
        for byte in bytes {
            if let Some(packet) = self.decoder.push(byte) {
                self.host
                    .on_message(now, &DeviceMessage::decode(&packet, 24).unwrap());
            }
        }
    }

    fn streaming(ms: u64) -> Self {
        let mut pair = Self::new();
        pair.run(60);
        assert_eq!(pair.host.state(), BridgeState::Ready);
        assert!(pair.host.arm(pair.now()));
        pair.run(ms);
        pair
    }

    fn disarmed_by(&self) -> Option<(DisarmedBy, &str)> {
        self.events.iter().rev().find_map(|event| match event {
            BridgeEvent::Disarmed { by, reason } => Some((*by, reason.as_str())),
            _ => None,
        })
    }

    fn lost(&self) -> Option<&str> {
        self.events.iter().find_map(|event| match event {
            BridgeEvent::Lost(reason) => Some(reason.as_str()),
            _ => None,
        })
    }
}

#[test]
fn host_and_device_stream_without_a_miss() {
    let mut pair = Pair::streaming(2000);
    assert!(matches!(pair.events[0], BridgeEvent::Connected(_)));
    assert!(matches!(pair.events[1], BridgeEvent::Ready(_)));
    assert_eq!(pair.events[2..], [BridgeEvent::Armed]);
    assert_eq!(pair.host.state(), BridgeState::Streaming);
    assert_eq!(pair.host.counters().device, DeviceCounters::default());
    assert_eq!(
        pair.log.frames.len() + 1,
        pair.sent.len(),
        "the last one waits for its tick"
    );
    // Every applied frame holds the codes of its amplitudes and soft-start gain, in apply order.
    let first = pair.log.frames[0].0;
    for (index, (tick, seq, codes)) in pair.log.frames.iter().enumerate() {
        let (stamp, amplitudes) = &pair.sent[index];
        assert_eq!((*tick, *seq), (stamp.apply_tick, stamp.seq));
        assert_eq!(*tick, first + u32::try_from(index).unwrap());
        let gain = (f64::from(tick - first + 1) / 20.0).min(1.0);
        assert!((stamp.gain - gain).abs() < 1e-12);
        let expected = Coder::new(&ArrayProfile::default(), 24).encode(amplitudes, gain);
        assert_eq!(*codes, expected);
    }
    assert_eq!(pair.device.output(), vec![[13107, 26214]; 24]);

    pair.host.stop(pair.now(), StopHow::Ramp);
    assert!(pair.host.frame(pair.now(), &[[1.0, 1.0]; 24]).is_none());
    pair.run(10);
    assert_eq!(pair.disarmed_by(), Some((DisarmedBy::Host, "stopped")));
    assert_eq!(pair.host.state(), BridgeState::Stopping, "still ramping");
    pair.run(90);
    assert_eq!(pair.host.state(), BridgeState::Ready);
    assert_eq!(pair.device.state(), DeviceState::Ready);
    pair.run(3000);
    assert_eq!(
        pair.host.state(),
        BridgeState::Ready,
        "pings keep the lease"
    );
    assert!(pair.host.arm(pair.now()));
    pair.run(200);
    assert_eq!(
        pair.device.state(),
        DeviceState::Run,
        "and it can be armed again"
    );
}

#[test]
fn an_idle_host_never_arms_and_refuses_frames() {
    let mut pair = Pair::new();
    pair.run(5000);
    assert!(pair.host.frame(pair.now(), &[[9.0, 9.0]; 24]).is_none());
    assert_eq!(pair.device.state(), DeviceState::Ready);
    assert!(pair.sent.is_empty());
}

#[test]
fn a_lost_frame_is_bridged_and_a_late_one_deepens() {
    let mut pair = Pair::streaming(500);
    pair.cut = true;
    pair.run(25);
    pair.cut = false;
    pair.run(500);
    assert_eq!(pair.host.state(), BridgeState::Streaming);
    assert!(pair.host.counters().device.underrun >= 1);
    let late = frame::packet(60_000, 1, &[[0, 0]; 24]).unwrap();
    pair.to_device(&late);
    pair.run(50);
    assert_eq!(pair.host.depth(), 2);
    assert!(pair.events.contains(&BridgeEvent::DepthRaised(2)));
}

#[test]
fn a_cut_link_is_lost_within_500_ms_and_the_device_silent_within_100() {
    let mut pair = Pair::streaming(500);
    pair.cut = true;
    pair.run(125);
    assert!(pair.device.output().iter().all(|codes| *codes == [0, 0]));
    assert_eq!(pair.host.state(), BridgeState::Streaming);
    pair.run(400);
    assert_eq!(pair.host.state(), BridgeState::Lost);
    assert!(pair.lost().unwrap().starts_with("no STATUS for 500 ms"));
}

#[test]
fn a_device_that_disarms_itself_is_not_armed_again() {
    let mut pair = Pair::streaming(500);
    let stop = Stop {
        reason: 0,
        how: StopHow::Now,
    }
    .packet(60_000)
    .unwrap();
    pair.to_device(&stop);
    pair.run(1000);
    let (by, reason) = pair.disarmed_by().unwrap();
    assert_eq!(by, DisarmedBy::Device);
    assert!(reason.contains("disarmed itself"), "{reason}");
    assert_eq!(pair.host.state(), BridgeState::Ready);
    assert_eq!(pair.device.state(), DeviceState::Ready);
}

#[test]
fn a_fault_disarms_is_shown_and_can_be_cleared() {
    let mut pair = Pair::streaming(500);
    pair.device
        .raise_fault(fault_bit::OVER_TEMPERATURE, 3, 9000, &mut pair.log);
    pair.run(100);
    assert_eq!(pair.host.state(), BridgeState::Faulted);
    assert!(pair.disarmed_by().unwrap().1.contains("over-temperature"));
    let told = pair.events.iter().any(|event| {
        matches!(
            event,
            BridgeEvent::Fault(Fault {
                channel: 3,
                value: 9000,
                ..
            })
        )
    });
    assert!(told);
    assert!(!pair.host.arm(pair.now()));
    pair.device.end_fault_cause(fault_bit::OVER_TEMPERATURE);
    pair.host.clear_faults(pair.now());
    pair.run(100);
    assert_eq!(pair.host.state(), BridgeState::Ready);
}

#[test]
fn a_silent_port_is_greeted_for_5_s() {
    let start = Instant::now();
    let mut host = session();
    host.opened(start);
    assert_eq!(host.next_packet().unwrap().as_bytes(), [0]);
    let mut hellos = 0;
    for ms in 0..6000 {
        host.on_time(start + Duration::from_millis(ms));
        while host.next_packet().is_some() {
            hellos += 1;
        }
    }
    assert_eq!(hellos, 20);
    let Some(BridgeEvent::Lost(reason)) = host.next_event() else {
        panic!("lost")
    };
    assert!(reason.contains("powered"), "{reason}");
}

#[test]
fn stale_messages_before_our_caps_are_ignored() {
    let now = Instant::now();
    let mut host = session();
    host.opened(now);
    let status = Status {
        tick: 9,
        state: 3,
        ..Status::default()
    };
    for _ in 0..20 {
        host.on_message(now, &DeviceMessage::Status(status));
    }
    let other = DeviceModel::default().caps(NONCE + 1, 1);
    host.on_message(now, &DeviceMessage::Caps(other));
    assert_eq!(host.state(), BridgeState::Greeting);
    assert!(host.next_event().is_none());
}

#[test]
fn caps_that_cannot_be_driven_are_refused_with_a_line() {
    let good = DeviceModel::default().caps(NONCE, 1);
    let cases = [
        (Caps { version: 0, ..good }, "version"),
        (Caps { rows: 5, ..good }, "5 rows"),
        (
            Caps {
                rows: 5,
                cols: 5,
                n_ch: 25,
                ..good
            },
            "25 channels",
        ),
        (Caps { n_comp: 1, ..good }, "components"),
        (
            Caps {
                tick_us: 20_000,
                ..good
            },
            "20000 µs",
        ),
        (
            Caps {
                freq_mhz: [40_000, 250_000],
                ..good
            },
            "250 Hz",
        ),
        (
            Caps {
                max_body: 107,
                ..good
            },
            "needs 108",
        ),
    ];
    for (caps, word) in cases {
        let now = Instant::now();
        let mut host = session();
        host.opened(now);
        host.on_message(now, &DeviceMessage::Caps(caps));
        assert_eq!(host.state(), BridgeState::Refused);
        let Some(BridgeEvent::Refused(reason)) = host.next_event() else {
            panic!("refused")
        };
        assert!(reason.contains(word) && !reason.contains('\n'), "{reason}");
        assert!(!host.arm(now));
        host.on_message(now, &DeviceMessage::Caps(good));
        assert_eq!(host.state(), BridgeState::Refused);
    }
    let now = Instant::now();
    let mut host = session();
    host.opened(now);
    host.on_message(
        now,
        &DeviceMessage::Caps(Caps {
            max_body: 108,
            ..good
        }),
    );
    assert_eq!(host.state(), BridgeState::Configuring);
}

/// Brings a session alone to `Ready`, emptying its queues.
fn ready_alone(now: Instant) -> HostSession {
    let mut host = session();
    host.opened(now);
    host.on_message(
        now,
        &DeviceMessage::Caps(DeviceModel::default().caps(NONCE, 1)),
    );
    let config = host.wish();
    host.on_message(now, &DeviceMessage::Cfg(config));
    assert_eq!(host.state(), BridgeState::Ready);
    while host.next_packet().is_some() {}
    while host.next_event().is_some() {}
    host
}

/// Lets 10 s pass in which the device only ticks; gives how many STOP and other packets went out.
fn ticking_only(host: &mut HostSession, start: Instant) -> (usize, usize) {
    let mut counts = (0, 0);
    for ms in 0..10_000 {
        let now = start + Duration::from_millis(ms);
        host.on_time(now);
        if ms % 25 == 0 && host.state().is_open() {
            let status = Status {
                state: 1,
                ..Status::default()
            };
            host.on_message(now, &DeviceMessage::Status(status));
        }
        counts.0 += usize::from(host.take_stop().is_some());
        while let Some(packet) = host.next_packet() {
            counts.1 += usize::from(packet.as_bytes().len() > 15);
        }
    }
    counts
}

#[test]
fn an_unanswered_stop_is_repeated_8_times_and_then_the_link_is_lost() {
    let start = Instant::now();
    let mut host = ready_alone(start);
    host.stop(start, StopHow::Ramp);
    let (stops, _) = ticking_only(&mut host, start);
    // Once, eight repeats, and a last one into the lost link.
    assert_eq!(stops, 10);
    assert_eq!(host.state(), BridgeState::Lost);
}

#[test]
fn an_unanswered_arm_is_repeated_8_times_and_ends_in_stop() {
    let start = Instant::now();
    let mut host = ready_alone(start);
    assert!(host.arm(start));
    let (stops, arms) = ticking_only(&mut host, start);
    assert_eq!(arms, 9);
    assert!(stops > 0);
    assert!(host.frame(start, &[[1.0, 1.0]; 24]).is_none());
}

#[test]
fn replies_to_older_requests_do_not_arm() {
    let start = Instant::now();
    let mut host = ready_alone(start);
    let ack = |seq| {
        DeviceMessage::Ack(Ack {
            kind: kind::ARM,
            code: AckCode::Ok,
            seq,
        })
    };
    host.on_message(start, &ack(7));
    assert_eq!(host.state(), BridgeState::Ready, "nobody asked");
    let seq = host.sequence.next().wrapping_add(1);
    host.arm(start);
    host.on_message(start, &ack(seq.wrapping_sub(1)));
    host.on_message(start, &ack(seq.wrapping_add(1)));
    assert_eq!(host.state(), BridgeState::Arming);
    host.on_message(start, &ack(seq));
    assert_eq!(host.state(), BridgeState::Armed);
    host.stop(start, StopHow::Now);
    host.on_message(start, &ack(seq));
    assert_eq!(
        host.state(),
        BridgeState::Stopping,
        "not armed behind a STOP's back"
    );
}

#[test]
fn a_refused_arm_says_why() {
    let start = Instant::now();
    let mut host = ready_alone(start);
    let seq = host.sequence.next().wrapping_add(1);
    host.arm(start);
    let ack = Ack {
        kind: kind::ARM,
        code: AckCode::WrongState,
        seq,
    };
    host.on_message(start, &DeviceMessage::Ack(ack));
    assert_eq!(host.state(), BridgeState::Ready);
    let Some(BridgeEvent::Disarmed { reason, .. }) = host.next_event() else {
        panic!("disarmed")
    };
    assert!(reason.contains("not possible in this state"), "{reason}");
}

#[test]
fn missing_ticks_are_estimated_and_a_suspended_host_is_not_lost() {
    let mut pair = Pair::streaming(500);
    let tick = pair.host.status().unwrap().tick;
    let received = pair.host.status_received().unwrap();
    let later = received + Duration::from_millis(37);
    let (stamp, _) = pair.host.frame(later, &[[1.0, 1.0]; 24]).unwrap();
    assert_eq!(stamp.apply_tick, tick + 2);
    // An hour passes for the host alone, then it goes on.
    pair.start += Duration::from_secs(3600);
    pair.run(30);
    assert!(pair.host.state().is_open());
}

#[test]
fn soft_start_is_linear_over_20_ticks() {
    let first = u32::MAX - 3;
    for since in 0..40 {
        let expected = (f64::from(since + 1) / 20.0).min(1.0);
        let gain = soft_start_gain(first, first.wrapping_add(since));
        assert!((gain - expected).abs() < 1e-15, "{since}");
    }
    assert!((soft_start_gain(10, 9) - 0.05).abs() < 1e-15);
}

#[test]
fn news_are_bounded_when_nobody_takes_them() {
    let start = Instant::now();
    let mut host = ready_alone(start);
    for tick in 0..1000 {
        host.on_message(
            start,
            &DeviceMessage::Status(Status {
                tick,
                state: 1,
                ..Status::default()
            }),
        );
        host.ping(start);
    }
    assert!(host.events.len() <= MOST_EVENTS && host.packets.len() <= MOST_PACKETS);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(1000))]

    /// Random packets and texts at any moment: no panic, never armed without ARM's own ACK, bounded queues.
    #[test]
    fn random_device_bytes_never_arm(
        steps in prop::collection::vec(
            (0u64..300, 0x80u8..0x90, any::<u16>(), prop::collection::vec(any::<u8>(), 0..80), any::<bool>()),
            0..40),
        greeted in any::<bool>(),
    ) {
        let start = Instant::now();
        let mut host = if greeted { ready_alone(start) } else { session() };
        host.opened(start);
        let mut decoder = Decoder::new(1024);
        let mut ms = 0;
        for (wait_ms, kind, seq, payload, framed) in steps {
            ms += wait_ms;
            let now = start + Duration::from_millis(ms);
            let wire = if framed {
                Packet::encode(kind, seq, &payload).unwrap().as_bytes().to_vec()
            } else {
                payload
            };
            for byte in wire {
                if let Some(packet) = decoder.push(byte)
                    && let Ok(message) = DeviceMessage::decode(&packet, 24)
                {
                    host.on_message(now, &message);
                }
            }
            host.on_time(now);
            prop_assert!(!host.state().takes_frames());
            prop_assert!(host.frame(now, &[[50.0, 50.0]; 24]).is_none());
            prop_assert!(host.events.len() <= MOST_EVENTS && host.packets.len() <= MOST_PACKETS);
        }
    }
}
