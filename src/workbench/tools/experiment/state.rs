//! What the window knows of experiments: the form, the session, the participant's window.

use crate::bench::background::Task;
use crate::tools::experiment::active_session::ActiveSession;
use crate::tools::experiment::builder::state::Builder;
use crate::tools::experiment::form::Form;
use crate::tools::experiment::materials::Materials;
use crate::tools::experiment::played_noise::PlayedNoise;
use selvedge_experiment::session::Session;

/// The window that shows a participant's view and nothing else.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct ParticipantsWindow {
    /// Whether it is open: the workbench shows no participant's view then.
    pub is_open: bool,
    /// Whether it is to fill its screen.
    pub(crate) fills_screen: bool,
}

/// Experiments, as the window knows them: neither saved nor undoable.
#[derive(Debug, Default)]
pub(crate) struct Experiment {
    /// What the next session is to be.
    pub(super) form: Form,
    /// A session on its way.
    pub(super) beginning: Option<Task<Begun>>,
    /// What the study builder shows.
    pub(super) builder: Builder,
    /// The session that is active.
    pub(super) session: Option<Box<ActiveSession>>,
    /// A masking noise on its way to its file.
    pub(super) noise: Option<Task<()>>,
    /// The masking noise as it is played.
    pub(super) played: PlayedNoise,
    /// A window of the participant's own.
    pub(super) window: ParticipantsWindow,
    /// Whether the participant sees nothing while a trial waits.
    pub(super) is_blank: bool,
    /// What the experimenter is asked before it is done.
    pub(super) asked: Option<Asked>,
}

/// What is done once the experimenter says so again.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Asked {
    /// The session begins.
    Begin,
    /// It ends.
    End,
}

/// A session that is ready to become active.
#[derive(Debug)]
pub(crate) struct Begun {
    /// The session.
    pub session: Session,
    /// What it presents.
    pub materials: Materials,
}
