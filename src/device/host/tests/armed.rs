//! What a device says while it is armed, against what was asked and sent: one test a sentence.

use super::*;

/// A session that streams to a device that is told what to say.
struct Armed {
    host: HostSession,
    now: Instant,
    tick: u32,
}

impl Armed {
    fn new() -> Self {
        Self::of(ArrayProfile::default())
    }

    fn of(profile: ArrayProfile) -> Self {
        let now = Instant::now();
        let mut host = HostSession::new(NONCE, profile, 24, Sequence::default());
        host.opened(now);
        let caps = DeviceModel::default().caps(NONCE, 1);
        host.on_message(now, &DeviceMessage::Caps(caps));
        let cfg = DeviceModel::default().clamp(&host.drive.wanted_config(&host.device));
        host.on_message(now, &DeviceMessage::Cfg(cfg));
        for tick in 1..=3 {
            host.on_message(now, &at(tick, DeviceState::Ready));
        }
        assert!(host.arm(now));
        let seq = host.request.map(|request| request.last_seq());
        let ack = Ack {
            kind: kind::ARM,
            code: AckCode::Ok,
            seq: seq.unwrap(),
        };
        host.on_message(now, &DeviceMessage::Ack(ack));
        assert_eq!(host.state(), BridgeState::Armed);
        while host.next_event().is_some() {}
        let mut armed = Self { host, now, tick: 3 };
        armed.pass(|_| {});
        armed
    }

    /// A tick passes: the device says what it should, changed by `lie`; the host answers.
    fn pass(&mut self, lie: impl FnOnce(&mut Status)) {
        self.now += TICK;
        self.tick += 1;
        let DeviceMessage::Status(mut status) = at(self.tick, DeviceState::Run) else {
            unreachable!("a STATUS");
        };
        (status.hv_dv, status.temp_cdeg) = (600, 2500);
        lie(&mut status);
        self.host
            .on_message(self.now, &DeviceMessage::Status(status));
        self.host.on_time(self.now);
        let _sent = self.host.frame(self.now, &[[10.0, 0.0]; 24]);
        while self.host.next_packet().is_some() {}
    }

    /// How the session ended: how output was ended, and the line. STOP went out first, and no
    /// frame follows.
    fn ended(&mut self) -> Option<(StopHow, String)> {
        if self.host.state() != BridgeState::Stopping {
            return None;
        }
        assert!(self.host.take_stop().is_some(), "STOP goes out");
        assert!(self.host.frame(self.now, &[[1.0; 2]; 24]).is_none());
        assert!(!self.host.arm(self.now), "not without a new command");
        while let Some(event) = self.host.next_event() {
            if let BridgeEvent::Disarmed { by, reason } = event {
                assert_eq!(by, DisarmedBy::Device);
                assert!(!reason.contains('\n'));
                return Some((self.host.stopping.how, reason));
            }
        }
        panic!("stopped without a word");
    }

    fn ends_after(lie: impl Fn(&mut Status)) -> Option<(StopHow, String)> {
        let mut armed = Self::new();
        armed.pass(lie);
        armed.ended()
    }
}

#[test]
fn a_device_that_does_as_asked_streams_on() {
    let mut armed = Armed::new();
    for _ in 0..400 {
        armed.pass(|status| status.amp_sum = 1000);
        assert_eq!(armed.ended(), None);
    }
}

#[test]
fn every_fault_bit_but_the_lost_lease_ends() {
    for bit in 0..16 {
        let ended = Armed::ends_after(|status| status.faults = 1 << bit);
        assert_eq!(ended.is_none(), bit == 5, "bit {bit}");
    }
    let mut armed = Armed::new();
    let fault = Fault {
        faults: 64,
        channel: u16::MAX,
        value: 0,
        tick: 9,
    };
    armed
        .host
        .on_message(armed.now, &DeviceMessage::Fault(fault));
    let (how, reason) = armed.ended().unwrap();
    assert_eq!(how, StopHow::Ramp);
    assert!(reason.contains("emergency stop") && reason.contains("CLEAR"));
}

#[test]
fn a_state_that_is_unknown_or_at_rest_without_our_stop_ends() {
    for (state, words) in [
        (0, "ended the session"),
        (1, "disarmed itself"),
        (6, "fault"),
        (7, "does not know"),
        (255, "does not know"),
    ] {
        let (_, reason) = Armed::ends_after(|status| status.state = state).unwrap();
        assert!(reason.contains(words), "{state}: {reason}");
    }
    for state in [2, 3, 4, 5] {
        assert_eq!(Armed::ends_after(|status| status.state = state), None);
    }
}

#[test]
fn more_voltage_than_is_in_force_ends_at_once() {
    assert_eq!(Armed::ends_after(|status| status.hv_dv = 680), None);
    let (how, reason) = Armed::ends_after(|status| status.hv_dv = 681).unwrap();
    assert_eq!(how, StopHow::Now);
    assert!(reason.contains("68.1 V where 60 V"), "{reason}");
}

#[test]
fn temperature_and_current_end_where_they_are_judged() {
    for (cdeg, ends) in [(-1000, false), (-1001, true), (7000, false), (7001, true)] {
        let ended = Armed::ends_after(|status| status.temp_cdeg = cdeg);
        assert_eq!(ended.is_some(), ends, "{cdeg}");
    }
    assert_eq!(Armed::ends_after(|status| status.i_ma = u16::MAX), None);
    let profile = ArrayProfile {
        i_ma_max: Some(20),
        temperature_c: Some([10.0, 40.0]),
        ..ArrayProfile::default()
    };
    for (lie, ends) in [
        ((20, 4000), false),
        ((21, 2500), true),
        ((20, 4001), true),
        ((20, 999), true),
    ] {
        let mut armed = Armed::of(profile.clone());
        armed.pass(|status| (status.i_ma, status.temp_cdeg) = lie);
        assert_eq!(armed.ended().is_some(), ends, "{lie:?}");
    }
}

