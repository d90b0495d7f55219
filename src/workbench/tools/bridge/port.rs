//! Which port to connect to: typed, or chosen from those that were found; and where a device that
//! was lost is back: one click connects it, and it is not armed.

use std::path::PathBuf;

use eframe::egui::{
    self, Align, Button, Layout, Margin, Popup, PopupCloseBehavior, RichText, Stroke, TextEdit, Ui,
    WidgetInfo, vec2,
};

use crate::bench::command::Commands;
use crate::bench::command::device::DeviceCommand;
use crate::kit::theme;
use crate::kit::theme::{Palette, ROW, STEP};
use crate::kit::widgets::text::{button, choice, named, paragraph};
use crate::tools::bridge::ports::{Ports, PortsView};
use selvedge_device::FoundPort;

/// How wide the menu of ports is, points.
const MENU: f32 = 288.0;

/// Whose device is connected.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) enum Whose {
    /// The first display's.
    First,
    /// The second's.
    Second,
}

impl Whose {
    fn connect(self, path: PathBuf) -> DeviceCommand {
        match self {
            Self::First => DeviceCommand::ConnectPort(path),
            Self::Second => DeviceCommand::ConnectSecond(Some(path)),
        }
    }

    fn emulate(self) -> DeviceCommand {
        match self {
            Self::First => DeviceCommand::ConnectEmulator,
            Self::Second => DeviceCommand::ConnectSecond(None),
        }
    }

    fn let_go(self) -> DeviceCommand {
        match self {
            Self::First => DeviceCommand::Disconnect,
            Self::Second => DeviceCommand::DisconnectSecond,
        }
    }

    /// What the field of its port is called.
    fn port(self) -> &'static str {
        match self {
            Self::First => "Port",
            Self::Second => "Port of the second display",
        }
    }
}

/// The port: typed, or chosen from those that were found.
pub(crate) fn show_port(
    ui: &mut Ui,
    (whose, port): (Whose, &mut String),
    ports: &mut Ports,
    commands: &mut Commands,
) {
    let size = vec2(ui.available_width(), ROW + 4.0);
    ui.allocate_ui_with_layout(size, Layout::right_to_left(Align::Center), |ui| {
        ui.spacing_mut().item_spacing.x = STEP;
        ui.push_id(whose, |ui| show_menu(ui, (whose, port), ports, commands));
        let field = TextEdit::singleline(port)
            .desired_width(ui.available_width())
            .margin(Margin::symmetric(6, 4))
            .font(theme::number())
            .hint_text("port, e.g. /dev/ttyACM0");
        let response = ui.add(field);
        named(&response, whose.port());
        let is_entered =
            response.lost_focus() && ui.input(|input| input.key_pressed(egui::Key::Enter));
        let path = port.trim();
        if is_entered && !path.is_empty() {
            commands.push(whose.connect(PathBuf::from(path)).into());
        }
    });
}

/// The menu of the ports that were found; opening it looks again.
fn show_menu(
    ui: &mut Ui,
    (whose, port): (Whose, &mut String),
    ports: &mut Ports,
    commands: &mut Commands,
) {
    let opener = ui.add(Button::new("").min_size(vec2(ROW + STEP, ROW)));
    opener.widget_info(|| WidgetInfo::labeled(egui::Role::Button, true, "Choose a port"));
    paint_arrow(ui, opener.rect.center());
    let opener = opener.on_hover_text("The serial ports of this machine");
    let menu = Popup::menu(&opener).close_behavior(PopupCloseBehavior::CloseOnClickOutside);
    // The click takes effect below, where the menu is shown.
    if opener.clicked() && !menu.is_open() {
        ports.list(ui.ctx());
    }
    menu.width(MENU).show(|ui| {
        ui.set_width(MENU);
        for (path, description) in &ports.view().ports {
            let name = RichText::new(path).font(theme::number());
            let tip = format!("Connect to {path}: {description}");
            if choice(ui, name, description, &tip) {
                path.clone_into(port);
                commands.push(whose.connect(PathBuf::from(path)).into());
                ui.close();
            }
        }
        if let Some(words) = empty_words(ports.view()) {
            let palette = Palette::in_ui(ui);
            ui.with_layout(Layout::top_down(Align::Min), |ui| {
                paragraph(ui, RichText::new(words).color(palette.dim));
            });
        }
        ui.separator();
        let busy = ports.view().is_listing.then_some("Looking…");
        if button(ui, "Look again", "List the ports anew", busy) {
            ports.list(ui.ctx());
        }
    });
}

