//! Picture: someone with a scanner and no tester photographs a cloth and feels it.
//!
//! What is chosen and typed on the left, step by step; what each stage made of it on the right.
//! Draws what `picturing` made; asks for everything by commands.

pub(crate) mod cards;
pub(crate) mod controls;
pub(crate) mod frame;
pub(crate) mod hemisphere;
pub(crate) mod keep;
pub(crate) mod plots;

use eframe::egui::{Align, Label, Layout, RichText, Ui, UiBuilder, vec2};

use crate::bench::command::{Commands, FileCommand, Purpose};
use crate::kit::part::{dropped, inside, scrolled};
use crate::kit::theme;
use crate::kit::theme::{Palette, STEP};
use crate::kit::widgets::text::button;
pub(crate) use crate::tools::picture::view::cards::PictureTextures;
use crate::tools::picture::{PictureCommand, Picturing};

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
    "Then type the scale that the scanner was set to and how high the relief is, and press Feel \
     it. Everything between can be looked at and changed.",
    "Brightness is taken for relief: cloth of one colour gives the best answer.",
];

/// Shows the pane.
pub(crate) fn show(
    ui: &mut Ui,
    (picturing, textures): (&mut Picturing, &mut PictureTextures),
    commands: &mut Commands,
) {
    ui.spacing_mut().item_spacing.y = STEP;
    if let Some(path) = dropped(ui).into_iter().next() {
        commands.push(PictureCommand::Open(path).into());
    }
    if picturing.draft.source.is_none() {
        show_empty(ui, commands);
        return;
    }
    let whole = ui.available_rect_before_wrap();
    let before = picturing.draft.clone();
    if whole.width() >= WIDE {
        let (left, right) = whole.split_left_right_at_x(whole.left() + LEFT);
        let hairline = (1.0, Palette::in_ui(ui).hairline);
        ui.painter().vline(left.right(), whole.y_range(), hairline);
        let left = left.with_max_x(left.right() - 10.0);
        let edge = (left.bottom() - KEEP).max(left.top() + 0.4 * left.height());
        let (steps, keep) = left.split_top_bottom_at_y(edge);
        inside(ui, steps.with_max_y(edge - 6.0), |ui| {
            scrolled(ui, "picture-steps", |ui| {
                controls::show(ui, picturing, commands);
            });
        });
        ui.painter().hline(left.x_range(), edge - 3.0, hairline);
        inside(ui, keep, |ui| keep::show(ui, picturing, commands));
        let right = right.with_min_x(right.left() + 12.0);
        inside(ui, right, |ui| cards::show(ui, picturing, textures));
    } else {
        scrolled(ui, "picture", |ui| {
            keep::show(ui, picturing, commands);
            controls::show(ui, picturing, commands);
            let size = vec2(ui.available_width(), 4.0 * ui.available_width());
            let (rect, _) = ui.allocate_exact_size(size, eframe::egui::Sense::hover());
            inside(ui, rect, |ui| cards::show(ui, picturing, textures));
        });
    }
    ui.advance_cursor_after_rect(whole);
    // Panes change nothing: what was typed goes through the dispatcher like everything else.
    let typed = std::mem::replace(&mut picturing.draft, before);
    if typed != picturing.draft {
        commands.push(PictureCommand::Draft(Box::new(typed)).into());
    }
}

/// What to do when there is nothing yet.
fn show_empty(ui: &mut Ui, commands: &mut Commands) {
    let palette = Palette::in_ui(ui);
    let whole = ui.available_rect_before_wrap();
    let size = vec2(whole.width().min(520.0), whole.height().min(260.0));
    let room = eframe::egui::Rect::from_center_size(whole.center(), size);
    let layout = Layout::top_down(Align::Min);
    let mut child = ui.new_child(UiBuilder::new().max_rect(room).layout(layout));
    let ui = &mut child;
    ui.spacing_mut().item_spacing.y = 2.0 * STEP;
    ui.label(RichText::new("Feel a cloth from its picture").font(theme::title()));
    ui.label(RichText::new("Drop a picture here, or choose one.").color(palette.text));
    if button(ui, "Choose a picture…", "", None) {
        commands.push(FileCommand::Ask(Purpose::OpenPicture).into());
    }
    for words in EMPTY {
        let words = RichText::new(words).font(theme::small()).color(palette.dim);
        ui.add(Label::new(words).wrap());
    }
}
