//! What a composition amounts to: what it is called, asks in words and takes.

use super::{Adaptation, Composition, Form, Seeks, Sets, Shown, Standard};
use crate::named::named;
use selvedge_statistics::detection::Relation;

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
    /// How shares of right answers follow from d′; `None` where nothing is right, or a criterion
    /// decides with it.
    pub(crate) fn relation(&self) -> Option<Relation> {
        let has_criterion = matches!(self.response.form, Form::SameDifferent | Form::Words(_));
        match (self.kind(), self.order.sets) {
            (Kind::Ranking, _) => Some(Relation::Alternatives(4)),
            (Kind::OddOneOut, _) | (Kind::Choice, Sets::Triads) => Some(Relation::Triangle),
            (Kind::Choice, Sets::Targets) => Some(Relation::Abx),
            (Kind::Judgement | Kind::Choice, _) if !has_criterion => {
                u32::try_from(self.n_choices())
                    .ok()
                    .map(Relation::Alternatives)
            }
            _ => None,
        }
    }

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

    /// What a trial takes, s: what is played, and the median of an answer, which is assumed but
    /// that a ranking takes 30 to 90 s.
    pub fn trial_s(&self) -> [f64; 2] {
        let (n, sets) = (self.presentation.n as f64, self.order.sets);
        let is_played = self.presentation.shown == Shown::Intervals;
        let has_standard = self.presentation.standard.is_some();
        let is_compared = has_standard || self.presentation.reference != Standard::None;
        let n_shown = n + f64::from(u8::from(is_compared));
        let shown_s = f64::from(self.presentation.interval_ms) * n_shown / 1000.0;
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
        let adaptation = self.adaptation.as_ref();
        let has_reference = adaptation.is_some_and(|one| one.reference.is_some());
        let is_vibration = adaptation.is_some_and(Adaptation::is_vibration);
        match (self.order.sets, self.presentation.shown) {
            (Sets::Triads, _) if self.response.confidence.n_grades() > 0 => {
                "choose the odd one, then say how hard that was"
            }
            (Sets::Triads, _) => "choose the odd one",
            (Sets::Opposed, _) => "choose the one that is real",
            (Sets::Targets, _) => "choose the one that is the same as the target",
            (Sets::Adapted, Shown::Intervals) if has_reference && is_vibration => {
                "choose the interval with the stronger vibration"
            }
            (Sets::Adapted, Shown::Intervals) if is_vibration => {
                "choose the interval with the vibration"
            }
            (_, Shown::Intervals) => "choose the interval with more",
            _ => "choose the one with more",
        }
    }
}
