//! Scenes: which textiles lie where in the workspace, which displays feel them, and how a display
//! moves over them.
//!
//! Scene files, path files and generated strokes become plain data; [`LoadedScene`] joins a scene
//! with the textiles that it places, each loaded once.
//!
//! # Invariants
//! - no clocks, no threads: time is a number that comes in
//! - every scene and path that was read holds only values that make sense; writing one and reading
//!   it gives the same again
//! - only the textiles that a scene places are loaded

mod arrangement;
mod check;
mod error;
mod file;
mod geometry;
mod loaded;
mod path;
mod placed;
mod pose;
mod reference;
mod slots;
mod stroke;

pub use arrangement::Arrangement;
pub use error::SceneError;
pub use file::{Display, Scene};
pub use geometry::{ArrayLayout, Geometry, MAX_CONTACTORS};
pub use loaded::LoadedScene;
pub use path::{ExplorationPath, PathCursor, PathRow, Ticks};
pub use placed::PlacedTextile;
pub(crate) use placed::{EDGE_MM, is_on};
pub use pose::{Pose, TICKS_PER_S};
pub use reference::RecordingReference;
pub use slots::{SlotLetter, TuningSlot};
pub use stroke::Stroke;

#[cfg(test)]
mod tests;
