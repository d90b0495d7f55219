//! The panes: each draws plain data and says what the user wants.
//!
//! A pane takes views (`view.rs`), pushes [`Command`]s, and changes nothing. What it computes
//! before it paints is a pure query with tests of its own.

mod ask;
mod bridge;
mod curve;
mod header;
mod heatmap;
mod notices;
mod strip;
mod tuning;

pub(crate) use ask::{Ask, show as show_ask};
pub(crate) use bridge::show as show_bridge;
pub(crate) use header::show as show_header;
pub(crate) use heatmap::show as show_heatmaps;
pub(crate) use notices::{Notices, show as show_notices};
pub(crate) use strip::{Levels, show as show_strip};
pub(crate) use tuning::show as show_tuning;

use super::command::Command;

/// Where panes put what the user wants.
pub(crate) type Wishes = Vec<Command>;
