//! Answers as they are typed, one line each.

use std::str::FromStr;

use crate::design::{Design, Method, Scale, TunedParameter};
use crate::trial::{Answer, AnswerError, Grade, N_RANKED, N_TRIAD, Task};

/// How an answer is typed, as an imperative with an example.
pub fn form(design: &Design, task: &Task) -> String {
    match task {
        Task::Rank { .. } => {
            "type the rank of each position, 1 for the one most like the target: 2 1 3 4".to_owned()
        }
        Task::OddOne { .. } => {
            "type the odd position, and how hard that was: 2 easy, 2 normal or 2 hard".to_owned()
        }
        Task::Adjust { .. } => adjusted_form(design.method.parameters()),
        Task::Judge { .. } => match design.method.confidence_grades() {
            0 => "type real or generated".to_owned(),
            most => format!("type real or generated, and how sure from 1 to {most}: real {most}"),
        },
        Task::JudgePair { .. } => match design.method.confidence_grades() {
            0 => "type the position of the real one: 1 or 2".to_owned(),
            most => format!(
                "type the position of the real one, and how sure from 1 to {most}: 1 {most}"
            ),
        },
        Task::Interval { .. } => format!("type the interval: 1 to {}", intervals(design)),
        Task::Estimate { .. } => match design.method {
            Method::Magnitude {
                modulus: Some(modulus),
                ..
            } => format!("type a number above 0 for how strong it is; the first was {modulus}"),
            _ => "type a number above 0 for how strong it is: 12.5".to_owned(),
        },
        Task::Rate { .. } => rating_form(design.method.scales()),
    }
}

