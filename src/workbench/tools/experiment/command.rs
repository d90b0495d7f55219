//! What can be done with a session.

use std::path::PathBuf;

use crate::bench::command::Command;
use crate::tools::experiment::draft::Mark;

/// What becomes of the participant's window.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum WindowAct {
    /// It is opened; the participant's view leaves the workbench.
    Open,
    /// It is closed; the view stands in the workbench again.
    Close,
    /// It fills its screen, or no longer does.
    FillScreen(bool),
}

/// Something to do with experiments. Never undone.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum ExperimentCommand {
    /// Take this design of the program for the next session.
    Choose(&'static str),
    /// Take the design in this file.
    Open(PathBuf),
    /// Look anew which sessions the folder holds.
    List,
    /// Begin the session that the form describes.
    Begin,
    /// Go on with the session of this log.
    Resume(PathBuf),
    /// Go on from instructions, a movement or a break.
    Pass,
    /// A part of an answer.
    Mark(Mark),
    /// Hand the answer in.
    Answer,
    /// Play the vibration of this trial again, where that is allowed.
    Play,
    /// Give the trial up; it comes again.
    Abort,
    /// Try to write again what could not be written.
    Retry,
    /// Pause before the next trial, or go on.
    Pause(bool),
    /// End the session; what is answered is on disk.
    End,
    /// Write a masking noise into the folder of sessions.
    Noise,
    /// Show the participant nothing while a trial waits: the experimenter types what is answered.
    Blank(bool),
    /// Do something with the participant's window.
    Window(WindowAct),
}

impl From<ExperimentCommand> for Command {
    fn from(command: ExperimentCommand) -> Self {
        Self::Experiment(command)
    }
}
