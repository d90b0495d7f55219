//! What the window's own events say of pointer, fingers and Esc, before the toolkit hears of them.
//!
//! The first finger feels as the pointer does; where the scene has more displays, a second finger
//! holds the second, and so on. A finger without a display feels nothing. Any finger stops.

use std::cell::RefCell;
use std::rc::Rc;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Instant;

use winit::event::{ElementState, Touch, TouchPhase, WindowEvent};
use winit::keyboard::{Key, NamedKey};
use winit::window::WindowId;

use crate::kit::fingers::HeldDisplays;
use crate::kit::view_transform::Pointed;
use crate::shell::pending_motion::PendingMotion;
use crate::shell::pointer::PointerTap;
#[cfg(target_os = "linux")]
use crate::shell::pointer_x11::Listener;
use selvedge_engine::StopSwitch;

/// What the event handler shares with the workbench; both live on the window's thread.
pub(crate) type Shared = Rc<RefCell<Option<Ears>>>;

/// What the handler does with what it hears.
pub(crate) struct Ears {
    pub(crate) tap: Arc<Mutex<PointerTap>>,
    pub(crate) stop: StopSwitch,
    /// The workbench's window.
    pub(crate) workbench: Option<WindowId>,
    /// Movements without a button held reach the tap by a thread of their own, if there is one.
    pub(crate) listener: Option<Listener>,
    /// The participant's window that was seen last, and whether that thread listens to it.
    pub(crate) participant: Option<(WindowId, bool)>,
    /// Whether the public is before it: only what is pressed is felt.
    pub(crate) is_stage: bool,
}

impl Ears {
    /// Which of the windows this is, and whether a thread listens to it.
    fn window_of(&mut self, id: WindowId) -> (Pointed, bool) {
        if self.workbench.is_none_or(|workbench| workbench == id) {
            return (Pointed::Workbench, self.listener.is_some());
        }
        let is_heard = match self.participant {
            Some((known, is_heard)) if known == id => is_heard,
            _ => {
                let listener = self.listener.as_ref();
                let is_heard = listener.is_some_and(|listener| listener.also(id.into()));
                self.participant = Some((id, is_heard));
                is_heard
            }
        };
        (Pointed::Participant, is_heard)
    }
}

/// Lets a thread of its own listen to the pointer, where that can be had.
#[cfg(target_os = "linux")]
pub(crate) fn listener(
    cc: &eframe::CreationContext<'_>,
    tap: &Arc<Mutex<PointerTap>>,
) -> Option<Listener> {
    let tap = Arc::clone(tap);
    crate::shell::pointer_x11::listen(cc, move |stamp, is_workbench, pixel| {
        let window = if is_workbench {
            Pointed::Workbench
        } else {
            Pointed::Participant
        };
        let mut tap = tap.lock().unwrap_or_else(PoisonError::into_inner);
        tap.moved_to_pixel(stamp, window, (0, pixel));
    })
}

/// Here the windows' own events are all there is.
#[cfg(not(target_os = "linux"))]
pub(crate) enum Listener {}

#[cfg(not(target_os = "linux"))]
impl Listener {
    fn also(&self, _window: u64) -> bool {
        match *self {}
    }
}

#[cfg(not(target_os = "linux"))]
fn listener(_cc: &eframe::CreationContext<'_>, _tap: &Arc<Mutex<PointerTap>>) -> Option<Listener> {
    None
}

/// What is heard of pointer and fingers.
pub(crate) struct Ear {
    shared: Shared,
    pub(crate) pending_motion: PendingMotion,
    /// The window that what waits there is over.
    waits_over: Pointed,
    /// Buttons of the pointer that are held.
    n_held: u32,
    /// Where it was last, pixels.
    pixel: [f64; 2],
    /// The fingers that hold displays.
    fingers: HeldDisplays,
}

