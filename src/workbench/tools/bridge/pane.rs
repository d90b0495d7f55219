//! What the pane of the device is drawn from.

use eframe::egui::Ui;

use crate::bench::Bench;
use crate::bench::command::Commands;
use crate::tools::bridge::array::ArrayView;
use crate::tools::bridge::{BridgePane, BridgeTyped};
use selvedge_device::LARGEST_CHANNELS;

impl Bench {
    /// Shows the pane of the device and the array that it drives.
    pub(crate) fn show_bridge(&mut self, ui: &mut Ui, commands: &mut Commands) {
        let has_plant = self.peek_at_plant(ui.ctx()).is_some();
        let profile = self.array();
        let mut copy_name = std::mem::take(&mut self.arrays.copy_name);
        let mut port = std::mem::take(&mut self.transient.port);
        let mut faults = std::mem::take(&mut self.transient.faults);
        // What no frame can carry is no array that a device drives.
        let is_drivable = profile.n_contactors() <= LARGEST_CHANNELS;
        let array = ArrayView {
            places_mm: if is_drivable {
                profile.places_mm()
            } else {
                Vec::new()
            },
            is_own: self.arrays.is_own(&profile.name),
            choices: self.arrays.choices(profile.n_contactors()),
            waits: self.arrays.waits,
            contactor: self.workspace.contactor,
            wizard: self.arrays.wizard.as_ref(),
            folder: self.arrays.folder(),
            profile: &profile,
        };
        let view = BridgePane {
            live: &self.transient.live,
            target: self.transient.target.as_deref(),
            ports: self.transient.ports.view(),
            array,
            sources: &self.sources_view(),
            plant: has_plant.then_some(&self.transient.plant.view),
            faults: faults.running.as_ref(),
            stops_on_focus_loss: self.settings.preferences.stops_on_focus_loss,
        };
        let mut typed = BridgeTyped {
            port: &mut port,
            copy_name: &mut copy_name,
            faults: &mut faults.chosen,
        };
        crate::tools::bridge::show(ui, &view, &mut typed, commands);
        self.arrays.copy_name = copy_name;
        self.transient.port = port;
        self.transient.faults = faults;
    }
}
