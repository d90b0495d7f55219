//! The engine with an emulated device, in real time and in told time: judged by what the device
//! counts.

#[cfg(unix)]
use std::path::Path;
#[cfg(unix)]
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;

use super::*;
use crate::input::PointerInput;
use crate::ready::{CoreCommand, ReadyCommand};
use selvedge_device::{
    BridgeError, BridgeEvent, BridgeState, ContactorModel, DeviceState, DisarmedBy, FaultWords,
    ReplayedLink, SessionLog, Target,
};
#[cfg(unix)]
use selvedge_device::{DeviceModel, Faults, PtyEmulator};
use selvedge_scratch::ScratchFolder;

/// Waits for what must come, for as long as a busy machine may take.
fn wait<T>(engine: &mut Engine, what: &str, mut look: impl FnMut(&mut Engine) -> Option<T>) -> T {
    for _ in 0..4000 {
        if let Some(found) = look(engine) {
            return found;
        }
        thread::sleep(Duration::from_millis(5));
    }
    panic!("{what} did not happen; {:?}", engine.snapshot().link);
}

fn wait_for(engine: &mut Engine, what: &str, is_it: impl Fn(&BridgeEvent) -> bool) {
    wait(engine, what, |engine| {
        std::iter::from_fn(|| engine.next_notice())
            .find(|notice| matches!(notice, Notice::Bridge(event) if is_it(event)))
    });
}

fn wait_for_status(
    engine: &mut Engine,
    what: &str,
    is_it: impl Fn(&selvedge_device::Status) -> bool,
) {
    wait(engine, what, |engine| {
        let status = engine.snapshot().link.and_then(|link| link.status);
        status.filter(|status| is_it(status))
    });
}

/// A circle over the cloth, played.
fn play_circle(engine: &mut Engine) {
    let circle = Stroke::Circle {
        centre: Point::new(40.0, 70.0),
        radius_mm: 10.0,
        speed_mm_per_s: 80.0,
    };
    engine
        .send(Command::SetSource(InputSource::Stroke(circle)))
        .unwrap();
    engine.send(Command::Play).unwrap();
}

fn start_streaming(target: Target) -> Engine {
    let mut engine = Engine::start(config(Method::Auto)).unwrap();
    engine.send(Command::Connect(target)).unwrap();
    wait_for(&mut engine, "ready", |event| {
        matches!(event, BridgeEvent::Ready(_))
    });
    play_circle(&mut engine);
    engine.send(Command::Arm).unwrap();
    wait_for(&mut engine, "armed", |event| {
        matches!(event, BridgeEvent::Armed)
    });
    wait_for_status(&mut engine, "output", |status| status.amp_sum > 0);
    engine
}

#[test]
fn a_device_is_armed_paces_plays_what_is_felt_and_stops() {
    let mut engine = start_streaming(Target::Emulator);
    wait(&mut engine, "thirty frames", |engine| {
        engine
            .snapshot()
            .link
            .filter(|link| link.counters.frames_sent >= 30)
    });
    let snapshot = engine.snapshot();
    let link = snapshot.link.unwrap();
    assert!(snapshot.clock.is_device_paced);
    assert!(snapshot.pointer.felt_age.is_none(), "a stroke has no stamp");
    let device = link.counters.device;
    assert_eq!((device.bad, device.dup, device.clipped), (0, 0, 0));
    assert_eq!(link.counters.codes.non_finite, 0);
    assert_eq!(link.caps.unwrap().n_ch, 24);

    engine.stop_switch().press_if_armed();
    wait_for_status(&mut engine, "rest", |status| {
        status.amp_sum == 0 && status.state == DeviceState::Ready.code()
    });
    wait(&mut engine, "the stop", |engine| {
        engine.snapshot().is_stopped.then_some(())
    });
    assert!(is_silent(engine.snapshot()));
    // Nothing arms it again but a command.
    let unheard = engine.snapshot().counters.frames_unheard;
    wait(&mut engine, "ticks without frames", |engine| {
        (engine.snapshot().counters.frames_unheard > unheard + 5).then_some(())
    });
    assert_eq!(
        engine.snapshot().link.unwrap().status.unwrap().state,
        DeviceState::Ready.code()
    );

    engine.send(Command::Play).unwrap();
    wait(&mut engine, "a device that can be armed", |engine| {
        engine.send(Command::Arm).unwrap();
        thread::sleep(Duration::from_millis(60));
        let link = engine.snapshot().link.unwrap();
        link.status.filter(|status| status.amp_sum > 0)
    });
    engine.send(Command::Disarm).unwrap();
    wait_for(&mut engine, "disarmed", |event| {
        matches!(
            event,
            BridgeEvent::Disarmed {
                by: DisarmedBy::Host,
                ..
            }
        )
    });
}

