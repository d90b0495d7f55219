//! The window on a real display: the event loop, and the two events that must not wait for a
//! frame (a movement of the pointer, and Esc).

use std::cell::RefCell;
use std::hint::black_box;
use std::path::PathBuf;
use std::rc::Rc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Instant;

use eframe::egui::{Context, ViewportCommand, ViewportId};
use eframe::{EframeWinitApplication, NativeOptions, Renderer, UserEvent};
use winit::application::ApplicationHandler;
use winit::event::{
    DeviceEvent, DeviceId, ElementState, StartCause, Touch, TouchPhase, WindowEvent,
};
use winit::event_loop::{ActiveEventLoop, ControlFlow, EventLoop};
use winit::keyboard::{Key, NamedKey};
use winit::window::WindowId;

use crate::bench::error::AppError;
use crate::bench::stage::StageOptions;
use crate::kit::view_transform::Pointed;
use crate::shell::opening_window::{Opening, begin, viewport};
use crate::shell::pending_motion::PendingMotion;
use crate::shell::pointer::PointerTap;
#[cfg(target_os = "linux")]
use crate::shell::pointer_x11::Listener;
use selvedge_engine::StopSwitch;

/// What the event handler shares with the workbench; both live on the window's thread.
type Shared = Rc<RefCell<Option<Ears>>>;

