//! An experiment that is run in the window: one session, seen by participant and experimenter.
//!
//! ```text
//! form ─▶ materials, session ─▶ held ─┬▶ participant's view: numbers of places alone
//!                               │  ▲  └▶ experimenter's view: progress and device
//!                 trial's scene ▼  └ marks, answers ─▶ row on disk ─▶ next trial
//!                            engine
//! ```
//!
//! # Invariants
//! - the document never learns of a session; when one ends, the user's scene is felt again
//! - the next trial begins only once the row of the last one is on disk
//! - what participants and experimenters see does not depend on what is right

pub(crate) mod command;
pub(crate) mod dispatch;
pub(crate) mod draft;
pub(crate) mod experimenter;
pub(crate) mod form;
pub(crate) mod guide;
pub(crate) mod held;
pub(crate) mod materials;
pub(crate) mod noise;
pub(crate) mod now;
pub(crate) mod pane;
pub(crate) mod participant;
pub(crate) mod sessions;
#[cfg(test)]
mod tests;
pub(crate) mod view;
pub(crate) mod who;

#[cfg(test)]
pub(crate) use crate::tools::experiment::command::ExperimentCommand;
pub(crate) use crate::tools::experiment::command::WindowAct;
#[cfg(test)]
pub(crate) use crate::tools::experiment::draft::Draft;
#[cfg(test)]
pub(crate) use crate::tools::experiment::draft::Mark;
#[cfg(test)]
pub(crate) use crate::tools::experiment::form::Chosen;
pub(crate) use crate::tools::experiment::form::Form;
pub(crate) use crate::tools::experiment::held::Held;
pub(crate) use crate::tools::experiment::materials::Materials;
pub(crate) use crate::tools::experiment::noise::NoiseView;
#[cfg(test)]
pub(crate) use crate::tools::experiment::now::Now;
#[cfg(test)]
pub(crate) use crate::tools::experiment::view::Ground;
#[cfg(test)]
pub(crate) use crate::tools::experiment::view::Link;
#[cfg(test)]
pub(crate) use crate::tools::experiment::view::ParticipantView;
#[cfg(test)]
pub(crate) use crate::tools::experiment::view::TrialView;

use crate::bench::task::Task;
use selvedge_experiment::session::Session;

/// The window that shows a participant's view and nothing else.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct ParticipantsWindow {
    /// Whether it is open: the workbench shows no participant's view then.
    pub is_open: bool,
    /// Whether it is to fill its screen.
    pub(crate) fills_screen: bool,
    /// Since when neither window has had the keyboard, s.
    left_since_s: Option<f64>,
}

/// The keyboard may be on its way from one window to the other for so long, s.
const PASSING_S: f64 = 0.25;

impl ParticipantsWindow {
    /// What becomes of it.
    pub(crate) fn act(&mut self, act: WindowAct) {
        match act {
            WindowAct::Open => self.is_open = true,
            WindowAct::Close => *self = Self::default(),
            WindowAct::FillScreen(fills) => self.fills_screen = fills && self.is_open,
        }
    }

    /// How long the windows must still be without the keyboard until another program is sure to
    /// have it, s; `None` while one of them has it.
    pub(crate) fn left_alone_s(&mut self, now_s: f64, has_keyboard: bool) -> Option<f64> {
        if has_keyboard {
            self.left_since_s = None;
            return None;
        }
        let since_s = *self.left_since_s.get_or_insert(now_s);
        Some((since_s + PASSING_S - now_s).max(0.0))
    }
}

/// Experiments, as the window knows them: neither saved nor undoable.
#[derive(Debug, Default)]
pub(crate) struct Experiment {
    /// What the next session is to be.
    pub form: Form,
    /// A session on its way.
    pub beginning: Option<Task<Begun>>,
    /// The session that is held.
    pub held: Option<Box<Held>>,
    /// A masking noise on its way to its file.
    pub noise: Option<Task<()>>,
    /// A window of the participant's own.
    pub window: ParticipantsWindow,
    /// Whether the participant sees nothing while a trial waits.
    pub(crate) is_blank: bool,
    /// Whether the next recording that ends is of a trial that nobody answered.
    pub(crate) lets_recording_go: bool,
}

/// A session that is ready to be held.
#[derive(Debug)]
pub(crate) struct Begun {
    /// The session.
    pub session: Session,
    /// What it presents.
    pub materials: Materials,
}

impl Experiment {
    /// Whether a session is held.
    pub(crate) fn is_held(&self) -> bool {
        self.held.is_some()
    }

    /// How it stands with a masking noise, where the design asks for one.
    pub(crate) fn noise(&self) -> Option<NoiseView> {
        let form = &self.form;
        let is_asked = match &self.held {
            Some(held) => held.design.course.masking_noise,
            None => (form.design.as_ref()).is_ok_and(|design| design.course.masking_noise),
        };
        let view = || NoiseView::of(self.noise.as_ref(), &form.folder(), form.has_noise);
        is_asked.then(view)
    }
}
