//! Frames of a paced session in virtual time, and whole sessions against an emulator: judged by
//! what was sent, never by durations.

use super::*;
use crate::device::DeviceModel;
use crate::framing::{Decoder, LARGEST_BODY, Packet};
use crate::host::{HostSession, SentFrame, Sequence};
use crate::message::{Ack, AckCode, Config, DeviceMessage, DeviceState, Pong, Status, kind};

const NONCE: u32 = 0x1234_5678;

/// A session with a device whose every word is scripted, and the pacer that drives it.
struct Scripted {
    host: HostSession,
    pacer: Pacer,
    start: Instant,
    sent: Vec<SentFrame>,
    n_ticks: u32,
}

/// The tick that the scripted device is in when the script begins.
const FIRST: u32 = 500;

/// What the scripted device answers to a packet at this time of the script.
fn reply_to(packet: &Packet, us: u64) -> Option<DeviceMessage> {
    let mut decoder = Decoder::new(LARGEST_BODY);
    for byte in packet.as_bytes() {
        let Some(packet) = decoder.push(*byte) else {
            continue;
        };
        return match packet.kind {
            kind::CONFIG => {
                let asked = Config::decode(packet.payload, 24)?;
                let slew = u16::MAX;
                Some(DeviceMessage::Cfg(Config { slew, ..asked }))
            }
            kind::PING => Some(DeviceMessage::Pong(Pong {
                token: u32::from_le_bytes(packet.payload.try_into().ok()?),
                dev_us: FIRST.wrapping_mul(TICK_US) + u32::try_from(us).ok()?,
                tick: 0,
                phase_us: 0,
            })),
            kind::ARM => Some(DeviceMessage::Ack(Ack {
                kind: kind::ARM,
                code: AckCode::Ok,
                seq: packet.seq,
            })),
            _ => None,
        };
    }
    None
}

impl Scripted {
    /// Armed, with a device whose clock is known.
    fn armed(pacer: impl FnOnce(Instant) -> Pacer) -> Self {
        let start = Instant::now();
        let profile = ArrayProfile::default();
        let mut host = HostSession::new(NONCE, profile, 24, Sequence::default());
        host.opened(start);
        let mut scripted = Self {
            host,
            pacer: pacer(start),
            start,
            sent: Vec::new(),
            n_ticks: 0,
        };
        let caps = DeviceModel::default().caps(NONCE, 1);
        scripted.says(0, DeviceMessage::Caps(caps));
        scripted.reply(0);
        for k in 0..10 {
            scripted.status(k, k * 25_000);
            scripted.reply(k * 25_000 + 1000);
        }
        let now = scripted.at(250_000);
        assert!(scripted.host.arm(now), "{}", scripted.host.state());
        scripted.reply(250_000);
        assert_eq!(scripted.host.state(), BridgeState::Armed);
        scripted.sent.clear();
        scripted.n_ticks = 0;
        scripted
    }

    fn at(&self, us: u64) -> Instant {
        self.start + Duration::from_micros(us)
    }

    fn says(&mut self, us: u64, message: DeviceMessage) {
        let now = self.at(us);
        self.host.on_message(now, &message);
        self.turn(us);
    }

    /// STATUS of the `k`th tick of the script, heard at this time.
    fn status(&mut self, k: u64, us: u64) {
        let state = if self.host.state().takes_frames() {
            DeviceState::Run
        } else {
            DeviceState::Ready
        };
        let tick = FIRST + u32::try_from(k).unwrap();
        let status = Status {
            tick,
            dev_us: tick.wrapping_mul(TICK_US),
            state: state.code(),
            age_ms: u16::MAX,
            ..Status::default()
        };
        self.says(us, DeviceMessage::Status(status));
    }

    /// The device acknowledges ARM, grants CONFIG and answers PING, all at once.
    fn reply(&mut self, us: u64) {
        self.host.on_time(self.at(us));
        while let Some(packet) = self.host.next_packet() {
            if let Some(reply) = reply_to(&packet, us) {
                self.says(us, reply);
            }
        }
    }

