//! `selvedge input`: tablets and touch frames that can be read directly.

use clap::Subcommand;

use super::{CliError, output, terminal};
use selvedge_engine::{AxisRange, EngineError, InputDevice};
use selvedge_foundation::quantity::fixed;

/// What to do with devices that tell places.
#[derive(Debug, Subcommand)]
pub(super) enum InputCommand {
    /// List the tablets and touch frames of this machine
    List,
}

/// Does it.
pub(super) fn run(command: &InputCommand) -> Result<(), CliError> {
    match command {
        InputCommand::List => list(),
    }
}

fn list() -> Result<(), CliError> {
    let devices = InputDevice::list().map_err(EngineError::from)?;
    if devices.is_empty() {
        terminal::notice(
            "no tablet or touch frame; connect one, or try the mouse in the workbench",
        );
    }
    let mut text = String::new();
    for device in devices {
        match device {
            Ok(device) => text.push_str(&line(&device)),
            Err(error) => terminal::notice(&error.to_string()),
        }
    }
    output::print(&text)
}

fn line(device: &InputDevice) -> String {
    let size = match device.axes.map(|axis: AxisRange| axis.length_mm()) {
        [Some(width_mm), Some(height_mm)] => {
            format!("{} × {} mm", fixed(width_mm, 1), fixed(height_mm, 1))
        }
        _ => "size unknown".to_owned(),
    };
    format!(
        "evdev:{}  {}, {size}, contact: {}\n",
        device.path.display(),
        device.name,
        device.contact
    )
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
            line(&device),
            "evdev:/dev/input/event7  Pen tablet, 216.0 × 216.0 mm, contact: touch\n"
        );
        device.axes[1].per_mm = 0;
        assert!(line(&device).contains("size unknown"));
    }
}
