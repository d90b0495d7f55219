//! The field that asks for a path: which scene to open, where to save.

use std::path::PathBuf;

use eframe::egui::{
    self, Align, Area, Frame, Id, Key, Layout, Margin, Order, Rect, RichText, Stroke, TextEdit, Ui,
    vec2,
};

use eframe::egui::text::{CCursor, CCursorRange};
use eframe::egui::text_edit::TextEditState;

use super::Wishes;
use crate::app::command::{Command, FileCommand, Purpose};
use crate::app::theme::{self, Palette};
use crate::app::widgets::button;

/// What is asked, and what was typed so far.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Ask {
    /// Whether it asks where to save; otherwise what to open.
    pub(crate) is_save: bool,
    /// The path as typed.
    pub(crate) path: String,
    /// Whether the field has had the focus once.
    pub(crate) was_focused: bool,
}

impl Ask {
    /// A question with the path that is known already.
    pub(crate) fn new(is_save: bool, known: Option<&PathBuf>) -> Self {
        let path = known
            .map(|path| path.display().to_string())
            .unwrap_or_default();
        Self {
            is_save,
            path,
            was_focused: false,
        }
    }

    fn answer(&self) -> Option<Command> {
        let path = self.path.trim();
        if path.is_empty() {
            return None;
        }
        let path = PathBuf::from(path);
        Some(if self.is_save {
            FileCommand::Use(Purpose::SaveScene, path).into()
        } else {
            FileCommand::Use(Purpose::OpenScene, path).into()
        })
    }
}

/// Shows the question at the upper edge of `over`.
pub(crate) fn show(ui: &Ui, over: Rect, ask: &mut Ask, wishes: &mut Wishes) {
    let palette = Palette::in_ui(ui);
    let (title, verb) = if ask.is_save {
        ("Save scene as", "Save")
    } else {
        ("Open scene", "Open")
    };
    Area::new(Id::unique("ask for a path"))
        .order(Order::Foreground)
        .pivot(egui::Align2::CENTER_TOP)
        .fixed_pos(over.center_top() + vec2(0.0, 32.0))
        .show(ui.ctx(), |ui| {
            let card = Frame::new()
                .fill(palette.panel)
                .stroke(Stroke::new(1.0, palette.line))
                .corner_radius(6)
                .inner_margin(Margin::same(16));
            card.show(ui, |ui| {
                ui.set_width((over.width() - 96.0).clamp(240.0, 560.0));
                let label = ui.label(RichText::new(title).font(theme::title()));
                let field = TextEdit::singleline(&mut ask.path)
                    .desired_width(f32::INFINITY)
                    .font(theme::number())
                    .margin(Margin::symmetric(8, 6))
                    .hint_text("/path/to/NAME.scene.toml");
                let output = field.show(ui);
                let response = output.response.response.labelled_by(label.id);
                if !ask.was_focused {
                    response.request_focus();
                    select_all(ui, output.state, response.id, &ask.path);
                    ask.was_focused = true;
                }
                let entered = response.lost_focus() && ui.input(|i| i.key_pressed(Key::Enter));
                ui.add_space(4.0);
                ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
                    let answer = ask.answer();
                    let missing = answer.is_none().then_some("Type the path of a scene first");
                    if (button(ui, verb, "", missing) || entered)
                        && let Some(command) = answer
                    {
                        wishes.push(command);
                    }
                    if button(ui, "Cancel", "", None) {
                        wishes.push(Command::Dismiss);
                    }
                });
            });
        });
}

/// Selects the known path, so that typing replaces it.
fn select_all(ui: &Ui, mut state: TextEditState, id: Id, text: &str) {
    let end = CCursor::new(text.chars().count());
    state
        .cursor
        .set_char_range(Some(CCursorRange::two(CCursor::default(), end)));
    state.store(ui.ctx(), id);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_empty_path_is_no_answer() {
        let mut ask = Ask::new(false, None);
        ask.path = "  ".to_owned();
        assert_eq!(ask.answer(), None);
        ask.path = " a.scene.toml ".to_owned();
        assert_eq!(
            ask.answer(),
            Some(FileCommand::Use(Purpose::OpenScene, PathBuf::from("a.scene.toml")).into())
        );
    }
}
