//! The device: where it is, how it is, arming; the array that it drives; and the counters that tell
//! whether to trust it.
//!
//! What is needed at once stands on top; the parts below it fold away, each with what matters of it
//! beside its name.

pub(crate) mod actuators;
pub(crate) mod array;
pub(crate) mod calibration;
pub(crate) mod certificate;
pub(crate) mod counters;
pub(crate) mod export;
pub(crate) mod faults;
pub(crate) mod felt;
pub(crate) mod inputs;
pub(crate) mod link;
pub(crate) mod port;
pub(crate) mod ports;
pub(crate) mod replug;
pub(crate) mod surface;
pub(crate) mod telemetry;
#[cfg(test)]
mod tests;
pub(crate) mod timing;
pub(crate) mod view;
pub(crate) mod wiring;

use eframe::egui::Ui;

use crate::bench::Bench;
use crate::bench::command::array::ArrayCommand;
use crate::bench::command::device::DeviceCommand;
use crate::bench::command::{Command, Commands};
use crate::bench::export::Exported;
use crate::bench::pane::Pane;
use crate::bench::settings::own_certificates;
use crate::bench::tool::{PaneContext, Tool};
use crate::bench::view::BridgeView;
use crate::kit::pane::{framed, scrolled};
use crate::kit::theme::STEP;
use crate::kit::widgets::fold;
use crate::kit::widgets::text::{paragraph, quiet};
use crate::tools::bridge::actuators::ActuatorPeek;
use crate::tools::bridge::certificate::CertificateMark;
use crate::tools::bridge::port::Whose;
use crate::tools::bridge::ports::Ports;
use crate::tools::bridge::view::{ArrayView, BridgePane, SecondDevice};
use selvedge_device::{BridgeState, FaultWords, LARGEST_CHANNELS, Target};

/// The pane of the device: what is typed and chosen in it, and what it looks after while a link is
/// open.
#[derive(Debug, Default)]
pub(crate) struct Bridge {
    /// The serial ports of this computer.
    ports: Ports,
    /// What is typed as a port.
    port: String,
    /// The same for the second display's device.
    second_port: String,
    /// What is typed as the name of a copy of the array profile.
    copy_name: String,
    /// What is to go wrong with the emulator when it is started next.
    faults: FaultWords,
    /// The emulator's contactors.
    actuators: ActuatorPeek,
    /// Whether the device passed everything.
    certificate: CertificateMark,
}

impl Tool for Bridge {
    fn panes(&self) -> &'static [Pane] {
        &[Pane::Bridge]
    }

    fn logic(&mut self, bench: &mut Bench) {
        self.ports.poll();
        let link = bench.engine.snapshot().link;
        let is_lost = link.is_some_and(|link| link.state == BridgeState::Lost);
        let uid = link.and_then(|link| link.caps).map(|caps| caps.uid);
        if let Some(found) = self.ports.follow(&bench.ctx, is_lost, uid) {
            bench.notices.give(port::back_notice(&found));
        }
        let caps = link
            .filter(|link| link.state.is_open())
            .and_then(|link| link.caps);
        let caps = caps.filter(|_| bench.device.faults.is_none());
        let tried = caps.as_ref().zip(own_certificates());
        self.certificate.follow(&bench.ctx, &bench.executor, tried);
        let is_in_sight = bench.shows(Pane::Bridge);
        self.actuators.rest(&mut bench.engine, is_in_sight);
    }

    fn ui(&mut self, pane: Pane, ui: &mut Ui, context: &mut PaneContext<'_>) {
        let bench = &mut *context.bench;
        let mut has_developer_tools = bench.settings.preferences.developer_tools;
        {
            let has_actuator_model = self.actuators.look(ui.ctx(), &mut bench.engine).is_some();
            let profile = bench.array();
            // What no frame can carry is no array that a device drives.
            let is_drivable = profile.n_contactors() <= LARGEST_CHANNELS;
            let view = BridgePane {
                live: &bench.live,
                target: bench.device.target.as_deref(),
                second: (bench.document.scene().displays.len() > 1).then_some(SecondDevice {
                    target: bench.device.second.as_deref(),
                }),
                array: ArrayView {
                    places_mm: if is_drivable {
                        profile.places_mm()
                    } else {
                        Vec::new()
                    },
                    is_own: bench.device.arrays.is_own(&profile.name),
                    choices: bench.device.arrays.choices(profile.n_contactors()),
                    waits: bench.device.arrays.waits,
                    contactor: bench.selection.contactor,
                    wizard: bench.device.arrays.wizard.as_ref(),
                    folder: bench.device.arrays.folder(),
                    profile: &profile,
                },
                sources: &bench.sources_view(),
                has_actuator_model,
                faults: bench.device.faults.as_ref(),
                trouble: bench.device.trouble.as_deref(),
                has_developer_tools,
                stops_on_focus_loss: bench.settings.preferences.stops_on_focus_loss,
            };
            framed(ui, 12, |ui| {
                show_device(ui, &view, context.commands);
                certificate::show(ui, self.certificate.state());
            });
            scrolled(ui, pane.title(), |ui| {
                self.show(ui, &view, context.commands);
                ui.add_space(STEP);
                show_developer_tools(ui, &mut has_developer_tools);
            });
        }
        bench.settings.preferences.developer_tools = has_developer_tools;
    }

    fn command(&mut self, command: &Command, bench: &mut Bench) {
        let Command::Device(command) = command else {
            return;
        };
        let target = match command {
            DeviceCommand::ConnectEmulator => Some(Target::Emulator),
            DeviceCommand::StartFaults(words) => match bench.emulator_with(words) {
                Ok(target) => Some(target),
                Err(_) => return,
            },
            DeviceCommand::ConnectPort(path) => Some(Target::Port(path.clone())),
            DeviceCommand::Disconnect => None,
            DeviceCommand::Array(ArrayCommand::Copy(name)) => {
                if bench.device.arrays.is_free(name.trim()) {
                    self.copy_name.clear();
                }
                return;
            }
            _ => return,
        };
        if target.is_some() {
            bench.notices.forget_about(port::BACK);
        }
        self.ports.hold(&bench.ctx, target.as_ref());
    }

    fn export(&mut self, _pane: Pane, bench: &mut Bench) -> Result<Exported, &'static str> {
        let bridge = bench.live.bridge.as_ref();
        let exported =
            bridge.and_then(|bridge| export::distributions(&bridge.timing, bench.origin()));
        exported.ok_or("There is nothing to export yet: connect a device")
    }
}

