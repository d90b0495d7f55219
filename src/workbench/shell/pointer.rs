//! The way of a pointer movement to the engine, outside the toolkit.
//!
//! The toolkit's events carry no time and wait for the next frame. So the window's own event
//! handler stamps every movement (`pending_motion.rs`), turns it into mm with the view of the last
//! frame and hands it to the engine's ring, whether a frame is drawn or not.

use std::time::Instant;

use eframe::egui::{Pos2, Rect, pos2};

use crate::kit::view_transform::{Pointed, PointerGround, is_near};
use selvedge_engine::{PointerSample, PointerSender};
use selvedge_foundation::numerics::to_single;

/// Takes movements and passes on those over the workspace.
#[derive(Debug, Default)]
pub(crate) struct PointerTap {
    sender: Option<PointerSender>,
    ground: Option<PointerGround>,
    /// Where a press switches everything off, pixels.
    stop: Option<Rect>,
}

impl PointerTap {
    /// A tap that feeds this ring.
    pub(crate) fn new(sender: Option<PointerSender>) -> Self {
        Self {
            sender,
            ground: None,
            stop: None,
        }
    }

    /// Says where the workspace is now; `None` while something covers it.
    pub(crate) fn set_ground(&mut self, ground: Option<PointerGround>) {
        self.ground = ground;
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

    /// Takes in a movement to a pixel of a window, stamped on arrival. Only the window that shows
    /// what is felt counts.
    pub(crate) fn moved_to_pixel(&mut self, stamp: Instant, window: Pointed, [x, y]: [f64; 2]) {
        let Some(ground) = self.ground.filter(|ground| ground.window == window) else {
            return;
        };
        let point = pos2(to_single(x), to_single(y)) / ground.pixels_per_point;
        self.moved_to(stamp, point);
    }

    /// Where a place of the workspace is on the screen, points.
    #[cfg(test)]
    pub(crate) fn screen(&self, place: selvedge_foundation::geometry::Point) -> Option<Pos2> {
        self.ground.map(|ground| ground.view.screen(place))
    }

    /// Takes in a movement to a place on the screen, points.
    pub(crate) fn moved_to(&mut self, stamp: Instant, at: Pos2) {
        let (Some(ground), Some(sender)) = (self.ground, self.sender.as_mut()) else {
            return;
        };
        let position = ground.view.workspace(at);
        if ground.rect.contains(at) && is_near(position, ground.size_mm) {
            // A full ring drops the sample and counts it.
            sender.push(PointerSample { stamp, position });
        }
    }
}
