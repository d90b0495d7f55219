//! The pointer on X11, heard on a connection and a thread of its own.
//!
//! The thread that draws hears of movements only between two frames, and where no graphics card
//! helps a frame takes a tenth of a second. A second connection hears of them as they happen.
//! While a button is held the server tells the window alone, so that its own events remain needed
//! then; on Wayland a program has no second ear.

use std::sync::Arc;
use std::thread;
use std::time::Instant;

use winit::raw_window_handle::{HasWindowHandle, RawWindowHandle};
use x11rb::connection::Connection as _;
use x11rb::protocol::Event;
use x11rb::protocol::xinput::{ConnectionExt as _, EventMask, XIEventMask};
use x11rb::rust_connection::RustConnection;

/// Every pointer that moves the cursor, as the server numbers it.
const ALL_MASTER_DEVICES: u16 = 1;
/// Places come in fixed point: so many units a pixel.
const UNITS_PER_PIXEL: f64 = 65_536.0;

/// Somebody who listens.
pub(crate) struct Listener {
    connection: Arc<RustConnection>,
}

/// Gives `take` every movement over the window, and over those that are listened to later: when it
/// was heard, whether over the first window, and the pixel. `None`: nobody can listen here. The
/// thread ends with the window's server or with the process.
pub(crate) fn listen(
    window: &impl HasWindowHandle,
    mut take: impl FnMut(Instant, bool, [f64; 2]) + Send + 'static,
) -> Option<Listener> {
    let first = window_id(window)?;
    let connection = Arc::new(connect()?);
    select(&connection, first)?;
    let listener = Listener {
        connection: Arc::clone(&connection),
    };
    let thread = thread::Builder::new().name("pointer".to_owned());
    let is_first = move |window| window == first;
    let heard = move || {
        pass_on(&connection, |stamp, window, pixel| {
            take(stamp, is_first(window), pixel);
        });
    };
    thread.spawn(heard).ok()?;
    Some(listener)
}

impl Listener {
    /// Listens to this window too, until it is gone. Whether it is heard.
    pub(crate) fn also(&self, window: u64) -> bool {
        let selected = u32::try_from(window)
            .ok()
            .and_then(|window| select(&self.connection, window));
        selected.is_some()
    }
}

/// The window's number on an X server; `None` elsewhere.
fn window_id(window: &impl HasWindowHandle) -> Option<u32> {
    match window.window_handle().ok()?.as_raw() {
        RawWindowHandle::Xlib(handle) => u32::try_from(handle.window).ok(),
        RawWindowHandle::Xcb(handle) => Some(handle.window.get()),
        _ => None,
    }
}

/// A connection that can hear of movements. Whatever fails, there is none.
fn connect() -> Option<RustConnection> {
    let (connection, _screen) = x11rb::connect(None).ok()?;
    connection
        .xinput_xi_query_version(2, 2)
        .ok()?
        .reply()
        .ok()?;
    Some(connection)
}

/// Asks to hear of movements over a window.
fn select(connection: &RustConnection, window: u32) -> Option<()> {
    let movements = EventMask {
        deviceid: ALL_MASTER_DEVICES,
        mask: vec![XIEventMask::MOTION],
    };
    let selected = connection
        .xinput_xi_select_events(window, &[movements])
        .ok()?;
    selected.check().ok()
}

fn pass_on(connection: &RustConnection, mut take: impl FnMut(Instant, u32, [f64; 2])) {
    while let Ok(event) = connection.wait_for_event() {
        if let Event::XinputMotion(motion) = event {
            let pixel = [motion.event_x, motion.event_y].map(|at| f64::from(at) / UNITS_PER_PIXEL);
            take(Instant::now(), motion.event, pixel);
        }
    }
}
