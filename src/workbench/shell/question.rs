//! The question before the window closes, or opens another scene, on changes that are not saved.

use eframe::egui::{Align, Button, Layout, Rect, Ui, vec2};

use crate::bench::command::{Command, Commands, FileCommand};
use crate::kit::theme::{Palette, ROW, STEP};
use crate::kit::widgets::card;
use crate::kit::widgets::text::button;

/// Asks at the upper edge of `over` whether to save the scene called `name`.
///
/// Whoever asks closes the window, or opens another scene, once this one is saved.
pub(crate) fn show(ui: &Ui, over: Rect, name: &str, is_closing: bool, commands: &mut Commands) {
    let title = format!("Save changes to {name}?");
    card(ui, over, 440.0, &title, |ui, _| {
        let palette = Palette::in_ui(ui);
        ui.colored_label(
            palette.dim,
            if is_closing {
                "Otherwise they are lost when the window closes."
            } else {
                "Otherwise they are lost when another scene is opened."
            },
        );
        ui.add_space(2.0 * STEP);
        let size = vec2(ui.available_width(), ROW);
        ui.allocate_ui_with_layout(size, Layout::right_to_left(Align::Center), |ui| {
            let save = ui.add(Button::new("Save").min_size(vec2(64.0, ROW)));
            if ui.memory(|memory| memory.focused().is_none()) {
                save.request_focus();
            }
            if save.clicked() {
                commands.push(FileCommand::Save.into());
            }
            if button(ui, "Cancel", "Leave everything as it is", None) {
                commands.push(Command::Dismiss);
            }
            ui.with_layout(Layout::left_to_right(Align::Center), |ui| {
                if button(ui, "Don’t save", "Go on and let the changes go", None) {
                    commands.push(FileCommand::LetGo.into());
                }
            });
        });
    });
}
