//! `selvedge screenshot`: the workbench as a picture, without a display.

use std::path::PathBuf;

use clap::{Args, ValueEnum};

use super::{CliError, output};

use selvedge_foundation::files::encode_png_rgba;
use selvedge_workbench::StagePicture;

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
    /// The stage in this state in place of the workbench
    #[arg(long, value_enum, value_name = "STATE", conflicts_with = "theme")]
    stage: Option<StageState>,
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

#[derive(Debug, Clone, Copy, ValueEnum)]
enum StageState {
    /// Nobody is there
    Watching,
    /// A cloth is stroked
    Touching,
    /// Guessing and feeling are offered
    Offered,
    /// High voltage is on
    Armed,
    /// A cloth is to be found
    Guessing,
    /// One was chosen, and this was it
    Told,
    /// Whether anybody is still there is asked
    StillHere,
    /// How many were right
    Ended,
    /// The operator's page before the PIN
    Pin,
    /// The operator's page
    Operator,
}

impl StageState {
    fn picture(self) -> StagePicture {
        match self {
            Self::Watching => StagePicture::Watching,
            Self::Touching => StagePicture::Touching,
            Self::Offered => StagePicture::Offered,
            Self::Armed => StagePicture::Armed,
            Self::Guessing => StagePicture::Guessing,
            Self::Told => StagePicture::Told,
            Self::StillHere => StagePicture::StillHere,
            Self::Ended => StagePicture::Ended,
            Self::Pin => StagePicture::Pin,
            Self::Operator => StagePicture::Operator,
        }
    }
}

/// Draws and writes the picture.
pub(super) fn run(args: &ScreenshotArgs) -> Result<(), CliError> {
    let picture = selvedge_workbench::screenshot(&selvedge_workbench::Screenshot {
        scene: args.scene.clone(),
        width: args.width,
        height: args.height,
        pixels_per_point: args.scale,
        stage: args.stage.map(StageState::picture),
        theme: match args.theme {
            ThemeName::Dark => selvedge_workbench::Theme::Dark,
            ThemeName::Light => selvedge_workbench::Theme::Light,
        },
    })?;
    let png = encode_png_rgba(&picture.rgba, picture.width, picture.height, &args.out)?;
    output::write_bytes(&args.out, &png)
}
