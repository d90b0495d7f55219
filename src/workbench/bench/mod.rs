//! What the tools share: the document with its undo, commands, the views of scene and engine, the
//! library, recordings, settings, and work in the background.
//!
//! Knows neither the tools nor the window around them.

pub(crate) mod amplitude;
pub(crate) mod applied_gains;
pub(crate) mod arrays;
pub(crate) mod clips;
pub(crate) mod command;
pub(crate) mod document;
pub(crate) mod editing;
pub(crate) mod export;
pub(crate) mod folders;
pub(crate) mod follower;
pub(crate) mod free_places;
pub(crate) mod history;
pub(crate) mod inspect;
pub(crate) mod job;
pub(crate) mod keep;
pub(crate) mod library_view;
pub(crate) mod mute_solo;
pub(crate) mod notices;
pub(crate) mod opening;
pub(crate) mod perceptual_level;
pub(crate) mod preparing;
pub(crate) mod probe;
pub(crate) mod query;
pub(crate) mod recording;
pub(crate) mod rendering;
pub(crate) mod settings;
pub(crate) mod signals;
pub(crate) mod sources;
pub(crate) mod task;
pub(crate) mod view;
