//! `selvedge bridge`: which ports there are, whether a device works, and a device to try without.

use std::path::PathBuf;

use clap::Subcommand;

use super::identify::{self, IdentifyArgs};
use super::{CliError, array, output, play, terminal};
use crate::bridge::{ArrayProfile, Target, list_ports, self_test};

/// What to do with devices.
#[derive(Debug, Subcommand)]
pub(super) enum BridgeCommand {
    /// List the serial ports
    List,
    /// Test a connected device: handshake, pings, a second of faint frames, STOP
    Test {
        /// Serial port of the device
        #[arg(long, value_name = "PORT")]
        port: PathBuf,
        #[arg(long, value_name = "ARRAY", default_value = "exeter-24", help = array::HELP,
              value_parser = array::profile)]
        array: Box<ArrayProfile>,
    },
    /// Find which channel drives which contactor, one at a time, and write an array profile
    Identify(IdentifyArgs),
    /// Be a device behind a pseudo-terminal until SIGINT or SIGTERM
    Emulate {
        /// The link to the terminal: the port that a host opens
        #[arg(long, value_name = "PATH")]
        link: PathBuf,
        /// Every frame applied and every change of state, as CSV
        #[arg(long, value_name = "L.csv")]
        log: Option<PathBuf>,
        #[arg(long, value_name = "ARRAY", default_value = "exeter-24", help = array::HELP,
              value_parser = array::profile)]
        array: Box<ArrayProfile>,
    },
}

/// Does it.
pub(super) fn run(command: &BridgeCommand) -> Result<(), CliError> {
    match command {
        BridgeCommand::List => list(),
        BridgeCommand::Test { port, array } => {
            play::check_port(port)?;
            let report = self_test(Target::Port(port.clone()), (**array).clone());
            if let Some(doubt) = report.caps.and_then(|caps| array::doubt(array, &caps)) {
                terminal::notice(&doubt);
            }
            output::print(&format!("{report}\n"))?;
            if report.passed() {
                return Ok(());
            }
            let failed = report.steps.last().map_or("handshake", |step| step.name);
            let what = format!(
                "{}: the {failed} failed; check power and cable",
                port.display()
            );
            Err(CliError::Failed(what))
        }
        BridgeCommand::Emulate { link, log, array } => emulate(link, log.as_deref(), array),
        BridgeCommand::Identify(args) => identify::run(args),
    }
}

fn list() -> Result<(), CliError> {
    let ports = list_ports()?;
    if ports.is_empty() {
        terminal::notice(
            "no serial ports; connect a device, or make one: \"selvedge bridge emulate\"",
        );
    }
    let widest = ports.iter().map(|port| port.path.len()).max().unwrap_or(0);
    let line =
        |port: &crate::bridge::PortEntry| format!("{:widest$}  {}\n", port.path, port.description);
    output::print(&ports.iter().map(line).collect::<String>())
}

#[cfg(unix)]
fn emulate(
    link: &std::path::Path,
    log: Option<&std::path::Path>,
    array: &ArrayProfile,
) -> Result<(), CliError> {
    let stop = super::signals::stop_flag()?;
    let model = crate::bridge::DeviceModel::for_array(array);
    let emulator = crate::bridge::PtyEmulator::new(model, link, log)?;
    let ready = format!("{} -> {}\n", link.display(), emulator.device_path());
    // A reader that only wanted this line may be gone; the device runs on.
    drop(output::print(&ready));
    Ok(emulator.run(&stop)?)
}

#[cfg(not(unix))]
fn emulate(
    _link: &std::path::Path,
    _log: Option<&std::path::Path>,
    _array: &ArrayProfile,
) -> Result<(), CliError> {
    let what = "there are no pseudo-terminals on this system; use the emulator in the workbench";
    Err(CliError::Input(what.to_owned()))
}
