//! What there is to see of the line of time, and where.

use crate::bench::recording::tiles::Tiles;
use crate::tools::timeline::lanes::Layout;
use crate::tools::timeline::live;
use crate::tools::timeline::span::Span;
use crate::tools::timeline::transport::TransportView;

/// What there is to see, and where.
pub(crate) struct Scope<'a> {
    pub(crate) view: &'a TransportView<'a>,
    pub(crate) layout: Layout,
    /// All that there is, and what is in sight of it.
    pub(crate) all: Span,
    pub(crate) span: Span,
    /// The tick or column of the cursor.
    pub(crate) cursor: Option<u64>,
    pub(crate) felt: &'a Tiles,
    pub(crate) spectrum: &'a Tiles,
}

/// All that there is of what is shown.
pub(crate) fn extent(view: &TransportView<'_>) -> Span {
    view.shown_take().map_or_else(
        || live::extent_of(view.live),
        |take| Span::new(0.0, take.path().n_ticks() as f64),
    )
}