impl Ear {
    /// An ear that has heard nothing.
    pub(crate) fn new(shared: Shared, now: Instant) -> Self {
        Self {
            shared,
            pending_motion: PendingMotion::new(now),
            waits_over: Pointed::default(),
            n_held: 0,
            pixel: [0.0; 2],
            fingers: HeldDisplays::default(),
        }
    }

    /// Which window this is, and whether a thread listens to the pointer over it.
    fn window_of(&self, id: WindowId) -> (Pointed, bool) {
        let mut shared = self.shared.borrow_mut();
        let ears = shared.as_mut();
        ears.map_or_else(Default::default, |ears| ears.window_of(id))
    }

    /// Takes in an event of one of the windows that arrives now.
    pub(crate) fn listen(&mut self, now: Instant, id: WindowId, event: &WindowEvent) {
        let (window, is_heard) = self.window_of(id);
        let is_stage = (self.shared.borrow().as_ref()).is_some_and(|ears| ears.is_stage);
        match event {
            WindowEvent::CursorMoved { position, .. } => {
                self.pixel = [position.x, position.y];
                // A finger speaks for itself.
                let is_felt = self.n_held > 0 || !(is_heard || is_stage);
                if is_felt && !self.fingers.is_any() {
                    self.moved(now, window, (0, self.pixel));
                }
                return;
            }
            WindowEvent::Touch(touch) => return self.touched(now, window, touch),
            // A part of the movement before it, which X11 tells apart.
            WindowEvent::AxisMotion { .. } => return,
            _ => {}
        }
        // Movements come in a row: another event ends it.
        self.pass_on(now);
        let stop = (self.shared.borrow().as_ref()).map(|ears| ears.stop.clone());
        let Some(stop) = stop else { return };
        match event {
            WindowEvent::KeyboardInput { event, .. } => {
                let is_escape = event.logical_key == Key::Named(NamedKey::Escape);
                if is_escape && event.state == ElementState::Pressed {
                    // At once where a device may move; what else Esc does is done in a frame.
                    stop.press_if_armed();
                }
            }
            WindowEvent::MouseInput { state, .. } => match state {
                ElementState::Pressed => {
                    self.n_held += 1;
                    self.press_stop(self.pixel);
                    if is_stage && !self.fingers.is_any() {
                        self.moved(now, window, (0, self.pixel));
                    }
                }
                ElementState::Released => self.n_held = self.n_held.saturating_sub(1),
            },
            // The participant's window comes and goes while a device is armed.
            WindowEvent::CloseRequested | WindowEvent::Destroyed
                if window == Pointed::Workbench =>
            {
                stop.press();
            }
            _ => {}
        }
    }

    /// A finger that comes down on what is felt holds a display; any finger stops.
    fn touched(&mut self, now: Instant, window: Pointed, touch: &Touch) {
        let (finger, pixel) = (touch.id, [touch.location.x, touch.location.y]);
        self.held(now, window, touch);
        if self.fingers.is_stray(finger) {
            self.with_tap(|tap| tap.stray(pixel));
        }
    }

    fn held(&mut self, now: Instant, window: Pointed, touch: &Touch) {
        let (finger, pixel) = (touch.id, [touch.location.x, touch.location.y]);
        match touch.phase {
            TouchPhase::Started => {
                self.press_stop(pixel);
                let n_displays = self.with_tap(|tap| tap.n_displays_at(window, pixel));
                if let Some(display) = self.fingers.down(finger, n_displays.unwrap_or(0)) {
                    self.moved(now, window, (display, pixel));
                }
            }
            TouchPhase::Moved => {
                if let Some(display) = self.fingers.display(finger) {
                    self.moved(now, window, (display, pixel));
                }
            }
            TouchPhase::Ended | TouchPhase::Cancelled => {
                if let Some(display) = self.fingers.up(finger) {
                    self.pass_on(now);
                    self.with_tap(|tap| tap.lift(display));
                }
            }
        }
    }

