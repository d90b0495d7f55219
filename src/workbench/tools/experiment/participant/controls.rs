//! What an answer is given with: large buttons, lines without numbers, a field for one number.

use eframe::egui::{
    self, Align, Key, Layout, Rect, Response, RichText, Sense, TextEdit, Ui, WidgetInfo, pos2, vec2,
};

use crate::kit::theme;
use crate::kit::theme::{Palette, STEP};
use crate::tools::experiment::draft::Act;
use crate::tools::experiment::draft::{Draft, Mark, Order, Sure};
use crate::tools::experiment::participant::ground::count;
use crate::tools::experiment::participant::{big, keys, piles, ranks};
use crate::tools::experiment::view::TrialView;
use selvedge_experiment::design::{Scale, TunedParameter};

/// Width of the line of a scale, points.
const SCALE: f32 = 420.0;
/// Height of a scale, points.
const SCALE_ROW: f32 = 44.0;

/// Width of the button that hands a ranking in, and the gap before it, points.
const DONE: f32 = 168.0;

/// Whether that button has room beside the ranks.
fn is_wide(order: &Order, room: f32) -> bool {
    room >= ranks::width(order) + DONE
}

/// The height that an answer needs where there is `room` across, points.
pub(crate) fn height(draft: &Draft, room: f32) -> f32 {
    match draft {
        Draft::Order(order) if !is_wide(order, room) => super::ANSWER + big::ROW,
        Draft::Piles(sorted) => {
            let n_rows = sorted.len().div_ceil(piles::PILES_A_ROW);
            count(n_rows + 1) * (big::ROW + 2.0 * STEP)
        }
        Draft::Ratings { scales, .. } => SCALE_ROW * count(scales.len()) + big::ROW + 4.0 * STEP,
        Draft::Adjust { parameters, .. } => {
            SCALE_ROW * count(parameters.len()) + big::ROW + 4.0 * STEP
        }
        Draft::Choose { sure, .. } if sure.n_grades > 0 && sure.words.is_empty() => {
            3.0 * (big::ROW + 2.0 * STEP)
        }
        _ => super::ANSWER,
    }
}

/// Shows what the trial is answered with, and the button that hands the answer in.
pub(crate) fn show(ui: &mut Ui, trial: &TrialView<'_>, acts: &mut Vec<Act>) {
    match trial.draft {
        Draft::Nothing => {}
        Draft::Order(order) => {
            let is_wide = is_wide(order, ui.available_width());
            row(ui, ranks::width(order) + DONE, |ui| {
                ranks::show(ui, order, acts);
                if is_wide {
                    ui.add_space(2.0 * STEP);
                    show_done(ui, trial, acts);
                }
            });
            if !is_wide {
                // What the first and the last rank mean stands between.
                ui.add_space(5.0 * STEP);
                row(ui, DONE, |ui| show_done(ui, trial, acts));
            }
        }
        Draft::Choose {
            n,
            words,
            position,
            sure,
        } => {
            show_choices(ui, (*n, words), *position, acts);
            show_sure(ui, trial, sure, acts);
        }
        Draft::Piles(sorted) => piles::show(ui, trial, sorted, acts),
        Draft::Magnitude(text) => show_number(ui, trial, text, acts),
        Draft::Adjust {
            values, parameters, ..
        } => {
            for (at, (value, parameter)) in values.iter().zip(parameters).enumerate() {
                show_parameter(ui, (at, parameters.len()), (*value, parameter), acts);
            }
            row(ui, 160.0, |ui| show_done(ui, trial, acts));
        }
        Draft::Ratings { values, scales } => {
            focus_first(ui, trial, scales);
            for (at, (value, scale)) in values.iter().zip(scales).enumerate() {
                show_scale(ui, at, (*value, scale), acts);
            }
            row(ui, 160.0, |ui| show_done(ui, trial, acts));
        }
    }
}

/// Gives the keys to the first scale while nothing else has them.
fn focus_first(ui: &Ui, trial: &TrialView<'_>, scales: &[Scale]) {
    let is_free = ui.memory(|memory| memory.focused().is_none());
    let is_entered = ui.input(|input| input.key_pressed(Key::Enter));
    if let Some(first) = scales
        .first()
        .filter(|_| is_free && trial.is_open && !is_entered)
    {
        let id = ui.scope_id().with(name_of(first));
        ui.memory_mut(|memory| memory.request_focus(id));
    }
}

/// A scale as it is read out.
fn name_of(scale: &Scale) -> String {
    format!("From {} to {}", scale.low, scale.high)
}

