//! The workbench as a picture, without a display: the same window, drawn by our own rasteriser.
//!
//! The display has just gone round the scene once, so that everything is lit. Nothing depends on a
//! clock: the same scene gives the same bytes.

use std::path::PathBuf;

use clap::ValueEnum;
use eframe::egui::{self, Vec2, vec2};

use crate::bench::command::{DeviceCommand, PlayCommand, PlaySource, ShowCommand};
use crate::bench::error::AppError;
use crate::bench::perspective::Perspective;
use crate::bench::stage::{StageOptions, StagePicture};
use crate::kit::theme::Palette;
use crate::shell::headless::Headless;
use crate::shell::raster::{Picture, Rasteriser};

/// Frames that are run before the picture is taken, 25 ms apart: 11 s.
const N_FRAMES: u32 = 425;
/// Frames of the stage in which its emulator is greeted.
const N_GREETING_FRAMES: u32 = 20;
/// Frames of the stage in the state that is pictured, whose pictures have come by then.
const N_STAGE_FRAMES: u32 = 40;

/// Dark or light.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, ValueEnum)]
pub enum Theme {
    /// Light on dark.
    #[default]
    Dark,
    /// Dark on light.
    Light,
}

/// What to picture.
#[derive(Debug, Clone, PartialEq)]
pub struct Screenshot {
    /// The scene; `None` is the one that the program ships.
    pub scene: Option<PathBuf>,
    /// Pixels in a row.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// Pixels per point: 2 is a display at 200 %.
    pub pixels_per_point: f32,
    /// Dark or light.
    pub theme: Theme,
    /// What the window is arranged for.
    pub perspective: Perspective,
    /// The stage in this state in place of the workbench; it is dark.
    pub stage: Option<StagePicture>,
}

impl Default for Screenshot {
    fn default() -> Self {
        Self {
            scene: None,
            width: 1400,
            height: 900,
            pixels_per_point: 1.0,
            theme: Theme::Dark,
            perspective: Perspective::Explore,
            stage: None,
        }
    }
}

/// Draws the workbench.
///
/// # Errors
/// The scene cannot be opened; a picture that is too small or too large.
pub fn screenshot(wanted: &Screenshot) -> Result<Picture, AppError> {
    let Screenshot { width, height, .. } = *wanted;
    let is_size = |pixels: usize| (320..=16_384).contains(&pixels);
    if !is_size(width) || !is_size(height) || width * height > 64_000_000 {
        return Err(AppError::Size { width, height });
    }
    let scale = if wanted.pixels_per_point.is_finite() {
        wanted.pixels_per_point
    } else {
        1.0
    };
    let scale = scale.clamp(0.5, 4.0);
    let theme = match wanted.theme {
        Theme::Dark => egui::Theme::Dark,
        Theme::Light => egui::Theme::Light,
    };
    let size = vec2(width as f32, height as f32) / scale;
    let (mut window, n_frames) = match wanted.stage {
        Some(_) => (stage(wanted, size, scale)?, N_GREETING_FRAMES),
        None => (workbench(wanted, theme, size, scale)?, N_FRAMES),
    };
    window.dispatch(DeviceCommand::ConnectEmulator);
    let theme = window.ctx.theme();
    let mut rasteriser = Rasteriser::default();
    for _ in 1..n_frames {
        rasteriser.apply(&mut window.run().textures_delta);
    }
    if let Some(picture) = wanted.stage {
        window.go_to(picture);
        for _ in 1..N_STAGE_FRAMES {
            rasteriser.apply(&mut window.run().textures_delta);
        }
    }
    let mut last = window.run();
    rasteriser.apply(&mut last.textures_delta);
    let primitives = window.ctx.tessellate(last.shapes, last.pixels_per_point);
    let floor = Palette::of(theme).floor;
    Ok(rasteriser.draw(&primitives, [width, height], scale, floor))
}

/// The stage, which nobody has touched.
fn stage(wanted: &Screenshot, size: Vec2, scale: f32) -> Result<Headless, AppError> {
    let mut options = StageOptions::default();
    options.scene.clone_from(&wanted.scene);
    Headless::on_stage(options, size, scale)
}

/// The workbench, moving by itself.
fn workbench(
    wanted: &Screenshot,
    theme: egui::Theme,
    size: Vec2,
    scale: f32,
) -> Result<Headless, AppError> {
    let mut window = Headless::new(wanted.scene.as_deref(), size, scale)?;
    window.ctx.set_theme(theme);
    window.dispatch(ShowCommand::Perspective(wanted.perspective));
    window.dispatch(PlayCommand::Source(PlaySource::Stroke));
    Ok(window)
}