    /// A press where STOP stands acts as Esc does, without waiting for a frame.
    fn press_stop(&self, pixel: [f64; 2]) {
        if self.with_tap(|tap| tap.is_stop(pixel)) == Some(true)
            && let Some(ears) = &*self.shared.borrow()
        {
            ears.stop.press_if_armed();
        }
    }

    fn moved(&mut self, now: Instant, window: Pointed, (display, pixel): (usize, [f64; 2])) {
        if window != self.waits_over {
            self.pass_on(now);
            self.waits_over = window;
        }
        self.pending_motion.moved(display, pixel);
    }

    /// Hands what was heard of pointer and fingers to the engine.
    pub(crate) fn pass_on(&mut self, now: Instant) {
        let window = self.waits_over;
        let shared = self.shared.borrow();
        let tap = shared.as_ref().map(|ears| &ears.tap);
        let mut tap = tap.map(|tap| tap.lock().unwrap_or_else(PoisonError::into_inner));
        self.pending_motion.pass_on(now, |stamp, moved| {
            if let Some(tap) = &mut tap {
                tap.moved_to_pixel(stamp, window, moved);
            }
        });
    }

    /// What comes of the tap; `None` before there is a workbench.
    fn with_tap<T>(&self, act: impl FnOnce(&mut PointerTap) -> T) -> Option<T> {
        let shared = self.shared.borrow();
        let ears = shared.as_ref()?;
        let mut tap = ears.tap.lock().unwrap_or_else(PoisonError::into_inner);
        Some(act(&mut tap))
    }
}

#[cfg(test)]
mod tests {
    use std::cell::RefCell;

    use eframe::egui::TouchPhase as Heard;
    use eframe::egui::{Event, TouchDeviceId, TouchId, vec2};
    use winit::dpi::PhysicalPosition;
    use winit::event::DeviceId;

    use super::*;
    use crate::bench::command::{PlayCommand, PlaySource, ShowCommand};
    use crate::bench::recording::tests::TWO_DISPLAYS;
    use crate::shell::headless::Headless;
    use crate::tools::why::explanation::Explanation;
    use selvedge_foundation::geometry::Point;
    use selvedge_scratch::ScratchFolder;

    /// A window on two displays, with the ear that is before the toolkit's.
    struct Desk {
        window: Headless,
        ear: Ear,
        _folder: ScratchFolder,
    }

    impl Desk {
        fn new() -> Self {
            let folder = ScratchFolder::made("ear");
            let scene = folder.write("two.scene.toml", TWO_DISPLAYS);
            let mut window = Headless::new(Some(&scene), vec2(1400.0, 900.0), 1.0).unwrap();
            window.dispatch(PlayCommand::Source(PlaySource::Pointer));
            window.pass(4);
            let workbench = &window.workbench;
            let ears = Ears {
                tap: Arc::clone(&workbench.shell.tap),
                stop: workbench.bench.engine.stop_switch().clone(),
                workbench: Some(WindowId::dummy()),
                listener: None,
                participant: None,
                is_stage: false,
            };
            let now = workbench.bench.clock.stamp();
            let ear = Ear::new(Rc::new(RefCell::new(Some(ears))), now);
            Self {
                window,
                ear,
                _folder: folder,
            }
        }

        /// A finger does this at a place of the workspace; ear and toolkit hear of it.
        fn touch(&mut self, id: u64, phase: TouchPhase, [x_mm, y_mm]: [f64; 2]) {
            let workbench = &self.window.workbench;
            let now = workbench.bench.clock.stamp();
            let place = Point::new(x_mm, y_mm);
            let at = workbench.shell.tap.lock().unwrap().screen(place).unwrap();
            let touch = Touch {
                device_id: DeviceId::dummy(),
                phase,
                location: PhysicalPosition::new(f64::from(at.x), f64::from(at.y)),
                force: None,
                id,
            };
            (self.ear).listen(now, WindowId::dummy(), &WindowEvent::Touch(touch));
            self.ear.pass_on(now);
            self.window.events.push(Event::Touch {
                device_id: TouchDeviceId(1),
                id: TouchId::from(id),
                phase: match phase {
                    TouchPhase::Started => Heard::Start,
                    TouchPhase::Moved => Heard::Move,
                    TouchPhase::Ended => Heard::End,
                    TouchPhase::Cancelled => Heard::Cancel,
                },
                pos: at,
                force: None,
            });
        }

