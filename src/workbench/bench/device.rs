//! The link to the device: what is connected, and what goes wrong with the emulator.

use crate::bench::command::device::DeviceCommand;
use crate::bench::{Bench, query};
use selvedge_device::{DeviceUid, FaultWords, Target};

impl Bench {
    pub(crate) fn dispatch_device(&mut self, command: DeviceCommand) {
        match command {
            DeviceCommand::Arm => self.send(selvedge_engine::Command::Arm),
            DeviceCommand::GoOn => {
                self.send(selvedge_engine::Command::Resume);
                if self.live.play.moves_by_itself() {
                    self.send(selvedge_engine::Command::Play);
                }
            }
            DeviceCommand::Disarm => self.send(selvedge_engine::Command::Disarm),
            DeviceCommand::ConnectEmulator => self.connect(Target::Emulator),
            DeviceCommand::StartFaults(words) => self.start_faults(words),
            DeviceCommand::ConnectPort(path) => self.connect(Target::Port(path)),
            DeviceCommand::Disconnect => {
                self.device.target = None;
                self.device.faults = None;
                self.send(selvedge_engine::Command::Disconnect);
            }
            DeviceCommand::ConnectSecond(path) => {
                let target = path.map_or(Target::Emulator, Target::Port);
                self.device.second = Some(query::device_name(&target));
                self.send(selvedge_engine::Command::ConnectSecond(target));
            }
            DeviceCommand::DisconnectSecond => {
                self.device.second = None;
                self.send(selvedge_engine::Command::DisconnectSecond);
            }
            DeviceCommand::Array(command) => self.dispatch_array(command),
            DeviceCommand::ClearFaults => self.send(selvedge_engine::Command::ClearFaults),
            DeviceCommand::CopyLogPath => {
                let log = self.engine.session_log();
                let path = log.map(|log| log.path().display().to_string());
                self.ctx.copy_text(path.unwrap_or_default());
            }
            DeviceCommand::OpenLogFolder => {
                let log = self.engine.session_log();
                if let Some(folder) = log.and_then(|log| log.path().parent()) {
                    self.files.folders.open(&self.executor, folder);
                }
            }
            DeviceCommand::StopOnFocusLoss(is_wanted) => {
                self.settings.preferences.stops_on_focus_loss = is_wanted;
            }
        }
    }

    /// The emulator with these faults.
    ///
    /// # Errors
    /// One line: which of them cannot be read, or cannot be had by the array in force.
    pub(crate) fn emulator_with(&self, words: &FaultWords) -> Result<Target, String> {
        let faults = words
            .faults()
            .map_err(|(option, why)| format!("{}: {why}", option.label))?;
        faults
            .check(self.array().n_contactors())
            .map_err(|why| query::capitalised(&why))?;
        if faults.is_none() {
            return Ok(Target::Emulator);
        }
        Ok(Target::FaultyEmulator(Box::new(faults)))
    }

    /// Whether nobody feels what the device is given: it is an emulator, here or behind a port.
    pub(crate) fn is_emulated(&self) -> bool {
        let link = self.live.bridge.as_ref();
        let uid = link.and_then(|link| link.uid);
        self.device.faults.is_some() || uid == Some(DeviceUid::EMULATOR)
    }

    /// Starts the emulator anew with what was chosen, if it can be read and this array can have it.
    fn start_faults(&mut self, words: FaultWords) {
        match self.emulator_with(&words) {
            Ok(target) => {
                self.connect(target);
                self.device.faults = Some(words);
            }
            Err(why) => self.notices.give(why),
        }
    }

    fn connect(&mut self, target: Target) {
        self.device.faults = target.is_emulator().then(FaultWords::default);
        // What was said of the last device is no news of this one.
        if let Some(last) = &self.device.target {
            self.notices.forget_about(last);
        }
        self.device.trouble = None;
        self.device.target = Some(query::device_name(&target));
        self.send(selvedge_engine::Command::Connect(target));
    }
}

#[cfg(test)]
mod tests {
    use eframe::egui;

    use super::*;
    use crate::bench::Drive;
    use crate::bench::command::device::DeviceCommand;
    use crate::shell::window::Workbench;

    #[test]
    fn faults_last_until_something_else_is_connected() {
        let ctx = egui::Context::default();
        let mut window = Workbench::new(&ctx, None, Drive::Stepped).unwrap();
        assert_eq!(window.bench.device.faults, None);
        let words = FaultWords::of(&[("seed", "7"), ("drop", "0.1%")]);
        window.dispatch(DeviceCommand::StartFaults(words.clone()).into());
        assert_eq!(window.bench.device.faults.as_ref(), Some(&words));
        let name = window.bench.device.target.as_deref();
        assert_eq!(name, Some("Emulator with faults"));
        window.dispatch(DeviceCommand::ConnectEmulator.into());
        assert_eq!(window.bench.device.faults, Some(FaultWords::default()));
        window.dispatch(DeviceCommand::Disconnect.into());
        assert_eq!(window.bench.device.faults, None);
    }

    #[test]
    fn what_cannot_be_had_is_a_notice_and_nothing_is_started() {
        let ctx = egui::Context::default();
        let mut window = Workbench::new(&ctx, None, Drive::Stepped).unwrap();
        for (option, text, described) in [
            ("dead", "24", "Channel 24: this array has channels 0 to 23"),
            ("drop", "often", "Drop: \"often\" is no share"),
        ] {
            let words = FaultWords::of(&[(option, text)]);
            window.dispatch(DeviceCommand::StartFaults(words).into());
            let shown = window.bench.notices.shown();
            let last = &shown.last().unwrap().text;
            assert!(last.starts_with(described), "{last}");
            assert_eq!(window.bench.device.faults, None);
        }
    }
}
