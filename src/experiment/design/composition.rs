//! What a session asks, composed of how stimuli are shown, a question, a response and an order,
//! and of what is adapted to the answers. The usual methods are compositions like any other.

use std::collections::BTreeMap;

use serde::Deserialize;

use super::adaptation::Adaptation;
use super::parameter::{Scale, TunedParameter};
use crate::named::named;
use selvedge_render::stylus::StylusSettings;

/// What a session asks.
#[derive(Debug, Clone, PartialEq)]
pub struct Composition {
    /// How stimuli are shown.
    pub presentation: Presentation,
    /// What is asked of them.
    pub question: Question,
    /// What is answered.
    pub response: Response,
    /// Which stimuli come together, how often, in which order.
    pub order: Order,
    /// A number of the stimuli that follows the answers, or takes stated values.
    pub adaptation: Option<Adaptation>,
}

/// How stimuli are shown.
#[derive(Debug, Clone, PartialEq)]
pub struct Presentation {
    /// In space, in time or alone.
    pub shown: Shown,
    /// Places or intervals of a trial.
    pub n: usize,
    /// What stimuli are compared with.
    pub reference: Standard,
    /// The number of the stimulus that every trial is compared with.
    pub standard: Option<usize>,
    /// Length of an interval, ms.
    pub(crate) interval_ms: u32,
    /// A vibration of the other band under all intervals, dB re 1 µm.
    pub(crate) masker_db: Option<f64>,
    /// The stylus that textiles are felt with in place of the array: its vibration drives all
    /// contactors, its force is for a device beside it.
    pub stylus: Option<StylusSettings>,
    /// Whether textiles hang as cloths between two fingers in place of lying under the array.
    pub hangs: bool,
}

named! { "kind",
    /// How the stimuli of a trial come.
    pub enum Shown {
        /// One alone.
        Single = "single",
        /// Two side by side.
        Pair = "pair",
        /// At numbered places.
        Places = "places",
        /// One after the other.
        Intervals = "intervals",
        /// All of the design at once.
        Set = "set",
    }
}

named! { "reference",
    /// What a trial is compared with.
    pub enum Standard {
        /// The real cloth on the table.
        RealCloth = "real-cloth",
        /// A virtual one beside the others.
        Virtual = "virtual",
        /// Nothing: what is asked is the participant's own.
        None = "none",
    }
}

/// What is asked, in words.
#[derive(Debug, Clone, PartialEq, Eq, Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Question {
    /// Where no language is chosen; empty for what the composition asks by itself.
    pub(crate) text: String,
    /// In other languages, by their tags: `de`, `pt-BR`.
    pub(crate) texts: BTreeMap<String, String>,
    /// The tag of the language that is shown.
    pub(crate) language: String,
}

impl Question {
    /// The text that is shown; `None` where the design leaves it to the program.
    pub fn shown(&self) -> Option<&str> {
        let translated = self.texts.get(&self.language);
        let text = translated.unwrap_or(&self.text).trim();
        Some(text).filter(|text| !text.is_empty())
    }
}

/// What is answered.
#[derive(Debug, Clone, PartialEq)]
pub struct Response {
    /// In which form.
    pub form: Form,
    /// What makes an answer right, beyond what the order says.
    pub right: Option<Right>,
    /// How sure the answer is, where that is asked.
    pub confidence: Confidence,
}

/// What makes an answer right.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Right {
    /// Stimuli of this condition: to be chosen, or to be called by the first word.
    Condition(String),
    /// The stimulus that stands later in the design, which lists them from least to most.
    Later,
}

/// The form of an answer.
#[derive(Debug, Clone, PartialEq)]
pub enum Form {
    /// One of the places or intervals.
    Choice,
    /// One of two words, `yes` and `no` say.
    Words([String; 2]),
    /// Whether two are the same or different.
    SameDifferent,
    /// All places in order.
    Rank,
    /// The places at both ends of what is asked, with a word for each.
    BestWorst([String; 2]),
    /// A place on every scale.
    Scales(Vec<Scale>),
    /// A number above 0.
    Number {
        /// The number that the standard, or the first stimulus, is said to have, if one is said.
        modulus: Option<f64>,
    },
    /// Which are put together.
    Piles,
    /// What parameters are turned to.
    Adjustment(Vec<TunedParameter>),
}