#[test]
fn a_live_pointer_shows_the_age_of_what_is_felt() {
    let mut engine = start_streaming(Target::Emulator);
    let mut pointer = engine.take_pointer().unwrap();
    engine
        .send(Command::SetSource(InputSource::Pointer))
        .unwrap();
    let mut x_mm = 30.0;
    let view = wait(&mut engine, "an age", |engine| {
        x_mm += 0.3;
        let position = Point::new(x_mm, 60.0);
        pointer.push(PointerSample {
            stamp: Instant::now(),
            position,
        });
        let snapshot = engine.snapshot();
        let is_felt = snapshot.source == SourceKind::Pointer && !is_silent(snapshot);
        is_felt.then_some((snapshot.pointer, snapshot.link.unwrap()))
    });
    let (view, link) = view;
    let ahead = link.sent.unwrap().ahead;
    assert!(ahead <= TICK * u32::from(link.depth), "{ahead:?}");
    assert_eq!(view.felt_age.unwrap(), view.age.unwrap() + ahead + TICK / 2);
}

#[test]
fn a_scene_with_another_display_lets_the_device_go() {
    let mut engine = start_streaming(Target::Emulator);
    let offsets = vec![Displacement::default(); 25];
    engine
        .send(Command::SetScene(Box::new(prepared(
            offsets,
            Method::Banded,
        ))))
        .unwrap();
    wait(&mut engine, "the notice", |engine| {
        std::iter::from_fn(|| engine.next_notice()).find(|n| matches!(n, Notice::DisplayChanged))
    });
    wait(&mut engine, "no device", |engine| {
        engine.snapshot().link.is_none().then_some(())
    });
}

#[test]
fn a_port_that_is_not_there_is_a_notice_and_the_engine_goes_on() {
    let mut engine = Engine::start(config(Method::Auto)).unwrap();
    engine
        .send(Command::Connect(Target::Port("/nowhere/array".into())))
        .unwrap();
    let reason = wait(&mut engine, "the reason", |engine| {
        match engine.next_notice() {
            Some(Notice::Bridge(BridgeEvent::Lost(reason) | BridgeEvent::Refused(reason))) => {
                Some(reason)
            }
            _ => None,
        }
    });
    assert!(
        reason.contains("no such port") && !reason.contains('\n'),
        "{reason}"
    );
    let tick = engine.snapshot().tick;
    wait(&mut engine, "more ticks", |engine| {
        (engine.snapshot().tick > tick + 3).then_some(())
    });
}

#[cfg(unix)]
#[test]
fn a_device_that_vanishes_is_a_notice_and_the_own_clock_goes_on() {
    let (mut engine, _) = with_terminal("vanish", |link, vanish| {
        let mut engine = start_streaming(Target::Port(link.to_owned()));
        vanish.store(true, Ordering::SeqCst);
        wait_for(&mut engine, "the loss", |event| {
            matches!(event, BridgeEvent::Lost(_))
        });
        engine
    });
    let tick = engine.snapshot().tick;
    wait(&mut engine, "more ticks", |engine| {
        (engine.snapshot().tick > tick + 5).then_some(())
    });
    assert!(!engine.snapshot().clock.is_device_paced);
    assert_eq!(engine.snapshot().link.unwrap().state, BridgeState::Lost);
}

#[cfg(unix)]
#[test]
fn a_new_scene_keeps_to_the_limits_of_the_device_at_hand() {
    let model = DeviceModel {
        comp_limit: [100; 2],
        ..DeviceModel::for_array(&ArrayProfile::default())
    };
    let n_limited = |engine: &mut Engine| {
        let contactors = &engine.snapshot().displays[0].contactors;
        contactors.iter().filter(|c| c.limiter.limited[0]).count()
    };
    // Judged once the device is gone: its thread would outlive a failure in here.
    let (counts, _) = with_device("limits", model, |link, _| {
        let mut engine = start_streaming(Target::Port(link.to_owned()));
        let mut counts = vec![n_limited(&mut engine)];
        for command in [Command::SetScene, Command::UpdateScene] {
            let scene = Box::new(prepared(exeter(), Method::Table));
            let serial = scene.serial();
            engine.send(command(scene)).unwrap();
            wait(&mut engine, "a tick of the scene", |engine| {
                let snapshot = engine.snapshot();
                let is_felt = snapshot.scene_serial == serial && !is_silent(snapshot);
                is_felt.then_some(())
            });
            counts.push(n_limited(&mut engine));
        }
        counts
    });
    assert_eq!(counts, [24; 3], "far below what the array could do");
}

/// A source that fails in a way that nobody foresaw.
#[derive(Debug)]
struct Panics;

impl PointerInput for Panics {
    fn kind(&self) -> SourceKind {
        SourceKind::Stroke
    }

    fn poll(&mut self, _now: Instant, _take: &mut dyn FnMut(PointerSample)) -> Reading {
        panic!("on purpose: the engine's thread ends")
    }
}

/// Runs an emulated device behind a pseudo-terminal until the work is done, or sets the flag that
/// ends it. Returns the work's result and the device's log.
#[cfg(unix)]
fn with_terminal<T>(name: &str, work: impl FnOnce(&Path, &AtomicBool) -> T) -> (T, String) {
    let model = DeviceModel::for_array(&ArrayProfile::default());
    with_device(name, model, work)
}