        /// These fingers stroke along lines of their own, one tick after the other.
        fn stroke(&mut self, fingers: &[u64], ticks: std::ops::Range<u16>) {
            for n in ticks {
                for id in fingers {
                    self.touch(*id, TouchPhase::Moved, place(*id, n));
                }
                self.window.pass(1);
            }
        }

        /// Which displays sound, and where they are across, mm.
        fn displays(&mut self) -> [(bool, f64); 2] {
            let snapshot = self.window.workbench.bench.engine.snapshot();
            [0, 1].map(|nth| {
                let display = &snapshot.displays[nth];
                let mut felt = display.contactors.iter().map(|c| c.amplitude_um);
                let sounds = felt.any(|um| um != [0.0; 2]);
                (sounds, display.pose.position.y_mm)
            })
        }
    }

    /// Where a finger is after so many ticks: each on a line of its own.
    fn place(finger: u64, n: u16) -> [f64; 2] {
        [60.0 + 2.0 * f64::from(n), 40.0 * finger as f64]
    }

    fn is_near(a: f64, b: f64) -> bool {
        (a - b).abs() < 0.5
    }

    #[test]
    fn a_second_finger_holds_the_second_display_and_either_may_lift_first() {
        for phase in [TouchPhase::Ended, TouchPhase::Cancelled] {
            for (first, stays) in [(1, 2), (2, 1)] {
                let mut desk = Desk::new();
                desk.touch(1, TouchPhase::Started, place(1, 0));
                desk.stroke(&[1], 1..8);
                let [one, two] = desk.displays();
                assert_eq!(one, two, "the second follows the first");
                assert!(one.0 && is_near(one.1, 40.0), "{one:?}");
                desk.touch(2, TouchPhase::Started, place(2, 8));
                desk.stroke(&[1, 2], 9..16);
                let [one, two] = desk.displays();
                assert!(one.0 && two.0, "both are felt");
                assert!(
                    is_near(one.1, 40.0) && is_near(two.1, 80.0),
                    "{one:?} {two:?}"
                );
                desk.touch(first, phase, place(first, 16));
                desk.stroke(&[stays], 17..24);
                let felt = desk.displays();
                let at = |finger: u64| felt[usize::from(finger != 1)];
                assert!(!at(first).0 && at(stays).0, "{phase:?} {first}: {felt:?}");
                assert!(is_near(at(first).1, 40.0 * first as f64), "it stays");
                desk.touch(stays, phase, place(stays, 24));
                desk.window.pass(1);
                assert_eq!(desk.displays().map(|display| display.0), [false; 2]);
            }
        }
    }

    #[test]
    fn a_third_finger_draws_a_ring_and_is_not_felt_and_the_next_takes_what_is_free() {
        let mut desk = Desk::new();
        for id in [1, 2, 3] {
            desk.touch(id, TouchPhase::Started, place(id, 0));
        }
        desk.stroke(&[1, 2, 3], 1..8);
        let [one, two] = desk.displays();
        assert!(
            is_near(one.1, 40.0) && is_near(two.1, 80.0),
            "{one:?} {two:?}"
        );
        let rings = |desk: &mut Desk| {
            let output = desk.window.run();
            let is_ring = |shape: &eframe::egui::epaint::ClippedShape| {
                matches!(&shape.shape, eframe::egui::Shape::Circle(circle)
                    if circle.radius == 30.0 && circle.fill.a() == 0)
            };
            let n = output.shapes.iter().filter(|shape| is_ring(shape)).count();
            output.drop_without_applying_deltas();
            n
        };
        assert!(rings(&mut desk) > 0, "the third has rings");
        desk.window.pass(40);
        assert_eq!(rings(&mut desk), 0, "they fade");
        // The first lifts: the third gains nothing by that, a fourth takes the first display.
        desk.touch(1, TouchPhase::Ended, place(1, 8));
        desk.stroke(&[2, 3], 9..16);
        assert!(is_near(desk.displays()[0].1, 40.0));
        desk.touch(4, TouchPhase::Started, place(4, 16));
        desk.stroke(&[2, 3, 4], 17..24);
        let [one, two] = desk.displays();
        assert!(
            is_near(one.1, 160.0) && is_near(two.1, 80.0),
            "{one:?} {two:?}"
        );
        assert!(one.0 && two.0);
    }