/// How sure an answer is.
#[derive(Debug, Clone, PartialEq, Default)]
pub enum Confidence {
    /// Not asked.
    #[default]
    Unasked,
    /// From 1, guessed.
    Grades(u8),
    /// In words, each with what a right answer is worth then, from 0 to 1.
    Words(Vec<(String, f64)>),
}

impl Confidence {
    /// Grades that are offered; 0 asks for none.
    pub fn n_grades(&self) -> u8 {
        match self {
            Self::Unasked => 0,
            Self::Grades(n) => *n,
            Self::Words(words) => u8::try_from(words.len()).unwrap_or(u8::MAX),
        }
    }

    /// The words of the grades, where they have words.
    pub fn words(&self) -> Vec<&str> {
        match self {
            Self::Words(words) => words.iter().map(|(word, _)| word.as_str()).collect(),
            _ => Vec::new(),
        }
    }
}

/// Which stimuli come together, how often, in which order.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Order {
    /// Which come together.
    pub sets: Sets,
    /// How often each set comes; of balanced sets, each stimulus.
    pub repeats: usize,
    /// In which order the sets of a block come.
    pub(crate) sequence: Sequence,
    /// Trials of every block in which all stimuli are the same.
    pub(crate) catch_trials: usize,
}

named! { "sets",
    /// Which stimuli come together in a trial.
    pub enum Sets {
        /// Every stimulus by itself.
        Each = "each",
        /// Every two; the same one twice as often as two others where that is asked.
        Pairs = "pairs",
        /// One of the right condition and one of another, of the same material.
        Opposed = "opposed",
        /// Two alike and an odd one, for every two.
        Triads = "triads",
        /// A target, and it among others.
        Targets = "targets",
        /// Sets in which every two stimuli meet as often as may be.
        Balanced = "balanced",
        /// All at once.
        All = "all",
        /// One, whose number is adapted, among such as are at the reference.
        Adapted = "adapted",
    }
}

impl Sets {
    /// Whether two of them come together.
    pub(crate) fn has_pairs(self) -> bool {
        matches!(self, Self::Pairs | Self::Opposed)
    }
}

named! { "sequence",
    /// In which order the sets of a block come.
    #[derive(Default)]
    pub(crate) enum Sequence {
        /// By chance, anew for every block and subject.
        #[default]
        Random = "random",
        /// Rows of a Latin square, by subject and block.
        LatinSquare = "latin-square",
        /// Likewise, and each set follows every other as often (Williams 1949).
        Williams = "williams",
    }
}

impl Composition {
    /// What is turned; nothing unless that is asked.
    pub fn parameters(&self) -> &[TunedParameter] {
        match &self.response.form {
            Form::Adjustment(parameters) => parameters,
            _ => &[],
        }
    }

    /// The scales that are asked for.
    pub fn scales(&self) -> &[Scale] {
        match &self.response.form {
            Form::Scales(scales) => scales,
            _ => &[],
        }
    }

    /// Whether a trial has a stimulus that its items are compared with.
    pub(crate) fn has_reference(&self) -> bool {
        let has_standard = self.presentation.standard.is_some();
        self.order.sets == Sets::Targets || has_standard || self.is_beside_cloth()
    }

    /// Whether two of one material lie beside its real cloth.
    pub(crate) fn is_beside_cloth(&self) -> bool {
        let is_cloth = self.presentation.reference == Standard::RealCloth;
        is_cloth && self.order.sets == Sets::Opposed
    }

    /// The words that are chosen from; none where positions are.
    pub fn words(&self) -> Option<[&str; 2]> {
        match &self.response.form {
            Form::Words([yes, no]) => Some([yes, no]),
            Form::SameDifferent => Some(["same", "different"]),
            _ => None,
        }
    }

    /// How many may be chosen from.
    pub fn n_choices(&self) -> usize {
        self.words()
            .map_or(self.presentation.n, |words| words.len())
    }

    /// Whether trials say what is right, or where what is adapted is.
    pub(crate) fn has_right(&self) -> bool {
        match (&self.response.form, self.order.sets) {
            (_, Sets::Targets | Sets::Triads | Sets::Opposed) | (Form::SameDifferent, _) => true,
            (_, Sets::Adapted) => self.presentation.n > 1,
            _ => self.response.right.is_some(),
        }
    }

    /// The condition of what is right to choose or to call by the first word.
    pub fn right_condition(&self) -> Option<&str> {
        match &self.response.right {
            Some(Right::Condition(condition)) => Some(condition),
            _ => None,
        }
    }
}
