//! Where the display was during the last 0.8 s.
//!
//! Ages are counted in ticks of the engine, so the trail is the same however often it is drawn.

use std::collections::VecDeque;

use selvedge_foundation::geometry::Point;

/// How long the trail is, s.
pub(crate) const TRAIL_S: f64 = 0.8;
/// Ticks per second.
const TICKS_PER_S: f64 = 40.0;
/// A step longer than this is a jump, not a stroke, mm.
const JUMP_MM: f64 = 120.0;

/// The places of the last ticks, old to new.
#[derive(Debug, Clone, Default)]
pub(crate) struct Trail {
    places: VecDeque<(u64, Point)>,
    now: u64,
}

impl Trail {
    /// Takes in a tick. Says whether the trail looks different now.
    pub(crate) fn take(&mut self, tick: u64, centre: Option<Point>) -> bool {
        if tick <= self.now && self.now != 0 {
            return false;
        }
        let was_visible = self.is_visible();
        self.now = tick;
        if let Some(centre) = centre {
            let last = self.places.back().map(|(_, place)| *place);
            if last.is_some_and(|last| (centre - last).length_mm() > JUMP_MM) {
                self.places.clear();
            }
            if last != Some(centre) {
                self.places.push_back((tick, centre));
            } else if self.places.len() == 1 {
                // At rest the trail begins here and now.
                self.places[0].0 = tick;
            }
        }
        while self.places.len() > 1 && self.age_s(self.places[0].0) > TRAIL_S {
            self.places.pop_front();
        }
        was_visible || self.is_visible()
    }

    /// Whether there is anything to draw.
    pub(crate) fn is_visible(&self) -> bool {
        self.places.len() > 1
    }

    /// `(age in s, place)`, old to new.
    pub(crate) fn aged(&self) -> impl Iterator<Item = (f64, Point)> {
        let places = self.places.iter();
        places.map(|&(tick, place)| (self.age_s(tick), place))
    }

    fn age_s(&self, tick: u64) -> f64 {
        self.now.saturating_sub(tick) as f64 / TICKS_PER_S
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_trail_fades_in_eight_tenths_of_a_second_and_then_stands() {
        let mut trail = Trail::default();
        for tick in 1..=10_u32 {
            assert!(trail.take(tick.into(), Some(Point::new(f64::from(tick), 0.0))) || tick == 1);
        }
        let rest = Some(Point::new(10.0, 0.0));
        let mut changed = 0;
        for tick in 11..200 {
            changed += u32::from(trail.take(tick, rest));
        }
        assert!((30..=34).contains(&changed), "{changed} ticks of fading");
        assert!(!trail.is_visible(), "{trail:?}");
    }

    #[test]
    fn a_jump_is_no_stroke() {
        let mut trail = Trail::default();
        trail.take(1, Some(Point::new(0.0, 0.0)));
        trail.take(2, Some(Point::new(200.0, 0.0)));
        assert_eq!(trail.aged().count(), 1);
    }
}