/// The mark of what opens a menu.
fn paint_arrow(ui: &Ui, at: egui::Pos2) {
    let corners = [vec2(-4.0, -2.0), vec2(0.0, 2.0), vec2(4.0, -2.0)].map(|by| at + by);
    let ink = Palette::in_ui(ui).text;
    let line = egui::Shape::line(corners.to_vec(), Stroke::new(1.5, ink));
    ui.painter().add(line);
}

/// What stands in the menu where there is no port.
fn empty_words(ports: &PortsView) -> Option<String> {
    match &ports.error {
        Some(error) => Some(error.clone()),
        None if !ports.ports.is_empty() => None,
        None if ports.is_listing || !ports.is_known => Some("Looking for ports…".to_owned()),
        None => Some("No ports found: plug the device in and look again".to_owned()),
    }
}

pub(crate) fn show_connecting(
    ui: &mut Ui,
    (whose, port): (Whose, &str),
    is_connected: bool,
    commands: &mut Commands,
) {
    ui.columns(2, |columns| {
        columns[0].vertical_centered_justified(|ui| {
            let path = port.trim();
            let missing = path
                .is_empty()
                .then_some("Type or choose the path of a port first");
            if button(ui, "Connect", "Connect to this port", missing) {
                commands.push(whose.connect(PathBuf::from(path)).into());
            }
        });
        columns[1].vertical_centered_justified(|ui| {
            if is_connected {
                if button(ui, "Disconnect", "Stop the device and let go of it", None) {
                    commands.push(whose.let_go().into());
                }
                return;
            }
            let tip = "Connect to the emulator in this program";
            if button(ui, "Emulator", tip, None) {
                commands.push(whose.emulate().into());
            }
        });
    });
}

/// How the sentence begins, here and as a notice.
pub(crate) const BACK: &str = "The array is back as";

/// Shows what is back, if anything is.
pub(crate) fn show_back(ui: &mut Ui, back: Option<&FoundPort>, commands: &mut Commands) {
    let Some(found) = back else { return };
    let path = found.path.display().to_string();
    ui.add_space(STEP);
    let words = RichText::new(back_words(found)).color(Palette::in_ui(ui).text);
    ui.label(words).on_hover_text(found.by.words());
    let tip = format!("Connect to {path}; the device stays disarmed");
    ui.vertical_centered_justified(|ui| {
        if button(ui, "Connect again", &tip, None) {
            commands.push(DeviceCommand::ConnectPort(found.path.clone()).into());
        }
    });
}

/// Where it is.
fn back_words(found: &FoundPort) -> String {
    format!("{BACK} {}", found.path.display())
}

/// The notice of it.
pub(crate) fn back_notice(found: &FoundPort) -> String {
    format!("{}: connect again", back_words(found))
}

#[cfg(test)]
mod tests {
    use super::*;
    use selvedge_device::RecognisedBy;

    #[test]
    fn an_empty_menu_says_why_it_is_empty() {
        let new = PortsView::default();
        assert!(empty_words(&new).is_some_and(|words| words.starts_with("Looking")));
        let none = PortsView {
            is_known: true,
            ..new.clone()
        };
        assert!(empty_words(&none).is_some_and(|words| words.starts_with("No ports")));
        let again = PortsView {
            is_listing: true,
            ..none.clone()
        };
        assert!(empty_words(&again).is_some_and(|words| words.starts_with("Looking")));
        let failed = PortsView {
            error: Some("no udev".to_owned()),
            ..none.clone()
        };
        assert_eq!(empty_words(&failed).as_deref(), Some("no udev"));
        let found = PortsView {
            ports: vec![("/dev/ttyACM0".to_owned(), String::new())],
            ..none
        };
        assert_eq!(empty_words(&found), None);
    }

    #[test]
    fn a_notice_begins_with_what_it_is_put_away_by() {
        let found = FoundPort {
            path: PathBuf::from("/dev/ttyACM1"),
            by: RecognisedBy::UsbSerial,
        };
        let line = back_notice(&found);
        assert_eq!(line, "The array is back as /dev/ttyACM1: connect again");
        assert!(line.starts_with(BACK));
    }
}
