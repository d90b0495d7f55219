//! What can go wrong with a report.

use selvedge_chart::FigureError;
use selvedge_drape::DrapeError;
use selvedge_engine::EngineError;
use selvedge_foundation::files::FileError;
use selvedge_render::RenderError;
use selvedge_render::scene::SceneError;
use selvedge_statistics::Undefined;
use selvedge_textile::TextileError;

/// Why a report, or a study of it, was not made.
#[derive(Debug, thiserror::Error)]
pub enum ReportError {
    /// It was asked to stop; studies that were done before are kept.
    #[error("the report was cancelled; what was finished is kept")]
    Cancelled,
    /// A study of that name is not known.
    #[error("no study is called {name:?}; choose from {known}")]
    Unknown {
        /// What was asked for.
        name: String,
        /// The names of all studies.
        known: String,
    },
    /// A file cannot be written.
    #[error(transparent)]
    File(#[from] FileError),
    /// A plot cannot be drawn.
    #[error(transparent)]
    Figure(#[from] FigureError),
    /// A scene cannot be loaded.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// A textile cannot be loaded.
    #[error(transparent)]
    Textile(#[from] TextileError),
    /// A scene cannot be rendered.
    #[error(transparent)]
    Render(#[from] RenderError),
    /// A cloth cannot be simulated.
    #[error(transparent)]
    Drape(#[from] DrapeError),
    /// The engine cannot do what a study asks.
    #[error(transparent)]
    Engine(#[from] EngineError),
    /// What a study simulates cannot be computed.
    #[error(transparent)]
    Statistics(#[from] Undefined),
    /// Friction cannot be read from a picture.
    #[cfg(feature = "friction")]
    #[error(transparent)]
    Friction(#[from] selvedge_friction::FrictionError),
    /// A study of a floor above cannot do its work.
    #[error("{0}")]
    Study(String),
}