    /// One turn, as [`Pacer::turn`] does it with a bridge.
    fn turn(&mut self, us: u64) {
        let now = self.at(us);
        while let Some(event) = self.host.next_event() {
            if let BridgeEvent::Tick { received, due } = event {
                self.pacer.announce(received, due);
            }
        }
        if self.pacer.due(now, self.host.present_tick(now)).is_some() {
            self.n_ticks += 1;
            if let Some((sent, _)) = self.host.frame(now, &[[10.0, 5.0]; 24]) {
                self.sent.push(sent);
            }
        }
    }

    /// One loop of a program: time, and what there is to do.
    fn pass(&mut self, us: std::ops::Range<u64>) {
        for us in us.step_by(1000) {
            self.reply(us);
            self.turn(us);
        }
    }

    fn assert_one_frame_a_tick(&self) {
        let ticks: Vec<u32> = self.sent.iter().map(|sent| sent.apply_tick).collect();
        assert!(ticks.is_sorted_by(|a, b| a < b), "{ticks:?}");
    }
}

/// Ticks of the script after it was armed, so that its first is a whole one.
const ARMED: u64 = 11;

#[test]
fn a_lost_stretch_makes_no_two_frames_for_one_tick() {
    // With an own clock, which stands in for what is lost, and without; the first STATUS after
    // the loss comes at any time within its tick.
    for held_us in (0..25_000).step_by(500) {
        for has_own_clock in [true, false] {
            let mut script = Scripted::armed(|start| {
                if has_own_clock {
                    Pacer::with_own_clock(start)
                } else {
                    Pacer::waiting()
                }
            });
            let mut passed = ARMED * 25_000 - 10_000;
            for k in ARMED..ARMED + 60 {
                let us = k * 25_000;
                let (is_lost, held) = match k - ARMED {
                    20 | 21 => (true, 0),
                    22 => (false, held_us),
                    _ => (false, 1000),
                };
                if !is_lost {
                    script.pass(passed..us + held);
                    script.status(k, us + held);
                    passed = us + held;
                }
            }
            script.assert_one_frame_a_tick();
            let n_frames = script.sent.len();
            let least = if has_own_clock { 59 } else { 57 };
            assert!(
                (least..=61).contains(&n_frames),
                "{n_frames} at {held_us} µs"
            );
        }
    }
}

#[test]
fn a_flood_and_old_status_make_no_frame_more_than_there_are_ticks() {
    let mut script = Scripted::armed(|_| Pacer::waiting());
    let n = 100;
    for k in ARMED..ARMED + n {
        let us = k * 25_000;
        script.pass(us - 24_000..us);
        for stray in 0..20 {
            script.status(k, us + 100 * stray);
            if stray % 3 == 0 {
                script.status(k - 1 - stray % 7, us + 100 * stray + 50);
            }
        }
    }
    script.assert_one_frame_a_tick();
    assert_eq!(u64::from(script.n_ticks), n);
    assert_eq!(u64::try_from(script.sent.len()).unwrap(), n);
}

#[test]
fn after_a_pause_of_our_own_the_third_status_brings_a_frame() {
    for pacer in [|_| Pacer::waiting(), Pacer::with_own_clock] {
        let mut script = Scripted::armed(pacer);
        script.status(ARMED, ARMED * 25_000);
        let n_before = script.sent.len();
        assert!(n_before > 0, "a frame before the pause");
        for (nth, k) in (ARMED + 12..).take(5).enumerate() {
            let us = k * 25_000;
            script.status(k, us);
            script.pass(us + 1000..us + 24_000);
            let n_frames = script.sent.len() - n_before;
            assert_eq!(
                n_frames,
                (nth + 1).saturating_sub(2),
                "after {} STATUS",
                nth + 1
            );
        }
        script.assert_one_frame_a_tick();
    }
}

