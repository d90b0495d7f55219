//! A plot as pixels: its SVG drawn, with a font that is part of the program.
//!
//! The one home of the SVG renderer, so that a picture shows what its SVG says.

use std::sync::{Arc, OnceLock};

use resvg::tiny_skia::{Pixmap, PremultipliedColorU8, Transform};
use resvg::usvg::{Options, Tree, fontdb};

use super::Plot;
use super::svg::WIDTH_PX;

/// A picture of red, green, blue and alpha, row by row from the top.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Pixels {
    /// Pixels in a row.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// Four bytes a pixel, not premultiplied.
    pub rgba: Vec<u8>,
}

/// Why a figure has no picture.
#[derive(Debug, thiserror::Error)]
pub enum FigureError {
    /// Of no size, or too large.
    #[error("a picture {0} pixels wide cannot be drawn; choose 64 to 8192")]
    Width(u32),
    /// The drawing failed.
    #[error("the figure cannot be drawn: {0}; its SVG shows the same")]
    Drawing(String),
}

impl Plot {
    /// The picture of [`Plot::to_svg`], `width` pixels wide.
    ///
    /// # Errors
    /// A width below 64 or above 8192.
    pub fn to_pixels(&self, width: u32) -> Result<Pixels, FigureError> {
        if !(64..=8192).contains(&width) {
            return Err(FigureError::Width(width));
        }
        let options = Options {
            fontdb: Arc::clone(fonts()),
            ..Options::default()
        };
        let tree = Tree::from_str(&self.to_svg(), &options)
            .map_err(|error| FigureError::Drawing(error.to_string()))?;
        let scale = f64::from(width) / WIDTH_PX;
        let height = rows(f64::from(tree.size().height()) * scale);
        let mut pixmap = Pixmap::new(width, height).ok_or(FigureError::Width(width))?;
        let scale = single(scale);
        resvg::render(
            &tree,
            Transform::from_scale(scale, scale),
            &mut pixmap.as_mut(),
        );
        let straight = |pixel: &PremultipliedColorU8| {
            let colour = pixel.demultiply();
            [colour.red(), colour.green(), colour.blue(), colour.alpha()]
        };
        Ok(Pixels {
            width: pixmap.width() as usize,
            height: pixmap.height() as usize,
            rgba: pixmap.pixels().iter().flat_map(straight).collect(),
        })
    }
}

/// The program's own fonts: a sans-serif, and one with more signs to fall back to.
fn fonts() -> &'static Arc<fontdb::Database> {
    static FONTS: OnceLock<Arc<fontdb::Database>> = OnceLock::new();
    FONTS.get_or_init(|| {
        let mut fonts = fontdb::Database::new();
        fonts.load_font_data(epaint_default_fonts::UBUNTU_LIGHT.to_vec());
        let family = fonts
            .faces()
            .next()
            .and_then(|face| face.families.first().map(|(name, _)| name.clone()));
        fonts.set_sans_serif_family(family.unwrap_or_default());
        fonts.load_font_data(epaint_default_fonts::HACK_REGULAR.to_vec());
        Arc::new(fonts)
    })
}

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a cast from a float saturates, and the pixmap refuses what is too large"
)]
fn rows(height: f64) -> u32 {
    height.ceil().max(1.0) as u32
}

#[expect(clippy::cast_possible_truncation, reason = "the renderer draws in f32")]
fn single(x: f64) -> f32 {
    x as f32
}