/// A row in the middle: as wide as it was when it was drawn last, `width` before that.
pub(crate) fn row(ui: &mut Ui, width: f32, content: impl FnOnce(&mut Ui)) {
    let room = ui.available_width();
    let id = ui.next_auto_id().with("row");
    let before = ui.data(|data| data.get_temp(id)).unwrap_or(width);
    let line = Layout::left_to_right(Align::Center);
    let drawn = ui.allocate_ui_with_layout(vec2(room, big::ROW), line, |ui| {
        ui.add_space((0.5 * (room - before)).max(0.0));
        let left = ui.cursor().left();
        content(ui);
        ui.min_rect().right() - left
    });
    let now = drawn.inner;
    if (now - before).abs() > 0.5 {
        ui.data_mut(|data| data.insert_temp(id, now));
        ui.ctx().request_discard("a row is wider than it was");
    }
    ui.add_space(STEP);
}

/// A large button that says something, chosen or not.
fn choose(ui: &mut Ui, words: &str, is_on: bool, mark: Mark, acts: &mut Vec<Act>) {
    let least = if words.chars().count() > 1 {
        112.0
    } else {
        72.0
    };
    if big::button(ui, (words, words), least, is_on).clicked() {
        acts.push(Act::Mark(mark));
    }
}

/// Words, or numbers where there are none.
fn show_choices(
    ui: &mut Ui,
    (n, words): (usize, &[String]),
    chosen: Option<usize>,
    acts: &mut Vec<Act>,
) {
    let width = if words.is_empty() { 80.0 } else { 172.0 };
    row(ui, count(n) * width, |ui| {
        for at in 0..n {
            let number = (at + 1).to_string();
            let words = words.get(at).unwrap_or(&number);
            choose(ui, words, chosen == Some(at), Mark::Place(at), acts);
        }
    });
}

/// How sure somebody is, where that is asked, and the button that ends the trial.
fn show_sure(ui: &mut Ui, trial: &TrialView<'_>, sure: &Sure, acts: &mut Vec<Act>) {
    if !sure.words.is_empty() {
        return row(ui, f32::from(sure.n_grades) * 128.0 + 160.0, |ui| {
            for (grade, word) in (1..).zip(&sure.words) {
                choose(
                    ui,
                    word,
                    sure.grade == Some(grade),
                    Mark::Confidence(grade),
                    acts,
                );
            }
            ui.add_space(4.0 * STEP);
            show_done(ui, trial, acts);
        });
    }
    if sure.n_grades > 0 {
        let width = f32::from(sure.n_grades) * 80.0 + 220.0;
        let n = f32::from(sure.n_grades);
        let side = ((ui.available_width() - 240.0) / n - 2.0 * STEP).clamp(44.0, 64.0);
        row(ui, width, |ui| {
            show_end(ui, "guessed");
            for grade in 1..=sure.n_grades {
                let is_on = sure.grade == Some(grade);
                let (words, label) = (grade.to_string(), format!("Sure {grade}"));
                if big::button(ui, (&words, &label), side, is_on).clicked() {
                    acts.push(Act::Mark(Mark::Confidence(grade)));
                }
            }
            show_end(ui, "certain");
        });
    }
    if !trial.ends_at_once() {
        row(ui, 160.0, |ui| show_done(ui, trial, acts));
    }
}

/// What one end of a row of grades means.
fn show_end(ui: &mut Ui, words: &str) {
    let text = RichText::new(words).font(theme::large());
    ui.label(text.color(Palette::in_ui(ui).dim));
}

/// The button that hands the answer in; grey, with what is missing as its tip.
pub(crate) fn show_done(ui: &mut Ui, trial: &TrialView<'_>, acts: &mut Vec<Act>) {
    if trial.may_play && big::button(ui, ("Again", "Again"), 112.0, false).clicked() {
        acts.push(Act::Play);
    }
    let missing = trial.refusal();
    let words = if trial.is_open { "Done" } else { "…" };
    let done = ui.add_enabled_ui(missing.is_none(), |ui| {
        big::button(ui, (words, words), 136.0, false)
    });
    let response = done
        .inner
        .on_disabled_hover_text(missing.unwrap_or_default());
    if response.clicked() {
        acts.push(Act::Answer);
    }
}

fn show_number(ui: &mut Ui, trial: &TrialView<'_>, text: &str, acts: &mut Vec<Act>) {
    row(ui, 420.0, |ui| {
        let label = ui.label(RichText::new("Number").font(theme::large()));
        let mut typed = text.to_owned();
        keys::take_space(ui, trial, acts);
        let field = TextEdit::singleline(&mut typed)
            .font(theme::large())
            .char_limit(12)
            .margin(egui::Margin::symmetric(12, 10))
            .desired_width(168.0);
        let response = ui.add(field).labelled_by(label.id);
        let is_entered = response.lost_focus() && ui.input(|input| input.key_pressed(Key::Enter));
        if response.changed() {
            acts.push(Act::Mark(Mark::Type(typed)));
        }
        if is_entered && trial.refusal().is_none() {
            acts.push(Act::Answer);
        }
        let is_free = ui.memory(|memory| memory.focused().is_none());
        if trial.is_open && is_free && !is_entered {
            response.request_focus();
        }
        show_done(ui, trial, acts);
    });
}

