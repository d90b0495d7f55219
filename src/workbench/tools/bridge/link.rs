//! Where the device is and how it is, and arming.

use eframe::egui::{self, Align, Button, Layout, RichText, Stroke, Ui, vec2};

use crate::bench::command::Commands;
use crate::bench::command::device::DeviceCommand;
use crate::bench::view::{BridgePhase, BridgeView};
use crate::kit::theme::{Palette, ROW};
use crate::kit::widgets::text::{mark, paragraph, small};

/// How it stands with a link.
pub(crate) fn word(bridge: Option<&BridgeView>) -> &'static str {
    bridge.map_or("not connected", |bridge| bridge.state)
}

pub(crate) fn show_state(ui: &mut Ui, bridge: Option<&BridgeView>, target: Option<&str>) {
    let palette = Palette::in_ui(ui);
    let lamp = match bridge.map(|bridge| bridge.phase) {
        Some(BridgePhase::Armed | BridgePhase::Broken) => palette.danger,
        Some(BridgePhase::Ready) => palette.text,
        Some(BridgePhase::Opening) | None => palette.line,
    };
    let word = word(bridge);
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

/// Why the device is not driven, in the words of the one line.
pub(crate) fn show_trouble(ui: &mut Ui, trouble: Option<&str>) {
    let Some(trouble) = trouble else { return };
    let ink = Palette::in_ui(ui).danger;
    paragraph(ui, small(trouble, ink));
}

pub(crate) fn show_arming(ui: &mut Ui, bridge: Option<&BridgeView>, commands: &mut Commands) {
    let palette = Palette::in_ui(ui);
    let phase = bridge.map(|bridge| bridge.phase);
    let size = vec2(ui.available_width(), ROW + 4.0);
    if phase == Some(BridgePhase::Armed) {
        let text = RichText::new("Disarm").color(palette.danger);
        let edge = Stroke::new(1.0, palette.danger);
        let armed = Button::new(text).stroke(edge);
        let tip = "Ramp the device to silence; the window goes on";
        if ui.add_sized(size, armed).on_hover_text(tip).clicked() {
            commands.push(DeviceCommand::Disarm.into());
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
        commands.push(DeviceCommand::Arm.into());
    }
}
