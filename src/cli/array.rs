//! `--array`: an array profile by name or file.

use std::path::Path;

use clap::Args;

use super::{CliError, terminal};

use selvedge_device::{ArrayProfile, BridgeError, Caps, Certificate, DeviceUid, ProfileFolder};
use selvedge_foundation::quantity;
use selvedge_render::scene::LoadedScene;

/// Contactors closer than this to where they ought to be are there, mm.
const ELSEWHERE_MM: f64 = 0.01;

/// Help of the option.
pub(super) const HELP: &str =
    "Array profile: exeter-24, 5x5, 10x10, one of your own by its name, or a file.toml";

/// `--baud`: how fast a port is opened.
#[derive(Debug, Args)]
pub(super) struct BaudArgs {
    /// Rate of a bridge with a real UART, baud; without it the array profile's, usually 1000000.
    /// USB ignores it
    #[arg(long, value_name = "BAUD", value_parser = ArrayProfile::read_baud)]
    baud: Option<u32>,
}

impl BaudArgs {
    /// Lets the rate of the command line, if there is one, take the place of the profile's.
    pub(super) fn set(&self, profile: &mut ArrayProfile) {
        profile.baud = self.baud.unwrap_or(profile.baud);
    }
}

/// The profile that the word on the command line names: a file if it ends in .toml, otherwise one
/// of the user's own or of the program.
pub(super) fn profile(word: &str) -> Result<Box<ArrayProfile>, String> {
    let is_file = Path::new(word)
        .extension()
        .is_some_and(|end| end.eq_ignore_ascii_case("toml"));
    let found = if is_file {
        ArrayProfile::read(Path::new(word))
    } else {
        let folder = selvedge_workbench::own_arrays().unwrap_or_default();
        ProfileFolder::new(&folder).find(word)
    };
    found
        .map(Box::new)
        .map_err(|error: BridgeError| error.to_string())
}

/// What is to be said when a device with these CAPS is connected for a profile.
pub(super) fn doubt(profile: &ArrayProfile, caps: &Caps) -> Option<String> {
    profile.wiring_doubt(DeviceUid(caps.uid))
}

/// The same of a device that was tried.
pub(super) fn certified_doubt(profile: &ArrayProfile, found: &Certificate) -> Option<String> {
    profile.wiring_doubt(DeviceUid::parse(&found.uid)?)
}

/// Refuses an array with another number of contactors than the scene's first display, and says when
/// they stand elsewhere.
pub(super) fn fit(profile: &ArrayProfile, loaded: &LoadedScene) -> Result<(), CliError> {
    let display = loaded.scene().displays.first();
    let display_mm = display.map_or_else(Vec::new, |display| display.geometry.contactors());
    let (n, asked) = (profile.n_contactors(), display_mm.len());
    if n != asked {
        let what = format!(
            "array \"{}\" has {n} contactors and the scene's first display {asked}; choose an \
             --array that matches, or change the display's geometry",
            profile.name
        );
        return Err(CliError::Input(what));
    }
    let places = profile.places_mm().into_iter().zip(display_mm);
    let apart = places.map(|(array, at)| (array[0] - at.x_mm).hypot(array[1] - at.y_mm));
    let farthest_mm = apart.fold(0.0, f64::max);
    if farthest_mm > ELSEWHERE_MM {
        terminal::notice(&format!(
            "the contactors of array \"{}\" stand up to {} from where the scene's display has \
             them; what is felt is rendered for the display",
            profile.name,
            quantity::with_unit(farthest_mm, 2, "mm")
        ));
    }
    Ok(())
}
