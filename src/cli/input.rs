//! `selvedge input`: tablets and touch frames that can be read directly.

use clap::Subcommand;

use super::output::{Cell, JsonArgs};
use super::{CliError, output, terminal};
use selvedge_engine::{AxisRange, EngineError, InputDevice};
use selvedge_foundation::quantity::fixed;

/// What to do with devices that tell places.
#[derive(Debug, Subcommand)]
pub(super) enum InputCommand {
    /// List the tablets and touch frames of this machine
    List {
        #[command(flatten)]
        how: JsonArgs,
    },
}

/// Does it.
pub(super) fn run(command: &InputCommand) -> Result<(), CliError> {
    match command {
        InputCommand::List { how } => list(how),
    }
}

fn list(how: &JsonArgs) -> Result<(), CliError> {
    let devices = InputDevice::list().map_err(EngineError::from)?;
    if devices.is_empty() {
        terminal::notice(
            "no tablet or touch frame; connect one, or try the mouse in the workbench",
        );
    }
    let mut rows = Vec::new();
    for device in devices {
        match device {
            Ok(device) => rows.push(row(&device)),
            Err(error) => terminal::notice(&error.to_string()),
        }
    }
    output::print_rows(how, COLUMNS, &rows, || rows.iter().map(line).collect())
}

const COLUMNS: [&str; 5] = ["device", "name", "width_mm", "height_mm", "contact"];

fn row(device: &InputDevice) -> [Cell; 5] {
    let [width_mm, height_mm] = device.axes.map(|axis: AxisRange| axis.length_mm());
    [
        Cell::text(format!("evdev:{}", device.path.display())),
        Cell::text(&device.name),
        Cell::Number(width_mm),
        Cell::Number(height_mm),
        Cell::text(device.contact),
    ]
}

fn line([device, name, width, height, contact]: &[Cell; 5]) -> String {
    let size = match (width, height) {
        (Cell::Number(Some(width_mm)), Cell::Number(Some(height_mm))) => {
            format!("{} × {} mm", fixed(*width_mm, 1), fixed(*height_mm, 1))
        }
        _ => "size unknown".to_owned(),
    };
    format!("{device}  {name}, {size}, contact: {contact}\n")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_device_is_a_line_with_the_name_to_choose_it_by() {
        let axis = AxisRange {
            min: 0,
            max: 21_600,
            per_mm: 100,
        };
        let mut device = InputDevice {
            path: "/dev/input/event7".into(),
            name: "Pen tablet".to_owned(),
            axes: [axis; 2],
            contact: "touch",
        };
        assert_eq!(
            line(&row(&device)),
            "evdev:/dev/input/event7  Pen tablet, 216.0 × 216.0 mm, contact: touch\n"
        );
        device.axes[1].per_mm = 0;
        assert!(line(&row(&device)).contains("size unknown"));
    }
}
