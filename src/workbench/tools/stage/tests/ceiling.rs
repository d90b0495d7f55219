//! What the device puts out in two hundred visits, tick by tick.

use super::window::{opened, square, stage, wait, with_pin};
use super::*;
use crate::bench::command::DeviceCommand;
use crate::bench::command::edit::Edit;
use crate::shell::headless::Headless;
use eframe::egui::{Event, Key, Modifiers, PointerButton, vec2};
use selvedge_device::FULL_CODE;
use selvedge_foundation::numerics::Random;

/// Of full scale, as `with_pin` says.
const CEILING: f64 = 0.3;
/// Ticks to a frame where nobody strokes by hand.
const TICKS: u32 = 4;

/// The stage, and what was seen of the codes that its device puts out.
struct Visited {
    window: Headless,
    n_ticks: u64,
    n_felt: u64,
    largest: u16,
}

impl Visited {
    /// Lets ticks pass, looks at the device after each, then draws a frame.
    fn frame(&mut self, n_ticks: u32) {
        for _ in 0..n_ticks {
            let bench = &mut self.window.workbench.bench;
            bench.clock.stepped_at = bench.engine.advance_ticks(1);
            let actuators = bench.engine.actuators().unwrap();
            let codes = actuators.reading().codes.iter().flatten();
            let largest = codes.copied().max().unwrap_or_default();
            self.n_ticks += 1;
            self.n_felt += u64::from(largest > 0);
            self.largest = self.largest.max(largest);
            assert!(
                f64::from(largest) <= most(),
                "{largest} at tick {}",
                self.n_ticks
            );
        }
        self.window.run_after(n_ticks).textures_delta.clear();
    }

    fn frames(&mut self, n_frames: usize) {
        (0..n_frames).for_each(|_| self.frame(TICKS));
    }

    fn act(&mut self, act: Act) {
        stage(&mut self.window).machine.act(act, "keys");
    }

    fn key(&mut self, pressed: bool) {
        self.window.events.push(Event::Key {
            key: Key::Space,
            physical_key: None,
            pressed,
            repeat: false,
            modifiers: Modifiers::NONE,
        });
    }

    /// Strokes over a cloth by hand, fast and slow.
    fn stroke(&mut self, random: &mut Random) {
        let side = 0.2 * square(&mut self.window).width();
        let [x, y] = [random.index(2), random.index(2)].map(|n| if n == 0 { -side } else { side });
        let at = square(&mut self.window).center() + vec2(x, y);
        let button = |pressed| Event::PointerButton {
            pos: at,
            button: PointerButton::Primary,
            pressed,
            modifiers: Modifiers::NONE,
        };
        let down = [Event::PointerMoved(at), button(true)];
        self.window.events.extend(down);
        let hurry = [0.2, 1.0, 3.0][random.index(3)];
        for n in 0..12_u8 {
            let off = 60.0 * (hurry * f32::from(n)).sin();
            let moved = Event::PointerMoved(at + vec2(off, 0.0));
            self.window.events.push(moved);
            self.frame(1);
        }
        self.window.events.push(button(false));
        self.frame(1);
    }
}

/// The largest code that the ceiling allows, rounded up.
fn most() -> f64 {
    CEILING * f64::from(FULL_CODE) + 1.0
}

/// One visitor of the `nth` kind.
fn visit(hall: &mut Visited, kind: usize, random: &mut Random) {
    hall.act(Act::Tour(random.index(N_CLOTHS)));
    if stage(&mut hall.window).machine.voltage.is_permitted() {
        hall.key(true);
        hall.frames(1);
        hall.act(Act::HoldFeel(true));
        hall.frames(12);
        hall.key(false);
    }
    hall.frames(3 + random.index(8));
    if random.index(2) == 0 {
        hall.act(Act::SameStrength);
    }
    match kind {
        0 | 1 => hall.stroke(random),
        2 => hall.act(Act::Guess),
        3 => stage(&mut hall.window).machine.voltage.permit(false),
        // Nobody is there any more: back to watching by itself.
        4 if random.index(4) == 0 => (0..100).for_each(|_| hall.frame(20)),
        _ => {}
    }
    hall.frames(2);
    let end = if kind == 5 {
        VisitEnd::Restart
    } else {
        VisitEnd::Stop
    };
    stage(&mut hall.window).machine.end(end);
    hall.frames(3);
}

#[test]
fn no_tick_of_two_hundred_visits_exceeds_the_ceiling_on_the_device() {
    let mut window = opened(with_pin(), vec2(1280.0, 720.0), 1.0);
    // Far more than any profile allows, so that limits bite.
    window.dispatch(Edit::MasterGain(24.0));
    window.dispatch(DeviceCommand::ConnectEmulator);
    wait(&mut window, |window| window.workbench.is_ready(), "ready");
    window
        .workbench
        .bench
        .engine
        .actuators()
        .unwrap()
        .look(true);
    let mut hall = Visited {
        window,
        n_ticks: 0,
        n_felt: 0,
        largest: 0,
    };
    let mut random = Random::new(2027);
    for nth in 0..200 {
        let is_permitted = nth % 4 != 0;
        stage(&mut hall.window).machine.voltage.permit(is_permitted);
        let before = hall.n_felt;
        visit(&mut hall, nth % 7, &mut random);
        assert!(
            is_permitted || hall.n_felt == before,
            "{nth} had no permission"
        );
    }
    assert!(
        hall.n_felt > 2000,
        "{} of {} ticks",
        hall.n_felt,
        hall.n_ticks
    );
    let reached = f64::from(hall.largest) / most();
    assert!(reached > 0.99, "the ceiling bites: {reached}");
}
