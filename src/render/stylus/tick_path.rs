//! How a stylus is led between two ticks.

/// A display that moves farther in a tick has leapt, mm.
const LEAP_MM: f64 = 50.0;

/// How a display is led over a textile from a tick to the next: through every place, and without a
/// jump of its velocity.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TickPath {
    /// Where it begins, the way of this tick, and that of the one before, mm.
    from: [f64; 2],
    moved: [f64; 2],
    moved_before: [f64; 2],
}

impl TickPath {
    /// From a place to the next, after the place before, if it was led from there, mm.
    pub fn new(before_mm: Option<[f64; 2]>, from_mm: [f64; 2], to_mm: [f64; 2]) -> Self {
        let way = |from: [f64; 2], to: [f64; 2]| [to[0] - from[0], to[1] - from[1]];
        let moved = way(from_mm, to_mm);
        Self {
            from: from_mm,
            moved,
            moved_before: before_mm.map_or(moved, |before_mm| way(before_mm, from_mm)),
        }
    }

    /// Whether it leads nowhere.
    pub fn stands(&self) -> bool {
        self.moved.iter().all(|mm| mm.abs() <= 0.0)
    }

    /// Whether a display may be led so; else it has leapt.
    pub fn is_led(&self) -> bool {
        self.moved[0].hypot(self.moved[1]) <= LEAP_MM
    }

    /// The place at a share of the tick, 0 to 1: `p₀ + d s + (d₀ − d) s (1 − s)²` with d the way of
    /// this tick and d₀ that of the one before, mm.
    pub fn at(&self, share: f64) -> [f64; 2] {
        let bend = share * (1.0 - share) * (1.0 - share);
        [0, 1].map(|axis| {
            let moved = self.moved[axis];
            self.from[axis] + moved * share + (self.moved_before[axis] - moved) * bend
        })
    }
}