/// A parameter as a line without numbers: where it is, and its two keys.
fn show_parameter(
    ui: &mut Ui,
    (at, n): (usize, usize),
    (value, parameter): (f64, &TunedParameter),
    acts: &mut Vec<Act>,
) {
    let name = match (n, at) {
        (1, _) => "Control",
        (_, 0) => "Control 1",
        _ => "Control 2",
    };
    let range = parameter.to - parameter.from;
    let rail = Rail {
        name,
        ends: ("less", "more"),
        share: Some((value - parameter.from) / range),
        step: (parameter.step / range).abs(),
        is_in_steps: false,
    };
    if let Some(share) = line(ui, &rail) {
        let to = parameter.from + share * range;
        acts.push(Act::Mark(Mark::Set(at, to)));
    }
}

fn show_scale(ui: &mut Ui, at: usize, (value, scale): (Option<f64>, &Scale), acts: &mut Vec<Act>) {
    let [low, high] = scale.bounds();
    let is_in_steps = scale.points > 0;
    let rail = Rail {
        name: &name_of(scale),
        ends: (&scale.low, &scale.high),
        share: value.map(|value| (value - low) / (high - low)),
        step: if is_in_steps {
            1.0 / (high - low)
        } else {
            0.05
        },
        is_in_steps,
    };
    if let Some(share) = line(ui, &rail) {
        let to = low + share * (high - low);
        let to = if is_in_steps { to.round() } else { to };
        acts.push(Act::Mark(Mark::Rate(at, to)));
    }
}

/// A line without numbers.
struct Rail<'a> {
    /// As it is read out.
    name: &'a str,
    /// Words at its ends.
    ends: (&'a str, &'a str),
    /// Where somebody put it, 0…1.
    share: Option<f64>,
    /// How far a key moves it, as a share.
    step: f64,
    /// Whether only whole steps can be chosen; they are marked.
    is_in_steps: bool,
}

/// A line to point at, with words at its ends: the share that was pointed at, 0…1.
fn line(ui: &mut Ui, rail: &Rail<'_>) -> Option<f64> {
    let width = SCALE.min(ui.available_width() - 280.0).max(80.0);
    let (whole, _) = ui.allocate_exact_size(vec2(ui.available_width(), SCALE_ROW), Sense::hover());
    let rect = Rect::from_center_size(whole.center(), vec2(width, SCALE_ROW - 8.0));
    let id = ui.scope_id().with(rail.name);
    let response = ui.interact(rect.expand2(vec2(12.0, 0.0)), id, Sense::click_and_drag());
    declare(ui, &response, rail.name, rail.share);
    paint_rail(ui, rect, rail, &response);
    let steps = crate::kit::widgets::slider::key_steps(ui, &response);
    let stepped = (steps != 0).then(|| {
        let share = rail.share.unwrap_or(0.5) + rail.step * f64::from(steps);
        share.clamp(0.0, 1.0)
    });
    if response.has_focus() && ui.input(|input| input.key_pressed(Key::Enter)) {
        // Enter belongs to the answer as a whole.
        response.surrender_focus();
    }
    let at = response
        .interact_pointer_pos()
        .filter(|_| response.clicked() || response.dragged());
    let pointed = at.map(|at| f64::from((at.x - rect.left()) / rect.width()).clamp(0.0, 1.0));
    pointed.or(stepped)
}

fn paint_rail(ui: &Ui, rect: Rect, rail: &Rail<'_>, response: &Response) {
    let palette = Palette::in_ui(ui);
    let painter = ui.painter();
    let y = rect.center().y;
    let is_lit = response.hovered() || response.has_focus();
    let ink = if is_lit { palette.text } else { palette.line };
    painter.hline(rect.x_range(), y, egui::Stroke::new(3.0, ink));
    let at = |share: f64| rect.left() + narrow(share.clamp(0.0, 1.0)) * rect.width();
    if rail.is_in_steps {
        let mut share = 0.0;
        while share < 1.0 + 0.5 * rail.step {
            let marks = (y - 7.0)..=(y + 7.0);
            painter.vline(at(share), marks, egui::Stroke::new(2.0, ink));
            share += rail.step;
        }
    }
    if let Some(share) = rail.share {
        painter.circle_filled(pos2(at(share), y), 12.0, palette.selection);
    }
    big::ring(ui, rect.expand2(vec2(12.0, 0.0)), response);
    let ends = [
        (rect.left() - 24.0, egui::Align2::RIGHT_CENTER, rail.ends.0),
        (rect.right() + 24.0, egui::Align2::LEFT_CENTER, rail.ends.1),
    ];
    for (x, align, words) in ends {
        painter.text(pos2(x, y), align, words, theme::large(), palette.text);
    }
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
