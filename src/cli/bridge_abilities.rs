//! The options of `selvedge bridge emulate` that say what the device can.

use clap::{Args, ValueEnum};

use selvedge_device::LARGEST_BODY;
use selvedge_device::{ArrayProfile, Caps, DeviceModel};

/// The smallest `max_body` that a device may have.
const SMALLEST_BODY: i64 = 256;

/// One of the things that a device may offer in its CAPS.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Ability {
    /// Mode A: amplitudes
    A,
    /// One channel alone
    Ident,
    /// Amplitudes that move linearly inside a tick
    Interpolate,
}

impl Ability {
    fn bit(self) -> u16 {
        match self {
            Self::A => Caps::MODE_A,
            Self::Ident => Caps::MODE_IDENT,
            Self::Interpolate => Caps::INTERPOLATES,
        }
    }
}

/// What the device can. What every device can, and IDENT, unless more is asked for.
#[derive(Debug, Args)]
pub(super) struct AbilityArgs {
    /// What the device offers: a, ident, interpolate
    #[arg(
        long,
        value_name = "MODES",
        value_delimiter = ',',
        default_value = "a,ident"
    )]
    modes: Vec<Ability>,
    /// Largest body of a packet that the device takes, bytes: 256 to 1024 (enough for a frame)
    #[arg(
        long,
        value_name = "BYTES",
        value_parser = clap::value_parser!(u16).range(SMALLEST_BODY..=LARGEST_BODY as i64)
    )]
    max_body: Option<u16>,
}

impl AbilityArgs {
    /// A device shaped like `array` that can all of this. A frame always fits.
    pub(super) fn model(&self, array: &ArrayProfile) -> DeviceModel {
        let model = DeviceModel::for_array(array);
        DeviceModel {
            modes: self.modes.iter().fold(0, |bits, mode| bits | mode.bit()),
            max_body: self.max_body.unwrap_or(0).max(model.max_body),
            ..model
        }
    }
}

#[cfg(test)]
mod tests {
    use clap::Parser;

    use super::*;

    #[derive(Parser)]
    struct Line {
        #[command(flatten)]
        abilities: AbilityArgs,
    }

    fn model(words: &[&str]) -> Result<DeviceModel, String> {
        let line = Line::try_parse_from([&["emulate"], words].concat());
        line.map(|line| line.abilities.model(&ArrayProfile::default()))
            .map_err(|error| error.to_string())
    }

    #[test]
    fn a_device_can_what_every_device_can_unless_more_is_asked_for() {
        assert_eq!(model(&[]).unwrap(), DeviceModel::default());
        let able = model(&["--modes", "a,interpolate", "--max-body", "1024"]).unwrap();
        let modes = Caps::MODE_A | Caps::INTERPOLATES;
        assert_eq!((able.modes, able.max_body), (modes, 1024));
    }

    #[test]
    fn an_ability_or_a_size_that_there_is_not_says_which_there_are() {
        assert!(
            model(&["--modes", "c"])
                .unwrap_err()
                .contains("interpolate")
        );
        assert!(model(&["--max-body", "40"]).unwrap_err().contains("256"));
    }
}
