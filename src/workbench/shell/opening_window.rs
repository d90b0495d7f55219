//! What a window on a display opens as: the workbench on a scene, or the stage.

use std::path::{Path, PathBuf};

use eframe::egui::{Context, ViewportBuilder};

use crate::bench::Drive;
use crate::bench::command::device::DeviceCommand;
use crate::bench::error::AppError;
use crate::bench::stage::StageOptions;
use crate::kit::own_window::own_window;
use crate::shell::on_stage::fill_screen;
use crate::shell::tour;
use crate::shell::window::Workbench;

/// What is opened.
pub(crate) enum Opening {
    Workbench(Option<PathBuf>),
    /// The workbench for who has no terminal: a scene that cannot be opened is told in the window.
    FromDesktop(Option<PathBuf>),
    Stage(StageOptions),
}

/// The window's content, with a device on its way.
///
/// # Errors
/// The scene cannot be opened or shown.
pub(crate) fn begin(
    cc: &eframe::CreationContext<'_>,
    opening: Opening,
) -> Result<Workbench, AppError> {
    let ctx = &cc.egui_ctx;
    let (mut workbench, connect) = match opening {
        Opening::Workbench(scene) => {
            let workbench = Workbench::new(ctx, scene.as_deref(), Drive::Live)?;
            (workbench, DeviceCommand::ConnectEmulator)
        }
        Opening::FromDesktop(scene) => {
            let workbench = from_desktop(ctx, scene.as_deref(), Drive::Live)?;
            (workbench, DeviceCommand::ConnectEmulator)
        }
        Opening::Stage(options) => {
            fill_screen(ctx);
            let port = options.port().map(Path::to_owned);
            let connect = port.map_or(DeviceCommand::ConnectEmulator, DeviceCommand::ConnectPort);
            (Workbench::on_stage(ctx, options, Drive::OnStage)?, connect)
        }
    };
    workbench.bench.engine.stop_switch().press_on_panic();
    workbench.dispatch(connect.into());
    if workbench.face.is_none() {
        workbench.begin_motion();
        if workbench.bench.settings.are_first {
            tour::begin(&mut workbench.bench, &mut workbench.shell);
        }
    }
    Ok(workbench)
}

/// A workbench on a scene, or on the shipped one with a notice that says why not.
fn from_desktop(ctx: &Context, scene: Option<&Path>, drive: Drive) -> Result<Workbench, AppError> {
    let failure = match Workbench::new(ctx, scene, drive) {
        Err(error) if scene.is_some() => error,
        outcome => return outcome,
    };
    let mut workbench = Workbench::new(ctx, None, drive)?;
    workbench.bench.notices.give(failure.to_string());
    Ok(workbench)
}

/// The window as it opens.
pub(crate) fn viewport(is_stage: bool) -> ViewportBuilder {
    let window = own_window("Selvedge");
    if is_stage {
        return window.with_fullscreen(true).with_decorations(false);
    }
    window
        .with_inner_size([1400.0, 900.0])
        .with_min_inner_size([960.0, 600.0])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_double_click_on_a_broken_scene_opens_a_window_that_says_why() {
        let broken = Path::new("/nowhere/broken.scene.toml");
        let ctx = Context::default();
        let workbench = from_desktop(&ctx, Some(broken), Drive::Stepped).expect("it opens");
        let notices = workbench.bench.notices.shown();
        let is_told = notices
            .iter()
            .any(|one| one.text.contains("broken.scene.toml"));
        assert!(is_told, "{notices:?}");
        assert!(
            workbench.bench.document.path().is_none(),
            "the shipped scene"
        );
    }
}
