//! What everything is drawn with: widgets, colours, letters and distances.
//!
//! Knows nothing of scenes, engines or tools.

pub(crate) mod amplitude;
pub(crate) mod drop;
pub(crate) mod fingers;
pub(crate) mod foot;
pub(crate) mod own_window;
pub(crate) mod pane;
pub(crate) mod plot;
pub(crate) mod spectrum_scale;
pub(crate) mod swatch;
pub(crate) mod texture;
pub(crate) mod theme;
pub(crate) mod tile;
pub(crate) mod view_transform;
pub(crate) mod widgets;
