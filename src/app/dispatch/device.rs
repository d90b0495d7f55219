//! Commands to the device.

use eframe::egui;

use crate::app::command::DeviceCommand;
use crate::app::query;
use crate::app::window::Workbench;
use crate::bridge::Target;
use crate::engine;

impl Workbench {
    pub(super) fn dispatch_device(&mut self, ctx: &egui::Context, command: DeviceCommand) {
        match command {
            DeviceCommand::Arm => self.send(engine::Command::Arm),
            DeviceCommand::GoOn => {
                // The engine goes on and refuses to arm what is not there: no news to anybody.
                self.transient.n_expected_refusals += 1;
                self.send(engine::Command::Arm);
            }
            DeviceCommand::Disarm => self.send(engine::Command::Disarm),
            DeviceCommand::ConnectEmulator => self.connect(Target::Emulator),
            DeviceCommand::ConnectPort(path) => self.connect(Target::Port(path)),
            DeviceCommand::Disconnect => {
                self.transient.target = None;
                self.send(engine::Command::Disconnect);
            }
            DeviceCommand::Array(command) => self.dispatch_array(command),
            DeviceCommand::ListPorts => self.transient.ports.list(ctx),
        }
    }

    fn connect(&mut self, target: Target) {
        // What was said of the last device is no news of this one.
        if let Some(last) = &self.transient.target {
            self.transient.notices.forget_about(last);
        }
        self.transient.target = Some(query::device_name(&target));
        self.send(engine::Command::Connect(target));
    }
}
