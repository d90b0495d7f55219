//! What can go wrong with an engine.

use super::{AudioError, InputError};
use selvedge_device::SinkError;
use selvedge_render::RenderError;
use selvedge_render::scene::SceneError;

/// Why an engine, or something that was asked of it, could not be.
#[derive(Debug, thiserror::Error)]
pub enum EngineError {
    /// More commands than it could obey so far.
    #[error("the engine is busy with earlier commands; try again in a moment")]
    Busy,
    /// A device for a display that is not there.
    #[error(
        "the scene has no second display with as many contactors as the first: add one and connect \
         again"
    )]
    NoSecondDisplay,
    /// The system gives no thread.
    #[error("cannot start a thread: {0}; close other programs and try again")]
    Thread(#[source] std::io::Error),
    /// The scene cannot be rendered.
    #[error(transparent)]
    Render(#[from] RenderError),
    /// A stroke or path makes no sense.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// A sound card.
    #[error(transparent)]
    Audio(#[from] AudioError),
    /// A source of positions.
    #[error(transparent)]
    Input(#[from] InputError),
    /// A file for other programs.
    #[error(transparent)]
    Sink(#[from] SinkError),
}
