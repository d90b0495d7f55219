//! `selvedge bridge kit`: what an engineer needs who builds a device, written to a folder.
//!
//! The files are part of the program, so that the kit fits the protocol that this program speaks.

use std::fs;
use std::path::Path;

use super::{CliError, output};

/// Path within the kit, and text.
type KitFile = (&'static str, &'static str);

macro_rules! shipped {
    ($($path:literal),* $(,)?) => {
        &[$(($path, include_str!(concat!("../../assets/bridge/", $path)))),*]
    };
}

const SHIPPED: &[KitFile] = shipped![
    "99-selvedge.rules",
    "firmware/README.md",
    "firmware/hbp_config.h",
    "firmware/hbp_core.c",
    "firmware/hbp_core.h",
    "firmware/hbp_defects.h",
    "firmware/host/Makefile",
    "firmware/host/hbp_host.c",
    "firmware/lm3s6965evb/Makefile",
    "firmware/lm3s6965evb/board.c",
    "firmware/lm3s6965evb/lm3s6965evb.ld",
    "firmware/lm3s6965evb/restart.h",
    "firmware/lm3s6965evb/startup.c",
    "firmware/rp2040/CMakeLists.txt",
    "firmware/rp2040/board.h",
    "firmware/rp2040/converters.c",
    "firmware/rp2040/converters.h",
    "firmware/rp2040/main.c",
    "firmware/rp2040/tusb_config.h",
    "firmware/rp2040/usb_descriptors.c",
    "protocol.md",
    "vectors.txt",
];

const LICENCES: &[KitFile] = &[
    ("LICENSE-APACHE", include_str!("../../LICENSE-APACHE")),
    ("LICENSE-MIT", include_str!("../../LICENSE-MIT")),
];

/// Writes the kit to `out`, a new or empty folder.
///
/// # Errors
/// The folder holds something already, or cannot be written.
pub(super) fn run(out: &Path) -> Result<(), CliError> {
    let place = out.display();
    let wrong = |error: std::io::Error| {
        CliError::Input(format!(
            "cannot write to {place}: {error}; check the folder"
        ))
    };
    if out.exists() && fs::read_dir(out).map_err(wrong)?.next().is_some() {
        return Err(CliError::Input(format!(
            "{place} is not empty; name a new folder for the kit"
        )));
    }
    let files = SHIPPED.iter().chain(LICENCES);
    let files: Vec<(&str, &[u8])> = files.map(|(path, text)| (*path, text.as_bytes())).collect();
    output::write_folder(out, &files).map_err(|error| CliError::Input(error.to_string()))?;
    let n_files = SHIPPED.len() + LICENCES.len();
    output::print(&format!(
        "{n_files} files in {place}; begin with protocol.md and firmware/README.md\n"
    ))
}

#[cfg(test)]
mod tests {
    use std::path::PathBuf;

    use super::*;

    fn files_below(folder: &Path, found: &mut Vec<PathBuf>) {
        for entry in fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                files_below(&path, found);
            } else {
                found.push(path);
            }
        }
    }

    #[test]
    fn the_kit_holds_every_file_of_its_folder() {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../assets/bridge");
        let mut found = Vec::new();
        files_below(&folder, &mut found);
        // What building the kit in place leaves there.
        let built = ["hbp_host", "hbp.elf", "hbp_emulated.elf", ".gitignore"];
        let mut names: Vec<String> = found
            .iter()
            .filter(|path| !built.iter().any(|name| path.ends_with(name)))
            .map(|path| path.strip_prefix(&folder).unwrap().display().to_string())
            .collect();
        names.sort();
        let shipped: Vec<&str> = SHIPPED.iter().map(|file| file.0).collect();
        assert_eq!(names, shipped);
    }
}
