//! A visit under way, and what is counted of it.

use crate::tools::stage::act::Hand;
use selvedge_experiment::visits::N_CLOTHS;

/// A finger that has not moved for so long does not stroke, s.
const STILL_S: f64 = 0.3;
/// How long a cloth is stroked by itself, s.
pub(crate) const TOUR_S: f64 = 6.0;
/// A touch that moves less is no stroke, mm.
const STROKE_MM: f64 = 10.0;

/// A visit under way.
#[derive(Debug, Clone)]
pub(super) struct OpenVisit {
    pub(super) began_s: f64,
    /// When something moved last, s.
    pub(super) moved_s: f64,
    pub(super) input: &'static str,
    pub(super) was_armed: bool,
    pub(super) cloth_s: [f64; N_CLOTHS],
    pub(super) n_strokes: u32,
    /// How far the touch at hand has moved, mm.
    pub(super) stroke_mm: f64,
    /// The cloth that strokes itself, and since when, s.
    pub(super) tour: Option<(usize, f64)>,
    /// When sound was chosen last, s.
    pub(super) sound_s: f64,
}

impl OpenVisit {
    /// A visit that begins now.
    pub(super) fn begun(now_s: f64, input: &'static str) -> Self {
        Self {
            began_s: now_s,
            moved_s: now_s,
            input,
            was_armed: false,
            cloth_s: [0.0; N_CLOTHS],
            n_strokes: 0,
            stroke_mm: 0.0,
            tour: None,
            sound_s: f64::NEG_INFINITY,
        }
    }

    /// Counts what was stroked in the time that passed. A touch that does not move is a sleeve.
    pub(super) fn count(&mut self, (now_s, passed_s): (f64, f64), hand: Hand) {
        if self
            .tour
            .is_some_and(|(_, since_s)| now_s - since_s >= TOUR_S)
        {
            self.tour = None;
        }
        let moves = hand.is_down && hand.moved_mm > 0.0;
        // Between two movements a frame may see none.
        let strokes = hand.is_down && now_s - self.moved_s < STILL_S;
        let under_hand = hand.cloth.filter(|_| moves || strokes);
        let stroked = under_hand.or_else(|| self.tour.map(|(cloth, _)| cloth));
        if let Some(s) = stroked.and_then(|cloth| self.cloth_s.get_mut(cloth)) {
            *s += passed_s;
        }
        if moves {
            self.moved_s = now_s;
            let before_mm = self.stroke_mm;
            self.stroke_mm += hand.moved_mm;
            let is_first = before_mm < STROKE_MM && self.stroke_mm >= STROKE_MM;
            self.n_strokes += u32::from(is_first);
        }
    }
}
