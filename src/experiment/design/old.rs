//! Designs of earlier versions, whose one table of several said what is asked: it is turned into
//! the composition that it was. Logs carry such designs.

use serde::Deserialize;

use super::adaptation::count;
use super::adapting::{AdaptationKeys, ConstantKeys, QuestPlusKeys};
use super::composing::interval_ms;
use super::{
    Composition, Confidence, Form, Order, Presentation, Question, Response, Right, Scale, Seeks,
    Sequence, Sets, Shown, StaircaseTrack, Standard, Stopping, Tunable, TunedParameter,
};
use crate::named::named;
use selvedge_foundation::files::Flaw;

/// Those tables; the rest of the file is read elsewhere.
#[derive(Deserialize)]
pub(super) struct OldTables {
    ranking: Option<Ranking>,
    odd_one_out: Option<OddOneOut>,
    adjustment: Option<Adjusting>,
    judgement: Option<Judging>,
    levels: Option<Levels>,
    magnitude: Option<Magnitude>,
    rating: Option<Rating>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Ranking {
    target: Standard,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct OddOneOut {
    #[serde(default = "grade_weights")]
    weights: [f64; 3],
}

fn grade_weights() -> [f64; 3] {
    [1.0, 0.5, 0.1]
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Adjusting {
    standard: Standard,
    #[serde(default = "count::<2>")]
    repeats: usize,
    #[serde(rename = "parameter")]
    parameters: Vec<TunedParameter>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Judging {
    real: String,
    protocol: Protocol,
    #[serde(default = "count::<1>")]
    repeats: usize,
    #[serde(default)]
    confidence_grades: u8,
}

named! { "protocol",
    /// How stimuli were judged.
    enum Protocol {
        /// One at a time.
        Single = "single",
        /// The real and a generated one of a material.
        Pair = "pair",
    }
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Levels {
    band_hz: f64,
    #[serde(default = "count::<2>")]
    intervals: usize,
    reference_db: Option<f64>,
    #[serde(default = "interval_ms")]
    interval_ms: u32,
    range_db: [f64; 2],
    staircase: Option<StaircaseTrack>,
    quest_plus: Option<QuestPlusKeys>,
    constant: Option<ConstantKeys>,
    #[serde(default)]
    stop: Stopping,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Magnitude {
    #[serde(default = "count::<2>")]
    repeats: usize,
    modulus: Option<f64>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Rating {
    #[serde(default = "count::<1>")]
    repeats: usize,
    #[serde(rename = "scale")]
    scales: Vec<Scale>,
}

impl OldTables {
    /// What they composed.
    ///
    /// # Errors
    /// None of them is there, or the way of finding the next level is not said.
    pub(super) fn composition(self) -> Result<Composition, Flaw> {
        let known = [
            self.ranking.map(|ranking| {
                let asked = composed(Shown::Places, 4, Form::Rank, (Sets::Targets, 1));
                against(asked, ranking.target)
            }),
            self.odd_one_out.map(OddOneOut::composition),
            self.adjustment.map(|adjusting| {
                let form = Form::Adjustment(adjusting.parameters);
                let asked = composed(Shown::Single, 1, form, (Sets::Each, adjusting.repeats));
                against(asked, adjusting.standard)
            }),
            self.judgement.map(Judging::composition),
            self.levels.map(Levels::composition).transpose()?,
            self.magnitude.map(|magnitude| {
                let modulus = magnitude.modulus;
                let order = (Sets::Each, magnitude.repeats);
                composed(Shown::Single, 1, Form::Number { modulus }, order)
            }),
            self.rating.map(|rating| {
                let order = (Sets::Each, rating.repeats);
                composed(Shown::Single, 1, Form::Scales(rating.scales), order)
            }),
        ];
        known.into_iter().flatten().next().ok_or_else(|| {
            let mend = "add [presentation] and [response]";
            Flaw::new(("", 0, "experiment"), "nothing is asked", mend)
        })
    }
}

impl OddOneOut {
    fn composition(self) -> Composition {
        let words = ["easy", "normal", "hard"].map(str::to_owned);
        let words = words.into_iter().zip(self.weights).collect();
        let mut asked = composed(Shown::Places, 3, Form::Choice, (Sets::Triads, 1));
        asked.response.confidence = Confidence::Words(words);
        asked
    }
}

impl Judging {
    fn composition(self) -> Composition {
        let words = Form::Words(["real", "generated"].map(str::to_owned));
        let mut asked = match self.protocol {
            Protocol::Single => composed(Shown::Single, 1, words, (Sets::Each, self.repeats)),
            Protocol::Pair => composed(Shown::Pair, 2, Form::Choice, (Sets::Opposed, self.repeats)),
        };
        asked.response.right = Some(Right::Condition(self.real));
        asked.response.confidence = match self.confidence_grades {
            0 => Confidence::Unasked,
            grades => Confidence::Grades(grades),
        };
        asked
    }
}

impl Levels {
    fn composition(self) -> Result<Composition, Flaw> {
        let order = (Sets::Adapted, 1);
        let mut asked = composed(Shown::Intervals, self.intervals, Form::Choice, order);
        asked.presentation.interval_ms = self.interval_ms;
        let keys = AdaptationKeys {
            parameter: Tunable::Level,
            band_hz: Some(self.band_hz),
            reference: self.reference_db,
            range: self.range_db,
            seeks: Seeks::Difference,
            staircase: self.staircase,
            quest_plus: self.quest_plus,
            constant: self.constant,
            stop: self.stop,
        };
        asked.adaptation = Some(keys.adaptation(self.intervals)?);
        Ok(asked)
    }
}

fn composed(shown: Shown, n: usize, form: Form, (sets, repeats): (Sets, usize)) -> Composition {
    Composition {
        presentation: Presentation {
            shown,
            n,
            reference: Standard::None,
            standard: None,
            interval_ms: interval_ms(),
            masker_db: None,
            stylus: None,
            hangs: false,
        },
        question: Question::default(),
        response: Response {
            form,
            right: None,
            confidence: Confidence::Unasked,
        },
        order: Order {
            sets,
            repeats,
            sequence: Sequence::Random,
            catch_trials: 0,
        },
        adaptation: None,
    }
}

fn against(mut asked: Composition, reference: Standard) -> Composition {
    asked.presentation.reference = reference;
    asked
}