/// What the handler does with what it hears.
struct Ears {
    tap: Arc<Mutex<PointerTap>>,
    stop: StopSwitch,
    /// The workbench's window.
    workbench: Option<WindowId>,
    /// Movements without a button held reach the tap by a thread of their own, if there is one.
    listener: Option<Listener>,
    /// The participant's window that was seen last, and whether that thread listens to it.
    participant: Option<(WindowId, bool)>,
    /// Whether the public is before it: only what is pressed is felt.
    is_stage: bool,
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

/// Ends the workbench from any thread: the device stops at once, the window closes.
#[derive(Debug, Clone)]
pub struct EndSwitch {
    stop: StopSwitch,
    ends: Arc<AtomicBool>,
    ctx: Context,
}

impl EndSwitch {
    /// Everything off; then the window closes, and unsaved work waits for the next start.
    pub fn press(&self) {
        self.stop.press();
        self.ends.store(true, Ordering::Relaxed);
        // The participant's window may be the one that is being drawn.
        (self.ctx).send_viewport_cmd_to(ViewportId::ROOT, ViewportCommand::Close);
        self.ctx.request_repaint_of(ViewportId::ROOT);
    }
}

/// Opens the workbench on the scene at `scene` (`None`: the one that the program ships), connected
/// to the emulator in this process and disarmed.
///
/// Returns when the window is closed. Once it is open, `on_open` is given the switch that ends it.
///
/// # Errors
/// There is no display, or it cannot draw; the scene cannot be opened.
pub fn run(
    scene: Option<PathBuf>,
    on_open: impl FnOnce(EndSwitch) + 'static,
) -> Result<(), AppError> {
    open_window(Opening::Workbench(scene), on_open)
}

/// As [`run`] for who has no terminal: what is wrong with the scene is told in the window.
pub fn run_from_desktop(
    scene: Option<PathBuf>,
    on_open: impl FnOnce(EndSwitch) + 'static,
) -> Result<(), AppError> {
    open_window(Opening::FromDesktop(scene), on_open)
}

/// Opens the stage over the whole screen, disarmed, connected to the device that the operator names
/// or to the emulator. Otherwise as [`run`].
///
/// # Errors
/// As [`run`]; a scene that a stage cannot show.
pub fn run_stage(
    options: StageOptions,
    on_open: impl FnOnce(EndSwitch) + 'static,
) -> Result<(), AppError> {
    open_window(Opening::Stage(options), on_open)
}

fn open_window(
    opening: Opening,
    on_open: impl FnOnce(EndSwitch) + 'static,
) -> Result<(), AppError> {
    keep_freed_memory();
    let event_loop = EventLoop::<UserEvent>::with_user_event()
        .build()
        .map_err(|_no_display| AppError::NoDisplay)?;
    event_loop.set_control_flow(ControlFlow::Wait);
    let is_stage = matches!(opening, Opening::Stage(_));
    let options = NativeOptions {
        viewport: viewport(is_stage),
        renderer: Renderer::Glow,
        ..NativeOptions::default()
    };
    let shared = Shared::default();
    let failure = Rc::new(RefCell::new(None));
    let (for_app, for_failure) = (Rc::clone(&shared), Rc::clone(&failure));
    let app = eframe::create_native(
        "Selvedge",
        options,
        Box::new(move |cc| match begin(cc, opening) {
            Ok(workbench) => {
                let stop = workbench.bench.engine.stop_switch().clone();
                *for_app.borrow_mut() = Some(Ears {
                    tap: Arc::clone(&workbench.shell.tap),
                    stop: stop.clone(),
                    workbench: cc.winit_window().map(|window| window.id()),
                    listener: (!is_stage)
                        .then(|| listener(cc, &workbench.shell.tap))
                        .flatten(),
                    participant: None,
                    is_stage,
                });
                on_open(EndSwitch {
                    stop,
                    ends: Arc::clone(&workbench.shell.ends),
                    ctx: cc.egui_ctx.clone(),
                });
                Ok(Box::new(workbench))
            }
            Err(error) => {
                let words = error.to_string();
                *for_failure.borrow_mut() = Some(error);
                Err(words.into())
            }
        }),
        &event_loop,
    );
    let pending_motion = PendingMotion::new(Instant::now());
    let outcome = event_loop.run_app(&mut Stamping {
        app,
        shared,
        pending_motion,
        waits_over: Pointed::default(),
        n_held: 0,
        pixel: [0.0; 2],
        finger: None,
    });
    if let Some(error) = failure.borrow_mut().take() {
        return Err(error);
    }
    outcome.map_err(|error| AppError::NoGraphics(error.to_string()))
}

/// Lets the C library keep what a frame frees for the next one.
///
/// glibc gives the upper end of the heap back to the system from 128 kB on, and a driver that draws
/// in software frees and wants more than that many times in a frame: half of the time of the thread
/// that draws went into pages that came and went. A large block that is freed raises that bound to
/// twice its size (`mallopt(3)`, dynamic thresholds); it is never touched, so it costs nothing.
/// Elsewhere this does nothing.
fn keep_freed_memory() {
    drop(black_box(Vec::<u8>::with_capacity(16 << 20)));
}

/// Lets a thread of its own listen to the pointer, where that can be had.
#[cfg(target_os = "linux")]
fn listener(cc: &eframe::CreationContext<'_>, tap: &Arc<Mutex<PointerTap>>) -> Option<Listener> {
    let tap = Arc::clone(tap);
    crate::shell::pointer_x11::listen(cc, move |stamp, is_workbench, pixel| {
        let window = if is_workbench {
            Pointed::Workbench
        } else {
            Pointed::Participant
        };
        let mut tap = tap.lock().unwrap_or_else(PoisonError::into_inner);
        tap.moved_to_pixel(stamp, window, pixel);
    })
}

/// Here the windows' own events are all there is.
#[cfg(not(target_os = "linux"))]
enum Listener {}

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

/// The toolkit's own handler, with an ear in front of it.
struct Stamping<'a> {
    app: EframeWinitApplication<'a>,
    shared: Shared,
    pending_motion: PendingMotion,
    /// The window that what waits there is over.
    waits_over: Pointed,
    /// Buttons of the pointer that are held.
    n_held: u32,
    /// Where it was last, pixels.
    pixel: [f64; 2],
    /// The finger that owns the display.
    finger: Option<u64>,
}

