//! The window around the tools: its frame, header, tiles, menu, keys, dialogs and questions; where
//! commands are done and inboxes emptied; the window without a display.
//!
//! Uses everything below it: `tools`, `bench` and `kit`. Nothing below uses the shell.

pub(crate) mod arrangement;
pub(crate) mod ask;
pub(crate) mod completion;
pub(crate) mod dialogs;
pub(crate) mod dispatch;
pub(crate) mod display_check;
pub(crate) mod dropped;
pub(crate) mod ear;
pub(crate) mod escape;
pub(crate) mod export;
pub(crate) mod frame;
pub(crate) mod guide;
pub(crate) mod header;
pub(crate) mod headless;
pub(crate) mod help;
pub(crate) mod inbox;
pub(crate) mod inspect;
pub(crate) mod menu;
pub(crate) mod native;
pub(crate) mod offer;
pub(crate) mod on_stage;
pub(crate) mod opening_window;
pub(crate) mod palette;
pub(crate) mod pane_focus;
pub(crate) mod pane_host;
pub(crate) mod pending_motion;
pub(crate) mod perspective;
pub(crate) mod pointer;
#[cfg(target_os = "linux")]
pub(crate) mod pointer_x11;
pub(crate) mod question;
pub(crate) mod raster;
pub(crate) mod recovery;
pub(crate) mod screenshot;
pub(crate) mod start_motion;
pub(crate) mod state;
pub(crate) mod status_line;
pub(crate) mod study;
pub(crate) mod tab_row;
#[cfg(test)]
mod tests;
pub(crate) mod tour;
mod undo;
pub(crate) mod window;
