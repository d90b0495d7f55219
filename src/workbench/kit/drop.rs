//! What a pane that files are dropped on says before there are any.

use eframe::egui::{Align, Layout, Rect, RichText, Ui, UiBuilder, vec2};

use crate::kit::theme;
use crate::kit::theme::{Palette, STEP};
use crate::kit::widgets::text::{button, paragraph, quiet};

/// What to do when there is nothing yet, at most so high: a title, a line, a button, and small
/// words. Whether the button was pressed.
pub(crate) fn nothing_yet(
    ui: &mut Ui,
    most_height: f32,
    [title, line, ask]: [&str; 3],
    notes: [&str; 3],
) -> bool {
    let palette = Palette::in_ui(ui);
    let whole = ui.available_rect_before_wrap();
    let size = vec2(whole.width().min(520.0), whole.height().min(most_height));
    let room = Rect::from_center_size(whole.center(), size);
    let layout = Layout::top_down(Align::Min);
    let mut child = ui.new_child(UiBuilder::new().max_rect(room).layout(layout));
    let ui = &mut child;
    ui.spacing_mut().item_spacing.y = 2.0 * STEP;
    ui.label(RichText::new(title).font(theme::title()));
    ui.label(RichText::new(line).color(palette.text));
    let is_pressed = button(ui, ask, "", None);
    for words in notes {
        paragraph(ui, quiet(words));
    }
    is_pressed
}
