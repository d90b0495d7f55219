//! The offer of work that an earlier run left: a line below the header.

use eframe::egui::{Align, Frame, Label, Layout, Margin, Panel, RichText, Ui};

use crate::bench::command::{Commands, FileCommand, Left};
use crate::bench::recovery::{Offer, Unsaved};
use crate::kit::theme::Palette;
use crate::kit::widgets::text::button;

/// Shows what is offered; it covers nothing.
pub(crate) fn show(ui: &mut Ui, offer: &Offer, commands: &mut Commands) {
    let palette = Palette::in_ui(ui);
    let frame = Frame::new().fill(palette.raised);
    let frame = frame.inner_margin(Margin::symmetric(16, 6));
    Panel::top("unsaved work").frame(frame).show(ui, |ui| {
        ui.with_layout(Layout::right_to_left(Align::Min), |ui| {
            let mut answer = |ui: &mut Ui, text, tip, left| {
                if button(ui, text, tip, None) {
                    commands.push(FileCommand::Left(left).into());
                }
            };
            answer(ui, "Later", "Ask again at the next start", Left::PutOff);
            answer(ui, "Discard", "Delete it for good", Left::Discarded);
            let tip = "Go on where it broke off; files on disk stay as they are";
            answer(ui, "Restore", tip, Left::Restored);
            ui.with_layout(Layout::left_to_right(Align::Min), |ui| {
                let parts = offer.parts().iter().map(|part| {
                    let Unsaved { name, what, .. } = &part.unsaved;
                    format!("{name}: {what}")
                });
                let parts: Vec<String> = parts.collect();
                let words = format!("Unsaved work of {} UTC. {}", offer.at(), parts.join(". "));
                let text = RichText::new(words).color(palette.text);
                ui.add(Label::new(text).wrap());
            });
        });
    });
}