#[test]
fn louder_than_sent_in_two_status_running_ends_at_once() {
    let mut armed = Armed::new();
    // 24 channels of a fifth of full drive, after the soft start.
    for _ in 0..40 {
        armed.pass(|_| {});
    }
    let sum = 24 * 13_107;
    let most = sum + sum / 100 + 24;
    for _ in 0..10 {
        armed.pass(|status| status.amp_sum = most);
        armed.pass(|status| status.amp_sum = most + 2);
    }
    assert_eq!(armed.ended(), None, "never twice running");
    armed.pass(|status| status.amp_sum = most + 2);
    let (how, reason) = armed.ended().unwrap();
    assert_eq!(how, StopHow::Now);
    assert!(reason.contains(&sum.to_string()), "{reason}");
}

#[test]
fn output_before_the_first_frame_and_beside_an_ident_is_too_much() {
    let loud = |amp_sum, ident: bool| {
        let mut armed = Armed::new();
        armed.host.drive.begin();
        armed.host.prediction.begin();
        armed.host.state = BridgeState::Armed;
        if ident {
            let asked = armed.host.identify(armed.now, 3, (10.0, 600));
            assert_eq!(asked, Ok(()));
        }
        for _ in 0..2 {
            armed.now += TICK;
            armed.tick += 1;
            let DeviceMessage::Status(status) = at(armed.tick, DeviceState::Armed) else {
                unreachable!("a STATUS");
            };
            let status = Status { amp_sum, ..status };
            armed
                .host
                .on_message(armed.now, &DeviceMessage::Status(status));
        }
        armed.ended().is_some()
    };
    assert!(!loud(24, false));
    assert!(loud(25, false));
    assert!(!loud(13_107, true), "the IDENT itself");
    assert!(loud(14_000, true));
}

#[test]
fn what_repeats_goes_back_or_jumps_paces_nothing_and_ends_nothing() {
    let mut armed = Armed::new();
    let ticks = |host: &mut HostSession| {
        let events = std::iter::from_fn(|| host.next_event());
        events
            .filter(|event| matches!(event, BridgeEvent::Tick { .. }))
            .count()
    };
    ticks(&mut armed.host);
    for tick in [armed.tick, 2, armed.tick + 41, u32::MAX] {
        // Old ones tell of another time: what they say is not judged either.
        armed
            .host
            .on_message(armed.now, &at(tick, DeviceState::Ready));
    }
    assert_eq!(ticks(&mut armed.host), 0);
    assert_eq!(armed.ended(), None);
    assert_eq!(armed.host.counters().stray_status, 4);
    armed.pass(|_| {});
    assert_eq!(ticks(&mut armed.host), 1);
}

#[test]
fn a_device_whose_ticks_stand_still_is_lost_after_half_a_second() {
    let mut armed = Armed::new();
    let start = armed.now;
    for ms in 0..600 {
        let now = start + Duration::from_millis(ms);
        let heard = Heard {
            bytes: ms * 47,
            bad: 0,
        };
        armed
            .host
            .on_message(now, &at(armed.tick, DeviceState::Run));
        armed.host.heard(now, heard);
        armed.host.on_time(now);
        if armed.host.state() == BridgeState::Lost {
            assert!((500..=502).contains(&ms), "{ms}");
            break;
        }
    }
    assert!(armed.host.take_stop().is_some(), "STOP goes out");
    let events: Vec<_> = std::iter::from_fn(|| armed.host.next_event()).collect();
    let lost = events.iter().find_map(|event| match event {
        BridgeEvent::Lost(reason) => Some(reason.clone()),
        _ => None,
    });
    assert!(lost.unwrap().contains("advances"));
}

#[test]
fn one_tick_gets_one_frame_however_often_it_is_asked_for() {
    let mut armed = Armed::new();
    armed.pass(|_| {});
    let mut applied = Vec::new();
    for ms in [0, 1, 30, 70, 71, 200] {
        let now = armed.now + Duration::from_millis(ms);
        let frame = armed.host.frame(now, &[[1.0; 2]; 24]);
        applied.extend(frame.map(|(sent, _)| sent.apply_tick));
    }
    assert!(applied.is_sorted_by(|a, b| a < b), "{applied:?}");
    assert_eq!(applied.len(), 3, "30, 70 and 200 ms later: {applied:?}");
}

#[test]
fn a_refused_stop_is_no_stop() {
    let mut armed = Armed::new();
    armed.host.stop(armed.now, StopHow::Ramp);
    let seq = armed.host.stopping.pending.unwrap().last_seq();
    for code in [AckCode::WrongState, AckCode::BadSession] {
        let ack = Ack {
            kind: kind::STOP,
            code,
            seq,
        };
        armed.host.on_message(armed.now, &DeviceMessage::Ack(ack));
        assert!(armed.host.stopping.pending.is_some(), "{code:?}");
    }
}

#[test]
fn a_flood_of_texts_and_faults_that_were_told_is_no_news() {
    let mut armed = Armed::new();
    let fault = Fault {
        faults: 32,
        channel: u16::MAX,
        value: 0,
        tick: 9,
    };
    for _ in 0..1000 {
        armed
            .host
            .on_message(armed.now, &DeviceMessage::Fault(fault));
    }
    assert_eq!(armed.ended(), None);
    let events = std::iter::from_fn(|| armed.host.next_event());
    let told = events.filter(|event| matches!(event, BridgeEvent::Fault(_)));
    assert_eq!(told.count(), 1);
}
