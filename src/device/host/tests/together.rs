//! Session and device on one virtual clock, end to end.

use super::*;

#[test]
fn host_and_device_stream_without_a_miss() {
    let mut pair = Pair::streaming(2000);
    assert!(matches!(pair.events[0], BridgeEvent::Connected(_)));
    assert!(matches!(pair.events[1], BridgeEvent::Ready(_)));
    let is_answer = |event: &&BridgeEvent| matches!(event, BridgeEvent::Pong { .. });
    let others: Vec<_> = pair.events.iter().filter(|e| !is_answer(e)).collect();
    assert_eq!(others[2..], [&BridgeEvent::Armed]);
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
        let stamp = &pair.sent[index];
        assert_eq!((*tick, *seq), (stamp.apply_tick, stamp.seq));
        assert_eq!(*tick, first + u32::try_from(index).unwrap());
        let gain = (f64::from(tick - first + 1) / 20.0).min(1.0);
        assert!((stamp.gain - gain).abs() < 1e-12);
        let expected =
            Coder::new(&ArrayProfile::default(), 24).encode(&[pair.amplitude_um; 24], gain);
        assert_eq!(*codes, expected);
    }
    assert_eq!(pair.device.core().output(), vec![[13107, 26214]; 24]);

    pair.host.stop(pair.now(), StopHow::Ramp);
    assert!(pair.host.frame(pair.now(), &[[1.0, 1.0]; 24]).is_none());
    pair.run(10);
    assert_eq!(pair.disarmed_by(), Some((DisarmedBy::Host, "stopped")));
    assert_eq!(pair.host.state(), BridgeState::Stopping, "still ramping");
    pair.run(90);
    assert_eq!(pair.host.state(), BridgeState::Ready);
    assert_eq!(pair.device.core().state(), DeviceState::Ready);
    pair.run(3000);
    assert_eq!(
        pair.host.state(),
        BridgeState::Ready,
        "pings keep the lease"
    );
    assert!(pair.host.arm(pair.now()));
    pair.run(200);
    assert_eq!(
        pair.device.core().state(),
        DeviceState::Run,
        "and it can be armed again"
    );
}

#[test]
fn an_idle_host_never_arms_and_refuses_frames() {
    let mut pair = Pair::new();
    pair.run(5000);
    assert!(pair.host.frame(pair.now(), &[[9.0, 9.0]; 24]).is_none());
    assert_eq!(pair.device.core().state(), DeviceState::Ready);
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
    pair.host_writes(&late);
    pair.run(50);
    assert_eq!(pair.host.depth(), 2);
    assert!(pair.events.contains(&BridgeEvent::DepthRaised(2)));
}

#[test]
fn a_cut_link_is_lost_within_500_ms_and_the_device_silent_within_100() {
    let mut pair = Pair::streaming(500);
    pair.cut = true;
    pair.run(125);
    assert!(
        pair.device
            .core()
            .output()
            .iter()
            .all(|codes| *codes == [0, 0])
    );
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
    pair.host_writes(&stop);
    pair.run(1000);
    let (by, reason) = pair.disarmed_by().unwrap();
    assert_eq!(by, DisarmedBy::Device);
    assert!(reason.contains("disarmed itself"), "{reason}");
    assert_eq!(pair.host.state(), BridgeState::Ready);
    assert_eq!(pair.device.core().state(), DeviceState::Ready);
}

#[test]
fn a_fault_disarms_is_shown_and_can_be_cleared() {
    let mut pair = Pair::streaming(500);
    let device = pair.device.core_mut();
    device.raise_fault(fault_bit::OVER_TEMPERATURE, 3, 9000, &mut pair.log);
    pair.run(100);
    assert_eq!(pair.host.state(), BridgeState::Faulted);
    assert!(pair.disarmed_by().unwrap().1.contains("over-temperature"));
    let described = pair.events.iter().any(|event| {
        matches!(
            event,
            BridgeEvent::Fault(Fault {
                channel: 3,
                value: 9000,
                ..
            })
        )
    });
    assert!(described);
    assert!(!pair.host.arm(pair.now()));
    pair.device
        .core_mut()
        .end_fault_cause(fault_bit::OVER_TEMPERATURE);
    pair.host.clear_faults(pair.now());
    pair.run(100);
    assert_eq!(pair.host.state(), BridgeState::Ready);
}

#[test]
fn missing_ticks_are_estimated_and_a_suspended_host_is_not_lost() {
    let mut pair = Pair::streaming(500);
    let tick = pair.host.status().unwrap().tick;
    let start = pair.host.device.tick_start.unwrap();
    let later = start + Duration::from_millis(37);
    let (stamp, _) = pair.host.frame(later, &[[1.0, 1.0]; 24]).unwrap();
    assert_eq!(stamp.apply_tick, tick + 2);
    // An hour passes for the host alone, then it goes on.
    pair.start += Duration::from_hours(1);
    pair.run(30);
    assert!(pair.host.state().is_open());
}

#[test]
fn clocks_that_drift_apart_miss_no_tick() {
    for ppm in [-100, 100] {
        let mut pair = Pair::new();
        pair.host_ppm = ppm;
        pair.run(150);
        assert!(pair.host.arm(pair.now()));
        pair.run(600_000);
        assert_eq!(pair.host.state(), BridgeState::Streaming);
        assert_eq!(
            pair.host.counters().device,
            DeviceCounters::default(),
            "{ppm} ppm"
        );
        let ticks: Vec<u32> = pair.log.frames.iter().map(|(tick, ..)| *tick).collect();
        assert!(ticks.windows(2).all(|pair| pair[1] == pair[0] + 1));
    }
}

#[test]
fn a_noisy_link_costs_frames_but_never_applies_a_wrong_one() {
    for seed in 0..8 {
        let noisy = LinkFaults {
            drop_rate: 1.0 / 1200.0,
            flip_rate: 1.0 / 1200.0,
            insert_rate: 1.0 / 1200.0,
            ..LinkFaults::default()
        };
        let faults = Faults {
            seed,
            to_device: noisy,
            ..Faults::default()
        };
        let mut pair = Pair::streaming_over(&faults, 20_000);
        let codes = Coder::new(&ArrayProfile::default(), 24).encode(&[[10.0, 20.0]; 24], 1.0);
        assert!(pair.host.counters().device.bad > 0);
        assert!(
            pair.log
                .frames
                .iter()
                .skip(20)
                .all(|(_, _, applied)| *applied == codes)
        );
        pair.host.stop(pair.now(), StopHow::Ramp);
        pair.run(1000);
        assert!(!pair.device.core().state().is_live());
    }
}
