//! What is wrong with an import: one line, and the step at which it is mended.

use selvedge_textile::{KesAsk, TextileError};

/// A step of the pane.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Step {
    /// Which files.
    Files,
    /// What they mean.
    Meaning,
    /// What is looked at of them.
    Look,
    /// What it is called.
    Keep,
}

impl Step {
    /// Its number in the pane.
    pub(crate) fn number(self) -> u8 {
        match self {
            Self::Files => 1,
            Self::Meaning => 2,
            Self::Look => 3,
            Self::Keep => 4,
        }
    }
}

/// What is wrong, in one line, and where it is mended.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Failure {
    /// The step that it belongs to.
    pub step: Step,
    /// The line.
    pub line: String,
    /// What must be said.
    pub ask: Option<KesAsk>,
    /// Which file it is about.
    pub file: Option<usize>,
}

impl Failure {
    /// A line at a step.
    pub(crate) fn at(step: Step, line: impl Into<String>) -> Self {
        Self {
            step,
            line: line.into(),
            ask: None,
            file: None,
        }
    }

    /// A reader's own line; at another step if what it asks for is there.
    pub(crate) fn of(step: Step, error: &TextileError) -> Self {
        let ask = match error {
            TextileError::Kes { ask, .. } => Some(*ask),
            _ => None,
        };
        let step = match ask {
            Some(KesAsk::Section) => Step::Look,
            Some(_) => Step::Meaning,
            None => step,
        };
        let line = match error {
            // In the window a field is named, not an option.
            TextileError::Kes {
                path,
                line,
                what,
                ask,
            } => format!("{}:{line}: {what}; {}", path.display(), field_words(*ask)),
            _ => error.to_string(),
        };
        Self {
            ask,
            ..Self::at(step, line)
        }
    }

    /// The line of a reader of heights. A mend that names an option asks for a word about the file;
    /// what no word mends belongs to the choice of files.
    pub(crate) fn of_heights(error: &TextileError) -> Self {
        let line = error.to_string();
        let step = if line.contains("(--") || line.contains("economical") {
            Step::Meaning
        } else {
            Step::Files
        };
        Self::at(step, line)
    }
}

/// What to do in the pane about what a reader asks.
fn field_words(ask: KesAsk) -> &'static str {
    match ask {
        KesAsk::UmPerVolt => "type the sensitivity below",
        KesAsk::Step => "type the step below, or the speed and the rate",
        KesAsk::Speed => "type the speed below",
        KesAsk::Direction => "choose above what each file holds",
        KesAsk::ReturnOrder => "choose below how the return rows are ordered",
        KesAsk::Decimal => "choose the decimal sign below",
        KesAsk::XUnit => "choose the unit of places below",
        KesAsk::HeightUnit => "choose the unit of heights below, or type the sensitivity for volts",
        KesAsk::Columns => "choose below what each column holds",
        KesAsk::Section => "drag or type the section on the strokes",
    }
}
