//! Answers as they are typed, one line each.

use std::str::FromStr;

use super::present::place;
use crate::design::{Composition, Confidence, Design, Form, Kind, Scale, Sets, TunedParameter};
use crate::trial::{Answer, AnswerError, AnswerValue, Task};

/// How an answer is typed, as an imperative with an example.
pub fn form(design: &Design) -> String {
    let composition = &design.composition;
    let n = composition.presentation.n;
    let order = (1..=n).cycle().skip(1).take(n).map(|at| at.to_string());
    let order = order.collect::<Vec<_>>().join(" ");
    match &composition.response.form {
        Form::Choice => choice_form(composition),
        Form::Words([yes, no]) => words_form(composition, [yes, no]),
        Form::SameDifferent => words_form(composition, ["same", "different"]),
        Form::Rank if composition.order.sets == Sets::Targets => {
            format!("type the positions in order, the one most like the target first: {order}")
        }
        Form::Rank => format!("type the positions in order, the first first: {order}"),
        Form::BestWorst([best, worst]) => {
            format!("type the position of the {best} one, then that of the {worst} one: 2 1")
        }
        Form::Scales(scales) => rating_form(scales),
        Form::Number {
            modulus: Some(modulus),
        } if composition.presentation.standard.is_some() => {
            format!("type a number above 0 for how strong it is; the standard is {modulus}")
        }
        Form::Number {
            modulus: Some(modulus),
        } => {
            format!("type a number above 0 for how strong it is; the first was {modulus}")
        }
        Form::Number { .. } if composition.kind() == Kind::Dissimilarity => {
            "type a number above 0 for how unlike they are: 12.5".to_owned()
        }
        Form::Number { .. } => "type a number above 0 for how strong it is: 12.5".to_owned(),
        Form::Piles => format!("type the positions pile by pile, / between: 1 {n} / 2"),
        Form::Adjustment(parameters) => adjusted_form(parameters),
    }
}

fn choice_form(composition: &Composition) -> String {
    let n = composition.presentation.n;
    let place = place(composition);
    let what = match composition.order.sets {
        Sets::Triads => format!("the odd {place}"),
        Sets::Opposed => format!("the {place} of the real one"),
        _ => format!("the {place}"),
    };
    match &composition.response.confidence {
        Confidence::Unasked if n == 2 => format!("type {what}: 1 or 2"),
        Confidence::Unasked => format!("type {what}: 1 to {n}"),
        Confidence::Grades(most) => {
            format!("type {what}, and how sure from 1 to {most}: 1 {most}")
        }
        Confidence::Words(words) => {
            let examples: Vec<String> = words.iter().map(|(word, _)| format!("2 {word}")).collect();
            format!("type {what}, and how hard that was: {}", either(&examples))
        }
    }
}

fn words_form(composition: &Composition, [yes, no]: [&str; 2]) -> String {
    match composition.response.confidence.n_grades() {
        0 => format!("type {yes} or {no}"),
        most => format!("type {yes} or {no}, and how sure from 1 to {most}: {yes} {most}"),
    }
}

/// `a, b or c`.
fn either(all: &[String]) -> String {
    match all {
        [others @ .., last] if !others.is_empty() => format!("{} or {last}", others.join(", ")),
        all => all.concat(),
    }
}

impl Answer {
    /// The answer that a line holds.
    ///
    /// # Errors
    /// It answers another question, or none: what is wrong, and how it is typed.
    pub fn typed(design: &Design, task: &Task, line: &str) -> Result<Self, AnswerError> {
        let words: Vec<&str> = line.split_whitespace().collect();
        let described = Told {
            line: line.trim(),
            words: &words,
            form: form(design),
        };
        let composition = &design.composition;
        let n = composition.presentation.n;
        let confidence = &composition.response.confidence;
        let answer = match &composition.response.form {
            Form::Choice => {
                let position = described.position(0, n)?;
                Self::chosen(position, described.confidence(confidence)?)
            }
            Form::Words(_) | Form::SameDifferent => {
                let known = composition.words().unwrap_or_default();
                let at = described.word(0, &known)?;
                Self::chosen(at, described.confidence(confidence)?)
            }
            Form::Rank => described.order(n)?,
            Form::BestWorst(_) => {
                let ends = [described.position(0, n)?, described.position(1, n)?];
                described.only(2)?;
                AnswerValue::BestWorst(ends).into()
            }
            Form::Scales(scales) => described.ratings(scales)?,
            Form::Number { .. } => AnswerValue::Number(described.numbers(1)?[0]).into(),
            Form::Piles => described.piles(n)?,
            Form::Adjustment(parameters) => described.adjusted(parameters)?,
        };
        composition.verdict(task, &answer)?;
        Ok(answer)
    }
}

/// A line, its words, and how it should have been typed.
struct Told<'a> {
    line: &'a str,
    words: &'a [&'a str],
    form: String,
}