impl Bridge {
    /// Shows what folds away and scrolls.
    pub(crate) fn show(&mut self, ui: &mut Ui, view: &BridgePane<'_>, commands: &mut Commands) {
        let bridge = view.live.bridge.as_ref();
        port::show_back(ui, self.ports.view().back.as_ref(), commands);
        if let Some(wizard) = view.array.wizard {
            ui.add_space(STEP);
            wiring::show_wizard(ui, wizard, view, commands);
            return;
        }
        ui.add_space(STEP);
        let first = Whose::First;
        port::show_port(ui, (first, &mut self.port), &mut self.ports, commands);
        port::show_connecting(ui, (first, &self.port), bridge.is_some(), commands);
        ui.add_space(STEP);
        if let Some(second) = view.second {
            let bridge = view.live.second_bridge.as_ref();
            self.show_second(ui, bridge, second.target, commands);
        }
        fold(ui, ("Array", false), &array::summary(view), |ui| {
            array::show(ui, view, &mut self.copy_name, commands);
            show_contactors(ui, view, commands);
        });
        fold(ui, ("Link", true), &counters::summary(bridge), |ui| {
            counters::show_counters(ui, bridge, view.live.status.felt_age_s);
            timing::show_focus(ui, view.stops_on_focus_loss, commands);
        });
        fold(
            ui,
            ("Telemetry", false),
            &telemetry::summary(bridge),
            |ui| {
                telemetry::show(ui, bridge);
            },
        );
        fold(ui, ("Timing", false), &timing::summary(bridge), |ui| {
            timing::show(ui, bridge, commands);
        });
        fold(ui, ("Input", false), inputs::word(view.live), |ui| {
            inputs::show(ui, view.live, view.sources, commands);
        });
        if !view.has_developer_tools {
            return;
        }
        if let Some(running) = view.faults {
            let summary = faults::summary(running, &self.faults);
            fold(ui, ("Faults", false), &summary, |ui| {
                faults::show(ui, &mut self.faults, commands);
            });
        }
        if view.has_actuator_model {
            felt::show(ui, &mut self.actuators);
        }
    }
}

impl Bridge {
    /// The device of the second display: how it is, and where it is.
    fn show_second(
        &mut self,
        ui: &mut Ui,
        bridge: Option<&BridgeView>,
        target: Option<&str>,
        commands: &mut Commands,
    ) {
        let whose = Whose::Second;
        fold(ui, ("Second display", true), link::word(bridge), |ui| {
            link::show_state(ui, bridge, target);
            port::show_port(
                ui,
                (whose, &mut self.second_port),
                &mut self.ports,
                commands,
            );
            port::show_connecting(ui, (whose, &self.second_port), bridge.is_some(), commands);
            paragraph(ui, quiet("It is armed, stopped and limited with the first"));
        });
    }
}

#[cfg(test)]
impl Bridge {
    /// With ports that were found.
    pub(crate) fn with_ports(ports: ports::PortsView) -> Self {
        Self {
            ports: Ports::found(ports),
            ..Self::default()
        }
    }
}

/// What never scrolls out of sight: where the device is, how it is, and arming.
fn show_device(ui: &mut Ui, view: &BridgePane<'_>, commands: &mut Commands) {
    let bridge = view.live.bridge.as_ref();
    link::show_state(ui, bridge, view.target);
    link::show_arming(ui, bridge, commands);
    timing::show_fault(ui, bridge, commands);
    link::show_trouble(ui, view.trouble);
}

fn show_developer_tools(ui: &mut Ui, is_shown: &mut bool) {
    let tip = "Faults to try the emulator with, and a model of what its contactors do";
    ui.checkbox(is_shown, "Developer tools").on_hover_text(tip);
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
