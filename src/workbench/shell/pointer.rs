//! The way of a pointer movement to the engine, outside the toolkit.
//!
//! The toolkit's events carry no time and wait for the next frame. So the window's own event
//! handler stamps every movement (`pending_motion.rs`), turns it into mm with the view of the last
//! frame and hands it to the engine's ring, whether a frame is drawn or not.

use std::time::Instant;

use eframe::egui::{Pos2, Rect, pos2};

use crate::kit::fingers::MOST_MARKS;
use crate::kit::view_transform::{Pointed, PointerGround, is_near};
use selvedge_engine::{PointerSample, PointerSender};
use selvedge_foundation::numerics::to_single;

/// Takes movements and passes on those over the workspace.
#[derive(Debug, Default)]
pub(crate) struct PointerTap {
    sender: Option<PointerSender>,
    ground: Option<PointerGround>,
    /// Displays of the scene.
    n_displays: usize,
    /// Where a press switches everything off, pixels.
    stop: Option<Rect>,
    /// Where fingers were since the last frame that hold no display, points.
    strays: Vec<Pos2>,
}

impl PointerTap {
    /// A tap that feeds this ring.
    pub(crate) fn new(sender: Option<PointerSender>) -> Self {
        Self {
            sender,
            ground: None,
            n_displays: 1,
            stop: None,
            strays: Vec::new(),
        }
    }

    /// Says where the workspace is now, in a scene of so many displays; `None` while something
    /// covers it.
    pub(crate) fn set_ground(&mut self, ground: Option<PointerGround>, n_displays: usize) {
        (self.ground, self.n_displays) = (ground, n_displays);
    }

    /// Displays that a finger may hold that comes down at this pixel of a window: none where
    /// nothing is felt.
    pub(crate) fn n_displays_at(&self, window: Pointed, [x, y]: [f64; 2]) -> usize {
        let ground = self.ground.filter(|ground| ground.window == window);
        let at = pos2(to_single(x), to_single(y));
        let is_on_it = |ground: PointerGround| ground.rect.contains(at / ground.pixels_per_point);
        if ground.is_some_and(is_on_it) {
            self.n_displays
        } else {
            0
        }
    }

    /// A finger that holds no display is at this pixel.
    pub(crate) fn stray(&mut self, [x, y]: [f64; 2]) {
        if let Some(ground) = self.ground.filter(|_| self.strays.len() < MOST_MARKS) {
            let at = pos2(to_single(x), to_single(y));
            self.strays.push(at / ground.pixels_per_point);
        }
    }

    /// Where such fingers were since this was asked last, points.
    pub(crate) fn take_strays(&mut self) -> Vec<Pos2> {
        std::mem::take(&mut self.strays)
    }

    /// The finger that held a display left the surface.
    pub(crate) fn lift(&mut self, display: usize) {
        if let Some(sender) = &mut self.sender {
            // A full ring drops it and counts it; the display rests all the same.
            sender.lift(display);
        }
    }

    /// Says where a press switches everything off, pixels; `None`: nowhere.
    pub(crate) fn set_stop(&mut self, stop: Option<Rect>) {
        self.stop = stop;
    }

    /// Whether a press of this pixel switches everything off.
    pub(crate) fn is_stop(&self, [x, y]: [f64; 2]) -> bool {
        let at = pos2(to_single(x), to_single(y));
        self.stop.is_some_and(|stop| stop.contains(at))
    }

    /// Takes in a movement of what holds a display to a pixel of a window, stamped on arrival. Only
    /// the window that shows what is felt counts.
    pub(crate) fn moved_to_pixel(
        &mut self,
        stamp: Instant,
        window: Pointed,
        (display, [x, y]): (usize, [f64; 2]),
    ) {
        let Some(ground) = self.ground.filter(|ground| ground.window == window) else {
            return;
        };
        let point = pos2(to_single(x), to_single(y)) / ground.pixels_per_point;
        self.display_moved_to(stamp, display, point);
    }

    /// Where a place of the workspace is on the screen, points.
    #[cfg(test)]
    pub(crate) fn screen(&self, place: selvedge_foundation::geometry::Point) -> Option<Pos2> {
        self.ground.map(|ground| ground.view.screen(place))
    }

    /// Takes in a movement of the pointer to a place on the screen, points.
    pub(crate) fn moved_to(&mut self, stamp: Instant, at: Pos2) {
        self.display_moved_to(stamp, 0, at);
    }

    fn display_moved_to(&mut self, stamp: Instant, display: usize, at: Pos2) {
        let (Some(ground), Some(sender)) = (self.ground, self.sender.as_mut()) else {
            return;
        };
        let position = ground.view.workspace(at);
        if ground.rect.contains(at) && is_near(position, ground.size_mm) {
            // A full ring drops the sample and counts it.
            sender.push_to(display, PointerSample { stamp, position });
        }
    }
}
