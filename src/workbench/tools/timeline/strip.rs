//! What the timeline shows as plain data, tick for tick.

use crate::bench::recording::Recording;
use crate::bench::recording::strips::Felt;
use crate::tools::timeline::live;
use crate::tools::timeline::live::N_TICKS;
use crate::tools::timeline::plot::round_above;
use crate::tools::timeline::transport::TransportView;
use selvedge_render::scene::TICKS_PER_S;

/// A tick of the timeline.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct StripTick {
    /// Its tick: of the engine, or of the recording.
    pub tick: u64,
    /// Where it stands, s: before the newest, or after the first of a recording.
    pub t_s: f64,
    /// Whether it goes on from the one before it.
    pub goes_on: bool,
    /// What was there.
    pub felt: Felt,
}

/// What the timeline shows.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct TimelineTicks {
    /// What people call the exploration.
    pub name: String,
    /// What its time is counted from.
    pub(crate) time_label: &'static str,
    /// From where to where it reaches, s.
    pub(crate) range_s: [f64; 2],
    /// The end of the speed axis, mm/s.
    pub(crate) top_mm_per_s: f64,
    /// Whether amplitudes are known.
    pub(crate) has_levels: bool,
    /// Which contactors a mean is of: "the contactors that …".
    pub which: &'static str,
    /// The ticks, old to new.
    pub ticks: Vec<StripTick>,
}

impl TransportView<'_> {
    /// What the timeline shows.
    pub(crate) fn timeline(&self) -> TimelineTicks {
        self.shown_take().map_or_else(|| self.felt_last(), of_take)
    }

    fn felt_last(&self) -> TimelineTicks {
        let placed = live::placed(self.live);
        let tick = |one: &live::Placed| StripTick {
            tick: one.tick_sample.tick,
            t_s: -(one.ago as f64) / TICKS_PER_S,
            goes_on: one.goes_on,
            felt: one.felt(),
        };
        TimelineTicks {
            name: "what was felt last".to_owned(),
            time_label: "felt time before the newest tick, s",
            range_s: [-(N_TICKS as f64) / TICKS_PER_S, 0.0],
            top_mm_per_s: round_above(live::speeds(&placed).most),
            has_levels: true,
            which: "lie on a textile",
            ticks: placed.iter().rev().map(tick).collect(),
        }
    }
}

fn of_take(take: &Recording) -> TimelineTicks {
    let strips = take.strips();
    let n_ticks = strips.n_ticks();
    let step = usize::try_from(strips.ticks_per_entry()).unwrap_or(1);
    let tick = |tick: u64| {
        Some(StripTick {
            tick,
            t_s: tick as f64 / TICKS_PER_S,
            goes_on: tick > 0,
            felt: strips.at(tick)?,
        })
    };
    TimelineTicks {
        name: take.name().to_owned(),
        time_label: "time, s",
        range_s: [0.0, n_ticks.saturating_sub(1) as f64 / TICKS_PER_S],
        top_mm_per_s: round_above(strips.fastest_mm_per_s()),
        has_levels: strips.has_levels(),
        which: "vibrate",
        ticks: (0..n_ticks).step_by(step).filter_map(tick).collect(),
    }
}
