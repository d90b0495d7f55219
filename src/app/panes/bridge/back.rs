//! A device that was lost and is back: where, and the one click that connects it. It is not armed.

use eframe::egui::{RichText, Ui};

use super::Wishes;
use crate::app::command::DeviceCommand;
use crate::app::theme::{Palette, STEP};
use crate::app::widgets::button;
use crate::bridge::FoundPort;

/// Shows what is back, if anything is.
pub(super) fn show(ui: &mut Ui, back: Option<&FoundPort>, wishes: &mut Wishes) {
    let Some(found) = back else { return };
    let path = found.path.display().to_string();
    ui.add_space(STEP);
    let words = RichText::new(words(found)).color(Palette::in_ui(ui).text);
    ui.label(words).on_hover_text(found.by.words());
    let tip = format!("Connect to {path}; the device stays disarmed");
    ui.vertical_centered_justified(|ui| {
        if button(ui, "Connect again", &tip, None) {
            wishes.push(DeviceCommand::ConnectPort(found.path.clone()).into());
        }
    });
}

/// The sentence, here and as a notice.
pub(crate) fn words(found: &FoundPort) -> String {
    format!(
        "The array is back as {}: connect again",
        found.path.display()
    )
}
