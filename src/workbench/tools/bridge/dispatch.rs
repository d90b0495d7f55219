//! Commands to the device.

use eframe::egui;

use crate::bench::command::device::DeviceCommand;
use crate::bench::{Bench, query};
use selvedge_device::{FaultWords, Target};

impl Bench {
    pub(crate) fn dispatch_device(&mut self, ctx: &egui::Context, command: DeviceCommand) {
        match command {
            DeviceCommand::Arm => self.send(selvedge_engine::Command::Arm),
            DeviceCommand::GoOn => {
                // The engine goes on and refuses to arm what is not there: no news to anybody.
                self.transient.n_expected_refusals += 1;
                self.send(selvedge_engine::Command::Arm);
            }
            DeviceCommand::Disarm => self.send(selvedge_engine::Command::Disarm),
            DeviceCommand::ConnectEmulator => self.connect(Target::Emulator),
            DeviceCommand::StartFaults(words) => self.start_faults(words),
            DeviceCommand::ConnectPort(path) => self.connect(Target::Port(path)),
            DeviceCommand::Disconnect => {
                self.transient.target = None;
                self.transient.faults.running = None;
                self.transient.ports.hold(None);
                self.send(selvedge_engine::Command::Disconnect);
            }
            DeviceCommand::Array(command) => self.dispatch_array(command),
            DeviceCommand::ListPorts => self.transient.ports.list(ctx),
            DeviceCommand::ShowContactors(is_open) => self.transient.plant.is_open = is_open,
            DeviceCommand::LoadContactors(skin) => self.transient.plant.skin = skin,
            DeviceCommand::ClearFaults => self.send(selvedge_engine::Command::ClearFaults),
            DeviceCommand::CopyLogPath => {
                let log = self.engine.session_log();
                let path = log.map(|log| log.path().display().to_string());
                ctx.copy_text(path.unwrap_or_default());
            }
            DeviceCommand::OpenLogFolder => {
                let log = self.engine.session_log();
                if let Some(folder) = log.and_then(|log| log.path().parent()) {
                    self.transient.folders.open(&self.executor, folder);
                }
            }
            DeviceCommand::StopOnFocusLoss(is_wanted) => {
                self.settings.preferences.stops_on_focus_loss = is_wanted;
            }
        }
    }

    /// Starts the emulator anew with what was chosen, if it can be read and this array can have it.
    fn start_faults(&mut self, words: FaultWords) {
        let n_channels = self.array().n_contactors();
        match crate::tools::bridge::fault_bench::target(&words, n_channels) {
            Ok(target) => {
                self.connect(target);
                self.transient.faults.running = Some(words);
            }
            Err(why) => self.transient.notices.give(why),
        }
    }

    fn connect(&mut self, target: Target) {
        self.transient.faults.running = target.is_emulator().then(FaultWords::default);
        // What was said of the last device is no news of this one.
        if let Some(last) = &self.transient.target {
            self.transient.notices.forget_about(last);
        }
        self.transient
            .notices
            .forget_about(crate::tools::bridge::back::BACK);
        self.transient.target = Some(query::device_name(&target));
        self.transient.ports.hold(Some(&target));
        self.send(selvedge_engine::Command::Connect(target));
    }
}