impl Told<'_> {
    fn wrong(&self) -> AnswerError {
        let what = match self.line {
            "" => "nothing was typed".to_owned(),
            line => format!("{line:?} is no answer"),
        };
        AnswerError::value(what, self.form.clone())
    }

    /// Positions in order: `2 1 3 4`, `2,1,3,4` or `2134`.
    fn order(&self, n: usize) -> Result<Answer, AnswerError> {
        let letters = self.line.chars();
        let letters = letters.filter(|c| !c.is_whitespace() && *c != ',');
        let digit = |c: char| usize::try_from(c.to_digit(10)?).ok()?.checked_sub(1);
        let positions: Option<Vec<usize>> = letters.map(digit).collect();
        let positions = positions.ok_or_else(|| self.wrong())?;
        let mut sorted = positions.clone();
        sorted.sort_unstable();
        if !sorted.iter().copied().eq(0..n) {
            let what = format!("{:?} is not each position once", self.line);
            return Err(AnswerError::value(what, self.form.clone()));
        }
        Ok(Answer::in_order(&positions))
    }

    /// Positions pile by pile: `1 4 / 2 3 / 5`.
    fn piles(&self, n: usize) -> Result<Answer, AnswerError> {
        let mut piles = vec![None; n];
        for (pile, positions) in self.line.split('/').enumerate() {
            for word in positions.split_whitespace() {
                let at = word.parse::<usize>().ok().and_then(|at| at.checked_sub(1));
                let slot = at
                    .and_then(|at| piles.get_mut(at))
                    .filter(|slot| slot.is_none());
                *slot.ok_or_else(|| self.wrong())? = Some(pile);
            }
        }
        let piles: Option<Vec<usize>> = piles.into_iter().collect();
        piles
            .map(|piles| Answer::in_piles(&piles))
            .ok_or_else(|| self.wrong())
    }

    fn adjusted(&self, parameters: &[TunedParameter]) -> Result<Answer, AnswerError> {
        let values = self.numbers(parameters.len())?;
        for (parameter, value) in parameters.iter().zip(&values) {
            if !(parameter.from..=parameter.to).contains(value) {
                let what = format!("{} is {value}", parameter.what.name());
                let mend = format!("stay between {} and {}", parameter.from, parameter.to);
                return Err(AnswerError::value(what, mend));
            }
        }
        // Nobody saw how they came there.
        let steps = Vec::new();
        Ok(AnswerValue::Adjusted { values, steps }.into())
    }

    fn ratings(&self, scales: &[Scale]) -> Result<Answer, AnswerError> {
        let values = self.numbers(scales.len())?;
        for (scale, &value) in scales.iter().zip(&values) {
            check_rating(scale, value)?;
        }
        Ok(AnswerValue::Ratings(values).into())
    }

    /// A word as a position from 1, from 0.
    fn position(&self, at: usize, n: usize) -> Result<usize, AnswerError> {
        let position: usize = self.parsed(at)?;
        let position = position.checked_sub(1).filter(|position| *position < n);
        position.ok_or_else(|| self.wrong())
    }

    /// A word, or its beginning, as one of those that are known.
    fn word(&self, at: usize, known: &[&str]) -> Result<usize, AnswerError> {
        let word = self.words.get(at).copied().unwrap_or_default();
        let found = known.iter().position(|known| is_short_for(word, known));
        found.ok_or_else(|| self.wrong())
    }

    /// The second word as a grade of confidence, which is asked for where there are grades.
    fn confidence(&self, asked: &Confidence) -> Result<Option<u8>, AnswerError> {
        let most = asked.n_grades();
        if most == 0 {
            return self.only(1).map(|()| None);
        }
        self.only(2)?;
        if let Confidence::Words(_) = asked {
            let at = self.word(1, &asked.words())?;
            return Ok(u8::try_from(at + 1).ok());
        }
        let grade: u8 = self.parsed(1)?;
        let is_grade = (1..=most).contains(&grade);
        is_grade.then_some(Some(grade)).ok_or_else(|| self.wrong())
    }

    /// Refuses fewer and more words.
    fn only(&self, n: usize) -> Result<(), AnswerError> {
        let is_right = self.words.len() == n;
        is_right.then_some(()).ok_or_else(|| self.wrong())
    }

    /// Exactly `n` finite numbers.
    fn numbers(&self, n: usize) -> Result<Vec<f64>, AnswerError> {
        self.only(n)?;
        let number = |at: usize| {
            let value = Some(self.parsed(at)?).filter(|value: &f64| value.is_finite());
            value.ok_or_else(|| self.wrong())
        };
        (0..n).map(number).collect()
    }

    fn parsed<T: FromStr>(&self, at: usize) -> Result<T, AnswerError> {
        let word = self.words.get(at).ok_or_else(|| self.wrong())?;
        let value = word.replace('−', "-").parse().ok();
        value.ok_or_else(|| self.wrong())
    }
}

fn check_rating(scale: &Scale, value: f64) -> Result<(), AnswerError> {
    let [low, high] = scale.bounds();
    let is_point = scale.points == 0 || value.fract().abs() < f64::EPSILON;
    if (low..=high).contains(&value) && is_point {
        return Ok(());
    }
    let whole = if scale.points == 0 { "" } else { " whole" };
    let what = format!("{value} is no place on {}", scale.key);
    let mend = format!("give a{whole} number from {low} to {high}");
    Err(AnswerError::value(what, mend))
}

