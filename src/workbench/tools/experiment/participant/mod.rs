//! What a participant sees: large, calm, to be read from a metre away. Everything that is asked can
//! be answered by keys alone.

pub(crate) mod big;
pub(crate) mod controls;
pub(crate) mod ground;
pub(crate) mod keys;
pub(crate) mod piles;
pub(crate) mod ranks;
#[cfg(test)]
mod tests;

use eframe::egui::{
    Align2, Key, Rect, RichText, Role, ScrollArea, Sense, TextWrapMode, Ui, UiBuilder, WidgetInfo,
    WidgetText, pos2, vec2,
};

use crate::kit::theme;
use crate::kit::theme::{Palette, STEP};
use crate::kit::view_transform::PointerGround;
use crate::kit::widgets::text::button;
use crate::tools::experiment::draft::Act;
use crate::tools::experiment::state::ParticipantsWindow;
use crate::tools::experiment::view::{ParticipantView, TrialView};

/// Height of the line that says what is asked, points.
const QUESTION: f32 = 56.0;
/// Height of what is answered with, points.
const ANSWER: f32 = 132.0;
/// Height of the line that names the keys, points.
const HINT: f32 = 24.0;
/// Height of the numbers of intervals above the cloth, points.
const STRIP: f32 = 110.0;
/// Controls that an experimenter types in are this wide at least, points.
const TYPED: f32 = 460.0;
/// No line of words is longer, points.
const LINE: f32 = 720.0;

/// Shows the participant's view; where the pointer feels, if there is such a place.
pub(crate) fn show(
    ui: &mut Ui,
    view: &ParticipantView<'_>,
    acts: &mut Vec<Act>,
) -> Option<PointerGround> {
    let (frame, _) = ui.allocate_exact_size(ui.available_size(), Sense::hover());
    ui.painter().rect_filled(frame, 0, Palette::in_ui(ui).floor);
    let mut ui = ui.new_child(UiBuilder::new().max_rect(frame.shrink(4.0 * STEP)));
    let ui = &mut ui;
    match view {
        ParticipantView::Nobody { is_coming } => {
            show_nobody(ui, *is_coming);
            None
        }
        ParticipantView::Words {
            title,
            words,
            left_s,
        } => {
            show_words(ui, title, words);
            show_pass(ui, *left_s, acts);
            None
        }
        ParticipantView::Movement {
            ground,
            is_circle,
            guide,
            left_s,
        } => {
            let words = if *is_circle {
                "Follow the dot in circles"
            } else {
                "Follow the dot to and fro"
            };
            let [rect, foot] = split(ui, words, ANSWER / 2.0);
            let shown = ground::show(ui, rect, ground);
            ground::paint_guide(ui, &shown.view, ground, (*is_circle, *guide));
            let mut ui = ui.new_child(UiBuilder::new().max_rect(foot));
            show_pass(&mut ui, Some(*left_s), acts);
            Some(shown)
        }
        ParticipantView::Trial(trial) => Some(show_trial(ui, trial, acts)),
        ParticipantView::Blank(ground) => {
            let rect = ui.max_rect();
            Some(ground::show_unseen(ui, rect, (ground, "Blank screen")))
        }
    }
}

/// What a trial is answered with, for an experimenter who types while the participant sees nothing.
pub(crate) fn show_typed(ui: &mut Ui, trial: &TrialView<'_>, acts: &mut Vec<Act>) {
    let width = ui.available_width().max(TYPED);
    ui.add(eframe::egui::Label::new(sentence(&trial.question)).wrap());
    let height = controls::height(trial.draft, width);
    // As wide as the controls need, however narrow the pane: it is scrolled, not widened.
    ScrollArea::horizontal()
        .id_salt("typed")
        .max_height(height)
        .show(ui, |ui| {
            if !trial.is_open {
                ui.disable();
            }
            ui.allocate_ui(vec2(width, height), |ui| {
                controls::show(ui, trial, acts);
            });
        });
    let hint = RichText::new(keys::hint(trial)).color(Palette::in_ui(ui).dim);
    ui.add(eframe::egui::Label::new(hint).wrap());
    if trial.is_open {
        keys::take(ui, trial, acts);
    }
}

/// Stands in a window of the participant's own while no session is active.
pub(crate) fn show_before(ui: &mut Ui, is_coming: bool) {
    let (frame, _) = ui.allocate_exact_size(ui.available_size(), Sense::hover());
    ui.painter().rect_filled(frame, 0, Palette::in_ui(ui).floor);
    let mut ui = ui.new_child(UiBuilder::new().max_rect(frame.shrink(4.0 * STEP)));
    let words = if is_coming {
        "The session is being prepared."
    } else {
        "The experimenter will begin the session."
    };
    show_words(&mut ui, "Welcome", words);
}

