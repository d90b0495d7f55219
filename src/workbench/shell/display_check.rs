//! Whether a window can be opened here and what draws it: tried with one that nobody sees.

use std::cell::RefCell;
use std::rc::Rc;

use eframe::glow::HasContext as _;
use eframe::{NativeOptions, Renderer, UserEvent};
use winit::event_loop::EventLoop;

use crate::bench::error::AppError;
use crate::kit::own_window::own_window;

/// Opens a window that is not shown, asks which OpenGL draws it, and closes it. To be called on the
/// main thread, once in a process.
///
/// # Errors
/// There is no display, or it cannot draw.
pub fn check_display() -> Result<String, AppError> {
    let event_loop = EventLoop::<UserEvent>::with_user_event()
        .build()
        .map_err(|_no_display| AppError::NoDisplay)?;
    let options = NativeOptions {
        viewport: own_window("Selvedge").with_visible(false),
        renderer: Renderer::Glow,
        ..NativeOptions::default()
    };
    let found = Rc::new(RefCell::new(None));
    let seen = Rc::clone(&found);
    let mut app = eframe::create_native(
        "Selvedge",
        options,
        Box::new(move |cc| {
            *seen.borrow_mut() = cc.gl.as_ref().map(|gl| {
                let version = gl.version();
                let (major, minor) = (version.major, version.minor);
                format!("OpenGL {major}.{minor} {}", version.vendor_info)
            });
            // A window that was asked is of no more use: an error closes it.
            Err("asked".into())
        }),
        &event_loop,
    );
    let outcome = event_loop.run_app(&mut app);
    let words = found.borrow_mut().take();
    words.ok_or_else(|| {
        let why = outcome.err().map(|error| error.to_string());
        AppError::NoGraphics(why.unwrap_or_else(|| "it gives no OpenGL".to_owned()))
    })
}
