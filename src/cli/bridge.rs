//! `selvedge bridge`: which ports there are, whether a device works, and a device to try without.

use std::path::PathBuf;

use clap::Subcommand;

use super::{CliError, output, play, terminal};
use crate::bridge::{ArrayProfile, Target, list_ports, self_test};
use crate::engine::{AudioEntry, AudioError, audio_outputs};
use crate::scene::{ArrayLayout, Geometry};

/// What to do with devices.
#[derive(Debug, Subcommand)]
pub(super) enum BridgeCommand {
    /// List the serial ports, and the sound cards where the program is built with audio
    List,
    /// Test a connected device: handshake, pings, a second of faint frames, STOP
    Test {
        /// Serial port of the device
        #[arg(long, value_name = "PORT")]
        port: PathBuf,
        /// The array that the device drives: exeter-24, 5x5 or 10x10
        #[arg(long, value_name = "ARRAY", default_value = "exeter-24", value_parser = array)]
        array: ArrayLayout,
    },
    /// Be a device behind a pseudo-terminal until SIGINT or SIGTERM
    Emulate {
        /// The link to the terminal: the port that a host opens
        #[arg(long, value_name = "PATH")]
        link: PathBuf,
        /// Every frame applied and every change of state, as CSV
        #[arg(long, value_name = "L.csv")]
        log: Option<PathBuf>,
        /// The array that the device drives: exeter-24, 5x5 or 10x10
        #[arg(long, value_name = "ARRAY", default_value = "exeter-24", value_parser = array)]
        array: ArrayLayout,
    },
}

/// Does it.
pub(super) fn run(command: &BridgeCommand) -> Result<(), CliError> {
    match command {
        BridgeCommand::List => list(),
        BridgeCommand::Test { port, array } => {
            play::check_port(port)?;
            let report = self_test(Target::Port(port.clone()), profile_of(*array));
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
        BridgeCommand::Emulate { link, log, array } => emulate(link, log.as_deref(), *array),
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
    let mut text: String = ports.iter().map(line).collect();
    match audio_outputs() {
        Ok(cards) => text.extend(cards.iter().map(card_line)),
        Err(AudioError::Absent) => {}
        Err(error) => terminal::notice(&error.to_string()),
    }
    output::print(&text)
}

fn card_line(AudioEntry { name, n_channels }: &AudioEntry) -> String {
    format!("audio: {name}, {n_channels} channels\n")
}

#[cfg(unix)]
fn emulate(
    link: &std::path::Path,
    log: Option<&std::path::Path>,
    array: ArrayLayout,
) -> Result<(), CliError> {
    let stop = super::signals::stop_flag()?;
    let model = crate::bridge::DeviceModel::for_array(&profile_of(array));
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
    _array: ArrayLayout,
) -> Result<(), CliError> {
    let what = "there are no pseudo-terminals on this system; use the emulator in the workbench";
    Err(CliError::Input(what.to_owned()))
}

fn array(name: &str) -> Result<ArrayLayout, String> {
    let names = ArrayLayout::ALL.map(ArrayLayout::name).join(", ");
    ArrayLayout::named(name).ok_or_else(|| format!("the arrays are {names}"))
}

fn profile_of(array: ArrayLayout) -> ArrayProfile {
    let geometry = Geometry::Array(array);
    let (rows, cols) = array.grid();
    let byte = |count: usize| u8::try_from(count).unwrap_or(u8::MAX);
    let pitch = ArrayProfile::default().pitch_um;
    ArrayProfile {
        name: geometry.label(),
        rows: byte(rows),
        cols: byte(cols),
        pitch_um: if array == ArrayLayout::Square10 {
            pitch / 2
        } else {
            pitch
        },
        ..ArrayProfile::default()
    }
}
