//! The finger of tests: it moves over what a trial lays out, a tick a frame.

use std::ops::Range;

use eframe::egui::Pos2;

use super::session;
use crate::shell::headless::Headless;
use selvedge_foundation::geometry::Point;

/// Whose frames are run.
pub(super) trait Frames {
    fn window(&mut self) -> &mut Headless;
    fn frames(&mut self, n: u32);
}

impl Frames for Headless {
    fn window(&mut self) -> &mut Headless {
        self
    }

    fn frames(&mut self, n: u32) {
        self.pass(n);
    }
}

/// Does what has to be done before an answer is taken: every textile is felt, every vibration
/// played.
pub(super) fn feel(on: &mut impl Frames) {
    feel_all(on);
    for n in 0..240 {
        let session = session(on.window());
        if session.missing().is_none() {
            return;
        }
        let is_stacked = session.layout.is_stacked();
        let first = session.layout.places.first();
        match first.map(|place| place.origin_mm).filter(|_| is_stacked) {
            // What comes in turn is moved over all the while.
            Some(corner) => stroke(on, corner, n..n + 1),
            None => on.frames(1),
        }
    }
    panic!("{:?}", session(on.window()).missing());
}

/// Moves the finger over all that lies there.
fn feel_all(on: &mut impl Frames) {
    let layout = session(on.window()).layout.clone();
    for place in layout.places.iter().filter(|_| !layout.is_stacked()) {
        stroke(on, place.origin_mm, 0..44);
    }
}

/// Moves the finger over what has its lower left corner here, a tick for each of these steps.
pub(super) fn stroke(on: &mut impl Frames, corner: Point, steps: Range<u64>) {
    for n in steps {
        let along = (n % 40) as f64;
        let [dx_mm, dy_mm] = [10.0 + 2.0 * along, 20.0 + along];
        let to = Point::new(corner.x_mm + dx_mm, corner.y_mm + dy_mm);
        let workbench = &on.window().workbench;
        let stamp = workbench.bench.clock.stamp();
        let mut tap = workbench.shell.tap.lock().unwrap();
        if let Some(at) = tap.screen(to) {
            tap.moved_to(stamp, at);
        }
        drop(tap);
        on.frames(1);
    }
}

/// Moves the finger to and fro for so many ticks.
pub(super) fn explore(window: &mut Headless, n_ticks: u16) {
    for n in 0..n_ticks {
        let at = Pos2::new(300.0 + 6.0 * f32::from(n % 40), 300.0);
        let stamp = window.workbench.bench.clock.stamp();
        window
            .workbench
            .shell
            .tap
            .lock()
            .unwrap()
            .moved_to(stamp, at);
        window.pass(1);
    }
}
