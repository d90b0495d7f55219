//! What an answer is given with: large buttons, lines without numbers, a field for one number.

use eframe::egui::{
    self, Align, Button, Key, Layout, Rect, Response, RichText, Sense, TextEdit, Ui, WidgetInfo,
    pos2, vec2,
};

use super::ground::count;
use super::ranks;
use crate::app::experiment::{Draft, ExperimentCommand, Mark, Sure, TrialView};
use crate::app::panes::Wishes;
use crate::app::theme::{self, Palette, STEP};
use crate::experiment::design::{Scale, TunedParameter};
use crate::experiment::{Grade, N_TRIAD};

/// Height of a row of large controls, points.
const BIG: f32 = 56.0;
/// Width of the line of a scale, points.
const SCALE: f32 = 420.0;
/// Height of a scale, points.
const SCALE_ROW: f32 = 44.0;

/// The room that an answer needs, points.
pub(super) fn height(draft: &Draft) -> f32 {
    match draft {
        Draft::Ratings { scales, .. } => SCALE_ROW * count(scales.len()) + BIG + 4.0 * STEP,
        Draft::Adjust { parameters, .. } => SCALE_ROW * count(parameters.len()) + BIG + 4.0 * STEP,
        Draft::Judge { sure, .. } | Draft::Choose { sure, .. } if sure.n_grades > 0 => {
            3.0 * (BIG + 2.0 * STEP)
        }
        _ => super::ANSWER,
    }
}

/// Shows what the trial is answered with, and the button that hands the answer in.
pub(super) fn show(ui: &mut Ui, trial: &TrialView<'_>, wishes: &mut Wishes) {
    match trial.draft {
        Draft::Nothing => {}
        Draft::Ranks(order) => {
            let button = 168.0;
            row(ui, ranks::width() + button, |ui| {
                ranks::show(ui, order, wishes);
                ui.add_space(2.0 * STEP);
                show_done(ui, trial, wishes);
            });
        }
        Draft::Odd { position, grade } => {
            show_numbers(ui, N_TRIAD, *position, wishes);
            row(ui, 3.0 * 128.0 + 160.0, |ui| {
                for one in Grade::ALL {
                    let mark = Mark::Grade(one);
                    choose(ui, one.name(), *grade == Some(one), mark, wishes);
                }
                ui.add_space(4.0 * STEP);
                show_done(ui, trial, wishes);
            });
        }
        Draft::Choose { n, position, sure } => {
            show_numbers(ui, *n, *position, wishes);
            show_sure(ui, trial, *sure, wishes);
        }
        Draft::Judge { is_real, sure } => {
            row(ui, 2.0 * 172.0, |ui| {
                for (words, said) in [("real", true), ("generated", false)] {
                    let is_on = *is_real == Some(said);
                    choose(ui, words, is_on, Mark::Real(said), wishes);
                }
            });
            show_sure(ui, trial, *sure, wishes);
        }
        Draft::Magnitude(text) => show_number(ui, trial, text, wishes),
        Draft::Adjust {
            values, parameters, ..
        } => {
            for (at, (value, parameter)) in values.iter().zip(parameters).enumerate() {
                show_parameter(ui, (at, parameters.len()), (*value, parameter), wishes);
            }
            row(ui, 160.0, |ui| show_done(ui, trial, wishes));
        }
        Draft::Ratings { values, scales } => {
            for (at, (value, scale)) in values.iter().zip(scales).enumerate() {
                show_scale(ui, at, (*value, scale), wishes);
            }
            row(ui, 160.0, |ui| show_done(ui, trial, wishes));
        }
    }
}

/// A row of this width in the middle.
fn row(ui: &mut Ui, width: f32, content: impl FnOnce(&mut Ui)) {
    let room = ui.available_width();
    ui.allocate_ui_with_layout(
        vec2(room, BIG),
        Layout::left_to_right(Align::Center),
        |ui| {
            ui.add_space((0.5 * (room - width)).max(0.0));
            content(ui);
        },
    );
    ui.add_space(STEP);
}

