//! `selvedge [SCENE]`: the way into the workbench.

use std::path::Path;

use super::{CliError, signals};

use selvedge_render::scene::Scene;

/// Opens the workbench, on the shipped scene if none is named.
///
/// # Errors
/// A scene that is wrong, before a window is tried; no display.
pub(super) fn open(scene: Option<&Path>) -> Result<(), CliError> {
    check(scene)?;
    let listen = |end: selvedge_workbench::EndSwitch| signals::on_signal(move || end.press());
    Ok(selvedge_workbench::run(
        scene.map(Path::to_path_buf),
        listen,
    )?)
}

/// The same for a launcher, which shows nobody what is written on stderr.
///
/// # Errors
/// No display.
pub(super) fn open_from_desktop(scene: Option<&Path>) -> Result<(), CliError> {
    let listen = |end: selvedge_workbench::EndSwitch| signals::on_signal(move || end.press());
    let scene = scene.map(Path::to_path_buf);
    Ok(selvedge_workbench::run_from_desktop(scene, listen)?)
}

/// Refuses a scene that is wrong before a window is tried.
pub(super) fn check(scene: Option<&Path>) -> Result<(), CliError> {
    let Some(path) = scene else { return Ok(()) };
    if !path.exists() {
        let what = format!("{} is neither a scene file nor a command", path.display());
        return Err(CliError::Input(format!("{what}; see \"selvedge --help\"")));
    }
    Scene::read(path)?;
    Ok(())
}
