//! Which STATUS pace: those whose tick advances. Repeated, old and wildly jumping ones are counted
//! and pace nothing.
//!
//! Three advancing ones set a base; after a pause of our own, in which anything may have passed,
//! the next three set a new one.

use std::time::{Duration, Instant};

/// A tick further than this after the last is no gap: one second.
pub(crate) const LONGEST_JUMP: u32 = 40;
/// Advancing STATUS that make a base.
const N_BASE: u8 = 3;
/// Who was away for longer has missed what passed.
const PAUSE: Duration = Duration::from_millis(150);

/// What a STATUS is worth by its tick.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Worth {
    /// It repeats, goes back or jumps: it tells nothing.
    Stray,
    /// It advances; no base is set yet.
    Advancing,
    /// It advances and paces.
    Pacing,
}

/// The ticks that a device announced.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Ticks {
    last: Option<u32>,
    /// Advancing ones since the base was lost, and strays since the last of them.
    n_advancing: u8,
    n_lost: u8,
    n_strays: u64,
    /// When we were last there.
    seen: Option<Instant>,
}

impl Ticks {
    /// We are here: after a pause the base is lost.
    pub(super) fn present(&mut self, now: Instant) {
        let away = self
            .seen
            .map_or(Duration::ZERO, |seen| now.saturating_duration_since(seen));
        if away > PAUSE {
            self.last = None;
            (self.n_advancing, self.n_lost) = (0, 0);
        }
        self.seen = self.seen.max(Some(now));
    }

    /// A STATUS with this tick arrived.
    pub(super) fn announced(&mut self, tick: u32) -> Worth {
        if let Some(last) = self.last {
            let step = tick.wrapping_sub(last);
            if step == 0 || step > LONGEST_JUMP {
                self.stray(tick, step != 0);
                return Worth::Stray;
            }
        }
        self.last = Some(tick);
        self.n_lost = 0;
        self.n_advancing = self.n_advancing.saturating_add(1).min(N_BASE);
        if self.is_set() {
            Worth::Pacing
        } else {
            Worth::Advancing
        }
    }

    /// Without a base the first may be the one astray: after three others it is begun anew.
    fn stray(&mut self, tick: u32, is_other: bool) {
        self.n_strays += 1;
        if is_other && !self.is_set() {
            self.n_lost += 1;
            if self.n_lost >= N_BASE {
                self.last = Some(tick);
                (self.n_advancing, self.n_lost) = (1, 0);
            }
        }
    }

    /// Whether a base is set.
    pub(super) fn is_set(&self) -> bool {
        self.n_advancing >= N_BASE
    }

    /// STATUS whose tick repeated, went back or jumped.
    pub(super) fn n_strays(&self) -> u64 {
        self.n_strays
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn based(first: u32) -> Ticks {
        let mut ticks = Ticks::default();
        assert_eq!(ticks.announced(first), Worth::Advancing);
        assert_eq!(ticks.announced(first.wrapping_add(1)), Worth::Advancing);
        assert_eq!(ticks.announced(first.wrapping_add(2)), Worth::Pacing);
        ticks
    }

    #[test]
    fn three_advancing_ticks_set_a_base_over_the_wrap_too() {
        let mut ticks = based(u32::MAX - 1);
        assert_eq!(ticks.announced(2), Worth::Pacing);
        assert_eq!(ticks.n_strays(), 0);
    }

    #[test]
    fn what_repeats_goes_back_or_jumps_paces_nothing_and_is_counted() {
        let mut ticks = based(100);
        for stray in [102, 101, 7, 143, u32::MAX] {
            assert_eq!(ticks.announced(stray), Worth::Stray, "{stray}");
        }
        assert_eq!(ticks.n_strays(), 5);
        assert_eq!(ticks.announced(142), Worth::Pacing, "40 later is a gap");
    }

    #[test]
    fn every_tick_paces_once_whatever_is_mixed_in() {
        let mut ticks = based(997);
        for tick in 1000..1200 {
            let old = [0, 1, 41, 900].map(|back| tick - 1 - back);
            let far = [40, 41, 3000, u32::MAX / 2].map(|jump| tick + jump);
            for stray in old.into_iter().chain(far) {
                assert_eq!(ticks.announced(stray), Worth::Stray, "{stray} in {tick}");
            }
            assert_eq!(ticks.announced(tick), Worth::Pacing, "{tick}");
            assert_eq!(ticks.announced(tick), Worth::Stray, "{tick} again");
        }
        assert_eq!(ticks.n_strays(), 200 * 9);
    }

    #[test]
    fn after_a_pause_of_our_own_three_set_a_new_base_wherever_they_are() {
        let (mut ticks, now) = (based(100), Instant::now());
        ticks.present(now);
        ticks.present(now + Duration::from_millis(100));
        assert!(ticks.is_set());
        ticks.present(now + Duration::from_secs(5));
        assert!(!ticks.is_set());
        assert_eq!(ticks.announced(295), Worth::Advancing);
        assert_eq!(ticks.announced(296), Worth::Advancing);
        assert_eq!(ticks.announced(297), Worth::Pacing);
    }

    #[test]
    fn old_ticks_mixed_in_from_the_start_do_not_keep_a_base_from_being_set() {
        let mut ticks = Ticks::default();
        let said = [900, 100, 101, 102, 103, 104].map(|tick| ticks.announced(tick));
        assert_eq!(said[5], Worth::Pacing, "{said:?}");
        let mut ticks = Ticks::default();
        let said = [100, 99, 101, 101, 100, 102].map(|tick| ticks.announced(tick));
        assert_eq!(said[5], Worth::Pacing, "{said:?}");
    }
}
