//! Notices: one sentence each that says what is wrong and how to mend it, until put away.

use eframe::egui::{
    self, Align, Area, Button, Frame, Id, Layout, Margin, Order, Rect, RichText, Stroke, Ui,
    WidgetInfo, vec2,
};

use crate::bench::command::{Command, Commands};
use crate::kit::theme::{Palette, ROW};
use crate::kit::widgets::text::mark;

/// Most notices that are shown at once; older ones go.
const MAX_NOTICES: usize = 3;

/// A sentence for the user.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Notice {
    /// Its number, by which it is put away.
    pub number: u64,
    /// What is wrong and how to mend it.
    pub text: String,
}

/// The notices that nobody has put away yet, old to new.
#[derive(Debug, Clone, Default)]
pub(crate) struct Notices {
    shown: Vec<Notice>,
    n_given: u64,
}

impl Notices {
    /// Gives a notice. The same sentence twice is shown once.
    pub(crate) fn give(&mut self, text: impl Into<String>) {
        let text = text.into();
        self.shown.retain(|notice| notice.text != text);
        self.n_given += 1;
        self.shown.push(Notice {
            number: self.n_given,
            text,
        });
        if self.shown.len() > MAX_NOTICES {
            self.shown.remove(0);
        }
    }

    /// Puts one away.
    pub(crate) fn dismiss(&mut self, number: u64) {
        self.shown.retain(|notice| notice.number != number);
    }

    /// Puts away those that begin with a name.
    pub(crate) fn forget_about(&mut self, name: &str) {
        self.shown.retain(|notice| !notice.text.starts_with(name));
    }

    /// Those that are shown, old to new.
    pub(crate) fn shown(&self) -> &[Notice] {
        &self.shown
    }
}

/// Shows the notices at the lower edge of `over`.
pub(crate) fn show(ui: &Ui, over: Rect, notices: &Notices, commands: &mut Commands) {
    if notices.shown.is_empty() {
        return;
    }
    let palette = Palette::in_ui(ui);
    let width = (over.width() - 48.0).min(720.0);
    Area::new(Id::unique("notices"))
        .order(Order::Foreground)
        .pivot(egui::Align2::CENTER_BOTTOM)
        .fixed_pos(over.center_bottom() - vec2(0.0, 16.0))
        .show(ui.ctx(), |ui| {
            ui.set_width(width);
            for notice in &notices.shown {
                let card = Frame::new()
                    .fill(palette.raised)
                    .stroke(Stroke::new(1.0, palette.line))
                    .corner_radius(6)
                    .inner_margin(Margin::symmetric(12, 8));
                card.show(ui, |ui| show_one(ui, notice, commands));
            }
        });
}

fn show_one(ui: &mut Ui, notice: &Notice, commands: &mut Commands) {
    let palette = Palette::in_ui(ui);
    ui.with_layout(Layout::right_to_left(Align::Min), |ui| {
        let close = ui.add(Button::new("Close").min_size(vec2(0.0, ROW)));
        close.widget_info(|| WidgetInfo::labeled(egui::Role::Button, true, "Close the notice"));
        if close.clicked() {
            commands.push(Command::DismissNotice(notice.number));
        }
        ui.with_layout(Layout::left_to_right(Align::Min), |ui| {
            mark(ui, palette.selection, "Notice");
            let text = RichText::new(&notice.text).color(palette.text);
            ui.add(egui::Label::new(text).wrap().selectable(true));
        });
    });
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_same_sentence_is_shown_once_and_old_ones_go() {
        let mut notices = Notices::default();
        for text in ["a", "b", "a", "c", "d"] {
            notices.give(text);
        }
        let texts: Vec<&str> = notices.shown().iter().map(|n| n.text.as_str()).collect();
        assert_eq!(texts, ["a", "c", "d"]);
        notices.forget_about("c");
        assert_eq!(notices.shown().len(), 2, "one began with it");
        notices.give("e");
        notices.dismiss(notices.shown()[1].number);
        assert_eq!(notices.shown().len(), 2);
    }
}