impl Stamping<'_> {
    /// Which window this is, and whether a thread listens to the pointer over it.
    fn window_of(&self, id: WindowId) -> (Pointed, bool) {
        let mut shared = self.shared.borrow_mut();
        let ears = shared.as_mut();
        ears.map_or_else(Default::default, |ears| ears.window_of(id))
    }

    fn listen(&mut self, id: WindowId, event: &WindowEvent) {
        let (window, is_heard) = self.window_of(id);
        let is_stage = (self.shared.borrow().as_ref()).is_some_and(|ears| ears.is_stage);
        match event {
            WindowEvent::CursorMoved { position, .. } => {
                self.pixel = [position.x, position.y];
                // A finger speaks for itself.
                let is_felt = self.n_held > 0 || !(is_heard || is_stage);
                if is_felt && self.finger.is_none() {
                    self.moved(window, self.pixel);
                }
                return;
            }
            WindowEvent::Touch(touch) => return self.touched(window, touch),
            _ => {}
        }
        // Movements come in a row: another event ends it.
        self.pass_on();
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
                    if is_stage {
                        self.moved(window, self.pixel);
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

    /// The first finger feels as the pointer does; any finger stops.
    fn touched(&mut self, window: Pointed, touch: &Touch) {
        let pixel = [touch.location.x, touch.location.y];
        match touch.phase {
            TouchPhase::Started => {
                self.press_stop(pixel);
                if self.finger.is_none() {
                    self.finger = Some(touch.id);
                    self.moved(window, pixel);
                }
            }
            TouchPhase::Moved if self.finger == Some(touch.id) => self.moved(window, pixel),
            TouchPhase::Moved => {}
            TouchPhase::Ended | TouchPhase::Cancelled => {
                if self.finger == Some(touch.id) {
                    self.finger = None;
                    self.pass_on();
                }
            }
        }
    }

    /// A press where STOP stands acts as Esc does, without waiting for a frame.
    fn press_stop(&self, pixel: [f64; 2]) {
        let shared = self.shared.borrow();
        let Some(Ears { tap, stop, .. }) = &*shared else {
            return;
        };
        let tap = tap.lock().unwrap_or_else(PoisonError::into_inner);
        if tap.is_stop(pixel) {
            stop.press_if_armed();
        }
    }

    fn moved(&mut self, window: Pointed, pixel: [f64; 2]) {
        if window != self.waits_over {
            self.pass_on();
            self.waits_over = window;
        }
        self.pending_motion.moved(pixel);
    }

    /// Hands what was heard of the pointer to the engine.
    fn pass_on(&mut self) {
        let window = self.waits_over;
        let shared = self.shared.borrow();
        let tap = shared.as_ref().map(|ears| &ears.tap);
        let mut tap = tap.map(|tap| tap.lock().unwrap_or_else(PoisonError::into_inner));
        self.pending_motion.pass_on(Instant::now(), |stamp, pixel| {
            if let Some(tap) = &mut tap {
                tap.moved_to_pixel(stamp, window, pixel);
            }
        });
    }
}

impl ApplicationHandler<UserEvent> for Stamping<'_> {
    fn window_event(&mut self, event_loop: &ActiveEventLoop, id: WindowId, event: WindowEvent) {
        self.listen(id, &event);
        self.app.window_event(event_loop, id, event);
    }

    fn resumed(&mut self, event_loop: &ActiveEventLoop) {
        self.app.resumed(event_loop);
    }

    fn new_events(&mut self, event_loop: &ActiveEventLoop, cause: StartCause) {
        self.pending_motion.wakes(Instant::now());
        self.app.new_events(event_loop, cause);
    }

    fn user_event(&mut self, event_loop: &ActiveEventLoop, event: UserEvent) {
        self.app.user_event(event_loop, event);
    }

    fn device_event(&mut self, event_loop: &ActiveEventLoop, id: DeviceId, event: DeviceEvent) {
        self.app.device_event(event_loop, id, event);
    }

    fn about_to_wait(&mut self, event_loop: &ActiveEventLoop) {
        // After a frame the queue is full again for all we know: only what was heard is passed on.
        if self.pending_motion.is_waiting() {
            self.pass_on();
        }
        self.app.about_to_wait(event_loop);
        self.pending_motion.falls_asleep(Instant::now());
    }

    fn suspended(&mut self, event_loop: &ActiveEventLoop) {
        self.app.suspended(event_loop);
    }

    fn exiting(&mut self, event_loop: &ActiveEventLoop) {
        self.app.exiting(event_loop);
    }

    fn memory_warning(&mut self, event_loop: &ActiveEventLoop) {
        self.app.memory_warning(event_loop);
    }
}
