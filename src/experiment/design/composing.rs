//! The tables that compose what is asked, as files have them.

use serde::Deserialize;

use super::adaptation::count;
use super::adapting::AdaptationKeys;
use super::{
    Composition, Confidence, Form, Order, Presentation, Question, Response, Right, Scale, Sequence,
    Sets, Shown, Source, Standard, Stimulus, TunedParameter,
};
use crate::named::named;
use selvedge_foundation::files::Flaw;
use selvedge_render::stylus::StylusSettings;

/// What makes the later stimulus of the design the right one.
const LATER: &str = "later";

/// The tables.
pub(super) struct Keys {
    pub(super) presentation: Option<PresentationKeys>,
    pub(super) question: Question,
    pub(super) response: Option<ResponseKeys>,
    pub(super) order: OrderKeys,
    pub(super) adaptation: Option<AdaptationKeys>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct PresentationKeys {
    kind: Shown,
    n: Option<usize>,
    #[serde(default = "nothing")]
    reference: Standard,
    standard: Option<String>,
    interval_ms: Option<u32>,
    masker_db: Option<f64>,
    stylus: Option<StylusSettings>,
    #[serde(default)]
    hangs: bool,
}

fn nothing() -> Standard {
    Standard::None
}

/// How long an interval of a vibration is where nothing is said, ms.
pub(super) fn interval_ms() -> u32 {
    500
}

/// The same of a textile, which a finger has to move over, ms.
const CLOTH_INTERVAL_MS: u32 = 3000;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ResponseKeys {
    kind: FormName,
    words: Option<[String; 2]>,
    right: Option<String>,
    modulus: Option<f64>,
    #[serde(default, rename = "scale")]
    scales: Vec<Scale>,
    #[serde(default, rename = "parameter")]
    parameters: Vec<TunedParameter>,
    #[serde(default)]
    confidence_grades: u8,
    #[serde(default)]
    confidence_words: Vec<String>,
    confidence_weights: Option<Vec<f64>>,
}

named! { "kind",
    /// Forms of answers as files call them.
    pub(super) enum FormName {
        /// [`Form::Choice`].
        Choice = "choice",
        /// [`Form::Words`].
        YesNo = "yes-no",
        /// [`Form::SameDifferent`].
        SameDifferent = "same-different",
        /// [`Form::Rank`].
        Rank = "rank",
        /// [`Form::BestWorst`].
        BestWorst = "best-worst",
        /// [`Form::Scales`].
        Sliders = "sliders",
        /// [`Form::Number`].
        Number = "number",
        /// [`Form::Piles`].
        Piles = "piles",
        /// [`Form::Adjustment`].
        Adjustment = "adjustment",
    }
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct OrderKeys {
    sets: Option<Sets>,
    #[serde(default = "count::<1>")]
    repeats: usize,
    #[serde(default)]
    sequence: Sequence,
    #[serde(default)]
    catch_trials: usize,
}

impl Default for OrderKeys {
    fn default() -> Self {
        Self {
            sets: None,
            repeats: 1,
            sequence: Sequence::Random,
            catch_trials: 0,
        }
    }
}

impl Keys {
    /// What they compose.
    ///
    /// # Errors
    /// A table is missing or does not say what it has to.
    pub(super) fn composition(self, stimuli: &[Stimulus]) -> Result<Composition, Flaw> {
        let missing = |table: &'static str, mend: &str| {
            let what = format!("there is no table [{table}]");
            Flaw::new(("", 0, "experiment"), what, mend)
        };
        let mend = "add it with kind = \"single\", \"pair\", \"places\", \"intervals\" or \"set\"";
        let presentation = self
            .presentation
            .ok_or_else(|| missing("presentation", mend))?;
        let mend = "add it with kind = \"choice\", \"rank\", \"sliders\" or another";
        let response = self.response.ok_or_else(|| missing("response", mend))?;
        let presentation = presentation.presentation(stimuli)?;
        let adapted = |keys: AdaptationKeys| keys.adaptation(presentation.n);
        let adaptation = self.adaptation.map(adapted).transpose()?;
        let usual = match (presentation.shown, adaptation.is_some()) {
            (_, true) => Some(Sets::Adapted),
            (Shown::Single, _) => Some(Sets::Each),
            (Shown::Pair, _) => Some(Sets::Pairs),
            (Shown::Set, _) => Some(Sets::All),
            (Shown::Places | Shown::Intervals, _) => None,
        };
        let sets = self.order.sets.or(usual).ok_or_else(|| {
            let mend = "add sets = \"targets\", \"triads\", \"pairs\" or \"balanced\" to [order]";
            let what = "it is not said which stimuli come together";
            Flaw::new(("presentation", 0, "kind"), what, mend)
        })?;
        Ok(Composition {
            presentation,
            question: self.question,
            response: response.response()?,
            order: Order {
                sets,
                repeats: self.order.repeats,
                sequence: self.order.sequence,
                catch_trials: self.order.catch_trials,
            },
            adaptation,
        })
    }
}

impl PresentationKeys {
    fn presentation(self, stimuli: &[Stimulus]) -> Result<Presentation, Flaw> {
        let usual = match self.kind {
            Shown::Single => Some(1),
            Shown::Pair | Shown::Intervals => Some(2),
            Shown::Set => Some(stimuli.len()),
            Shown::Places => None,
        };
        let n = self.n.or(usual).ok_or_else(|| {
            let what = "it is not said how many places there are";
            Flaw::new(("presentation", 0, "kind"), what, "add n = 2 or more")
        })?;
        let numbered = |id: String| {
            stimuli.iter().position(|one| one.id == id).ok_or_else(|| {
                let what = format!("the standard {id:?} is no stimulus");
                let place = ("presentation", 0, "standard");
                Flaw::new(place, what, "give the id of a stimulus of this design")
            })
        };
        let is_textile = |one: &Stimulus| matches!(one.source, Source::Textile { .. });
        let is_in_time = self.kind == Shown::Intervals;
        let usual_ms = if is_in_time && stimuli.iter().any(is_textile) {
            CLOTH_INTERVAL_MS
        } else {
            interval_ms()
        };
        Ok(Presentation {
            shown: self.kind,
            n,
            reference: self.reference,
            standard: self.standard.map(numbered).transpose()?,
            interval_ms: self.interval_ms.unwrap_or(usual_ms),
            masker_db: self.masker_db,
            stylus: self.stylus,
            hangs: self.hangs,
        })
    }
}

impl ResponseKeys {
    fn response(self) -> Result<Response, Flaw> {
        let confidence = self.confidence()?;
        let flaw = |key, what: &str, mend: &str| Flaw::new(("response", 0, key), what, mend);
        let strays = [
            (
                "scale",
                !self.scales.is_empty(),
                self.kind == FormName::Sliders,
            ),
            (
                "parameter",
                !self.parameters.is_empty(),
                self.kind == FormName::Adjustment,
            ),
            (
                "modulus",
                self.modulus.is_some(),
                self.kind == FormName::Number,
            ),
        ];
        if let Some((key, ..)) = strays
            .iter()
            .find(|(_, is_given, is_used)| *is_given && !is_used)
        {
            let what = format!("{key} has no meaning with kind = {:?}", self.kind.name());
            return Err(flaw("kind", &what, "take it away, or change the kind"));
        }
        let words = |usual: [&str; 2]| {
            self.words
                .clone()
                .unwrap_or_else(|| usual.map(str::to_owned))
        };
        let form = match self.kind {
            FormName::Choice => Form::Choice,
            FormName::YesNo => Form::Words(words(["yes", "no"])),
            FormName::SameDifferent => Form::SameDifferent,
            FormName::Rank => Form::Rank,
            FormName::BestWorst => Form::BestWorst(words(["best", "worst"])),
            FormName::Sliders => Form::Scales(self.scales),
            FormName::Number => Form::Number {
                modulus: self.modulus,
            },
            FormName::Piles => Form::Piles,
            FormName::Adjustment => Form::Adjustment(self.parameters),
        };
        let has_words = matches!(form, Form::Words(_) | Form::BestWorst(_));
        if self.words.is_some() && !has_words {
            let what = format!("words have no meaning with kind = {:?}", self.kind.name());
            return Err(flaw("words", &what, "take them away"));
        }
        let right = self.right.map(|right| match right.as_str() {
            LATER => Right::Later,
            _ => Right::Condition(right),
        });
        Ok(Response {
            form,
            right,
            confidence,
        })
    }

    fn confidence(&self) -> Result<Confidence, Flaw> {
        let n = self.confidence_words.len();
        let flaw = |key, what: String, mend: &str| Err(Flaw::new(("response", 0, key), what, mend));
        match (self.confidence_grades, n, &self.confidence_weights) {
            (1.., 1.., _) => {
                let what = "confidence has grades and words".to_owned();
                flaw("confidence_words", what, "keep one of them")
            }
            (_, n, Some(weights)) if weights.len() != n => {
                let what = format!("{} weights for {n} words", weights.len());
                flaw(
                    "confidence_weights",
                    what,
                    "give one for each of confidence_words",
                )
            }
            (0, 0, _) => Ok(Confidence::Unasked),
            (grades, 0, _) => Ok(Confidence::Grades(grades)),
            (_, n, weights) => {
                let weights = weights.clone().unwrap_or_else(|| vec![1.0; n]);
                let words = self.confidence_words.iter().cloned();
                Ok(Confidence::Words(words.zip(weights).collect()))
            }
        }
    }
}
