//! What the bar remembers from frame to frame, and how what it draws follows what is shown.

use std::ops::Range;
use std::sync::Arc;

use crate::bench::Bench;
use crate::bench::recording::Recording;
use crate::tools::timeline::lanes::Pictures;
use crate::tools::timeline::layer::RecordedTiles;
use crate::tools::timeline::live::LiveTiles;
use crate::tools::timeline::marks::Naming;
use crate::tools::timeline::scope::extent;
use crate::tools::timeline::sight::Sight;
use crate::tools::timeline::transport::TransportView;

/// What a drag does that has begun.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Drag {
    /// The cursor follows the pointer.
    Scrub,
    /// What is in sight follows the pointer.
    Pan,
    /// What lies between this tick and the pointer is selected.
    Select(u64),
}

/// The bar at the bottom: what it remembers from frame to frame.
#[derive(Default)]
pub(crate) struct Timeline {
    pub(crate) recorded: RecordedTiles,
    pub(crate) live: LiveTiles,
    pub(crate) sight: Sight,
    pub(crate) pictures: Pictures,
    /// Whether a recording is shown as it was recorded rather than as the scene renders it now.
    pub(crate) is_as_recorded: bool,
    /// What the drag does that goes on.
    pub(crate) drag: Option<Drag>,
    /// The tick that was asked for last in it.
    pub(crate) asked: Option<u64>,
    /// The ticks or columns that are selected.
    pub(crate) selected: Option<Range<u64>>,
    /// The marker that is being named.
    pub(crate) naming: Option<Naming>,
}

impl Timeline {
    /// Lets what is drawn follow the exploration that is shown, the scene and the contactor.
    pub(crate) fn follow(&mut self, bench: &mut Bench) {
        let contactor = bench.selection.contactor.unwrap_or(usize::MAX);
        let view = TransportView::of(bench);
        let all = extent(&view);
        let take = view.shown_take().cloned();
        let address = |take: &Recording| Arc::as_ptr(take.path()).addr() as u64;
        if self.sight.turn_to(take.as_ref().map_or(0, address)) {
            self.drag = None;
            self.selected = None;
            self.naming = None;
        }
        if let Some(tick) = bench.exploration.unnamed.take() {
            let markers = take.iter().flat_map(|take| &take.about().markers);
            let marker = markers.into_iter().find(|marker| marker.tick == tick);
            self.naming = marker.map(Naming::of);
        }
        let span = self.sight.span(all);
        let Some(take) = take else {
            if self.live.follow(bench, contactor, span) {
                bench.ctx.request_repaint();
            }
            return;
        };
        let focus = span.tick_at(0.5, all);
        let how = (contactor, self.is_as_recorded);
        if let Some(why) = self.recorded.follow(bench, &take, how, focus) {
            bench.notices.give(why);
        }
    }
}
