//! The participant's view under the hands of a simulated participant.

use eframe::egui::{Key, vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT as _, Queryable as _};

use super::*;
use crate::tools::experiment::draft::{Draft, Mark, Order, Sure};
use crate::tools::experiment::in_turn::Intervals;
use crate::tools::experiment::view::Ground;

fn trial(draft: &Draft) -> TrialView<'_> {
    TrialView {
        ground: Ground {
            size_mm: [340.0; 2],
            slots: Vec::new(),
            picture: None,
            finger: None,
            feels: true,
        },
        question: "put all 4 in order, the one most like the target first".to_owned(),
        draft,
        is_open: true,
        missing: None,
        intervals: None,
        may_play: false,
    }
}

/// Four that are put in order by their likeness to a target.
fn in_order(slots: [Option<usize>; 4]) -> Draft {
    Draft::Order(Order {
        n: 4,
        slots: slots.to_vec(),
        ends: ["most alike", "least alike"].map(str::to_owned),
        has_ends_alone: false,
    })
}

/// The odd one of three, and how hard that was.
fn odd(position: Option<usize>) -> Draft {
    Draft::Choose {
        n: 3,
        words: Vec::new(),
        position,
        sure: Sure {
            n_grades: 3,
            words: ["easy", "normal", "hard"].map(str::to_owned).to_vec(),
            grade: None,
        },
    }
}

