//! Two displays at two devices, in told time: armed together, never one without the first.

use super::fingers::{stroke, with_displays};
use super::*;
use selvedge_device::{BridgeEvent, BridgeState, Target};

/// Ticks in which an emulator becomes ready, arms or ramps down.
const A_WHILE: u32 = 40;

/// Two fingers, each with a display and a device.
struct Hands {
    engine: Engine,
    pointer: PointerSender,
    start: Instant,
    n: u32,
    /// Which fingers move.
    moves: [bool; 2],
    heard: Vec<Notice>,
}

impl Hands {
    /// Both connected.
    fn new() -> Self {
        let (mut engine, pointer, start) = with_displays(2);
        engine.step_emulators();
        engine.send(Command::Connect(Target::Emulator)).unwrap();
        engine
            .send(Command::ConnectSecond(Target::Emulator))
            .unwrap();
        Self {
            engine,
            pointer,
            start,
            n: 0,
            moves: [true; 2],
            heard: Vec::new(),
        }
    }

    fn armed() -> Self {
        let mut hands = Self::new();
        hands.go(A_WHILE);
        hands.send(Command::Arm);
        hands.go(A_WHILE);
        assert_eq!(hands.states(), [BridgeState::Streaming; 2].map(Some));
        hands
    }

    fn send(&mut self, command: Command) {
        self.engine.send(command).unwrap();
    }

    fn go(&mut self, n_ticks: u32) {
        for _ in 0..n_ticks {
            for finger in (0..2).filter(|finger| self.moves[*finger]) {
                stroke(&mut self.pointer, (finger, finger), self.start, self.n);
            }
            // Answers to ticks of devices are put off within them.
            for part in 1..=5 {
                let now = self.start + TICK * self.n + TICK / 5 * part;
                self.engine.advance(now);
            }
            self.n += 1;
            let heard = std::iter::from_fn(|| self.engine.next_notice());
            self.heard.extend(heard);
        }
    }

    fn states(&mut self) -> [Option<BridgeState>; 2] {
        let snapshot = self.engine.snapshot();
        [&snapshot.link, &snapshot.second_link].map(|link| link.as_ref().map(|link| link.state))
    }

    /// What each device says that it puts out.
    fn output(&mut self) -> [u32; 2] {
        let snapshot = self.engine.snapshot();
        [&snapshot.link, &snapshot.second_link].map(|link| {
            let status = link.as_ref().and_then(|link| link.status);
            status.map_or(0, |status| status.amp_sum)
        })
    }

    fn refusals(&self) -> Vec<&'static str> {
        let refused = |notice: &Notice| match notice {
            Notice::Refused(why) => Some(*why),
            _ => None,
        };
        self.heard.iter().filter_map(refused).collect()
    }
}

#[test]
fn each_device_plays_what_its_own_display_feels() {
    let mut hands = Hands::armed();
    assert!(hands.output().iter().all(|sum| *sum > 0));
    assert!(
        hands
            .heard
            .iter()
            .any(|notice| matches!(notice, Notice::SecondBridge(BridgeEvent::Armed)))
    );
    hands.moves = [true, false];
    hands.go(A_WHILE);
    let [first, second] = hands.output();
    assert!(first > 0 && second == 0, "{first}, {second}");
    hands.moves = [false, true];
    hands.go(A_WHILE);
    let [first, second] = hands.output();
    assert!(first == 0 && second > 0, "{first}, {second}");
    let link = hands.engine.snapshot().second_link.unwrap();
    assert_eq!(link.counters.device.underrun + link.counters.device.late, 0);
}

#[test]
fn a_hanging_cloth_reaches_each_device_under_its_own_finger() {
    let mut hands = Hands::armed();
    hands.moves = [false; 2];
    let (mut feed, drive) = ClothDrive::new();
    hands.send(Command::SetCloth(Some(Box::new(drive))));
    for touched in [[true, true], [true, false], [false, true], [false, false]] {
        let given = touched.map(|is_touched| [[f64::from(is_touched); 2]; 24]);
        for _ in 0..A_WHILE {
            feed.give(&given);
            hands.go(1);
        }
        let output = hands.output();
        assert_eq!(output.map(|sum| sum > 0), touched, "{output:?}");
    }
}

#[test]
fn a_stop_and_a_disarm_end_both() {
    for how in [Command::StopAll, Command::Disarm] {
        let mut hands = Hands::armed();
        hands.send(how);
        hands.go(A_WHILE);
        assert_eq!(hands.states(), [BridgeState::Ready; 2].map(Some));
        assert_eq!(hands.output(), [0; 2]);
    }
}

#[test]
fn the_second_never_moves_without_the_first() {
    let mut hands = Hands::armed();
    hands.send(Command::Disconnect);
    hands.go(A_WHILE);
    assert_eq!(hands.states(), [None, Some(BridgeState::Ready)]);
    assert_eq!(hands.output(), [0; 2]);
    hands.send(Command::Arm);
    hands.go(A_WHILE);
    assert_eq!(hands.refusals(), ["no device is ready to be armed"]);
    assert_eq!(hands.output(), [0; 2]);
}

#[test]
fn while_channels_of_the_first_are_identified_the_second_rests() {
    let mut hands = Hands::armed();
    hands.send(Command::Identify(true));
    hands.go(A_WHILE);
    hands.send(Command::Arm);
    hands.go(A_WHILE);
    let [first, second] = hands.states();
    assert_ne!(first, Some(BridgeState::Ready));
    assert_eq!(second, Some(BridgeState::Ready));
}

#[test]
fn nothing_is_armed_while_the_second_is_not_ready() {
    let mut hands = Hands::new();
    hands.go(A_WHILE);
    hands.send(Command::ConnectSecond(Target::Port(
        "/nowhere/array".into(),
    )));
    hands.send(Command::Arm);
    hands.go(A_WHILE);
    let refusals = hands.refusals();
    assert_eq!(refusals.len(), 1);
    assert!(refusals[0].contains("second display"), "{refusals:?}");
    assert_eq!(hands.states()[0], Some(BridgeState::Ready));
    hands.send(Command::DisconnectSecond);
    hands.send(Command::Arm);
    hands.go(A_WHILE);
    assert_eq!(hands.states(), [Some(BridgeState::Streaming), None]);
}

#[test]
fn what_only_lowers_reaches_both_at_once() {
    let mut hands = Hands::armed();
    let [_, before] = hands.output();
    let faint = ArrayProfile {
        limit_um: [0.001; 2],
        ..ArrayProfile::default()
    };
    hands.send(Command::SetArray(Some(Box::new(faint))));
    hands.go(4);
    let [_, after] = hands.output();
    assert!(after < before / 10, "{before} then {after}");
    assert_eq!(hands.states(), [BridgeState::Streaming; 2].map(Some));
}

#[test]
fn a_scene_with_one_display_lets_the_second_go_and_has_none() {
    let mut hands = Hands::armed();
    let scene = prepared(exeter(), Method::Auto);
    hands.send(Command::SetScene(Box::new(scene)));
    hands.go(A_WHILE);
    assert_eq!(hands.states()[1], None);
    assert!(hands.states()[0].is_some());
    let again = Command::ConnectSecond(Target::Emulator);
    let refused = hands.engine.send(again).unwrap_err();
    assert!(matches!(refused, EngineError::NoSecondDisplay));
}
