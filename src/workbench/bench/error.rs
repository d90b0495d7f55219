//! What can go wrong with the window as a whole.

use selvedge_engine::EngineError;
use selvedge_render::RenderError;
use selvedge_render::scene::SceneError;
use selvedge_textile::TextileError;

/// Why there is no window, or no picture of it.
#[derive(Debug, thiserror::Error)]
pub enum AppError {
    /// There is no display to open a window on.
    #[error(
        "there is no display to open a window on; set DISPLAY or WAYLAND_DISPLAY, or use what \
         works without one: selvedge screenshot, render, play, textile, bridge, experiment"
    )]
    NoDisplay,
    /// The display cannot draw.
    #[error("the display cannot draw the window ({0}); check that OpenGL 2.1 or later is there")]
    NoGraphics(String),
    /// The scene cannot be opened.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// A textile's picture cannot be read.
    #[error(transparent)]
    Textile(#[from] TextileError),
    /// The scene cannot be rendered.
    #[error(transparent)]
    Render(#[from] RenderError),
    /// The engine cannot start.
    #[error(transparent)]
    Engine(#[from] EngineError),
    /// An exploration that cannot be drawn.
    #[error("{0}")]
    Exploration(String),
    /// A scene that a stage cannot show.
    #[error("the stage shows four textiles and the scene has {n_cloths}; give a scene of four")]
    Stage {
        /// Textiles in the scene.
        n_cloths: usize,
    },
    /// A picture that is too small or too large to draw.
    #[error("a picture of {width} × {height} pixels; give 320 to 16384 each way")]
    Size {
        /// Pixels in a row.
        width: usize,
        /// Rows.
        height: usize,
    },
}
