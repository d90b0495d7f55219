//! What can be done with array profiles. Kept per user, never undone.

use crate::bench::arrays::wizard::WizardCommand;
use selvedge_device::Calibration;
use selvedge_textile::tactile::Band;

/// Something to do with the array profile in force, or another one.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum ArrayCommand {
    /// Let the profile of this name be in force wherever it fits; `None`: the one of the display.
    Choose(Option<String>),
    /// The largest amplitude of a band, µm; never above full scale.
    Limit(Band, f64),
    /// The amplitude that full drive stands for, µm; a limit above it comes down with it.
    FullScale(Band, f64),
    /// Time without a frame before the device ramps, ms.
    Hold(f64),
    /// Duration of that ramp, ms.
    Ramp(f64),
    /// High voltage to ask for, V.
    HighVoltage(f64),
    /// How a contactor answers its drive.
    Calibrate(usize, Calibration),
    /// Every contactor answers its drive as at first; those that are off stay off.
    LevelOut,
    /// Channel 0 drives contactor 0, and so on.
    WireStraight,
    /// The profile as the program has it, or, if it has none of that name, let go of it.
    Forget,
    /// A copy under this name, which is in force then.
    Copy(String),
    /// Find out which channel drives which contactor.
    Identify(WizardCommand),
}