/// Whether a word begins a longer one: `e`, `easy`; case is ignored.
fn is_short_for(word: &str, whole: &str) -> bool {
    !word.is_empty() && whole.to_lowercase().starts_with(&word.to_lowercase())
}

fn adjusted_form(parameters: &[TunedParameter]) -> String {
    let described = parameters.iter().map(|parameter| {
        let name = parameter.what.name();
        format!("{name} ({} to {})", parameter.from, parameter.to)
    });
    let described = described.collect::<Vec<_>>().join(" ");
    format!("type what was left: {described}")
}

fn rating_form(scales: &[Scale]) -> String {
    let described = scales.iter().map(|scale| {
        let [low, high] = scale.bounds();
        let (begin, end) = (&scale.low, &scale.high);
        format!("{} ({low} {begin} … {high} {end})", scale.key)
    });
    let described = described.collect::<Vec<_>>().join(", ");
    format!("type a number for each: {described}")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::design::Subject;
    use crate::{Course, Step};

    /// A shipped design and its first trial's task.
    fn first(name: &str) -> (Design, Task) {
        let design = Design::shipped(name).unwrap();
        let subject = Subject {
            pseudonym: "p".to_owned(),
            nth: 0,
            session: 1,
        };
        let mut course = Course::begin(&design, &subject).unwrap();
        while !matches!(course.step(), Step::Trial(_)) {
            course.pass();
        }
        let Step::Trial(trial) = course.step() else {
            panic!("no trial");
        };
        let task = trial.task.clone();
        (design, task)
    }

    fn typed(name: &str, line: &str) -> Result<Answer, String> {
        let (design, task) = first(name);
        Answer::typed(&design, &task, line).map_err(|error| error.to_string())
    }

    #[test]
    fn each_method_has_an_answer_of_one_line() {
        let ranks = Ok(AnswerValue::Ranks(vec![4, 1, 2, 3]).into());
        for line in ["2 3 4 1", "2,3,4,1", " 2341 "] {
            assert_eq!(
                typed("ranking-virtual-target", line),
                ranks,
                "2 is the first"
            );
        }
        let odd = Answer::chosen(1, Some(1));
        assert_eq!(typed("odd-one-out", "2 easy"), Ok(odd.clone()));
        assert_eq!(typed("odd-one-out", "2 E"), Ok(odd));
        let judged = Answer::chosen(0, Some(3));
        assert_eq!(typed("real-or-generated", "real 3"), Ok(judged));
        let (values, steps) = (vec![-3.0, 4.5], Vec::new());
        let adjusted: Answer = AnswerValue::Adjusted { values, steps }.into();
        assert_eq!(
            typed("adjustment-two-gains", "-3 4.5"),
            Ok(adjusted.clone())
        );
        assert_eq!(typed("adjustment-two-gains", "−3 4.5"), Ok(adjusted));
        assert_eq!(
            typed("magnitude", "12.5"),
            Ok(AnswerValue::Number(12.5).into())
        );
        let rated = AnswerValue::Ratings(vec![0.0, 50.0, 99.5, 100.0]);
        assert_eq!(typed("rating", "0 50 99.5 100"), Ok(rated.into()));
    }

    #[test]
    fn what_is_no_answer_is_told_how_it_is_typed() {
        for (name, line, expected) in [
            ("ranking-virtual-target", "1 2 3", "2 3 4 1"),
            (
                "ranking-virtual-target",
                "1 1 3 4",
                "not each position once",
            ),
            ("odd-one-out", "", "nothing was typed"),
            ("odd-one-out", "4 easy", "2 easy, 2 normal or 2 hard"),
            ("odd-one-out", "2", "2 easy"),
            ("odd-one-out", "2 easily", "2 easy"),
            ("real-or-generated", "real", "from 1 to 3"),
            ("real-or-generated", "real 4", "from 1 to 3"),
            ("adjustment-two-gains", "-25 0", "stay between -24 and 24"),
            ("adjustment-two-gains", "1", "gain_40_db (-24 to 24)"),
            ("magnitude", "0", "above 0"),
            ("magnitude", "12,5", "12.5"),
            ("rating", "0 50 99.5 101", "from 0 to 100"),
            ("rating", "0 50 NaN 1", "roughness (0 smooth … 100 rough)"),
        ] {
            let described = typed(name, line).unwrap_err();
            assert!(described.contains(expected), "{name} {line:?}: {described}");
            assert!(!described.contains('\n'), "{described}");
        }
    }

    #[test]
    fn an_interval_that_the_design_does_not_have_is_refused() {
        let design = Design::shipped("threshold-40").unwrap();
        let n = design.composition.presentation.n;
        let (_, task) = first("threshold-40");
        let last = Answer::typed(&design, &task, &n.to_string());
        assert_eq!(last, Ok(Answer::chosen(n - 1, None)));
        assert!(Answer::typed(&design, &task, &(n + 1).to_string()).is_err());
        assert!(Answer::typed(&design, &task, "0").is_err());
    }
}
