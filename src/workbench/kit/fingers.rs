//! Fingers on a touch screen: which display of the scene each holds, and rings at those that hold
//! none.

use eframe::egui::{Color32, Painter, Pos2, Stroke};

use selvedge_foundation::numerics::to_single;

/// A finger without a display is marked for so long, s.
const MARKED_S: f64 = 0.8;
/// Marks that are kept at most.
pub(crate) const MOST_MARKS: usize = 8;

/// Which finger holds which display: each takes the first that is free when it comes down.
#[derive(Debug, Default)]
pub(crate) struct HeldDisplays {
    by: Vec<Option<u64>>,
    /// Fingers that came down when others held all of them.
    strays: Vec<u64>,
}

impl HeldDisplays {
    /// A finger comes down: the display, of so many, that it holds from now on; `None` if others
    /// hold them all.
    pub(crate) fn down(&mut self, finger: u64, n_displays: usize) -> Option<usize> {
        if let Some(display) = self.display(finger) {
            return Some(display);
        }
        if self.by.len() < n_displays {
            self.by.resize(n_displays, None);
        }
        let display = (self.by.iter().take(n_displays)).position(Option::is_none);
        match display {
            Some(display) => self.by[display] = Some(finger),
            None if n_displays > 0 => self.strays.push(finger),
            None => {}
        }
        display
    }

    /// The display that a finger holds.
    pub(crate) fn display(&self, finger: u64) -> Option<usize> {
        self.by.iter().position(|by| *by == Some(finger))
    }

    /// Whether a finger came down in vain.
    pub(crate) fn is_stray(&self, finger: u64) -> bool {
        self.strays.contains(&finger)
    }

    /// A finger leaves: the display that it held.
    pub(crate) fn up(&mut self, finger: u64) -> Option<usize> {
        self.strays.retain(|stray| *stray != finger);
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
    /// Where, and when they were seen.
    marks: Vec<(Pos2, f64)>,
}

impl FingerRings {
    /// Takes in where such fingers are.
    pub(crate) fn take(&mut self, strays: &[Pos2], now_s: f64) {
        self.marks.extend(strays.iter().map(|at| (*at, now_s)));
        let n_old = self.marks.len().saturating_sub(MOST_MARKS);
        self.marks.drain(..n_old);
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
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_finger_takes_the_first_display_that_is_free_and_gives_it_back() {
        let mut held = HeldDisplays::default();
        assert_eq!(
            [7, 8, 9].map(|id| held.down(id, 2)),
            [Some(0), Some(1), None]
        );
        assert_eq!([8, 9].map(|id| held.is_stray(id)), [false, true]);
        assert_eq!(held.down(8, 2), Some(1), "it came down already");
        assert_eq!((held.up(7), held.up(7)), (Some(0), None));
        assert_eq!(held.display(9), None, "it came down in vain");
        assert_eq!((held.down(10, 2), held.display(8)), (Some(0), Some(1)));
        assert!(held.is_stray(9), "it holds none later either");
        assert_eq!((held.up(9), held.is_stray(9)), (None, false));
        assert_eq!(
            (held.up(8), held.up(10), held.is_any()),
            (Some(1), Some(0), false)
        );
        assert_eq!(held.down(11, 0), None, "beside what is felt");
        assert!(!held.is_stray(11));
    }
}
