//! What a session asks, composed of how stimuli are shown, a question, a response and an order,
//! and of what is adapted to the answers. The usual methods are compositions like any other.

use std::collections::BTreeMap;

use serde::Deserialize;

use super::adaptation::{Adaptation, Seeks};
use crate::named::named;
use selvedge_textile::tactile::Tuning;

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

named! { "kind",
    /// What a composition amounts to, by which it is called and analysed.
    pub enum Kind {
        /// Four ranked by their likeness to a target (Philpott & Summers 2012).
        Ranking = "ranking",
        /// The odd one of three, with how hard that was (Allerkamp et al.).
        OddOneOut = "odd_one_out",
        /// Parameters turned until a stimulus is as asked.
        Adjustment = "adjustment",
        /// What is real and what is generated (Cai et al. 2021).
        Judgement = "judgement",
        /// Thresholds and just noticeable differences.
        Levels = "levels",
        /// Where a number is as often called more as less.
        Equality = "equality",
        /// Numbers for strengths.
        Magnitude = "magnitude",
        /// Places on scales.
        Rating = "rating",
        /// One of several, right or wrong.
        Choice = "choice",
        /// One of several, none of which is right.
        Preference = "preference",
        /// Sets in order, or the ends of them.
        Orders = "orders",
        /// How unlike two are.
        Dissimilarity = "dissimilarity",
        /// Piles of what is alike.
        Sorting = "sorting",
    }
}

impl Composition {
    /// What it amounts to.
    pub fn kind(&self) -> Kind {
        let has_two = self.presentation.n > 1;
        match (&self.response.form, self.order.sets) {
            (_, Sets::Adapted) => match self.adaptation.as_ref().map(|one| one.seeks) {
                Some(Seeks::Equality) => Kind::Equality,
                _ => Kind::Levels,
            },
            (Form::Adjustment(_), _) => Kind::Adjustment,
            (Form::Rank, Sets::Targets) => Kind::Ranking,
            (Form::Rank | Form::BestWorst(_), _) => Kind::Orders,
            (Form::Choice, Sets::Triads) if self.response.confidence.words().len() == 3 => {
                Kind::OddOneOut
            }
            (Form::Words(_), _) | (Form::Choice, Sets::Opposed) => Kind::Judgement,
            (Form::SameDifferent, _) | (Form::Choice, Sets::Triads | Sets::Targets) => Kind::Choice,
            (Form::Choice, _) if self.response.right.is_some() => Kind::Choice,
            (Form::Choice, _) => Kind::Preference,
            (Form::Scales(_) | Form::Number { .. }, Sets::Pairs) if has_two => Kind::Dissimilarity,
            (Form::Scales(_), _) => Kind::Rating,
            (Form::Number { .. }, _) => Kind::Magnitude,
            (Form::Piles, _) => Kind::Sorting,
        }
    }

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

    /// What a trial takes, s: what is played, and the median of an answer, which is assumed but that
    /// a ranking takes 30 to 90 s.
    pub fn trial_s(&self) -> [f64; 2] {
        let (n, sets) = (self.presentation.n as f64, self.order.sets);
        let is_played = self.presentation.shown == Shown::Intervals;
        let shown_s = f64::from(self.presentation.interval_ms) * n / 1000.0;
        let answer_s = match &self.response.form {
            Form::Choice | Form::Words(_) if is_played => 1.0,
            Form::Rank | Form::BestWorst(_) => 12.5 * n,
            Form::Adjustment(_) => 30.0,
            Form::Scales(scales) => 5.0 * scales.len().max(2) as f64,
            Form::Number { .. } => 5.0 * n,
            Form::Piles => 20.0 * n,
            Form::Choice if sets == Sets::Triads => 20.0,
            Form::Choice | Form::SameDifferent => 6.0 * n,
            Form::Words(_) => 8.0,
        };
        [if is_played { shown_s } else { 0.0 }, answer_s]
    }

