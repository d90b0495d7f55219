//! The session against scripted messages, and random ones.

use proptest::prelude::*;

use super::*;
use crate::framing::Decoder;

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
}

#[test]
fn a_body_that_just_holds_a_frame_is_enough() {
    let good = DeviceModel::default().caps(NONCE, 1);
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

/// Lets 10 s pass in which the device only ticks; gives how many STOP and other packets went out.
fn ticking_only(host: &mut HostSession, start: Instant) -> (usize, usize) {
    let mut counts = (0, 0);
    for ms in 0..10_000 {
        let now = start + Duration::from_millis(ms);
        host.on_time(now);
        if ms % 25 == 0 && host.state().is_open() {
            let tick = u32::try_from(4 + ms / 25).unwrap();
            host.on_message(now, &at(tick, DeviceState::Ready));
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
    let seq = host.outbox.sequence.next().wrapping_add(1);
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
    let seq = host.outbox.sequence.next().wrapping_add(1);
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
    assert!(host.events.len() <= MAX_EVENTS && host.outbox.packets.len() <= MAX_PACKETS);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(1000))]

    /// Random packets and texts at any moment: no panic, never armed without ARM's own ACK, bounded
    /// queues.
    #[test]
    fn random_device_bytes_never_arm(
        steps in prop::collection::vec(
            (
                0u64..300, 0x80u8..0x90, any::<u16>(),
                prop::collection::vec(any::<u8>(), 0..80), any::<bool>(),
            ),
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
            prop_assert!(host.events.len() <= MAX_EVENTS);
            prop_assert!(host.outbox.packets.len() <= MAX_PACKETS);
        }
    }
}
