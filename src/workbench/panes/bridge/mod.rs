//! The device: where it is, how it is, arming; the array that it drives; and the counters that tell
//! whether to trust it.
//!
//! What is needed at once stands on top; the parts below it fold away, each with what matters of it
//! beside its name.

mod array;
mod back;
mod calibration;
mod counters;
mod faults;
mod felt;
mod inputs;
mod link;
mod port;
mod surface;
mod timing;
mod wiring;

pub(crate) use array::ArrayView;

use eframe::egui::Ui;

use super::Wishes;
use crate::plant::PlantView;
use crate::ports::PortsView;
use crate::sources::SourcesView;
use crate::theme::STEP;
use crate::view::Live;
use crate::widgets::fold;
use selvedge_device::FaultWords;

pub(crate) use back::BACK;
pub(crate) use back::notice as back_notice;

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
    wishes: &mut Wishes,
) {
    let bridge = view.live.bridge.as_ref();
    link::show_state(ui, bridge, view.target);
    link::show_arming(ui, bridge, view.live.is_stopped, wishes);
    timing::show_fault(ui, bridge, wishes);
    back::show(ui, view.ports.back.as_ref(), wishes);
    if let Some(wizard) = view.array.wizard {
        ui.add_space(STEP);
        wiring::show_wizard(ui, wizard, view, wishes);
        return;
    }
    ui.add_space(STEP);
    port::show_port(ui, typed.port, view.ports, wishes);
    port::show_connecting(ui, bridge.is_some(), typed.port, wishes);
    ui.add_space(STEP);
    fold(ui, ("Array", false), &array::summary(view), |ui| {
        array::show(ui, view, typed.copy_name, wishes);
        show_contactors(ui, view, wishes);
    });
    fold(ui, ("Link", true), &counters::summary(bridge), |ui| {
        counters::show_counters(ui, bridge, view.live.status.felt_age_s);
        timing::show_focus(ui, view.stops_on_focus_loss, wishes);
    });
    fold(ui, ("Timing", false), &timing::summary(bridge), |ui| {
        timing::show(ui, bridge, wishes);
    });
    fold(ui, ("Input", false), inputs::word(view.live), |ui| {
        inputs::show(ui, view.live, view.sources, wishes);
    });
    if let Some(running) = view.faults {
        let summary = faults::summary(running, typed.faults);
        fold(ui, ("Faults", false), &summary, |ui| {
            faults::show(ui, typed.faults, wishes);
        });
    }
    if let Some(plant) = view.plant {
        felt::show(ui, plant, wishes);
    }
}

/// What is known of each contactor.
fn show_contactors(ui: &mut Ui, view: &BridgePane<'_>, wishes: &mut Wishes) {
    if view.array.places_mm.is_empty() {
        return;
    }
    let summary = calibration::summary(view);
    fold(ui, ("Calibration", false), &summary, |ui| {
        calibration::show(ui, &view.array, wishes);
    });
    fold(ui, ("Wiring", false), &wiring::summary(view), |ui| {
        wiring::show(ui, view, wishes);
    });
}

#[cfg(test)]
mod tests;
