//! Which part of which exploration is in sight.

use crate::tools::timeline::live::N_SHOWN;
use crate::tools::timeline::span::Span;

/// What is in sight: of a recording all of it, of the last minutes the newest, until the user asks
/// for another part.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Sight {
    /// What tells the recording that is shown from others; 0 for the last minutes.
    pub(crate) of: u64,
    recorded: Option<Span>,
    /// How long a part of the last minutes, and how far it ends before the newest.
    live: [f64; 2],
}

impl Default for Sight {
    fn default() -> Self {
        Self {
            of: 0,
            recorded: None,
            live: [N_SHOWN, 0.0],
        }
    }
}

impl Sight {
    /// Turns to an exploration. Whether it is another than before.
    pub(crate) fn turn_to(&mut self, of: u64) -> bool {
        let is_other = std::mem::replace(&mut self.of, of) != of;
        if is_other {
            self.recorded = None;
        }
        is_other
    }

    /// The part that is in sight of all that there is.
    pub(crate) fn span(&self, all: Span) -> Span {
        if self.of != 0 {
            return self.recorded.map_or(all, |span| span.within(all));
        }
        let [length, back] = self.live;
        let end = all.end - back;
        Span::new(end - length, end).within(all)
    }

    /// Another part is to be in sight. What ends with the newest goes on to do so.
    pub(crate) fn set(&mut self, span: Span, all: Span) {
        if self.of != 0 {
            self.recorded = (span != all).then_some(span);
        } else {
            self.live = [span.length(), (all.end - span.end).max(0.0)];
        }
    }

    /// As at first.
    pub(crate) fn reset(&mut self) {
        *self = Self {
            of: self.of,
            ..Self::default()
        };
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_recording_is_seen_whole_and_another_one_again() {
        let (mut sight, all) = (Sight::default(), Span::new(0.0, 9_000.0));
        assert!(sight.turn_to(7));
        assert_eq!(sight.span(all), all);
        let part = Span::new(100.0, 300.0);
        sight.set(part, all);
        assert!(!sight.turn_to(7));
        assert_eq!(sight.span(all), part);
        assert!(sight.turn_to(8));
        assert_eq!(sight.span(all), all);
    }

    #[test]
    fn the_newest_stays_in_sight_until_it_is_left() {
        let mut sight = Sight::default();
        let all = |end| Span::new(0.0, end);
        assert_eq!(sight.span(all(5_000.0)), Span::new(4_520.0, 5_000.0));
        assert_eq!(sight.span(all(5_040.0)), Span::new(4_560.0, 5_040.0));
        sight.set(Span::new(4_000.0, 4_100.0), all(5_040.0));
        assert_eq!(sight.span(all(5_040.0)), Span::new(4_000.0, 4_100.0));
        sight.reset();
        assert_eq!(sight.span(all(5_040.0)), Span::new(4_560.0, 5_040.0));
    }
}
