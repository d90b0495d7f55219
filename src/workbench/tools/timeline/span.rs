//! The part of an exploration that is in sight, in ticks: zoomed about a place, panned, held within
//! what there is.

use std::ops::Range;

use selvedge_foundation::numerics::to_index;

/// The shortest part that is shown, ticks.
const SHORTEST: f64 = 8.0;

/// From where to where, in ticks; tick n lies from n to n + 1.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Span {
    /// Where it begins.
    pub(crate) start: f64,
    /// Where it ends.
    pub(crate) end: f64,
}

impl Span {
    /// From a place to another.
    pub(crate) fn new(start: f64, end: f64) -> Self {
        Self { start, end }
    }

    /// That of whole ticks.
    pub(crate) fn of(ticks: &Range<u64>) -> Self {
        Self::new(ticks.start as f64, ticks.end as f64)
    }

    /// How long it is, ticks.
    pub(crate) fn length(self) -> f64 {
        self.end - self.start
    }

    /// The place at a share of it.
    pub(crate) fn at(self, share: f64) -> f64 {
        self.start + share * self.length()
    }

    /// Where the middle of a tick stands, as a share of it.
    pub(crate) fn share_of(self, tick: u64) -> f64 {
        (tick as f64 + 0.5 - self.start) / self.length()
    }

    /// The tick at a share of it; the nearest within `all`.
    pub(crate) fn tick_at(self, share: f64, all: Self) -> u64 {
        whole(
            self.at(share)
                .floor()
                .clamp(all.start, (all.end - 1.0).max(all.start)),
        )
    }

    /// Longer or shorter by this factor, with the place at this share where it was.
    pub(crate) fn zoomed(self, factor: f64, share: f64, all: Self) -> Self {
        let length = (self.length() / factor).clamp(SHORTEST.min(all.length()), all.length());
        let start = self.at(share) - share * length;
        Self::new(start, start + length).within(all)
    }

    /// Moved by so many ticks.
    pub(crate) fn panned(self, by: f64, all: Self) -> Self {
        Self::new(self.start + by, self.end + by).within(all)
    }

    /// Moved into `all`, and cut where that is shorter.
    pub(crate) fn within(self, all: Self) -> Self {
        let length = self.length().min(all.length());
        let start = self.start.min(all.end - length).max(all.start);
        Self::new(start, start + length)
    }

    /// Of `n` columns side by side, the ticks that the column `x` shows: those that begin in it, or
    /// the one in its middle.
    pub(crate) fn column(self, x: usize, n: usize) -> Range<u64> {
        let at = |x: f64| self.at(x / n as f64);
        let (from, to) = (at(x as f64).ceil(), at(x as f64 + 1.0).ceil());
        if to > from {
            return whole(from)..whole(to);
        }
        let middle = at(x as f64 + 0.5).floor();
        whole(middle)..whole(middle + 1.0)
    }

    /// Its ticks, whole.
    pub(crate) fn ticks(self) -> Range<u64> {
        whole(self.start.floor())..whole(self.end.ceil())
    }
}

/// A whole number of ticks; 0 before the first.
fn whole(place: f64) -> u64 {
    to_index(place) as u64
}

#[cfg(test)]
mod tests {
    use super::*;

    const ALL: Span = Span {
        start: 0.0,
        end: 576_000.0,
    };

    #[test]
    fn zooming_holds_the_place_under_the_pointer() {
        let mut span = ALL;
        for _ in 0..20 {
            let before = span.at(0.3);
            span = span.zoomed(1.5, 0.3, ALL);
            assert!((span.at(0.3) - before).abs() < 1e-6);
        }
        assert!((span.length() - ALL.length() / 1.5_f64.powi(20)).abs() < 1e-6);
        for _ in 0..60 {
            span = span.zoomed(1.5, 0.5, ALL);
        }
        assert_eq!(span.length(), SHORTEST);
        assert_eq!(span.zoomed(1e-9, 0.5, ALL), ALL, "never more than there is");
    }

    #[test]
    fn panning_ends_where_the_exploration_ends() {
        let span = Span::new(10.0, 110.0);
        assert_eq!(span.panned(-50.0, ALL), Span::new(0.0, 100.0));
        assert_eq!(span.panned(1e9, ALL), Span::new(575_900.0, 576_000.0));
        let short = Span::new(0.0, 40.0);
        assert_eq!(span.within(short), short);
    }

    #[test]
    fn columns_share_the_ticks_out_and_none_is_empty() {
        let span = Span::new(3.25, 5_003.75);
        let mut next = 4;
        for x in 0..777 {
            let ticks = span.column(x, 777);
            assert_eq!(ticks.start, next, "column {x}");
            next = ticks.end;
        }
        assert_eq!(next, 5_004);
        let close = Span::new(10.0, 20.0);
        for x in 0..900 {
            let ticks = close.column(x, 900);
            assert_eq!(ticks.end - ticks.start, 1, "column {x}");
            assert!((10..20).contains(&ticks.start));
        }
    }

    #[test]
    fn every_tick_is_found_where_it_stands() {
        for n_ticks in [1, 2, 3, 494, 576_000] {
            let all = Span::new(0.0, n_ticks as f64);
            for tick in [0, 1, n_ticks / 2, n_ticks - 1] {
                let tick = tick.min(n_ticks - 1);
                assert_eq!(all.tick_at(all.share_of(tick), all), tick);
            }
            assert_eq!(
                (all.tick_at(-1.0, all), all.tick_at(2.0, all)),
                (0, n_ticks - 1)
            );
        }
    }
}
