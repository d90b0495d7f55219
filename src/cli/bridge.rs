//! `selvedge bridge`: which ports there are, whether a device works, and a device to try without.

use std::path::{Path, PathBuf};

use clap::{Args, Subcommand};

use super::bridge_abilities::AbilityArgs;
use super::bridge_faults::FaultArgs;
use super::bridge_show::{PlantArgs, PlantView};
use super::certify::{self, CertifyArgs, TestArgs};
use super::identify::{self, IdentifyArgs};
use super::output::{Cell, JsonArgs, OutFile};
use super::replay::{self, ReplayArgs};
use super::{CliError, array, output, terminal};
use selvedge_device::{ArrayProfile, PortEntry, UDEV_RULE};
use selvedge_engine::{AudioEntry, AudioError, AudioOutput};

/// What to do with devices.
#[derive(Debug, Subcommand)]
pub(super) enum BridgeCommand {
    /// List the serial ports, and the sound cards where the program is built with audio
    List {
        /// Print the udev rule that lets everybody at this machine use the array
        #[arg(long, conflicts_with = "json")]
        udev_rule: bool,
        #[command(flatten)]
        how: JsonArgs,
    },
    /// Test a connected device: handshake, pings, a second of faint frames, STOP
    Test(TestArgs),
    /// Certify a device: all that its firmware must do, in a report; at most a minute
    Certify(CertifyArgs),
    /// Play a session log to the emulator: what the finger got, tick by tick, and whether the
    /// device told the truth
    Replay(ReplayArgs),
    /// Write what a firmware engineer needs: protocol, golden vectors, a device core in C
    Kit {
        /// A new folder
        #[arg(long, value_name = "DIR")]
        out: OutFile,
    },
    /// Find which channel drives which contactor, one at a time, and write an array profile
    Identify(IdentifyArgs),
    /// Be a device behind a pseudo-terminal until SIGINT or SIGTERM
    Emulate(Box<EmulateArgs>),
}

/// The device to be, and what is to go wrong with it.
#[derive(Debug, Args)]
pub(super) struct EmulateArgs {
    /// The link to the terminal: the port that a host opens
    #[arg(long, value_name = "PATH")]
    link: PathBuf,
    /// Every frame applied, every change of state and every injected fault, as CSV
    #[arg(long, value_name = "L.csv")]
    log: Option<OutFile>,
    #[arg(long, value_name = "ARRAY", default_value = "exeter-24", help = array::HELP,
          value_parser = array::profile)]
    array: Box<ArrayProfile>,
    #[command(flatten)]
    abilities: AbilityArgs,
    #[command(flatten)]
    plant: PlantArgs,
    #[command(flatten)]
    faults: FaultArgs,
}

/// Does it.
pub(super) fn run(command: &BridgeCommand) -> Result<(), CliError> {
    match command {
        BridgeCommand::List {
            udev_rule: true, ..
        } => output::print(UDEV_RULE),
        BridgeCommand::List {
            udev_rule: false,
            how,
        } => list(how),
        BridgeCommand::Kit { out } => super::bridge_kit::run(out),
        BridgeCommand::Test(args) => certify::test(args),
        BridgeCommand::Certify(args) => certify::certify(args),
        BridgeCommand::Replay(args) => replay::run(args),
        BridgeCommand::Emulate(args) => emulate(args),
        BridgeCommand::Identify(args) => identify::run(args),
    }
}

fn list(how: &JsonArgs) -> Result<(), CliError> {
    let ports = PortEntry::list()?;
    if ports.is_empty() {
        terminal::notice(
            "no serial ports; connect a device, or make one: \"selvedge bridge emulate\"",
        );
    }
    let widest = ports.iter().map(|port| port.path.len()).max().unwrap_or(0);
    let line = |port: &PortEntry| format!("{:widest$}  {}\n", port.path, port.description);
    let mut words: String = ports.iter().map(line).collect();
    let port = |port: &PortEntry| ["serial", &port.path, &port.description].map(Cell::text);
    let mut rows: Vec<_> = ports.iter().map(port).collect();
    match AudioOutput::list() {
        Ok(cards) => {
            for AudioEntry { name, n_channels } in cards {
                let channels = format!("{n_channels} channels");
                words += &["audio: ", &name, ", ", &channels, "\n"].concat();
                rows.push(["audio", &name, &channels].map(Cell::text));
            }
        }
        Err(AudioError::Absent) => {}
        Err(error) => terminal::notice(&error.to_string()),
    }
    let columns = ["kind", "name", "description"];
    output::print_rows(how, columns, &rows, || words)
}

#[cfg(unix)]
fn emulate(args: &EmulateArgs) -> Result<(), CliError> {
    let model = args.abilities.model(&args.array);
    let faults = args.faults.faults().map_err(CliError::Input)?;
    faults.check(model.n_channels()).map_err(CliError::Input)?;
    let contactors = args.plant.model()?;
    let stop = super::signals::stop_flag()?;
    let log = args.log.as_deref();
    let n_columns = usize::from(model.cols);
    let mut emulator = selvedge_device::PtyEmulator::new(model, &faults, &args.link, log)?;
    // A reader that only wanted this line may be gone; the device runs on.
    let describe = |link: &Path, path: &str| {
        drop(output::print(&format!("{} -> {path}\n", link.display())));
    };
    describe(&args.link, emulator.device_path());
    let view = if args.plant.is_shown() {
        Some(PlantView::start(emulator.watch(contactors), n_columns)?)
    } else {
        None
    };
    let ended = emulator.run(&stop, describe);
    drop(view);
    Ok(ended?)
}

#[cfg(not(unix))]
fn emulate(_args: &EmulateArgs) -> Result<(), CliError> {
    let what = "there are no pseudo-terminals on this system; use the emulator in the workbench";
    Err(CliError::Input(what.to_owned()))
}
