//! Why a command failed, and which exit code says so.
//!
//! 2: the command or what it was given is wrong, and the line says how to mend it. 1: the work
//! itself failed. A reader that closed our output is no failure.

use std::io;

use selvedge_device::{BridgeError, SinkError};
use selvedge_drape::DrapeError;
use selvedge_engine::{AudioError, EngineError};
use selvedge_experiment::ExperimentError;
use selvedge_foundation::files::FileError;
use selvedge_foundation::progress::Cancelled;
use selvedge_foundation::signals::SignalError;
use selvedge_render::RenderError;
use selvedge_render::scene::SceneError;
use selvedge_studies::ReportError;
use selvedge_textile::TextileError;
use selvedge_textile::picture::PictureError;
use selvedge_workbench::AppError;

/// Why a command failed: one line.
#[derive(Debug, thiserror::Error)]
pub(crate) enum CliError {
    /// The command line or what it was given is wrong.
    #[error("{0}")]
    Input(String),
    /// The work failed.
    #[error("{0}")]
    Failed(String),
    /// Whoever reads our output has had enough.
    #[error("the output was closed")]
    OutputClosed,
    /// A file.
    #[error(transparent)]
    File(#[from] FileError),
    /// A textile or a library.
    #[error(transparent)]
    Textile(#[from] TextileError),
    /// A picture of a cloth.
    #[error(transparent)]
    Picture(#[from] PictureError),
    /// A scene or a path.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// Something that cannot be rendered.
    #[error(transparent)]
    Render(#[from] RenderError),
    /// A hanging cloth.
    #[error(transparent)]
    Drape(#[from] DrapeError),
    /// A device.
    #[error(transparent)]
    Bridge(#[from] BridgeError),
    /// The real-time work.
    #[error(transparent)]
    Engine(#[from] EngineError),
    /// A file for other programs.
    #[error(transparent)]
    Sink(#[from] SinkError),
    /// Friction from a picture.
    #[cfg(feature = "friction")]
    #[error(transparent)]
    Friction(#[from] selvedge_friction::FrictionError),
    /// A report.
    #[error(transparent)]
    Report(#[from] ReportError),
    /// A design, a session or a log.
    #[error(transparent)]
    Experiment(#[from] ExperimentError),
    /// Signals cannot be listened to.
    #[error(transparent)]
    Signals(#[from] SignalError),
    /// The window.
    #[error(transparent)]
    App(#[from] AppError),
}

impl CliError {
    /// 0, 1 or 2: see the head of this file.
    pub(crate) fn exit_code(&self) -> u8 {
        match self {
            Self::OutputClosed => 0,
            Self::Failed(_) | Self::Signals(_) => 1,
            Self::Input(_) | Self::Render(_) => 2,
            Self::File(error) => code_of_file(error),
            Self::Textile(error) => code_of_textile(error),
            Self::Picture(error) => code_of_picture(error),
            Self::Scene(error) => code_of_scene(error),
            Self::Drape(error) => code_of_drape(error),
            Self::Bridge(error) => code_of_bridge(error),
            Self::Engine(error) => code_of_engine(error),
            Self::Sink(error) => code_of_sink(error),
            #[cfg(feature = "friction")]
            Self::Friction(error) => code_of_friction(error),
            Self::Report(error) => code_of_report(error),
            Self::Experiment(error) => code_of_experiment(error),
            Self::App(error) => code_of_app(error),
        }
    }
}

impl From<io::Error> for CliError {
    /// An error of our standard output.
    fn from(error: io::Error) -> Self {
        if error.kind() == io::ErrorKind::BrokenPipe {
            return Self::OutputClosed;
        }
        Self::Failed(format!(
            "cannot write the output: {error}; make room or choose --out"
        ))
    }
}

impl From<Cancelled> for CliError {
    fn from(_: Cancelled) -> Self {
        Self::Failed("stopped before the work was done; run it again to finish".to_owned())
    }
}

fn code_of_file(error: &FileError) -> u8 {
    match error {
        FileError::Read { .. }
        | FileError::Exists { .. }
        | FileError::Content { .. }
        | FileError::Whole { .. } => 2,
        FileError::Write { source, .. } if source.kind() == io::ErrorKind::BrokenPipe => 0,
        FileError::Write { .. } | FileError::Busy { .. } => 1,
    }
}

fn code_of_textile(error: &TextileError) -> u8 {
    match error {
        TextileError::File(error) => code_of_file(error),
        TextileError::Cancelled(_) | TextileError::Figure(_) => 1,
        _ => 2,
    }
}

fn code_of_picture(error: &PictureError) -> u8 {
    match error {
        PictureError::File(error) => code_of_file(error),
        PictureError::Input(_) => 2,
        PictureError::Cancelled(_) => 1,
    }
}

fn code_of_scene(error: &SceneError) -> u8 {
    match error {
        SceneError::File(error) => code_of_file(error),
        SceneError::Textile(error) => code_of_textile(error),
        SceneError::Value { .. } => 2,
    }
}

fn code_of_drape(error: &DrapeError) -> u8 {
    match error {
        DrapeError::File(error) => code_of_file(error),
        DrapeError::Textile(error) => code_of_textile(error),
        DrapeError::Scene(error) => code_of_scene(error),
        _ => 2,
    }
}

/// Ports and places that are not what was said are wrong input; a link that breaks is not.
fn code_of_bridge(error: &BridgeError) -> u8 {
    match error {
        BridgeError::Profile(error) => code_of_file(error),
        BridgeError::Open { .. }
        | BridgeError::LogPlace { .. }
        | BridgeError::LogContent { .. }
        | BridgeError::LinkTaken(_)
        | BridgeError::LinkHeld { .. }
        | BridgeError::Model(_)
        | BridgeError::WavSpec { .. } => 2,
        _ => 1,
    }
}

fn code_of_engine(error: &EngineError) -> u8 {
    match error {
        EngineError::Busy
        | EngineError::Thread(_)
        | EngineError::Audio(AudioError::System { .. }) => 1,
        EngineError::Render(_)
        | EngineError::Input(_)
        | EngineError::Audio(_)
        | EngineError::NoSecondDisplay => 2,
        EngineError::Scene(error) => code_of_scene(error),
        EngineError::Sink(error) => code_of_sink(error),
    }
}

/// A place that is wrong is wrong input; a disk that fills up is not.
fn code_of_sink(error: &SinkError) -> u8 {
    match error {
        SinkError::Place { .. } => 2,
        SinkError::File(error) => code_of_file(error),
        SinkError::Bridge(error) => code_of_bridge(error),
        SinkError::Cancelled(_) => 1,
    }
}

/// A name that is not known is wrong input; whatever a study ran into, it met while working.
#[cfg(feature = "friction")]
fn code_of_friction(error: &selvedge_friction::FrictionError) -> u8 {
    use selvedge_friction::FrictionError;
    match error {
        FrictionError::File(error) => code_of_file(error),
        FrictionError::Size { .. }
        | FrictionError::Checkpoint { .. }
        | FrictionError::Fabric { .. }
        | FrictionError::Few { .. } => 2,
        FrictionError::Weights { .. } | FrictionError::Cancelled => 1,
    }
}

fn code_of_report(error: &ReportError) -> u8 {
    match error {
        ReportError::Unknown { .. } => 2,
        _ => 1,
    }
}

fn code_of_experiment(error: &ExperimentError) -> u8 {
    match error {
        ExperimentError::File(error) => code_of_file(error),
        ExperimentError::Textile(error) => code_of_textile(error),
        ExperimentError::Cancelled(_) => 1,
        _ => 2,
    }
}

/// A missing display is for the user to mend.
fn code_of_app(error: &AppError) -> u8 {
    match error {
        AppError::Scene(error) => code_of_scene(error),
        AppError::Textile(error) => code_of_textile(error),
        AppError::Engine(error) => code_of_engine(error),
        AppError::Exploration(_)
        | AppError::NoDisplay
        | AppError::NoGraphics(_)
        | AppError::Render(_)
        | AppError::Size { .. }
        | AppError::Stage { .. } => 2,
    }
}