#[test]
fn a_device_clock_that_jumps_and_comes_back_stamps_nothing_twice() {
    let mut script = Scripted::armed(|_| Pacer::waiting());
    for k in ARMED..ARMED + 80 {
        let us = k * 25_000;
        script.pass(us - 24_000..us);
        let told = match k - ARMED {
            30 => k + 5000,
            31 => k - 9,
            50 => k + 7,
            _ => k,
        };
        script.status(told, us);
    }
    script.assert_one_frame_a_tick();
    assert!((70..=80).contains(&script.n_ticks), "{}", script.n_ticks);
}

/// A source with so many frames, that may fail.
struct Frames {
    n_left: u32,
    fails: bool,
    n_sent: u32,
}

impl FrameSource for Frames {
    type Error = BridgeError;

    fn event(&mut self, _event: &BridgeEvent) -> Result<(), BridgeError> {
        Ok(())
    }

    fn tick(&mut self, bridge: &mut Bridge) -> Result<ControlFlow<()>, BridgeError> {
        if self.n_left == 0 && self.fails {
            return Err(BridgeError::WavFull);
        }
        if self.n_left == 0 {
            return Ok(ControlFlow::Break(()));
        }
        self.n_left -= 1;
        self.n_sent += u32::from(bridge.send(&[[10.0, 5.0]; 24], None).is_some());
        Ok(ControlFlow::Continue(()))
    }
}

/// A session with an emulator, again where the machine was too busy for one.
fn session(frames: impl Fn() -> Frames) -> (Result<Ended, BridgeError>, Frames, BridgeState) {
    let attempt = || {
        let mut source = frames();
        let mut driver = Driver::open(Target::Emulator, ArrayProfile::default(), 24);
        let ended = driver.run(&mut source, &AtomicBool::new(false));
        let state = driver.bridge().state();
        assert!(driver.missed() < 1000, "{}", driver.missed());
        driver.close();
        (ended, source, state)
    };
    let is_disturbed = |ended: &Result<Ended, BridgeError>| {
        let text = ended.as_ref().map_err(ToString::to_string);
        text.is_err_and(|text| text.contains("no frame reached it"))
    };
    let mut tries = (0..10).map(|_| attempt());
    tries.find(|(ended, ..)| !is_disturbed(ended)).unwrap()
}

#[test]
fn a_session_ends_with_its_source_and_leaves_a_device_at_rest() {
    let (ended, source, state) = session(|| Frames {
        n_left: 20,
        fails: false,
        n_sent: 0,
    });
    assert_eq!(ended.unwrap(), Ended::BySource);
    assert_eq!((source.n_left, state), (0, BridgeState::Ready));
    assert!(source.n_sent > 0);
}

#[test]
fn a_source_that_fails_is_the_reason_and_the_device_is_at_rest_all_the_same() {
    let (ended, source, state) = session(|| Frames {
        n_left: 5,
        fails: true,
        n_sent: 0,
    });
    assert!(matches!(ended, Err(BridgeError::WavFull)), "{ended:?}");
    assert_eq!((source.n_left, state), (0, BridgeState::Ready));
}

#[test]
fn a_session_that_is_asked_to_end_does_so_before_it_began() {
    let mut driver = Driver::open(Target::Emulator, ArrayProfile::default(), 24);
    let mut source = Frames {
        n_left: 1,
        fails: false,
        n_sent: 0,
    };
    let ended = driver.run(&mut source, &AtomicBool::new(true)).unwrap();
    assert_eq!((ended, source.n_sent), (Ended::ByRequest, 0));
    assert_eq!(driver.elapsed(), Duration::ZERO);
}

#[test]
fn a_port_that_cannot_be_opened_is_told_apart_from_a_link_that_breaks() {
    let path = std::env::temp_dir().join("no-such-port");
    let name = path.display().to_string();
    let mut driver = Driver::open(Target::Port(path), ArrayProfile::default(), 24);
    let mut source = Frames {
        n_left: 1,
        fails: false,
        n_sent: 0,
    };
    let error = driver
        .run(&mut source, &AtomicBool::new(false))
        .unwrap_err();
    assert!(matches!(error, BridgeError::Open { .. }), "{error:?}");
    let text = error.to_string();
    assert!(text.starts_with(&format!("{name}: ")), "{text}");
    assert_eq!(text.matches(&name).count(), 1, "{text}");
}
