//! What the builder shows of the design at hand, and what it waits for.

use crate::bench::background::Task;
use selvedge_experiment::design::Design;

/// What the builder shows of the design at hand.
#[derive(Debug, Default)]
pub(crate) struct Builder {
    /// Whether the text is shown in the place of blocks.
    pub(super) is_text: bool,
    /// The block that is open.
    pub(super) open: Option<&'static str>,
    pub(super) list: List,
    pub(super) step: Step,
    /// Why the file could not be written.
    pub(super) failure: Option<String>,
    /// A study of simulated observers under way.
    pub(super) simulating: Option<Task<Simulated>>,
    /// What became of the last, and the text that it was of.
    pub(super) simulated: Option<Simulated>,
}

/// A design's text, and what a study of simulated observers by it came to, a line each.
pub(crate) type Simulated = (String, Result<Vec<String>, String>);

impl Builder {
    /// Takes what became of writing the file.
    pub(crate) fn saved(&mut self, outcome: Result<(), String>) {
        self.failure = outcome.err();
    }
}

/// The list of stimuli as it is looked at.
#[derive(Debug, Default)]
pub(crate) struct List {
    /// The stimulus whose fields are shown.
    pub(super) open: Option<usize>,
    /// Why the last textile was not taken.
    pub(super) refused: Option<String>,
}

/// What of a session is looked at.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) enum Step {
    /// What is read first.
    Welcome,
    /// A movement that is practised.
    Movement,
    /// A trial.
    #[default]
    Trial,
    /// A break.
    Break,
}

impl Step {
    pub(super) const ALL: [(Self, &str); 4] = [
        (Self::Welcome, "welcome"),
        (Self::Movement, "movement"),
        (Self::Trial, "trial"),
        (Self::Break, "break"),
    ];

    /// The step that a block decides on.
    pub(crate) fn of_block(title: &str) -> Option<Self> {
        match title {
            "Presentation" | "Question" | "Response" | "Adaptation" => Some(Self::Trial),
            "Course" => Some(Self::Welcome),
            _ => None,
        }
    }

    /// Whether a session of the design has it.
    pub(super) fn is_in(self, design: &Design) -> bool {
        let course = &design.course;
        match self {
            Self::Welcome => !course.instructions.is_empty(),
            Self::Movement => !course.familiarisation.is_empty(),
            Self::Trial => true,
            Self::Break => course.has_breaks(),
        }
    }
}
