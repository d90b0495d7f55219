//! The workbench: the window in which a scene is felt, tuned and watched.
//!
//! ```text
//! keys, buttons, sliders ─▶ Command ─▶ dispatch ─┬▶ document (undoable, saved)
//!                                               ├▶ settings (kept per user), transient state
//!                                               └▶ engine
//! engine, jobs, desktop ─▶ inbox ─▶ state
//! document + state ─▶ query ─▶ views ─▶ panes in tiles ─▶ shapes ─▶ screen or rasteriser
//! pointer ─▶ own event handler (stamped on arrival) ─▶ engine, without waiting for a frame
//! ```
//!
//! To read: `command` (what can be wanted), `dispatch` (what comes of it), `window` and `state`
//! (what there is), `frame` and `desk` (where it is drawn), then any pane.
//!
//! # Invariants
//! - the one home of the toolkit (`eframe`, `egui`) and of `winit`
//! - panes take plain data and change nothing; `dispatch` is the one place that does
//! - every colour, distance and letter size is in `theme`
//! - nothing is drawn anew that has not changed; nothing longer than a frame runs on this thread
//! - Esc, closing the window and a panic switch everything off without waiting for a frame
#![cfg_attr(
    test,
    expect(clippy::float_cmp, reason = "tests compare exact results on purpose")
)]

mod accuracy;
mod amplitude;
mod analysis;
mod arrangement;
mod arrays;
mod asked;
mod audition;
mod backlog;
mod clips;
mod collection;
mod command;
mod compare;
mod completion;
mod curves;
mod desk;
mod dialogs;
mod dispatch;
mod document;
mod editing;
mod error;
mod experiment;
mod export;
mod faulty;
mod felt;
mod folders;
mod follower;
mod frame;
mod free_places;
mod headless;
mod history;
mod importing;
mod inbox;
mod inspect;
mod job;
mod keep;
mod lab;
mod maps;
mod native;
mod opening;
mod panes;
mod perspective;
mod picturing;
mod plant;
mod pointer;
#[cfg(target_os = "linux")]
mod pointer_x11;
mod ports;
mod preparing;
mod probe;
mod query;
mod raster;
mod rendering;
mod replug;
mod screenshot;
mod sensation;
mod settings;
mod shelf;
mod shortcuts;
mod signals;
mod sources;
mod state;
mod study;
mod tab_row;
mod take;
mod task;
mod theme;
mod view;
mod why;
mod widgets;
mod window;
mod workspace;

pub use document::Document;
pub use error::AppError;
pub use felt::Felt;
pub use native::{EndSwitch, run};
pub use raster::{Picture, Rasteriser};
pub use rendering::Rendering;
pub use screenshot::{Screenshot, Theme, screenshot};
pub use settings::Kept;
pub use settings::Settings;
pub use settings::{build_cache, own_arrays};
pub use study::studies;
pub use take::Take;
pub use window::{Drive, Workbench};
