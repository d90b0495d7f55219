//! The device: where it is, how it is, arming; the array that it drives; and the counters that tell
//! whether to trust it.
//!
//! What is needed at once stands on top; the parts below it fold away, each with what matters of it
//! beside its name.

pub(crate) mod actuators;
pub(crate) mod array;
pub(crate) mod back;
pub(crate) mod calibration;
pub(crate) mod counters;
pub(crate) mod dispatch;
pub(crate) mod dispatch_array;
pub(crate) mod export;
pub(crate) mod fault_bench;
pub(crate) mod faults;
pub(crate) mod felt;
pub(crate) mod inputs;
pub(crate) mod link;
pub(crate) mod pane;
pub(crate) mod port;
pub(crate) mod ports;
pub(crate) mod replug;
pub(crate) mod surface;
#[cfg(test)]
mod tests;
pub(crate) mod timing;
pub(crate) mod wiring;

pub(crate) use crate::tools::bridge::array::ArrayView;

use eframe::egui::Ui;

use crate::bench::command::Commands;
use crate::bench::sources::SourcesView;
use crate::bench::view::Live;
use crate::kit::theme::STEP;
use crate::kit::widgets::fold;
use crate::tools::bridge::actuators::PlantView;
use crate::tools::bridge::ports::PortsView;
use selvedge_device::FaultWords;

/// What the pane is drawn from.
pub(crate) struct BridgePane<'a> {
    /// The engine and the device.
    pub live: &'a Live,
    /// What the link was opened to.
    pub target: Option<&'a str>,
    /// The ports that were found.
    pub ports: &'a PortsView,
    /// The array.
    pub array: ArrayView<'a>,
    /// What moves the display, and who hears of it.
    pub sources: &'a SourcesView,
    /// What a model says the emulator's contactors do; `None` for other devices.
    pub plant: Option<&'a PlantView>,
    /// What goes wrong with the emulator that is connected; `None` for other devices.
    pub faults: Option<&'a FaultWords>,
    /// Whether an armed device stops when the window loses the keyboard.
    pub(crate) stops_on_focus_loss: bool,
}

/// What is typed in the pane.
pub(crate) struct BridgeTyped<'a> {
    /// A port.
    pub port: &'a mut String,
    /// The name of a copy of the array profile.
    pub(crate) copy_name: &'a mut String,
    /// What is to go wrong with the emulator next.
    pub faults: &'a mut FaultWords,
}

/// Shows the pane.
pub(crate) fn show(
    ui: &mut Ui,
    view: &BridgePane<'_>,
    typed: &mut BridgeTyped<'_>,
    commands: &mut Commands,
) {
    let bridge = view.live.bridge.as_ref();
    link::show_state(ui, bridge, view.target);
    link::show_arming(ui, bridge, view.live.is_stopped, commands);
    timing::show_fault(ui, bridge, commands);
    back::show(ui, view.ports.back.as_ref(), commands);
    if let Some(wizard) = view.array.wizard {
        ui.add_space(STEP);
        wiring::show_wizard(ui, wizard, view, commands);
        return;
    }
    ui.add_space(STEP);
    port::show_port(ui, typed.port, view.ports, commands);
    port::show_connecting(ui, bridge.is_some(), typed.port, commands);
    ui.add_space(STEP);
    fold(ui, ("Array", false), &array::summary(view), |ui| {
        array::show(ui, view, typed.copy_name, commands);
        show_contactors(ui, view, commands);
    });
    fold(ui, ("Link", true), &counters::summary(bridge), |ui| {
        counters::show_counters(ui, bridge, view.live.status.felt_age_s);
        timing::show_focus(ui, view.stops_on_focus_loss, commands);
    });
    fold(ui, ("Timing", false), &timing::summary(bridge), |ui| {
        timing::show(ui, bridge, commands);
    });
    fold(ui, ("Input", false), inputs::word(view.live), |ui| {
        inputs::show(ui, view.live, view.sources, commands);
    });
    if let Some(running) = view.faults {
        let summary = faults::summary(running, typed.faults);
        fold(ui, ("Faults", false), &summary, |ui| {
            faults::show(ui, typed.faults, commands);
        });
    }
    if let Some(plant) = view.plant {
        felt::show(ui, plant, commands);
    }
}

/// What is known of each contactor.
fn show_contactors(ui: &mut Ui, view: &BridgePane<'_>, commands: &mut Commands) {
    if view.array.places_mm.is_empty() {
        return;
    }
    let summary = calibration::summary(view);
    fold(ui, ("Calibration", false), &summary, |ui| {
        calibration::show(ui, &view.array, commands);
    });
    fold(ui, ("Wiring", false), &wiring::summary(view), |ui| {
        wiring::show(ui, view, commands);
    });
}
