//! The device: where it is, how it is, arming, and the counters that tell whether to trust it.

mod inputs;

pub(crate) use inputs::show as show_inputs;

use std::path::PathBuf;

use eframe::egui::{
    self, Align, Button, Layout, Margin, Popup, PopupCloseBehavior, RichText, Stroke, TextEdit, Ui,
    WidgetInfo, vec2,
};

use super::Wishes;
use crate::app::command::DeviceCommand;
use crate::app::ports::PortsView;
use crate::app::theme::{self, Palette, ROW, STEP};
use crate::app::view::{BridgePhase, BridgeView, Live};
use crate::app::widgets::{button, choice, mark, quiet_pair, row};
use crate::quantity;

/// How wide the menu of ports is, points.
const MENU: f32 = 288.0;

/// Shows the pane. `target` is what the link was opened to, `port` what is typed in the field,
/// `ports` what was found to choose from.
pub(crate) fn show(
    ui: &mut Ui,
    live: &Live,
    target: Option<&str>,
    port: &mut String,
    ports: &PortsView,
    wishes: &mut Wishes,
) {
    show_state(ui, live.bridge.as_ref(), target);
    show_arming(ui, live.bridge.as_ref(), live.is_stopped, wishes);
    ui.add_space(STEP);
    show_port(ui, port, ports, wishes);
    show_connecting(ui, live.bridge.is_some(), port, wishes);
    ui.add_space(STEP);
    show_counters(ui, live.bridge.as_ref(), live.status.felt_age_s);
}

fn show_state(ui: &mut Ui, bridge: Option<&BridgeView>, target: Option<&str>) {
    let palette = Palette::in_ui(ui);
    let (lamp, word) = match bridge {
        None => (palette.line, "not connected"),
        Some(bridge) => (
            match bridge.phase {
                BridgePhase::Armed | BridgePhase::Broken => palette.danger,
                BridgePhase::Ready => palette.text,
                BridgePhase::Opening => palette.line,
            },
            bridge.state,
        ),
    };
    let name = target.unwrap_or("No device");
    let size = vec2(ui.available_width(), ROW);
    ui.allocate_ui_with_layout(size, Layout::right_to_left(Align::Center), |ui| {
        ui.label(RichText::new(word).color(palette.text));
        mark(ui, lamp, word);
        // Paths of ports may be long; the state has its place all the same.
        ui.with_layout(Layout::left_to_right(Align::Center), |ui| {
            ui.add(egui::Label::new(name).truncate());
        });
    });
}

fn show_arming(ui: &mut Ui, bridge: Option<&BridgeView>, is_stopped: bool, wishes: &mut Wishes) {
    let palette = Palette::in_ui(ui);
    let phase = bridge.map(|bridge| bridge.phase);
    let size = vec2(ui.available_width(), ROW + 4.0);
    if phase == Some(BridgePhase::Armed) {
        let text = RichText::new("Disarm").color(palette.danger);
        let edge = Stroke::new(1.0, palette.danger);
        let armed = Button::new(text).stroke(edge);
        let tip = "Ramp the device to silence; the window goes on";
        if ui.add_sized(size, armed).on_hover_text(tip).clicked() {
            wishes.push(DeviceCommand::Disarm.into());
        }
        return;
    }
    if matches!(phase, None | Some(BridgePhase::Broken)) && is_stopped {
        let tip = "End the silence of all off; no device is connected that works";
        if ui
            .add_sized(size, Button::new("Go on without a device"))
            .on_hover_text(tip)
            .clicked()
        {
            wishes.push(DeviceCommand::GoOn.into());
        }
        return;
    }
    let why = match phase {
        None => Some("Connect a device first"),
        Some(BridgePhase::Opening) => Some("The device is not ready yet"),
        Some(BridgePhase::Broken) => Some("The device is gone or refused: connect again"),
        Some(_) => None,
    };
    let arm = ui
        .add_enabled_ui(why.is_none(), |ui| ui.add_sized(size, Button::new("Arm")))
        .inner;
    let tip = "Turn the high voltage on; levels rise from zero";
    let arm = match why {
        Some(why) => arm.on_disabled_hover_text(why),
        None => arm.on_hover_text(tip),
    };
    if arm.clicked() {
        wishes.push(DeviceCommand::Arm.into());
    }
}

/// The port: typed, or chosen from those that were found.
fn show_port(ui: &mut Ui, port: &mut String, ports: &PortsView, wishes: &mut Wishes) {
    let size = vec2(ui.available_width(), ROW + 4.0);
    ui.allocate_ui_with_layout(size, Layout::right_to_left(Align::Center), |ui| {
        ui.spacing_mut().item_spacing.x = STEP;
        show_menu(ui, port, ports, wishes);
        let field = TextEdit::singleline(port)
            .desired_width(ui.available_width())
            .margin(Margin::symmetric(6, 4))
            .font(theme::number())
            .hint_text("port, e.g. /dev/ttyACM0");
        let response = ui.add(field);
        ui.ctx()
            .accesskit_node_builder(response.id, |node| node.set_label("Port"));
        let is_entered =
            response.lost_focus() && ui.input(|input| input.key_pressed(egui::Key::Enter));
        let path = port.trim();
        if is_entered && !path.is_empty() {
            wishes.push(DeviceCommand::ConnectPort(PathBuf::from(path)).into());
        }
    });
}