#[test]
fn an_emulator_in_told_time_gets_a_frame_in_every_tick_and_falls_silent_without() {
    let (mut engine, _) = engine(Method::Auto);
    engine.step_emulators();
    let stall = FaultWords::of(&[("stall-reading-at", "5s+500ms")]);
    let target = Target::FaultyEmulator(Box::new(stall.faults().unwrap()));
    engine.send(Command::Connect(target)).unwrap();
    engine.advance_ticks(20);
    engine.send(Command::Arm).unwrap();
    engine.advance_ticks(120);
    let link = engine.snapshot().link.unwrap();
    assert_eq!(link.state, BridgeState::Streaming);
    let counted = link.counters;
    assert!(counted.frames_sent > 100, "{counted:?}");
    assert_eq!((counted.device.underrun, counted.device.late), (0, 0));
    engine.advance_ticks(100);
    let link = engine.snapshot().link.unwrap();
    assert!(link.counters.device.underrun >= 3, "{:?}", link.counters);
    assert_eq!(link.state, BridgeState::Ready, "it disarmed itself");
}

/// As [`with_terminal`] with a device of this model.
#[cfg(unix)]
fn with_device<T>(
    name: &str,
    model: DeviceModel,
    work: impl FnOnce(&Path, &AtomicBool) -> T,
) -> (T, String) {
    let folder = ScratchFolder::made(name);
    let (link, log) = (folder.join("array"), folder.join("log.csv"));
    let emulator = PtyEmulator::new(model, &Faults::default(), &link, Some(&log)).unwrap();
    let is_over = AtomicBool::new(false);
    let done = thread::scope(|scope| {
        let emulation = scope.spawn(|| emulator.run(&is_over, |_, _| {}));
        let done = work(&link, &is_over);
        is_over.store(true, Ordering::SeqCst);
        emulation.join().unwrap().unwrap();
        done
    });
    let text = std::fs::read_to_string(&log).unwrap();
    (done, text)
}

/// Lets the engine's thread panic while it streams, and returns the states that the device went
/// through.
#[cfg(unix)]
fn states_through_a_panic(number: u32) -> Vec<String> {
    let ((), log) = with_terminal(&format!("panic-{number}"), |link, _| {
        let mut engine = start_streaming(Target::Port(link.to_owned()));
        let source: Option<Box<dyn PointerInput>> = Some(Box::new(Panics));
        engine
            .push(ReadyCommand::Core(CoreCommand::Source(source)))
            .unwrap();
        wait(&mut engine, "the panic", |engine| {
            (!engine.is_running()).then_some(())
        });
        thread::sleep(Duration::from_millis(200));
    });
    let states = log
        .lines()
        .filter(|line| line.split(',').nth(2) == Some("state"));
    states
        .map(|line| line.split(',').nth(3).unwrap().to_owned())
        .collect()
}

#[cfg(unix)]
#[test]
fn a_panic_on_the_engines_thread_stops_the_device_before_it_has_to_help_itself() {
    // A busy machine may delay the STOP beyond the device's patience; not five times in a row.
    let stopped_by_host = (0..5).any(|number| {
        let states = states_through_a_panic(number);
        assert_eq!(
            states.last().map(String::as_str),
            Some("READY"),
            "{states:?}"
        );
        assert!(states.iter().any(|state| state == "RUN"), "{states:?}");
        states.iter().all(|state| state != "RAMP")
    });
    assert!(stopped_by_host, "the device always ramped by itself");
}

#[test]
fn the_log_of_a_device_in_told_time_replays_as_it_was() {
    let folder = ScratchFolder::made("told");
    let path = folder.join("link.csv");
    let (mut engine, start) = engine(Method::Auto);
    engine.step_emulators();
    engine.log_links_to(SessionLog::append(&path, None).unwrap());
    engine.send(Command::Connect(Target::Emulator)).unwrap();
    let mut ticks = 0;
    for n in 1..400_u32 {
        if n == 30 {
            engine.send(Command::Arm).unwrap();
        }
        engine.advance(start + TICK * n);
        ticks += u64::from(
            engine
                .snapshot()
                .link
                .is_some_and(|link| link.state.is_live()),
        );
        // The log has a thread of its own, for which told time is too fast.
        thread::sleep(Duration::from_millis(1));
    }
    assert!(ticks > 300, "{ticks}");
    drop(engine);
    let mut n_felt = 0;
    let links = ReplayedLink::of_log(&path, &ContactorModel::default(), |tick| {
        n_felt += u64::from(tick.state == DeviceState::Run);
        Ok::<(), BridgeError>(())
    });
    let links = links.unwrap();
    assert!(
        links[0].agrees() && n_felt + 3 > ticks,
        "{n_felt} of {ticks}: {}",
        links[0]
    );
}
