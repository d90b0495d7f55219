//! `selvedge screenshot`: the workbench as a picture, without a display.

use std::path::PathBuf;

use clap::{Args, ValueEnum};

use super::{CliError, output};

use selvedge_foundation::files::encode_png_rgba;

/// What to picture.
#[derive(Debug, Args)]
pub(super) struct ScreenshotArgs {
    /// Scene file (the shipped scene of four textiles if none is given)
    scene: Option<PathBuf>,
    /// The picture
    #[arg(long, value_name = "PNG")]
    out: PathBuf,
    /// Width, pixels
    #[arg(long, value_name = "PX", default_value_t = 1400)]
    width: usize,
    /// Height, pixels
    #[arg(long, value_name = "PX", default_value_t = 900)]
    height: usize,
    /// Pixels a point: 2 is a display at 200 %
    #[arg(long, value_name = "SCALE", default_value_t = 1.0)]
    scale: f32,
    /// Colours
    #[arg(long, value_enum, default_value_t = ThemeName::Dark)]
    theme: ThemeName,
}

#[derive(Debug, Clone, Copy, ValueEnum)]
enum ThemeName {
    /// Light on dark
    Dark,
    /// Dark on light
    Light,
}

/// Draws and writes the picture.
pub(super) fn run(args: &ScreenshotArgs) -> Result<(), CliError> {
    let picture = selvedge_workbench::screenshot(&selvedge_workbench::Screenshot {
        scene: args.scene.clone(),
        width: args.width,
        height: args.height,
        pixels_per_point: args.scale,
        theme: match args.theme {
            ThemeName::Dark => selvedge_workbench::Theme::Dark,
            ThemeName::Light => selvedge_workbench::Theme::Light,
        },
    })?;
    let png = encode_png_rgba(&picture.rgba, picture.width, picture.height, &args.out)?;
    output::write_bytes(&args.out, &png)
}