    #[test]
    fn every_view_looks_at_the_display_that_is_chosen() {
        let mut desk = Desk::new();
        for id in [1, 2] {
            desk.touch(id, TouchPhase::Started, place(id, 0));
        }
        desk.stroke(&[1, 2], 1..8);
        for (key, y_mm) in [
            (ShowCommand::NextDisplay, 80.0),
            (ShowCommand::SelectDisplay(0), 40.0),
        ] {
            desk.window.dispatch(key);
            desk.stroke(&[1, 2], 8..16);
            let expected = {
                let bench = &mut desk.window.workbench.bench;
                let (display, snapshot) = (bench.display(), bench.engine.snapshot());
                let contactors = snapshot.displays[display].contactors.iter();
                contactors
                    .map(|c| c.amplitude_um.map(f64::from))
                    .collect::<Vec<_>>()
            };
            let bench = &mut desk.window.workbench.bench;
            let live = &bench.live;
            assert!(is_near(live.pose.position.y_mm, y_mm), "{:?}", live.pose);
            let shown: Vec<_> = live.dots.iter().map(|dot| dot.amplitude_um).collect();
            assert_eq!(shown, expected, "heatmaps, dots and lens");
            assert!(shown.iter().any(|um| um[0] > 0.0));
            assert_eq!(live.others.len(), 1);
            let felt = bench.past.history.newest().unwrap().tick_sample;
            assert_eq!(felt.pose, live.pose, "timeline, spectra and stylus");
            let shown = live.dots[bench.selection.contactor.unwrap()].position;
            let why = Explanation::of_chosen(bench).unwrap();
            assert_eq!(why.trace.position, shown);
        }
    }

    #[test]
    fn a_finger_that_comes_down_beside_what_is_felt_holds_nothing() {
        let mut desk = Desk::new();
        desk.touch(1, TouchPhase::Started, [-300.0, 130.0]);
        desk.touch(2, TouchPhase::Started, place(2, 0));
        desk.stroke(&[2], 1..8);
        let [one, two] = desk.displays();
        assert!(one.0 && is_near(one.1, 80.0), "{one:?}");
        assert_eq!(one, two, "it is the first on the cloth");
    }

    #[test]
    fn the_pointer_rests_while_a_finger_holds_the_display() {
        let mut desk = Desk::new();
        desk.touch(1, TouchPhase::Started, place(1, 0));
        let at = PhysicalPosition::new(400.0, 300.0);
        let device_id = DeviceId::dummy();
        for n in 1..8 {
            desk.touch(1, TouchPhase::Moved, place(1, n));
            let now = desk.window.workbench.bench.clock.stamp();
            let moved = WindowEvent::CursorMoved {
                device_id,
                position: at,
            };
            desk.ear.listen(now, WindowId::dummy(), &moved);
            desk.ear.pass_on(now);
            desk.window.pass(1);
        }
        let x_mm = (desk.window.workbench.bench.live.centre).map(|centre| centre.x_mm);
        assert!(x_mm.is_some_and(|x_mm| is_near(x_mm, 74.0)), "{x_mm:?}");
    }
}