    /// What is asked: the design's own words, or those for its form.
    pub fn question(&self) -> String {
        let n = self.presentation.n;
        match (self.question.shown(), &self.response.form) {
            (Some(text), _) => text.to_owned(),
            (None, Form::Choice) => self.choice_question().to_owned(),
            (None, Form::Words([yes, no])) => format!("say whether this is {yes} or {no}"),
            (None, Form::SameDifferent) => "say whether they are the same or different".to_owned(),
            (None, Form::Rank) if self.order.sets == Sets::Targets => {
                format!("put all {n} in order, the one most like the target first")
            }
            (None, Form::Rank) => format!("put all {n} in order"),
            (None, Form::BestWorst([best, worst])) => {
                format!("choose the {best} one, then the {worst} one")
            }
            (None, Form::Scales(_)) if n > 1 => "say how unlike they are".to_owned(),
            (None, Form::Scales(_)) => "place it on every scale".to_owned(),
            (None, Form::Number { .. }) if self.kind() == Kind::Dissimilarity => {
                "give a number above 0 for how unlike they are".to_owned()
            }
            (None, Form::Number { .. }) => "give a number above 0 for how strong it is".to_owned(),
            (None, Form::Piles) => "put those that feel alike together".to_owned(),
            (None, Form::Adjustment(_)) => "adjust until it is as asked".to_owned(),
        }
    }

    fn choice_question(&self) -> &'static str {
        let has_reference = self
            .adaptation
            .as_ref()
            .is_some_and(|a| a.reference.is_some());
        match (self.order.sets, self.presentation.shown) {
            (Sets::Triads, _) if self.response.confidence.n_grades() > 0 => {
                "choose the odd one, then say how hard that was"
            }
            (Sets::Triads, _) => "choose the odd one",
            (Sets::Opposed, _) => "choose the one that is real",
            (Sets::Targets, _) => "choose the one that is the same as the target",
            (Sets::Adapted, Shown::Intervals) if has_reference => {
                "choose the interval with the stronger vibration"
            }
            (Sets::Adapted, Shown::Intervals) => "choose the interval with the vibration",
            (_, Shown::Intervals) => "choose the interval with more",
            _ => "choose the one with more",
        }
    }
}

/// A parameter that participants turn.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TunedParameter {
    /// Which.
    #[serde(rename = "key")]
    pub(crate) what: Tunable,
    /// The lowest value.
    pub from: f64,
    /// The highest value.
    pub to: f64,
    /// What one press of a key turns it by.
    pub step: f64,
}

named! { "parameter",
    /// A number of a stimulus that can be turned or adapted.
    pub(crate) enum Tunable {
        /// The level of a vibration, dB re 1 µm.
        Level = "level_db",
        /// The gain of everything, dB.
        Gain = "gain_db",
        /// The gain of the 40 Hz band, dB.
        Gain40 = "gain_40_db",
        /// The gain of the 320 Hz band, dB.
        Gain320 = "gain_320_db",
        /// Compression, 0 to 1.
        Compression = "compression",
    }
}

impl Tunable {
    /// Sets it in a tuning, which holds no levels of vibrations.
    pub(crate) fn set(self, tuning: &mut Tuning, value: f64) {
        match self {
            Self::Level => {}
            Self::Gain => tuning.gain_db = value,
            Self::Gain40 => tuning.gain_40_db = value,
            Self::Gain320 => tuning.gain_320_db = value,
            Self::Compression => tuning.compression = value,
        }
    }

    /// A log's column of it: gains and compression of the whole array have columns of their own.
    pub(crate) fn column(self) -> String {
        match self {
            Self::Level => self.name().to_owned(),
            _ => format!("adapted_{}", self.name()),
        }
    }

    /// What that column holds.
    pub(crate) fn meaning(self) -> &'static str {
        match self {
            Self::Level => "level of the signal",
            Self::Gain => "gain of the stimulus",
            Self::Gain40 => "gain of the 40 Hz band",
            Self::Gain320 => "gain of the 320 Hz band",
            Self::Compression => "compression of the stimulus, 0 to 1",
        }
    }

    /// Its unit; empty where it has none.
    pub(crate) fn unit(self) -> &'static str {
        match self {
            Self::Level => "dB re 1 µm",
            Self::Compression => "",
            _ => "dB",
        }
    }
}

/// One scale.
#[derive(Debug, Clone, PartialEq, Eq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Scale {
    /// Its name in logs: letters, digits and `_`.
    pub key: String,
    /// What stands at its low end.
    pub low: String,
    /// What stands at its high end.
    pub high: String,
    /// Its points from 1; 0 is a line from 0 to 100 without points.
    #[serde(default)]
    pub points: u8,
}

impl Scale {
    /// The lowest and the highest answer.
    pub fn bounds(&self) -> [f64; 2] {
        match self.points {
            0 => [0.0, 100.0],
            points => [1.0, f64::from(points)],
        }
    }
}
