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

pub(crate) mod bench;
pub(crate) mod kit;
pub(crate) mod shell;
pub(crate) mod tools;

pub use crate::bench::Drive;
pub use crate::bench::error::AppError;
pub use crate::bench::perspective::Perspective;
pub use crate::bench::settings::build_cache;
pub use crate::bench::settings::{OwnFiles, own_arrays, own_certificates, own_files, stage_file};
pub use crate::bench::stage::{StageOptions, StagePicture};
pub use crate::shell::display_check::check_display;
pub use crate::shell::guide::{GuidePage, guide_pages};
pub use crate::shell::native::EndSwitch;
pub use crate::shell::native::{run, run_from_desktop, run_stage};
pub use crate::shell::raster::Picture;
pub use crate::shell::raster::Rasteriser;
pub use crate::shell::screenshot::Screenshot;
pub use crate::shell::screenshot::Theme;
pub use crate::shell::screenshot::screenshot;
pub use crate::shell::study::studies;
pub use crate::shell::window::Workbench;
pub use crate::tools::timeline::figure::{FigureFiles, FigureOf, exploration_figure};
