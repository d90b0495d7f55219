//! Answers by keys, wherever the pointer is.

use eframe::egui::{Event, Key, Modifiers, Ui};

use crate::tools::experiment::draft::Act;
use crate::tools::experiment::draft::{Draft, Mark, Sure};
use crate::tools::experiment::view::TrialView;

/// Keys of positions, from the first.
const DIGITS: [Key; 9] = [
    Key::Num1,
    Key::Num2,
    Key::Num3,
    Key::Num4,
    Key::Num5,
    Key::Num6,
    Key::Num7,
    Key::Num8,
    Key::Num9,
];
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

/// Takes Space away from the field that has the focus, in which no number has one: it plays again.
pub(super) fn take_space(ui: &Ui, trial: &TrialView<'_>, acts: &mut Vec<Act>) {
    if !trial.may_play || !ui.ctx().text_edit_focused() {
        return;
    }
    let is_pressed = ui.input_mut(|input| {
        let is_blank = |event: &Event| matches!(event, Event::Text(text) if text == " ");
        input.events.retain(|event| !is_blank(event));
        input.consume_key(Modifiers::NONE, Key::Space)
    });
    if is_pressed {
        acts.push(Act::Play);
    }
}

/// Which keys answer, for whoever has no pointer; once all is answered, what it still waits for.
pub(crate) fn hint(trial: &TrialView<'_>) -> String {
    let missing = trial.missing.as_deref().filter(|what| !what.is_empty());
    if let (Some(what), Ok(_)) = (missing, trial.draft.answer()) {
        return format!("Not yet: {what}");
    }
    let keys = match trial.draft {
        Draft::Nothing => return String::new(),
        Draft::Order(order) if order.has_ends_alone => {
            let [best, worst] = &order.ends;
            format!(
                "1 to {}, the {best} one, then the {worst} one; Backspace takes back",
                order.n
            )
        }
        Draft::Order(order) => format!("1 to {} in order, Backspace takes back", order.n),
        Draft::Choose { n, words, sure, .. } => {
            let [positions, grades] = choice_keys((*n, words), sure);
            match (names(&positions), names(&grades)) {
                (choice, sure) if sure.is_empty() => choice,
                (choice, grade) if sure.words.is_empty() => {
                    format!("{choice}, then {grade} for how sure you are")
                }
                (choice, grade) => format!("{choice}, then {grade}"),
            }
        }
        Draft::Piles(_) => "Tab for the next one, Space for its pile".to_owned(),
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
    let moving = if trial.is_felt_in_turn() {
        ". Each is felt once: keep moving while it is lit"
    } else {
        ""
    };
    format!("Keys: {keys}{again}{end}{moving}")
}

/// The keys of positions or words, and those of grades. Where both are digits, they choose first.
fn choice_keys((n, words): (usize, &[String]), sure: &Sure) -> [Vec<Key>; 2] {
    let digits = |n: usize| DIGITS.into_iter().take(n).collect();
    let positions: Vec<Key> = letters(words, &[]).unwrap_or_else(|| digits(n));
    let grades = letters(&sure.words, &positions);
    let grades = grades.unwrap_or_else(|| digits(usize::from(sure.n_grades)));
    [positions, grades]
}

/// The key of each word: its first letter that is a key and no other word's; `None` where there are
/// no words, or one has no such letter.
fn letters(words: &[String], taken: &[Key]) -> Option<Vec<Key>> {
    let mut keys = taken.to_vec();
    for word in words {
        let letters = word
            .chars()
            .map(|letter| letter.to_ascii_uppercase().to_string());
        let mut known = letters.filter_map(|letter| Key::from_name(&letter));
        keys.push(known.find(|key| !keys.contains(key))?);
    }
    (!words.is_empty()).then(|| keys.split_off(taken.len()))
}

/// Those keys as a sentence has them: `E, N or H`, `1 to 3`.
fn names(keys: &[Key]) -> String {
    let keys: Vec<&str> = keys.iter().map(|key| key.name()).collect();
    match keys.as_slice() {
        ["1", .., last] => format!("1 to {last}"),
        [others @ .., last] if !others.is_empty() => format!("{} or {last}", others.join(", ")),
        keys => keys.concat(),
    }
}

/// What the keys say in this trial.
fn marks(draft: &Draft, is_pressed: impl Fn(Key) -> bool) -> Vec<Mark> {
    let digits = || (0..).zip(DIGITS).filter(|(_, key)| is_pressed(*key));
    let mut marks = Vec::new();
    match draft {
        Draft::Order(_) => {
            marks.extend(digits().map(|(at, _)| Mark::Place(at)));
            if is_pressed(Key::Backspace) {
                marks.push(Mark::TakeBack);
            }
        }
        Draft::Choose {
            n,
            words,
            position,
            sure,
        } => {
            let [positions, grades] = choice_keys((*n, words), sure);
            let is_shared = positions.first() == grades.first();
            let is_next = is_shared && position.is_some();
            if !is_next {
                let pressed = (0..).zip(positions).filter(|(_, key)| is_pressed(*key));
                marks.extend(pressed.map(|(at, _)| Mark::Place(at)));
            }
            if is_next || !is_shared {
                let pressed = (1..).zip(grades).filter(|(_, key)| is_pressed(*key));
                marks.extend(pressed.map(|(grade, _)| Mark::Confidence(grade)));
            }
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
        Draft::Nothing | Draft::Magnitude(_) | Draft::Ratings { .. } | Draft::Piles(_) => {}
    }
    marks
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tools::experiment::draft::Order;

    #[test]
    fn digits_choose_first_and_then_say_how_sure() {
        let sure = || Sure {
            n_grades: 3,
            ..Sure::default()
        };
        let draft = |position| Draft::Choose {
            n: 2,
            words: Vec::new(),
            position,
            sure: sure(),
        };
        let two = |key| key == Key::Num2;
        assert_eq!(marks(&draft(None), two), [Mark::Place(1)]);
        assert_eq!(marks(&draft(Some(0)), two), [Mark::Confidence(2)]);
        let words = ["easy", "normal", "hard"].map(str::to_owned);
        let graded = Draft::Choose {
            n: 3,
            words: Vec::new(),
            position: Some(0),
            sure: Sure {
                words: words.to_vec(),
                ..sure()
            },
        };
        assert_eq!(marks(&graded, two), [Mark::Place(1)], "grades have letters");
        let hard = |key| key == Key::H;
        assert_eq!(marks(&graded, hard), [Mark::Confidence(3)]);
        let ranked = Draft::Order(Order {
            n: 4,
            slots: vec![None; 4],
            ends: [String::new(), String::new()],
            has_ends_alone: false,
        });
        assert_eq!(
            marks(&ranked, |key| key == Key::Backspace),
            [Mark::TakeBack]
        );
    }

    #[test]
    fn the_keys_that_answer_are_named() {
        let draft = Draft::Choose {
            n: 2,
            words: ["real", "generated"].map(str::to_owned).to_vec(),
            position: None,
            sure: Sure {
                n_grades: 3,
                ..Sure::default()
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
        let mut answered = draft.clone();
        answered.take(&Mark::Place(0), 0.0);
        answered.take(&Mark::Confidence(1), 0.0);
        let waits = TrialView {
            draft: &answered,
            missing: Some("number 1 was not felt for 1 s yet".to_owned()),
            ..trial
        };
        assert_eq!(hint(&waits), "Not yet: number 1 was not felt for 1 s yet");
    }

    #[test]
    fn no_key_is_two_words_and_words_without_letters_have_digits() {
        let words = |words: &[&str]| words.iter().map(|word| (*word).to_owned()).collect();
        let keys = |choices: &[&str], grades: &[&str]| {
            let choices: Vec<String> = words(choices);
            let sure = Sure {
                n_grades: 3,
                words: words(grades),
                grade: None,
            };
            choice_keys((2, &choices), &sure).map(|keys| names(&keys))
        };
        let grades = ["easy", "normal", "hard"];
        assert_eq!(keys(&["yes", "no"], &grades), ["Y or N", "E, O or H"]);
        assert_eq!(keys(&["да", "нет"], &grades), ["1 to 2", "E, N or H"]);
        assert_eq!(keys(&["yes", "yes"], &[]), ["Y or E", "1 to 3"]);
    }
}