/// The answer that a line holds.
///
/// # Errors
/// It answers another question, or none: what is wrong, and how it is typed.
pub fn typed_answer(design: &Design, task: &Task, line: &str) -> Result<Answer, AnswerError> {
    let words: Vec<&str> = line.split_whitespace().collect();
    let described = Told {
        line: line.trim(),
        words: &words,
        form: form(design, task),
    };
    let grades = design.method.confidence_grades();
    let answer = match task {
        Task::Rank { .. } => described.ranks()?,
        Task::OddOne { .. } => described.odd()?,
        Task::Adjust { .. } => described.adjusted(design.method.parameters())?,
        Task::Judge { .. } => {
            let word = described.words.first().copied().unwrap_or_default();
            let known = ["real", "generated"];
            let said = known.iter().position(|known| is_short_for(word, known));
            Answer::Judged {
                is_real: said.ok_or_else(|| described.wrong())? == 0,
                confidence: described.confidence(grades)?,
            }
        }
        Task::JudgePair { .. } => Answer::Chosen {
            position: described.position(2)?,
            confidence: described.confidence(grades)?,
        },
        Task::Interval { .. } => Answer::Chosen {
            position: described.position(intervals(design))?,
            confidence: described.confidence(0)?,
        },
        Task::Estimate { .. } => Answer::Magnitude(described.numbers(1)?[0]),
        Task::Rate { .. } => described.ratings(design.method.scales())?,
    };
    task.verdict(&answer)?;
    Ok(answer)
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

    /// Four ranks: `2 1 3 4`, `2,1,3,4` or `2134`.
    fn ranks(&self) -> Result<Answer, AnswerError> {
        let letters = self.line.chars();
        let letters = letters.filter(|c| !c.is_whitespace() && *c != ',');
        let digit = |c: char| u8::try_from(c.to_digit(10)?).ok();
        let digits: Option<Vec<u8>> = letters.map(digit).collect();
        let ranks = digits.and_then(|digits| <[u8; N_RANKED]>::try_from(digits).ok());
        ranks.map(Answer::Ranks).ok_or_else(|| self.wrong())
    }

    fn odd(&self) -> Result<Answer, AnswerError> {
        let position = self.position(N_TRIAD)?;
        let [_, word] = self.words else {
            return Err(self.wrong());
        };
        let mut grades = Grade::ALL.into_iter();
        let grade = grades.find(|grade| is_short_for(word, grade.name()));
        let grade = grade.ok_or_else(|| self.wrong())?;
        Ok(Answer::Odd { position, grade })
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
        Ok(Answer::Adjusted { values, steps })
    }

    fn ratings(&self, scales: &[Scale]) -> Result<Answer, AnswerError> {
        let values = self.numbers(scales.len())?;
        for (scale, &value) in scales.iter().zip(&values) {
            check_rating(scale, value)?;
        }
        Ok(Answer::Ratings(values))
    }

    /// The first word as a position from 1, from 0.
    fn position(&self, n: usize) -> Result<usize, AnswerError> {
        let position: usize = self.parsed(0)?;
        let position = position.checked_sub(1).filter(|position| *position < n);
        position.ok_or_else(|| self.wrong())
    }

    /// The second word as a grade of confidence, which is asked for where there are grades.
    fn confidence(&self, most: u8) -> Result<Option<u8>, AnswerError> {
        if most == 0 {
            let is_alone = self.words.len() == 1;
            return is_alone.then_some(None).ok_or_else(|| self.wrong());
        }
        let grade: u8 = self.parsed(1)?;
        let is_grade = (1..=most).contains(&grade) && self.words.len() == 2;
        is_grade.then_some(Some(grade)).ok_or_else(|| self.wrong())
    }

    /// Exactly `n` finite numbers.
    fn numbers(&self, n: usize) -> Result<Vec<f64>, AnswerError> {
        if self.words.len() != n {
            return Err(self.wrong());
        }
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
    !word.is_empty() && whole.starts_with(&word.to_ascii_lowercase())
}

fn intervals(design: &Design) -> usize {
    design.method.levels().map_or(0, |levels| levels.intervals)
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
        typed_answer(&design, &task, line).map_err(|error| error.to_string())
    }

    #[test]
    fn each_method_has_an_answer_of_one_line() {
        let ranks = Ok(Answer::Ranks([2, 1, 3, 4]));
        for line in ["2 1 3 4", "2,1,3,4", " 2134 "] {
            assert_eq!(typed("ranking-virtual-target", line), ranks);
        }
        let odd = Answer::Odd {
            position: 1,
            grade: Grade::Easy,
        };
        assert_eq!(typed("odd-one-out", "2 easy"), Ok(odd.clone()));
        assert_eq!(typed("odd-one-out", "2 E"), Ok(odd));
        let judged = Answer::Judged {
            is_real: true,
            confidence: Some(3),
        };
        assert_eq!(typed("real-or-generated", "real 3"), Ok(judged));
        let adjusted = Answer::Adjusted {
            values: vec![-3.0, 4.5],
            steps: Vec::new(),
        };
        assert_eq!(
            typed("adjustment-two-gains", "-3 4.5"),
            Ok(adjusted.clone())
        );
        assert_eq!(typed("adjustment-two-gains", "−3 4.5"), Ok(adjusted));
        assert_eq!(typed("magnitude", "12.5"), Ok(Answer::Magnitude(12.5)));
        let rated = Answer::Ratings(vec![0.0, 50.0, 99.5, 100.0]);
        assert_eq!(typed("rating", "0 50 99.5 100"), Ok(rated));
    }

    #[test]
    fn what_is_no_answer_is_told_how_it_is_typed() {
        for (name, line, expected) in [
            ("ranking-virtual-target", "1 2 3", "2 1 3 4"),
            (
                "ranking-virtual-target",
                "1 1 3 4",
                "each of 1, 2, 3 and 4 once",
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
        let task = Task::Interval {
            track: 0,
            level_db: 3.0,
            signal: 0,
        };
        let n = intervals(&design);
        let last = typed_answer(&design, &task, &n.to_string());
        let chosen = Answer::Chosen {
            position: n - 1,
            confidence: None,
        };
        assert_eq!(last, Ok(chosen));
        assert!(typed_answer(&design, &task, &(n + 1).to_string()).is_err());
        assert!(typed_answer(&design, &task, "0").is_err());
    }
}
