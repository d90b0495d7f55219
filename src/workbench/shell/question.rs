//! The question before the window closes, or opens another scene, on everything that would be lost.

use eframe::egui::{Align, Button, Layout, Rect, RichText, Ui, vec2};

use crate::bench::command::{Command, Commands, FileCommand};
use crate::kit::theme::{Palette, ROW, STEP};
use crate::kit::widgets::card;
use crate::kit::widgets::text::{button, paragraph};
use crate::shell::state::{After, Question};

/// Asks at the upper edge of `over` what becomes of unsaved work, which it names.
///
/// Whoever asks goes on once the answer is there.
pub(crate) fn show(ui: &Ui, over: Rect, question: &Question, commands: &mut Commands) {
    let is_closing = question.after == After::Close;
    let title = if is_closing {
        "Save before the window closes?"
    } else {
        "Save before another scene is opened?"
    };
    card(ui, over, 520.0, title, |ui, _| {
        let palette = Palette::in_ui(ui);
        for part in &question.parts {
            paragraph(ui, RichText::new(&part.unsaved.name).color(palette.text));
            ui.colored_label(palette.dim, &part.unsaved.what);
            ui.add_space(STEP);
        }
        let words = if is_closing {
            "Save writes the scene to its file and leaves drafts to the next start. Recordings are \
             on disk already."
        } else {
            "Without saving, the changes to the scene are lost. Drafts and recordings stay."
        };
        paragraph(ui, RichText::new(words).color(palette.dim));
        ui.add_space(2.0 * STEP);
        let size = vec2(ui.available_width(), ROW);
        ui.allocate_ui_with_layout(size, Layout::right_to_left(Align::Center), |ui| {
            let save = ui.add(Button::new("Save").min_size(vec2(64.0, ROW)));
            if ui.memory(|memory| memory.focused().is_none()) {
                save.request_focus();
            }
            if save.clicked() {
                commands.push(FileCommand::SaveAll.into());
            }
            if button(ui, "Cancel", "Leave everything as it is", None) {
                commands.push(Command::Dismiss);
            }
            ui.with_layout(Layout::left_to_right(Align::Center), |ui| {
                if button(ui, "Discard", "Go on and let all of it go", None) {
                    commands.push(FileCommand::LetGo.into());
                }
            });
        });
    });
}
