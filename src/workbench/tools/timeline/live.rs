//! The last seconds of what was felt, as strokes: where each tick stands, the newest on the right.
//!
//! Stillness is left out: a pause between two strokes is one thin gap, however long it was.

use crate::bench::recording::strips::{Extent, Felt};
use crate::bench::signals::history::History;
use selvedge_engine::TickSample;

/// Ticks of felt exploration that are shown: 12 s.
pub(crate) const N_TICKS: u64 = 480;
/// How wide a gap is at most, in ticks.
const GAP: u64 = 5;

/// A tick sample and its place.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Placed {
    /// Ticks to the left of the newest, pauses left out.
    pub(crate) ago: u64,
    /// Whether it goes on from the one before it: no tick is missing between them.
    pub(crate) goes_on: bool,
    /// What was there.
    pub(crate) tick_sample: TickSample,
}

impl Placed {
    /// Speed and amplitudes; nothing was felt in silence.
    pub(crate) fn felt(&self) -> Felt {
        let TickSample {
            pose,
            is_silent,
            mean_um,
            ..
        } = self.tick_sample;
        let speed = pose.velocity.speed_mm_per_s();
        Felt {
            speed_mm_per_s: if speed.is_finite() { speed } else { 0.0 },
            mean_um: Some(if is_silent {
                [0.0; 2]
            } else {
                mean_um.map(f64::from)
            }),
        }
    }
}

/// The tick samples that are shown with their places, new to old.
pub(crate) fn placed(history: &History) -> Vec<Placed> {
    let mut ago = 0;
    let mut shown = Vec::new();
    let mut tick_samples = history.tick_samples().rev().peekable();
    while let Some(&tick_sample) = tick_samples.next() {
        if ago > N_TICKS {
            break;
        }
        let step = tick_samples
            .peek()
            .map(|before| tick_sample.tick.saturating_sub(before.tick));
        shown.push(Placed {
            ago,
            goes_on: step == Some(1),
            tick_sample,
        });
        ago += step.unwrap_or(0).clamp(1, GAP);
    }
    shown
}

/// The tick sample nearest to a place.
pub(crate) fn nearest(placed: &[Placed], ago: f64) -> Option<&Placed> {
    let distance = |one: &&Placed| (one.ago as f64 - ago).abs();
    placed
        .iter()
        .min_by(|one, other| distance(one).total_cmp(&distance(other)))
        .filter(|one| distance(one) <= GAP as f64)
}

/// From the least speed shown to the highest, mm/s.
pub(crate) fn speeds(placed: &[Placed]) -> Extent {
    let speeds = placed.iter().map(|one| one.felt().speed_mm_per_s);
    Extent {
        least: 0.0,
        most: speeds.fold(0.0, f64::max),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn history(ticks: impl IntoIterator<Item = u64>) -> History {
        let mut history = History::default();
        for tick in ticks {
            history.take(TickSample {
                tick,
                mean_um: [1.0, 2.0],
                ..TickSample::default()
            });
        }
        history
    }

    #[test]
    fn a_long_pause_is_one_thin_gap() {
        let shown = placed(&history((0..10).chain(50_000..50_010)));
        assert_eq!(shown.len(), 20);
        assert_eq!(shown[9].ago + GAP, shown[10].ago);
        let breaks: Vec<u64> = shown
            .iter()
            .filter(|one| !one.goes_on)
            .map(|one| one.tick_sample.tick)
            .collect();
        assert_eq!(breaks, [50_000, 0], "only strokes begin anew");
    }

    #[test]
    fn twelve_seconds_are_shown_and_no_more() {
        let shown = placed(&history(0..5_000));
        assert_eq!(shown.len(), 480);
        assert_eq!(shown[0].tick_sample.tick, 4_999);
        assert!(placed(&history([])).is_empty());
    }

    #[test]
    fn the_pointer_reads_what_is_near_it() {
        let shown = placed(&history(0..20));
        let read = nearest(&shown, 3.4).map(|one| one.tick_sample.tick);
        assert_eq!(read, Some(16));
        assert_eq!(nearest(&shown, 200.0), None);
    }

    #[test]
    fn silence_is_not_felt() {
        let mut history = History::default();
        history.take(TickSample {
            tick: 1,
            is_silent: true,
            mean_um: [1.0, 2.0],
            ..TickSample::default()
        });
        assert_eq!(placed(&history)[0].felt().mean_um, Some([0.0, 0.0]));
    }
}
