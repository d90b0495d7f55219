//! A device that was lost and is back: where, and the one click that connects it. It is not armed.

use eframe::egui::{RichText, Ui};

use crate::bench::command::Commands;
use crate::bench::command::device::DeviceCommand;
use crate::kit::theme::{Palette, STEP};
use crate::kit::widgets::text::button;
use selvedge_device::FoundPort;

/// How the sentence begins, here and as a notice.
pub(crate) const BACK: &str = "The array is back as";

/// Shows what is back, if anything is.
pub(crate) fn show(ui: &mut Ui, back: Option<&FoundPort>, commands: &mut Commands) {
    let Some(found) = back else { return };
    let path = found.path.display().to_string();
    ui.add_space(STEP);
    let words = RichText::new(words(found)).color(Palette::in_ui(ui).text);
    ui.label(words).on_hover_text(found.by.words());
    let tip = format!("Connect to {path}; the device stays disarmed");
    ui.vertical_centered_justified(|ui| {
        if button(ui, "Connect again", &tip, None) {
            commands.push(DeviceCommand::ConnectPort(found.path.clone()).into());
        }
    });
}

/// Where it is.
fn words(found: &FoundPort) -> String {
    format!("{BACK} {}", found.path.display())
}

/// The notice of it.
pub(crate) fn notice(found: &FoundPort) -> String {
    format!("{}: connect again", words(found))
}

#[cfg(test)]
mod tests {
    use std::path::PathBuf;

    use super::*;
    use selvedge_device::RecognisedBy;

    #[test]
    fn a_notice_begins_with_what_it_is_put_away_by() {
        let found = FoundPort {
            path: PathBuf::from("/dev/ttyACM1"),
            by: RecognisedBy::UsbSerial,
        };
        let line = notice(&found);
        assert_eq!(line, "The array is back as /dev/ttyACM1: connect again");
        assert!(line.starts_with(BACK));
    }
}
