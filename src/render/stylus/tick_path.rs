//! How a stylus is led between two ticks.

/// A display that moves farther in a tick has leapt, mm.
const LEAP_MM: f64 = 50.0;

/// How a display is led over a textile from a tick to the next: through every place, and without a
/// jump of its velocity.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TickPath {
    from_mm: [f64; 2],
    moved_mm: [f64; 2],
    moved_before_mm: [f64; 2],
}

impl TickPath {
    /// From a place to the next, after the place before, if it was led from there, mm.
    pub fn new(before_mm: Option<[f64; 2]>, from_mm: [f64; 2], to_mm: [f64; 2]) -> Self {
        let way = |from: [f64; 2], to: [f64; 2]| [to[0] - from[0], to[1] - from[1]];
        let moved_mm = way(from_mm, to_mm);
        Self {
            from_mm,
            moved_mm,
            moved_before_mm: before_mm.map_or(moved_mm, |before_mm| way(before_mm, from_mm)),
        }
    }

    /// Whether a display may be led so; else it has leapt.
    pub fn is_led(&self) -> bool {
        self.moved_mm[0].hypot(self.moved_mm[1]) <= LEAP_MM
    }

    /// The place at a share of the tick, 0 to 1: `p₀ + d s + (d₀ − d) s (1 − s)²` with d the way of
    /// this tick and d₀ that of the one before, mm.
    pub fn at(&self, share: f64) -> [f64; 2] {
        let bend = share * (1.0 - share) * (1.0 - share);
        [0, 1].map(|axis| {
            let moved = self.moved_mm[axis];
            self.from_mm[axis] + moved * share + (self.moved_before_mm[axis] - moved) * bend
        })
    }
}