/// A window with nothing in it but a participant's view, and what is wished for in it.
fn window(view: ParticipantView<'_>) -> Harness<'_, Vec<Act>> {
    window_of(view, vec2(900.0, 700.0))
}

fn window_of(view: ParticipantView<'_>, size: eframe::egui::Vec2) -> Harness<'_, Vec<Act>> {
    let mut is_styled = false;
    Harness::builder().with_size(size).build_ui_state(
        move |ui, acts| {
            if !is_styled {
                theme::install(ui.ctx());
                is_styled = true;
            }
            show(ui, &view, acts);
        },
        Vec::new(),
    )
}

fn marks(harness: &Harness<'_, Vec<Act>>) -> Vec<Act> {
    let mut all = harness.state().clone();
    all.dedup();
    all
}

#[test]
fn ranks_are_given_by_click_by_digit_and_by_drag() {
    let draft = in_order([Some(0), None, None, None]);
    let mut harness = window(ParticipantView::Trial(trial(&draft)));
    harness.run();
    harness.get_by_label("Fabric 3").click();
    harness.run();
    assert_eq!(marks(&harness), [Act::Mark(Mark::Place(2))]);
    harness.state_mut().clear();
    harness.key_press(Key::Num4);
    harness.run();
    assert_eq!(marks(&harness), [Act::Mark(Mark::Place(3))]);
    harness.state_mut().clear();
    let from = harness.get_by_label("Fabric 2").rect().center();
    let to = harness.get_by_label("Rank 4: empty").rect().center();
    harness.drag_at(from);
    harness.run_steps(2);
    harness.hover_at(from + vec2(20.0, 0.0));
    harness.run_steps(2);
    harness.hover_at(to);
    harness.run_steps(2);
    harness.drop_at(to);
    harness.run_steps(3);
    assert_eq!(marks(&harness), [Act::Mark(Mark::Rank(1, 3))]);
    harness.get_by_label("Rank 1: fabric 1");
    assert!(harness.query_by_label("Fabric 1").is_none(), "it is ranked");
}

#[test]
fn nothing_is_handed_in_before_all_is_answered() {
    let draft = in_order([Some(0), Some(2), Some(1), None]);
    let mut harness = window(ParticipantView::Trial(trial(&draft)));
    harness.run();
    harness.key_press(Key::Enter);
    harness.get_by_label("Done").click();
    harness.run();
    assert_eq!(marks(&harness), []);
    let complete = in_order([Some(0), Some(2), Some(1), Some(3)]);
    let mut harness = window(ParticipantView::Trial(trial(&complete)));
    harness.run();
    harness.key_press(Key::Enter);
    harness.run();
    assert_eq!(marks(&harness), [Act::Answer]);
}

#[test]
fn a_break_counts_down_before_anybody_goes_on() {
    let words = |left_s| ParticipantView::Words {
        title: "A break",
        words: "Rest your finger.".to_owned(),
        left_s: Some(left_s),
    };
    let mut harness = window(words(61.2));
    harness.run();
    harness.get_by_label("1:02");
    harness.key_press(Key::Enter);
    harness.run();
    assert_eq!(marks(&harness), []);
    let mut harness = window(words(0.0));
    harness.run();
    harness.get_by_label("Go on").click();
    harness.run();
    assert_eq!(marks(&harness), [Act::Pass]);
}

#[test]
fn space_plays_again_while_a_number_is_being_typed_and_is_no_part_of_it() {
    let draft = Draft::Magnitude("1".to_owned());
    let view = TrialView {
        may_play: true,
        ..trial(&draft)
    };
    let mut harness = window(ParticipantView::Trial(view));
    harness.run();
    assert!(harness.ctx.text_edit_focused(), "the number has the keys");
    harness.key_press(Key::Space);
    harness.event(eframe::egui::Event::Text(" ".to_owned()));
    harness.run();
    assert_eq!(marks(&harness), [Act::Play]);
}

#[test]
fn a_number_is_typed_and_a_line_answers_keys() {
    let draft = Draft::Magnitude(String::new());
    let mut harness = window(ParticipantView::Trial(trial(&draft)));
    harness.run();
    let field = harness.get_by_role_and_label(Role::TextInput, "Number");
    assert!(
        field.accesskit_node().is_focused(),
        "ready to be typed into"
    );
    harness.event(eframe::egui::Event::Text("7".to_owned()));
    harness.run();
    let typed = Act::Mark(Mark::Type("7".to_owned()));
    assert_eq!(marks(&harness), [typed]);
    let scale = selvedge_experiment::design::Scale {
        key: "roughness".to_owned(),
        low: "smooth".to_owned(),
        high: "rough".to_owned(),
        points: 0,
    };
    let draft = Draft::Ratings {
        values: vec![None],
        scales: vec![scale],
    };
    let mut harness = window(ParticipantView::Trial(trial(&draft)));
    harness.run();
    let line = harness.get_by_role_and_label(Role::Slider, "From smooth to rough");
    line.click();
    harness.run();
    let marked = marks(&harness);
    let [Act::Mark(Mark::Rate(0, value))] = marked[..] else {
        panic!("{marked:?}")
    };
    assert!((value - 50.0).abs() < 2.0, "{value}");
}

fn scale(key: &str, points: u8) -> selvedge_experiment::design::Scale {
    selvedge_experiment::design::Scale {
        key: key.to_owned(),
        low: format!("little {key}"),
        high: format!("much {key}"),
        points,
    }
}

#[test]
fn scales_are_answered_by_keys_alone_and_whole_steps_stay_whole() {
    let draft = Draft::Ratings {
        values: vec![Some(50.0), Some(4.0)],
        scales: vec![scale("grip", 0), scale("warmth", 7)],
    };
    let mut harness = window(ParticipantView::Trial(trial(&draft)));
    harness.run();
    harness.key_press(Key::ArrowRight);
    harness.run();
    let marked = marks(&harness);
    let [Act::Mark(Mark::Rate(0, value))] = marked[..] else {
        panic!("the first scale has the keys: {marked:?}")
    };
    assert!((value - 55.0).abs() < 1e-9, "{value}");
    harness.state_mut().clear();
    harness.key_press(Key::Tab);
    harness.run();
    harness.key_press(Key::ArrowLeft);
    harness.run();
    assert_eq!(marks(&harness), [Act::Mark(Mark::Rate(1, 3.0))]);
    harness.state_mut().clear();
    harness.key_press(Key::Enter);
    harness.run();
    assert_eq!(marks(&harness), [Act::Answer]);
}

#[test]
fn piles_are_made_by_tab_and_space_and_handed_in_by_enter() {
    let draft = Draft::Piles(vec![Some(0), Some(0), Some(1)]);
    let mut harness = window(ParticipantView::Trial(trial(&draft)));
    harness.run();
    harness.key_press(Key::Space);
    harness.run();
    let first = Act::Mark(Mark::NextPile(0));
    assert_eq!(marks(&harness), [first], "the first has the keys");
    harness.state_mut().clear();
    harness.key_press(Key::Tab);
    harness.run();
    harness.key_press(Key::Space);
    harness.run();
    assert_eq!(marks(&harness), [Act::Mark(Mark::NextPile(1))]);
    harness.state_mut().clear();
    harness.key_press(Key::Enter);
    harness.run();
    assert_eq!(marks(&harness), [Act::Answer], "and not the next pile");
}

#[test]
fn keys_go_to_the_answer_though_a_button_was_reached_by_tab() {
    let draft = odd(Some(1));
    let mut harness = window(ParticipantView::Trial(trial(&draft)));
    harness.run();
    harness.key_press(Key::Tab);
    harness.run();
    harness.key_press(Key::Num3);
    harness.run();
    assert_eq!(marks(&harness), [Act::Mark(Mark::Place(2))]);
    harness.state_mut().clear();
    harness.key_press(Key::Enter);
    harness.run();
    assert_eq!(
        marks(&harness),
        [Act::Mark(Mark::Place(0))],
        "Enter presses the button that has the keys"
    );
}

#[test]
fn where_choosing_is_all_there_is_nothing_to_hand_in() {
    let draft = Draft::Choose {
        n: 2,
        words: Vec::new(),
        position: None,
        sure: Sure::default(),
    };
    let view = TrialView {
        intervals: Some(Intervals {
            n: 2,
            is_compared: false,
            played: None,
        }),
        ..trial(&draft)
    };
    let mut harness = window(ParticipantView::Trial(view));
    harness.run();
    assert!(harness.query_by_label("Done").is_none());
    harness.get_by_label("2").click();
    harness.run();
    assert_eq!(marks(&harness), [Act::Mark(Mark::Place(1))]);
}

#[test]
fn everything_that_is_pressed_lies_within_the_smallest_window_and_apart() {
    let grades = |n_grades| Sure {
        n_grades,
        ..Sure::default()
    };
    let drafts = [
        in_order([Some(2), None, None, None]),
        odd(None),
        Draft::Choose {
            n: 8,
            words: Vec::new(),
            position: None,
            sure: grades(0),
        },
        Draft::Choose {
            n: 2,
            words: ["real", "generated"].map(str::to_owned).to_vec(),
            position: None,
            sure: grades(7),
        },
        Draft::Order(Order {
            n: 4,
            slots: vec![None; 2],
            ends: ["most pleasant", "least pleasant"].map(str::to_owned),
            has_ends_alone: true,
        }),
        Draft::Piles(vec![None; 16]),
        Draft::Magnitude(String::new()),
        Draft::Ratings {
            values: vec![None; 4],
            scales: ["grip", "warmth", "strength", "hardness"]
                .map(|key| scale(key, 0))
                .to_vec(),
        },
    ];
    for draft in drafts {
        let mut harness = window_of(ParticipantView::Trial(trial(&draft)), vec2(700.0, 600.0));
        harness.run();
        let whole = harness.ctx.content_rect();
        let roles = [Role::Button, Role::Slider, Role::TextInput];
        let mut rects = Vec::new();
        for role in roles {
            rects.extend(harness.query_all_by_role(role).map(|node| node.rect()));
        }
        assert!(rects.len() > 1, "{draft:?}");
        for (n, rect) in rects.iter().enumerate() {
            assert!(whole.contains_rect(*rect), "{draft:?} {rect}");
            for other in &rects[..n] {
                assert!(
                    !other.shrink(1.0).intersects(*rect),
                    "{draft:?} {rect} {other}"
                );
            }
        }
    }
}

#[test]
fn while_the_screen_is_blank_answers_are_typed_in_the_experimenters_pane_alone() {
    let draft = in_order([Some(0), None, None, None]);
    let mut blank = window(ParticipantView::Blank(trial(&draft).ground));
    blank.run();
    blank.get_by_label("Blank screen");
    assert!(blank.query_by_label("Fabric 3").is_none());
    blank.key_press(Key::Num4);
    blank.run();
    assert_eq!(marks(&blank), []);

    let mut typed = Harness::builder()
        .with_size(vec2(300.0, 500.0))
        .build_ui_state(|ui, acts| show_typed(ui, &trial(&draft), acts), Vec::new());
    typed.run();
    typed.key_press(Key::Num4);
    typed.run();
    assert_eq!(marks(&typed), [Act::Mark(Mark::Place(3))]);
}
