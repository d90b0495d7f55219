//! `selvedge screenshot`: the workbench as a picture, without a display.

use std::path::PathBuf;

use clap::Args;

use super::output::OutFile;
use super::{CliError, output};

use selvedge_foundation::files::encode_png_rgba;
use selvedge_workbench::{Perspective, Screenshot, StagePicture, Theme, screenshot};

/// What to picture.
#[derive(Debug, Args)]
pub(super) struct ScreenshotArgs {
    /// Scene file (the shipped scene of four textiles if none is given)
    scene: Option<PathBuf>,
    /// The picture
    #[arg(long, value_name = "PNG")]
    out: OutFile,
    /// Width, pixels
    #[arg(long, value_name = "PX", default_value_t = 1400)]
    width: usize,
    /// Height, pixels
    #[arg(long, value_name = "PX", default_value_t = 900)]
    height: usize,
    /// Pixels a point: 2 is a display at 200 %
    #[arg(long, value_name = "SCALE", default_value_t = 1.0)]
    scale: f32,
    /// The stage in this state in place of the workbench
    #[arg(long, value_enum, value_name = "STATE", conflicts_with_all = ["theme", "perspective"])]
    stage: Option<StagePicture>,
    /// What the window is arranged for
    #[arg(long, value_enum, default_value_t = Perspective::Explore)]
    perspective: Perspective,
    /// Colours
    #[arg(long, value_enum, default_value_t = Theme::Dark)]
    theme: Theme,
}

/// Draws and writes the picture.
pub(super) fn run(args: &ScreenshotArgs) -> Result<(), CliError> {
    let extension = args.out.extension();
    if extension.is_some_and(|extension| !extension.eq_ignore_ascii_case("png")) {
        let what = format!("{} is to be a PNG; call it .png", args.out.display());
        return Err(CliError::Input(what));
    }
    let picture = screenshot(&Screenshot {
        scene: args.scene.clone(),
        width: args.width,
        height: args.height,
        pixels_per_point: args.scale,
        stage: args.stage,
        perspective: args.perspective,
        theme: args.theme,
    })?;
    let png = encode_png_rgba(&picture.rgba, picture.width, picture.height, &args.out)?;
    output::write_bytes(&args.out, &png)
}
