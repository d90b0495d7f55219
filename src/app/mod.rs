//! The workbench: the window in which a scene is felt, tuned and watched.
//!
//! ```text
//! keys, buttons, sliders ─▶ Command ─▶ dispatch ─┬▶ document (undoable, saved)
//!                                               ├▶ layout, transient state
//!                                               └▶ engine
//! document + engine's snapshot ─▶ query ─▶ views ─▶ panes ─▶ shapes ─▶ screen, or our rasteriser
//! pointer ─▶ own event handler (stamped on arrival) ─▶ engine, without waiting for a frame
//! ```
//!
//! # Invariants
//! - the one home of the toolkit (`eframe`, `egui`) and of `winit`
//! - panes take plain data and change nothing; `dispatch` is the one place that does
//! - every colour, distance and letter size is in `theme`
//! - nothing is drawn anew that has not changed; nothing longer than a frame runs on this thread
//! - Esc, closing the window and a panic switch everything off without waiting for a frame

mod amplitude;
mod arrangement;
mod backlog;
mod command;
mod dispatch;
mod document;
mod error;
mod frame;
mod history;
mod native;
mod opening;
mod panes;
mod pointer;
#[cfg(target_os = "linux")]
mod pointer_x11;
mod query;
mod raster;
mod screenshot;
mod shortcuts;
mod theme;
mod view;
mod widgets;
mod window;
mod workspace;

pub use error::AppError;
pub use native::{EndSwitch, run};
pub use raster::{Picture, Rasteriser};
pub use screenshot::{Screenshot, Theme, screenshot};
pub use window::{Drive, Workbench};