/// A large button that is chosen or not.
fn choose(ui: &mut Ui, words: &str, is_on: bool, mark: Mark, wishes: &mut Wishes) {
    let palette = Palette::in_ui(ui);
    let (fill, ink) = if is_on {
        (palette.selection, palette.panel)
    } else {
        (palette.raised, palette.text)
    };
    let text = RichText::new(words).font(theme::large()).color(ink);
    let least = if words.len() > 1 { 112.0 } else { 72.0 };
    let button = Button::new(text)
        .fill(fill)
        .min_size(vec2(least, BIG - 8.0));
    let response = ui.add(button);
    let is_enabled = ui.is_enabled();
    response.widget_info(|| WidgetInfo::selected(egui::Role::Button, is_enabled, is_on, words));
    if response.clicked() {
        wishes.push(ExperimentCommand::Mark(mark).into());
    }
}

fn show_numbers(ui: &mut Ui, n: usize, chosen: Option<usize>, wishes: &mut Wishes) {
    row(ui, count(n) * 80.0, |ui| {
        for at in 0..n {
            let words = (at + 1).to_string();
            choose(ui, &words, chosen == Some(at), Mark::Place(at), wishes);
        }
    });
}

/// How sure somebody is, where that is asked, and the button that ends the trial.
fn show_sure(ui: &mut Ui, trial: &TrialView<'_>, sure: Sure, wishes: &mut Wishes) {
    if sure.n_grades > 0 {
        let width = f32::from(sure.n_grades) * 80.0 + 220.0;
        row(ui, width, |ui| {
            let words = RichText::new("guessed").font(theme::body());
            ui.label(words.color(Palette::in_ui(ui).dim));
            for grade in 1..=sure.n_grades {
                let is_on = sure.grade == Some(grade);
                let words = grade.to_string();
                choose_sure(ui, &words, is_on, grade, wishes);
            }
            let words = RichText::new("certain").font(theme::body());
            ui.label(words.color(Palette::in_ui(ui).dim));
        });
    }
    row(ui, 160.0, |ui| show_done(ui, trial, wishes));
}

fn choose_sure(ui: &mut Ui, words: &str, is_on: bool, grade: u8, wishes: &mut Wishes) {
    let palette = Palette::in_ui(ui);
    let (fill, ink) = if is_on {
        (palette.selection, palette.panel)
    } else {
        (palette.raised, palette.text)
    };
    let text = RichText::new(words).font(theme::large()).color(ink);
    let button = Button::new(text)
        .fill(fill)
        .min_size(vec2(64.0, BIG - 12.0));
    let response = ui.add(button);
    let is_enabled = ui.is_enabled();
    response.widget_info(|| {
        let label = format!("Sure {words}");
        WidgetInfo::selected(egui::Role::Button, is_enabled, is_on, label)
    });
    if response.clicked() {
        wishes.push(ExperimentCommand::Mark(Mark::Confidence(grade)).into());
    }
}

/// The button that hands the answer in; grey, with what is missing as its tip.
fn show_done(ui: &mut Ui, trial: &TrialView<'_>, wishes: &mut Wishes) {
    if trial.may_play {
        let again = Button::new(RichText::new("Again").font(theme::large()));
        if ui.add(again.min_size(vec2(112.0, BIG - 8.0))).clicked() {
            wishes.push(ExperimentCommand::Play.into());
        }
    }
    let missing = trial.draft.answer().err();
    let words = if trial.is_open { "Done" } else { "…" };
    let button = Button::new(RichText::new(words).font(theme::large()));
    let response = ui.add_enabled(missing.is_none(), button.min_size(vec2(136.0, BIG - 8.0)));
    let response = response.on_disabled_hover_text(missing.unwrap_or_default());
    if response.clicked() {
        wishes.push(ExperimentCommand::Answer.into());
    }
}

fn show_number(ui: &mut Ui, trial: &TrialView<'_>, text: &str, wishes: &mut Wishes) {
    row(ui, 420.0, |ui| {
        let label = ui.label(RichText::new("Number").font(theme::large()));
        let mut typed = text.to_owned();
        let field = TextEdit::singleline(&mut typed)
            .font(theme::large())
            .char_limit(12)
            .desired_width(140.0);
        let response = ui.add(field).labelled_by(label.id);
        let is_entered = response.lost_focus() && ui.input(|input| input.key_pressed(Key::Enter));
        if response.changed() {
            wishes.push(ExperimentCommand::Mark(Mark::Type(typed)).into());
        }
        if is_entered && trial.draft.answer().is_ok() {
            wishes.push(ExperimentCommand::Answer.into());
        }
        let is_free = ui.memory(|memory| memory.focused().is_none());
        if trial.is_open && is_free && !is_entered {
            response.request_focus();
        }
        show_done(ui, trial, wishes);
    });
}

