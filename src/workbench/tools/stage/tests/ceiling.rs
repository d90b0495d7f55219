//! What goes to the device in two hundred visits: read from the log of the link, tick by tick.

use super::window::{opened, square, stage, wait, with_pin};
use super::*;
use crate::bench::command::DeviceCommand;
use crate::bench::command::edit::Edit;
use crate::shell::headless::Headless;
use eframe::egui::{Event, Key, Modifiers, PointerButton, vec2};
use selvedge_device::{BridgeError, FULL_CODE, ReplayedTick, SessionLog, replay_log};
use selvedge_foundation::numerics::Random;
use selvedge_scratch::ScratchFolder;

/// Of full scale, as `with_pin` says.
const CEILING: f64 = 0.3;
/// Ticks to a frame where nobody strokes by hand.
const TICKS: u32 = 4;

fn key(window: &mut Headless, pressed: bool) {
    window.events.push(Event::Key {
        key: Key::Space,
        physical_key: None,
        pressed,
        repeat: false,
        modifiers: Modifiers::NONE,
    });
}

fn frames(window: &mut Headless, n_frames: usize) {
    for _ in 0..n_frames {
        window.run_after(TICKS).textures_delta.clear();
    }
}

fn act(window: &mut Headless, act: Act) {
    stage(window).machine.act(act, "keys");
}

/// Strokes over a cloth by hand, fast and slow.
fn stroke(window: &mut Headless, random: &mut Random) {
    let side = 0.2 * square(window).width();
    let corner = [random.index(2), random.index(2)].map(|n| if n == 0 { -side } else { side });
    let at = square(window).center() + vec2(corner[0], corner[1]);
    let button = |pressed| Event::PointerButton {
        pos: at,
        button: PointerButton::Primary,
        pressed,
        modifiers: Modifiers::NONE,
    };
    window
        .events
        .extend([Event::PointerMoved(at), button(true)]);
    let hurry = [0.2, 1.0, 3.0][random.index(3)];
    for n in 0..12_u8 {
        let off = 60.0 * (hurry * f32::from(n)).sin();
        window.events.push(Event::PointerMoved(at + vec2(off, 0.0)));
        window.pass(1);
    }
    window.events.push(button(false));
    window.pass(1);
}

/// One visitor of the `nth` kind.
fn visit(window: &mut Headless, kind: usize, random: &mut Random) {
    act(window, Act::Tour(random.index(N_CLOTHS)));
    if stage(window).machine.voltage.is_permitted() {
        key(window, true);
        frames(window, 1);
        act(window, Act::HoldFeel(true));
        frames(window, 12);
        key(window, false);
    }
    frames(window, 3 + random.index(8));
    if random.index(2) == 0 {
        act(window, Act::SameStrength);
    }
    match kind {
        0 | 1 => stroke(window, random),
        2 => act(window, Act::Guess),
        3 => {
            stage(window).machine.voltage.permit(false);
            frames(window, 2);
        }
        // Nobody is there any more: back to watching by itself.
        4 if random.index(4) == 0 => (0..100).for_each(|_| {
            window.run_after(20).textures_delta.clear();
        }),
        _ => {}
    }
    frames(window, 2);
    let end = if kind == 5 {
        VisitEnd::Restart
    } else {
        VisitEnd::Stop
    };
    stage(window).machine.end(end);
    frames(window, 3);
}

#[test]
fn no_tick_of_two_hundred_visits_exceeds_the_ceiling_on_the_device() {
    let folder = ScratchFolder::made("stage-ceiling");
    let path = folder.join("link.csv");
    let mut window = opened(with_pin(), vec2(1280.0, 720.0), 1.0);
    let log = SessionLog::append(&path, None).unwrap();
    window.workbench.bench.engine.log_links_to(log);
    // Far more than any profile allows, so that limits bite.
    window.dispatch(Edit::MasterGain(24.0));
    window.dispatch(DeviceCommand::ConnectEmulator);
    wait(&mut window, |window| window.workbench.is_ready(), "ready");
    let mut random = Random::new(2027);
    for nth in 0..200 {
        stage(&mut window).machine.voltage.permit(nth % 4 != 0);
        visit(&mut window, nth % 7, &mut random);
    }
    drop(window);
    let (mut n_felt, mut largest) = (0, 0);
    let most = CEILING * f64::from(FULL_CODE) + 1.0;
    let mut look = |tick: &ReplayedTick| {
        for code in tick.codes.iter().flatten() {
            assert!(f64::from(*code) <= most, "{code} at tick {}", tick.tick);
            largest = largest.max(*code);
        }
        n_felt += usize::from(tick.codes.iter().flatten().any(|code| *code > 0));
        Ok::<(), BridgeError>(())
    };
    replay_log(&path, &Default::default(), &mut look).unwrap();
    assert!(n_felt > 1000, "{n_felt} ticks were felt");
    assert!(
        f64::from(largest) > 0.9 * most,
        "the ceiling bites: {largest}"
    );
}
