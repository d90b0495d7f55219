//! Picture: someone with a scanner and no tester photographs a cloth and feels it.
//!
//! What is chosen and typed on the left, step by step; what each stage made of it on the right.
//! Draws what was made.

pub(crate) mod before_after;
pub(crate) mod cards;
pub(crate) mod controls;
pub(crate) mod frame;
pub(crate) mod keep;
pub(crate) mod plots;
pub(crate) mod repeats;
pub(crate) mod sun;
pub(crate) mod turned;

use eframe::egui::{Ui, vec2};

use crate::bench::command::{Commands, FileCommand, Purpose};
use crate::bench::pane::Pane;
use crate::kit::drop::nothing_yet;
use crate::kit::pane::{inside, scrolled_column};
use crate::kit::theme::{Palette, STEP};
use crate::tools::picture::state::Picture;

/// A pane this wide has room for two columns, points.
const WIDE: f32 = 560.0;
/// Width of the left column, points.
const LEFT: f32 = 286.0;
/// Height of what is always in sight below it, points.
const KEEP: f32 = 142.0;
/// What is said before a picture was chosen.
const EMPTY: [&str; 3] = [
    "A scan or a photograph of a cloth, taken straight from above, its threads at least three \
     pixels wide, in light from one side: PNG, JPEG, TIFF or BMP.",
    "Then type the scale that the scanner was set to and how high the relief is, and press Keep…: \
     it is felt first. Everything between can be looked at and changed.",
    "Brightness is taken for relief: cloth of one colour gives the best answer.",
];

/// Shows the pane.
pub(crate) fn show(ui: &mut Ui, picture: &mut Picture, commands: &mut Commands) {
    ui.spacing_mut().item_spacing.y = STEP;
    if picture.draft.source.is_none() {
        let words = [
            "Feel a cloth from its picture",
            "Drop a picture here, or choose one.",
            "Choose a picture…",
        ];
        if nothing_yet(ui, 260.0, words, EMPTY) {
            commands.push(FileCommand::Ask(Purpose::OpenPicture(Pane::Picture)).into());
        }
        return;
    }
    let whole = ui.available_rect_before_wrap();
    let before = picture.draft.clone();
    if whole.width() >= WIDE {
        let (left, right) = whole.split_left_right_at_x(whole.left() + LEFT);
        let hairline = (1.0, Palette::in_ui(ui).hairline);
        ui.painter().vline(left.right(), whole.y_range(), hairline);
        let left = left.with_max_x(left.right() - 10.0);
        let edge = (left.bottom() - KEEP).max(left.top() + 0.4 * left.height());
        let (steps, keep) = left.split_top_bottom_at_y(edge);
        inside(ui, steps.with_max_y(edge - 6.0), |ui| {
            scrolled_column(ui, "picture-steps", |ui| {
                controls::show(ui, picture, commands);
            });
        });
        ui.painter().hline(left.x_range(), edge - 3.0, hairline);
        inside(ui, keep, |ui| keep::show(ui, picture, commands));
        let right = right.with_min_x(right.left() + 12.0);
        inside(ui, right, |ui| cards::show(ui, picture));
    } else {
        scrolled_column(ui, "picture", |ui| {
            keep::show(ui, picture, commands);
            controls::show(ui, picture, commands);
            let size = vec2(ui.available_width(), 4.0 * ui.available_width());
            let (rect, _) = ui.allocate_exact_size(size, eframe::egui::Sense::hover());
            inside(ui, rect, |ui| cards::show(ui, picture));
        });
    }
    ui.advance_cursor_after_rect(whole);
    if picture.forget_after(&before) {
        ui.ctx().request_repaint();
    }
}