/// The menu of the ports that were found; opening it looks again.
fn show_menu(ui: &mut Ui, port: &mut String, ports: &PortsView, wishes: &mut Wishes) {
    let opener = ui.add(Button::new("").min_size(vec2(ROW + STEP, ROW)));
    opener.widget_info(|| WidgetInfo::labeled(egui::Role::Button, true, "Choose a port"));
    paint_arrow(ui, opener.rect.center());
    let opener = opener.on_hover_text("The serial ports of this machine");
    let menu = Popup::menu(&opener).close_behavior(PopupCloseBehavior::CloseOnClickOutside);
    // The click takes effect below, where the menu is shown.
    if opener.clicked() && !menu.is_open() {
        wishes.push(DeviceCommand::ListPorts.into());
    }
    menu.width(MENU).show(|ui| {
        ui.set_width(MENU);
        for (path, description) in &ports.ports {
            let name = RichText::new(path).font(theme::number());
            let tip = format!("Connect to {path}: {description}");
            if choice(ui, name, description, &tip) {
                path.clone_into(port);
                wishes.push(DeviceCommand::ConnectPort(PathBuf::from(path)).into());
                ui.close();
            }
        }
        if let Some(words) = empty_words(ports) {
            let palette = Palette::in_ui(ui);
            ui.with_layout(Layout::top_down(Align::Min), |ui| {
                ui.add(egui::Label::new(RichText::new(words).color(palette.dim)).wrap());
            });
        }
        ui.separator();
        let busy = ports.is_listing.then_some("Looking…");
        if button(ui, "Look again", "List the ports anew", busy) {
            wishes.push(DeviceCommand::ListPorts.into());
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

fn show_connecting(ui: &mut Ui, is_connected: bool, port: &str, wishes: &mut Wishes) {
    ui.columns(2, |columns| {
        columns[0].vertical_centered_justified(|ui| {
            let path = port.trim();
            let missing = path
                .is_empty()
                .then_some("Type or choose the path of a port first");
            if button(ui, "Connect", "Connect to this port", missing) {
                wishes.push(DeviceCommand::ConnectPort(PathBuf::from(path)).into());
            }
        });
        columns[1].vertical_centered_justified(|ui| {
            if is_connected {
                if button(ui, "Disconnect", "Stop the device and let go of it", None) {
                    wishes.push(DeviceCommand::Disconnect.into());
                }
                return;
            }
            let tip = "Connect to the emulator in this program";
            if button(ui, "Emulator", tip, None) {
                wishes.push(DeviceCommand::ConnectEmulator.into());
            }
        });
    });
}

fn show_counters(ui: &mut Ui, bridge: Option<&BridgeView>, felt_age_s: Option<f64>) {
    let number = |text: Option<String>| text.unwrap_or_else(|| "–".to_owned());
    let ms = |s: f64| quantity::fixed(s * 1e3, 2);
    let of = |pick: fn(&BridgeView) -> Option<f64>| bridge.and_then(pick);
    let interval_s = of(|bridge| bridge.frame_interval_s);
    let gain = of(|bridge| bridge.gain);
    let written = number(of(|bridge| bridge.stamp_to_write_s).map(ms));
    let depth = number(bridge.map(|bridge| bridge.depth.to_string()));
    let sent = number(bridge.map(|bridge| bridge.frames_sent.to_string()));
    let gain = number(gain.map(|gain| quantity::fixed(gain * 100.0, 0)));
    let felt = format!(
        "From the pointer's movement to the middle of the tick in which it is felt\nto the end of \
         the write to the port, 99 of 100: {written} ms"
    );
    let answered = bridge.and_then(|bridge| bridge.status_to_frame_s);
    let answered = answered.map_or_else(String::new, |[p99_s, most_s]| {
        let [p99, most] = [p99_s, most_s].map(quantity::time_span);
        format!("\nFrom its STATUS to our frame: 99 of 100 within {p99}, at most {most}")
    });
    let interval = format!("Measured on the device's clock{answered}");
    let rows = [
        [
            (
                "Frame interval",
                number(interval_s.map(ms)),
                "ms",
                interval.as_str(),
            ),
            ("Depth", depth, "ticks", "Ticks from a frame to its effect"),
        ],
        [
            (
                "Pointer to skin",
                number(felt_age_s.map(ms)),
                "ms",
                felt.as_str(),
            ),
            (
                "Soft start",
                gain,
                "%",
                "How far levels have risen since the device was armed",
            ),
        ],
    ];
    for row in rows {
        ui.columns_const(|columns: &mut [Ui; 2]| {
            for (ui, (name, value, unit, tip)) in columns.iter_mut().zip(row) {
                quiet_pair(ui, name, &value, unit).on_hover_text(tip);
            }
        });
    }
    quiet_pair(ui, "Frames sent", &sent, "");
    show_troubles(ui, bridge.map_or(&[], |bridge| &bridge.troubles));
}

/// Counters that ought to be zero: those that are not, in red, the rest on hover.
fn show_troubles(ui: &mut Ui, troubles: &[(&'static str, u64)]) {
    let palette = Palette::in_ui(ui);
    let counted = troubles.iter().filter(|(_, count)| *count > 0);
    let words: Vec<String> = counted
        .map(|(name, count)| format!("{count} {name}"))
        .collect();
    let (words, ink) = if words.is_empty() {
        ("none".to_owned(), palette.dim)
    } else {
        (words.join(", "), palette.danger)
    };
    let names: Vec<&str> = troubles.iter().map(|(name, _)| *name).collect();
    row(ui, "Losses and errors", |ui| {
        let label = egui::Label::new(RichText::new(words).color(ink)).truncate();
        ui.add(label)
            .on_hover_text(format!("Counted: {}", names.join(", ")));
    });
}

#[cfg(test)]
mod tests {
    use super::*;

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
}