/// A parameter as a line without numbers: where it is, and its two keys.
fn show_parameter(
    ui: &mut Ui,
    (at, n): (usize, usize),
    (value, parameter): (f64, &TunedParameter),
    wishes: &mut Wishes,
) {
    let name = match (n, at) {
        (1, _) => "Control",
        (_, 0) => "Control 1",
        _ => "Control 2",
    };
    let share = (value - parameter.from) / (parameter.to - parameter.from);
    if let Some(share) = line(ui, name, ("less", "more"), Some(share)) {
        let to = parameter.from + share * (parameter.to - parameter.from);
        wishes.push(ExperimentCommand::Mark(Mark::Set(at, to)).into());
    }
}

fn show_scale(ui: &mut Ui, at: usize, (value, scale): (Option<f64>, &Scale), wishes: &mut Wishes) {
    let [low, high] = scale.bounds();
    let share = value.map(|value| (value - low) / (high - low));
    let name = format!("From {} to {}", scale.low, scale.high);
    if let Some(share) = line(ui, &name, (&scale.low, &scale.high), share) {
        let to = low + share * (high - low);
        let to = if scale.points > 0 { to.round() } else { to };
        wishes.push(ExperimentCommand::Mark(Mark::Rate(at, to)).into());
    }
}

/// A line to point at, with words at its ends: the share that was pointed at, 0…1.
fn line(ui: &mut Ui, name: &str, (low, high): (&str, &str), share: Option<f64>) -> Option<f64> {
    let width = SCALE.min(ui.available_width() - 240.0).max(80.0);
    let (whole, _) = ui.allocate_exact_size(vec2(ui.available_width(), SCALE_ROW), Sense::hover());
    let rail = Rect::from_center_size(whole.center(), vec2(width, SCALE_ROW - 8.0));
    let response = ui.interact(rail, ui.scope_id().with(name), Sense::click_and_drag());
    declare(ui, &response, name, share);
    let palette = Palette::in_ui(ui);
    let painter = ui.painter();
    let y = rail.center().y;
    painter.hline(rail.x_range(), y, egui::Stroke::new(3.0, palette.line));
    if let Some(share) = share {
        let x = rail.left() + narrow(share.clamp(0.0, 1.0)) * rail.width();
        painter.circle_filled(pos2(x, y), 12.0, palette.selection);
    }
    let ends = [
        (rail.left() - 16.0, egui::Align2::RIGHT_CENTER, low),
        (rail.right() + 16.0, egui::Align2::LEFT_CENTER, high),
    ];
    for (x, align, words) in ends {
        painter.text(pos2(x, y), align, words, theme::large(), palette.text);
    }
    let stepped = step_of(ui, &response, share);
    let at = response
        .interact_pointer_pos()
        .filter(|_| response.clicked() || response.dragged());
    let pointed = at.map(|at| f64::from((at.x - rail.left()) / rail.width()).clamp(0.0, 1.0));
    pointed.or(stepped)
}

/// The share after the keys of a line that has the focus, twentieths of it.
fn step_of(ui: &Ui, response: &Response, share: Option<f64>) -> Option<f64> {
    let steps = crate::app::widgets::key_steps(ui, response);
    (steps != 0).then(|| (share.unwrap_or(0.5) + 0.05 * f64::from(steps)).clamp(0.0, 1.0))
}

fn declare(ui: &Ui, response: &Response, name: &str, share: Option<f64>) {
    let is_enabled = ui.is_enabled();
    response.widget_info(|| {
        let mut info = WidgetInfo::labeled(egui::Role::Slider, is_enabled, name);
        info.value = share;
        info
    });
}

#[expect(clippy::cast_possible_truncation, reason = "a share, for the screen")]
fn narrow(share: f64) -> f32 {
    share as f32
}
