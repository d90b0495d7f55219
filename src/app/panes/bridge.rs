//! The device: where it is, how it is, arming, and the counters that tell whether to trust it.

use std::path::PathBuf;

use eframe::egui::{self, Align, Button, Layout, Margin, RichText, Stroke, TextEdit, Ui, vec2};

use super::Wishes;
use crate::app::command::DeviceCommand;
use crate::app::theme::{self, Palette, ROW};
use crate::app::view::{BridgePhase, BridgeView, Live};
use crate::app::widgets::{button, mark, pair, row, section};
use crate::quantity;

/// Shows the pane. `target` is what the link was opened to, `port` what is typed in the field.
pub(crate) fn show(
    ui: &mut Ui,
    live: &Live,
    target: Option<&str>,
    port: &mut String,
    wishes: &mut Wishes,
) {
    section(ui, "Bridge");
    show_state(ui, live.bridge.as_ref(), target);
    show_arming(ui, live.bridge.as_ref(), live.is_stopped, wishes);
    show_target(ui, live.bridge.is_some(), port, wishes);
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
    row(ui, target.unwrap_or("No device"), |ui| {
        ui.label(RichText::new(word).color(palette.text));
        mark(ui, lamp, word);
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
    if phase.is_none() && is_stopped {
        let tip = "End the silence of all off; no device is connected";
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

fn show_target(ui: &mut Ui, is_connected: bool, port: &mut String, wishes: &mut Wishes) {
    ui.with_layout(Layout::right_to_left(Align::Min), |ui| {
        if is_connected {
            if button(ui, "Disconnect", "Stop the device and let go of it", None) {
                wishes.push(DeviceCommand::Disconnect.into());
            }
        } else if button(
            ui,
            "Emulator",
            "Connect to the emulator in this program",
            None,
        ) {
            wishes.push(DeviceCommand::ConnectEmulator.into());
        }
        let path = port.trim();
        let missing = path.is_empty().then_some("Type the path of a port first");
        let is_asked = button(ui, "Connect", "Connect to this port", missing);
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
        if (is_asked || is_entered) && !path.is_empty() {
            wishes.push(DeviceCommand::ConnectPort(PathBuf::from(path)).into());
        }
    });
}

fn show_counters(ui: &mut Ui, bridge: Option<&BridgeView>, felt_age_s: Option<f64>) {
    let number = |text: Option<String>| text.unwrap_or_else(|| "–".to_owned());
    let ms = |s: f64| quantity::fixed(s * 1e3, 2);
    let of = |pick: fn(&BridgeView) -> Option<f64>| bridge.and_then(pick);
    let interval_s = of(|bridge| bridge.frame_interval_s);
    let gain = of(|bridge| bridge.gain);
    let written = number(of(|bridge| bridge.stamp_to_write_s).map(ms));
    pair(ui, "Frame interval", &number(interval_s.map(ms)), "ms");
    pair(ui, "Pointer to skin", &number(felt_age_s.map(ms)), "ms").on_hover_text(format!(
        "From the pointer's movement to the middle of the tick in which it is felt\nto the end of \
         the write to the port, 99 of 100: {written} ms"
    ));
    pair(
        ui,
        "Depth",
        &number(bridge.map(|bridge| bridge.depth.to_string())),
        "ticks",
    );
    pair(
        ui,
        "Soft start",
        &number(gain.map(|gain| quantity::fixed(gain * 100.0, 0))),
        "%",
    );
    pair(
        ui,
        "Frames sent",
        &number(bridge.map(|bridge| bridge.frames_sent.to_string())),
        "",
    );
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
