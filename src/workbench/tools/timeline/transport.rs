//! What moves the display and how far it is, as the bar shows it.

use std::ops::Range;

use crate::bench::Bench;
use crate::bench::command::PlaySource;
use crate::bench::recording::Recording;
use crate::bench::signals::history::History;
use crate::bench::view::Source;

/// Time between two ticks, ms.
pub(crate) const TICK_MS: u64 = 25;

/// What the bar shows.
#[derive(Debug, Clone, Copy)]
pub(crate) struct TransportView<'a> {
    /// What moves the display.
    pub source: PlaySource,
    /// The tablet or program that was chosen.
    pub input: Option<&'a str>,
    /// Whether a recording or stroke moves on at the next tick.
    pub is_playing: bool,
    /// Whether a recording or stroke begins again at its end.
    pub does_loop: bool,
    /// Ticks recorded so far; `None` when nothing records.
    pub(crate) recorded_ticks: Option<u64>,
    /// The tick of the recording or stroke that is shown.
    pub tick: u64,
    /// How fast the display moves, mm/s.
    pub speed_mm_per_s: f64,
    /// The recording at hand.
    pub take: Option<&'a Recording>,
    /// What was felt last.
    pub live: &'a History,
    /// The ticks of the recording that are replayed again and again.
    pub(crate) loop_within: Option<&'a Range<u64>>,
    /// The column of the last minutes that every view looks back at.
    pub(crate) past_column: Option<u64>,
}

impl<'a> TransportView<'a> {
    /// What it shows now.
    pub(crate) fn of(bench: &'a Bench) -> Self {
        let live = &bench.live;
        Self {
            source: match live.play.source {
                Source::Pointer => PlaySource::Pointer,
                Source::Lines | Source::Device => PlaySource::Input,
                Source::Stroke => PlaySource::Stroke,
                Source::Recording => PlaySource::Recording,
            },
            input: bench.exploration.sources.chosen_name(),
            is_playing: live.play.is_playing,
            does_loop: bench.exploration.does_loop,
            recorded_ticks: live.play.is_recording.then_some(live.play.n_recorded),
            tick: live.play.tick,
            speed_mm_per_s: live.speed_mm_per_s,
            take: bench.exploration.at_hand.as_ref(),
            live: &bench.past.history,
            loop_within: bench.exploration.loop_within.as_ref(),
            past_column: bench.past.look_back.as_ref().map(|back| back.column),
        }
    }
}

impl TransportView<'_> {
    /// The take that the timeline shows: the one that moves the display. While something is
    /// recorded, the timeline shows what is felt.
    pub(crate) fn shown_take(&self) -> Option<&Recording> {
        let is_shown = self.source == PlaySource::Recording && self.recorded_ticks.is_none();
        self.take.filter(|_| is_shown)
    }

    /// Whether positions come as they happen.
    pub(crate) fn is_live(&self) -> bool {
        matches!(self.source, PlaySource::Pointer | PlaySource::Input)
    }

    /// Whether something runs that could be held.
    pub(crate) fn is_running(&self) -> bool {
        self.is_playing && !self.is_live()
    }

    /// The tick that the numbers show, and what it counts.
    pub(crate) fn counted(&self) -> (u64, &'static str) {
        if let Some(n_ticks) = self.recorded_ticks {
            return (n_ticks, "Ticks recorded, 25 ms each");
        }
        match self.source {
            PlaySource::Pointer | PlaySource::Input => {
                let newest = self.live.newest();
                let tick = newest.map_or(0, |entry| entry.tick_sample.tick);
                (
                    tick,
                    "The last tick in which something moved, since the program started",
                )
            }
            PlaySource::Stroke => (self.tick, "The tick of the stroke, 25 ms each"),
            PlaySource::Recording => (self.tick, "The tick of the recording, 25 ms each"),
        }
    }
}