/// Stands where the view was before it went to a window of its own.
pub(crate) fn show_apart(ui: &mut Ui, window: &mut ParticipantsWindow) {
    let palette = Palette::in_ui(ui);
    ui.painter().rect_filled(ui.max_rect(), 0, palette.floor);
    let height = ui.available_height();
    ui.vertical_centered(|ui| {
        ui.add_space((0.4 * height).max(STEP));
        let words = "The participant's view is in a window of its own: drag it to another screen, \
                     F11 fills that screen. Answers are typed there.";
        ui.set_max_width(LINE.min(ui.available_width() - 8.0 * STEP));
        ui.add(eframe::egui::Label::new(RichText::new(words).color(palette.dim)).wrap());
        ui.add_space(2.0 * STEP);
        let tip = "Close that window and show the view here";
        if button(ui, "Show it here again", tip, None) {
            *window = ParticipantsWindow::default();
            ui.ctx().request_repaint();
        }
    });
}

fn show_trial(ui: &mut Ui, trial: &TrialView<'_>, acts: &mut Vec<Act>) -> PointerGround {
    let [rect, foot] = split(
        ui,
        &sentence(&trial.question),
        controls::height(trial.draft, ui.max_rect().width()) + HINT,
    );
    // Cloth lies below the numbers of its intervals; a vibration is nowhere.
    let [strip, rect] = if trial.is_felt_in_turn() {
        let edge = rect.top() + STRIP.min(0.3 * rect.height());
        rect.split_top_bottom_at_y(edge).into()
    } else {
        [rect; 2]
    };
    let shown = ground::show(ui, rect, &trial.ground);
    if let Some(intervals) = trial.intervals {
        ground::paint_intervals(ui, strip, intervals);
    }
    let mut ui = ui.new_child(UiBuilder::new().max_rect(foot));
    if !trial.is_open {
        ui.disable();
    }
    controls::show(&mut ui, trial, acts);
    let palette = Palette::in_ui(&ui);
    let (at, font) = (foot.center_bottom(), theme::body());
    let hint = keys::hint(trial);
    ui.painter()
        .text(at, Align2::CENTER_BOTTOM, hint, font, palette.dim);
    if trial.is_open {
        keys::take(&ui, trial, acts);
    }
    shown
}

/// A line on top, what lies there in the middle, and room for an answer below.
fn split(ui: &Ui, words: &str, height: f32) -> [Rect; 2] {
    let whole = ui.max_rect();
    let palette = Palette::in_ui(ui);
    let at = pos2(whole.center().x, whole.top() + 0.5 * QUESTION);
    let text = RichText::new(words)
        .font(theme::large())
        .color(palette.text);
    let wrap = Some(TextWrapMode::Wrap);
    let style = eframe::egui::TextStyle::Body;
    let galley = WidgetText::from(text).into_galley(ui, wrap, whole.width(), style);
    let label = Align2::CENTER_CENTER.anchor_size(at, galley.size());
    ui.painter().galley(label.min, galley, palette.text);
    let id = ui.scope_id().with("question");
    let response = ui.interact(label, id, Sense::hover());
    response.widget_info(|| WidgetInfo::labeled(Role::Label, true, words));
    let foot = Rect::from_min_max(pos2(whole.left(), whole.bottom() - height), whole.max);
    let middle = Rect::from_min_max(
        pos2(whole.left(), whole.top() + QUESTION),
        pos2(whole.right(), foot.top() - 2.0 * STEP),
    );
    [middle, foot]
}

fn show_nobody(ui: &mut Ui, is_coming: bool) {
    if is_coming {
        return show_words(ui, "One moment, please", "The session is being prepared.");
    }
    show_words(
        ui,
        "No session",
        "Choose a design and begin a session in the Experimenter pane.",
    );
}

fn show_words(ui: &mut Ui, title: &str, words: &str) {
    let palette = Palette::in_ui(ui);
    let whole = ui.max_rect();
    ui.vertical_centered(|ui| {
        ui.add_space((0.22 * whole.height()).max(STEP));
        ui.label(RichText::new(title).font(theme::huge()).color(palette.text));
        ui.add_space(4.0 * STEP);
        ui.set_max_width(LINE.min(whole.width()));
        let text = RichText::new(words).font(theme::large());
        ui.add(eframe::egui::Label::new(text.color(palette.dim)).wrap());
        ui.add_space(8.0 * STEP);
    });
}

/// The button that goes on, with the seconds until it does.
fn show_pass(ui: &mut Ui, left_s: Option<f64>, acts: &mut Vec<Act>) {
    let Some(left_s) = left_s else { return };
    let may_pass = left_s <= 0.0;
    let words = if may_pass {
        "Go on".to_owned()
    } else {
        clock(left_s)
    };
    ui.vertical_centered(|ui| {
        let button = ui.add_enabled_ui(may_pass, |ui| {
            big::button(ui, (&words, &words), 180.0, false)
        });
        let is_clicked = button.inner.clicked();
        let is_free = !ui.ctx().text_edit_focused();
        let is_key = is_free && ui.input(|input| input.key_pressed(Key::Enter));
        if may_pass && (is_clicked || is_key) {
            acts.push(Act::Pass);
        }
    });
}

/// Minutes and seconds that are left.
pub(crate) fn clock(left_s: f64) -> String {
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "some minutes"
    )]
    let seconds = left_s.max(0.0).ceil() as u64;
    format!("{}:{:02}", seconds / 60, seconds % 60)
}

/// A question with a capital.
fn sentence(question: &str) -> String {
    let mut letters = question.chars();
    let first = letters.next().into_iter().flat_map(char::to_uppercase);
    first.chain(letters).collect()
}
