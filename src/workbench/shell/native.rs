//! The window on a real display: the event loop, and the two events that must not wait for a
//! frame (a movement of the pointer, and Esc).

use std::cell::RefCell;
use std::hint::black_box;
use std::path::PathBuf;
use std::rc::Rc;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Instant;

use eframe::egui::{Context, ViewportCommand, ViewportId};
use eframe::{EframeWinitApplication, NativeOptions, Renderer, UserEvent};
use winit::application::ApplicationHandler;
use winit::event::{DeviceEvent, DeviceId, StartCause, WindowEvent};
use winit::event_loop::{ActiveEventLoop, ControlFlow, EventLoop};
use winit::window::WindowId;

use crate::bench::error::AppError;
use crate::bench::stage::StageOptions;
use crate::shell::ear::{Ear, Ears, Shared, listener};
use crate::shell::opening_window::{Opening, begin, viewport};
use selvedge_engine::StopSwitch;

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
    let ear = Ear::new(Rc::clone(&shared), Instant::now());
    let outcome = event_loop.run_app(&mut Stamping { app, ear });
    if let Some(error) = failure.borrow_mut().take() {
        return Err(error);
    }
    outcome.map_err(|error| AppError::NoGraphics(error.to_string()))?;
    // The toolkit ends without a word where it gets no graphics.
    if shared.borrow().is_none() {
        return Err(AppError::NoGraphics("it gives no OpenGL".to_owned()));
    }
    Ok(())
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

/// The toolkit's own handler, with an ear in front of it.
struct Stamping<'a> {
    app: EframeWinitApplication<'a>,
    ear: Ear,
}

impl ApplicationHandler<UserEvent> for Stamping<'_> {
    fn window_event(&mut self, event_loop: &ActiveEventLoop, id: WindowId, event: WindowEvent) {
        self.ear.listen(Instant::now(), id, &event);
        self.app.window_event(event_loop, id, event);
    }

    fn resumed(&mut self, event_loop: &ActiveEventLoop) {
        self.app.resumed(event_loop);
    }

    fn new_events(&mut self, event_loop: &ActiveEventLoop, cause: StartCause) {
        self.ear.pending_motion.wakes(Instant::now());
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
        if self.ear.pending_motion.is_waiting() {
            self.ear.pass_on(Instant::now());
        }
        self.app.about_to_wait(event_loop);
        self.ear.pending_motion.falls_asleep(Instant::now());
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
