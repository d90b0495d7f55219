//! Fingers on a touch screen: which display of the scene each holds, and rings at those that hold
//! none.

use eframe::egui::{Color32, Event, Painter, Pos2, Rect, Stroke, TouchId, TouchPhase, Ui};

use selvedge_foundation::numerics::to_single;

/// A finger without a display is marked for so long, s.
const MARKED_S: f64 = 0.8;
/// Marks that are kept at most.
const MOST_MARKS: usize = 8;

/// Which finger holds which display: each takes the first that is free when it comes down.
#[derive(Debug)]
pub(crate) struct HeldDisplays<Id> {
    by: Vec<Option<Id>>,
}

impl<Id> Default for HeldDisplays<Id> {
    fn default() -> Self {
        Self { by: Vec::new() }
    }
}

impl<Id: Copy + PartialEq> HeldDisplays<Id> {
    /// A finger comes down: the display, of so many, that it holds from now on; `None` if others
    /// hold them all.
    pub(crate) fn down(&mut self, finger: Id, n_displays: usize) -> Option<usize> {
        if let Some(display) = self.display(finger) {
            return Some(display);
        }
        if self.by.len() < n_displays {
            self.by.resize(n_displays, None);
        }
        let display = (self.by.iter().take(n_displays)).position(Option::is_none)?;
        self.by[display] = Some(finger);
        Some(display)
    }

    /// The display that a finger holds.
    pub(crate) fn display(&self, finger: Id) -> Option<usize> {
        self.by.iter().position(|by| *by == Some(finger))
    }

    /// A finger leaves: the display that it held.
    pub(crate) fn up(&mut self, finger: Id) -> Option<usize> {
        let display = self.display(finger)?;
        self.by[display] = None;
        Some(display)
    }

    /// Whether a finger holds one.
    pub(crate) fn is_any(&self) -> bool {
        self.by.iter().any(Option::is_some)
    }
}

/// Rings that fade where fingers are that hold no display.
#[derive(Debug, Default)]
pub(crate) struct FingerRings {
    held: HeldDisplays<TouchId>,
    /// Where, and when they were seen.
    marks: Vec<(Pos2, f64)>,
}

impl FingerRings {
    /// Takes in the fingers of a frame that come down where a scene of so many displays is felt.
    pub(crate) fn take(&mut self, ui: &Ui, (ground, n_displays): (Rect, usize), now_s: f64) {
        ui.input(|input| {
            for event in &input.events {
                let Event::Touch { id, phase, pos, .. } = event else {
                    continue;
                };
                if *phase != TouchPhase::Start || ground.contains(*pos) {
                    self.touch((*id, *phase), *pos, (n_displays, now_s));
                }
            }
        });
        self.marks.retain(|(_, at_s)| now_s - at_s < MARKED_S);
    }

    /// Whether there is a ring to be drawn.
    pub(crate) fn is_any(&self) -> bool {
        !self.marks.is_empty()
    }

    /// Draws them.
    pub(crate) fn paint(&self, painter: &Painter, now_s: f64, (ink, radius): (Color32, f32)) {
        for (at, at_s) in &self.marks {
            let fresh = to_single(1.0 - (now_s - at_s) / MARKED_S);
            let stroke = Stroke::new(0.1 * radius, ink.gamma_multiply(fresh));
            painter.circle_stroke(*at, radius, stroke);
        }
    }

    fn touch(
        &mut self,
        (finger, phase): (TouchId, TouchPhase),
        at: Pos2,
        (n_displays, now_s): (usize, f64),
    ) {
        let display = match phase {
            TouchPhase::Start => self.held.down(finger, n_displays),
            TouchPhase::Move => self.held.display(finger),
            TouchPhase::End | TouchPhase::Cancel => self.held.up(finger),
        };
        if display.is_none() {
            self.marks.push((at, now_s));
            let n_old = self.marks.len().saturating_sub(MOST_MARKS);
            self.marks.drain(..n_old);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use eframe::egui::pos2;

    #[test]
    fn a_finger_takes_the_first_display_that_is_free_and_gives_it_back() {
        let mut held = HeldDisplays::default();
        assert_eq!(
            [7, 8, 9].map(|id| held.down(id, 2)),
            [Some(0), Some(1), None]
        );
        assert_eq!(held.down(8, 2), Some(1), "it came down already");
        assert_eq!((held.up(7), held.up(7)), (Some(0), None));
        assert_eq!(held.display(9), None, "it came down in vain");
        assert_eq!((held.down(10, 2), held.display(8)), (Some(0), Some(1)));
        assert_eq!(
            (held.up(8), held.up(10), held.is_any()),
            (Some(1), Some(0), false)
        );
        assert_eq!(held.down(11, 0), None, "a scene without displays");
    }

    #[test]
    fn fingers_without_a_display_leave_rings_and_others_none() {
        let mut rings = FingerRings::default();
        let mut touch = |finger: u64, phase| {
            let at = pos2(10.0, 10.0);
            rings.touch((TouchId::from(finger), phase), at, (2, 0.0));
            rings.marks.len()
        };
        assert_eq!([1, 2].map(|id| touch(id, TouchPhase::Start)), [0, 0]);
        assert_eq!(touch(3, TouchPhase::Start), 1);
        assert_eq!(touch(1, TouchPhase::Move), 1);
        assert_eq!(touch(1, TouchPhase::End), 1);
        assert_eq!(touch(3, TouchPhase::Move), 2, "it holds none later either");
        for _ in 0..20 {
            touch(3, TouchPhase::Move);
        }
        assert_eq!(rings.marks.len(), MOST_MARKS);
    }
}
