//! Answers by keys, wherever the pointer is.

use eframe::egui::{Key, Ui};

use crate::tools::experiment::draft::Act;
use crate::tools::experiment::draft::{Draft, Mark};
use crate::tools::experiment::view::TrialView;
use selvedge_experiment::Grade;

/// Keys of positions, from the first.
const DIGITS: [Key; 8] = [
    Key::Num1,
    Key::Num2,
    Key::Num3,
    Key::Num4,
    Key::Num5,
    Key::Num6,
    Key::Num7,
    Key::Num8,
];
/// Keys of grades, from easy to hard.
const GRADES: [Key; 3] = [Key::E, Key::N, Key::H];

/// Keys that belong to whatever has the focus.
const ARROWS: [Key; 4] = [
    Key::ArrowUp,
    Key::ArrowDown,
    Key::ArrowLeft,
    Key::ArrowRight,
];

/// Takes the keys that were pressed, unless words are being typed. Enter, Space and arrows belong
/// to a button or line that has the focus.
pub(crate) fn take(ui: &Ui, trial: &TrialView<'_>, acts: &mut Vec<Act>) {
    if ui.ctx().text_edit_focused() {
        return;
    }
    let is_free = ui.memory(|memory| memory.focused().is_none());
    let is_own = |key: Key| {
        let is_taken = ARROWS.contains(&key) || matches!(key, Key::Enter | Key::Space);
        is_free || !is_taken
    };
    let is_pressed = |key| is_own(key) && ui.input(|input| input.key_pressed(key));
    for mark in marks(trial.draft, is_pressed) {
        acts.push(Act::Mark(mark));
    }
    if is_pressed(Key::Enter) && trial.refusal().is_none() {
        acts.push(Act::Answer);
    }
    if is_pressed(Key::Space) && trial.may_play {
        acts.push(Act::Play);
    }
}

/// Which keys answer, for whoever has no pointer.
pub(crate) fn hint(trial: &TrialView<'_>) -> String {
    let sure = |n_grades: u8| match n_grades {
        0 => String::new(),
        n => format!(", then 1 to {n} for how sure you are"),
    };
    let keys = match trial.draft {
        Draft::Nothing => return String::new(),
        Draft::Ranks(_) => "1 to 4 in order, Backspace takes back".to_owned(),
        Draft::Odd { .. } => "1 to 3, then E, N or H".to_owned(),
        Draft::Choose { n, sure: said, .. } => format!("1 to {n}{}", sure(said.n_grades)),
        Draft::Judge { sure: said, .. } => format!("R or G{}", sure(said.n_grades)),
        Draft::Adjust { parameters, .. } => match parameters.len() {
            0 | 1 => "up and down".to_owned(),
            _ => "up and down, left and right".to_owned(),
        },
        Draft::Magnitude(_) => "digits".to_owned(),
        Draft::Ratings { .. } => "left and right, Tab for the next scale".to_owned(),
    };
    let end = if trial.ends_at_once() {
        ""
    } else {
        ", Enter for Done"
    };
    let again = if trial.may_play {
        ", Space for Again"
    } else {
        ""
    };
    format!("Keys: {keys}{again}{end}")
}

/// What the keys say in this trial.
fn marks(draft: &Draft, is_pressed: impl Fn(Key) -> bool) -> Vec<Mark> {
    let digits = || (0..).zip(DIGITS).filter(|(_, key)| is_pressed(*key));
    let mut marks = Vec::new();
    match draft {
        Draft::Ranks(_) => {
            marks.extend(digits().map(|(at, _)| Mark::Place(at)));
            if is_pressed(Key::Backspace) {
                marks.push(Mark::TakeBack);
            }
        }
        Draft::Odd { .. } => {
            marks.extend(digits().map(|(at, _)| Mark::Place(at)));
            let grades = GRADES.into_iter().zip(Grade::ALL);
            let said = grades.filter(|(key, _)| is_pressed(*key));
            marks.extend(said.map(|(_, grade)| Mark::Grade(grade)));
        }
        Draft::Choose { position, sure, .. } => {
            // Once one is chosen, digits say how sure that is.
            let is_sure = position.is_some() && sure.n_grades > 0;
            let mark = |at: usize| match (is_sure, u8::try_from(at + 1)) {
                (true, Ok(grade)) => Mark::Confidence(grade),
                _ => Mark::Place(at),
            };
            marks.extend(digits().map(|(at, _)| mark(at)));
        }
        Draft::Judge { .. } => {
            let words = [(Key::R, true), (Key::G, false)];
            let said = words.into_iter().filter(|(key, _)| is_pressed(*key));
            marks.extend(said.map(|(_, is_real)| Mark::Real(is_real)));
            let sure = digits().filter_map(|(at, _)| u8::try_from(at + 1).ok());
            marks.extend(sure.map(Mark::Confidence));
        }
        Draft::Adjust { .. } => {
            let turns = [
                (Key::ArrowUp, 0, 1),
                (Key::ArrowDown, 0, -1),
                (Key::ArrowRight, 1, 1),
                (Key::ArrowLeft, 1, -1),
            ];
            let turned = turns.into_iter().filter(|(key, ..)| is_pressed(*key));
            marks.extend(turned.map(|(_, parameter, by)| Mark::Turn(parameter, by)));
        }
        Draft::Nothing | Draft::Magnitude(_) | Draft::Ratings { .. } => {}
    }
    marks
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tools::experiment::draft::Sure;

    #[test]
    fn digits_choose_first_and_then_say_how_sure() {
        let draft = |position| Draft::Choose {
            n: 2,
            position,
            sure: Sure {
                n_grades: 3,
                grade: None,
            },
        };
        let two = |key| key == Key::Num2;
        assert_eq!(marks(&draft(None), two), [Mark::Place(1)]);
        assert_eq!(marks(&draft(Some(0)), two), [Mark::Confidence(2)]);
        let ranked = Draft::Ranks([None; 4]);
        assert_eq!(
            marks(&ranked, |key| key == Key::Backspace),
            [Mark::TakeBack]
        );
    }

    #[test]
    fn the_keys_that_answer_are_named() {
        let draft = Draft::Judge {
            is_real: None,
            sure: Sure {
                n_grades: 3,
                grade: None,
            },
        };
        let ground = crate::tools::experiment::view::Ground {
            size_mm: [100.0; 2],
            slots: Vec::new(),
            picture: None,
            finger: None,
            feels: true,
        };
        let trial = TrialView {
            ground,
            question: String::new(),
            draft: &draft,
            is_open: true,
            missing: None,
            intervals: None,
            may_play: false,
        };
        let words = "Keys: R or G, then 1 to 3 for how sure you are, Enter for Done";
        assert_eq!(hint(&trial), words);
    }
}
