//! A chart as pixels: its SVG drawn, with a font that is part of the program.
//!
//! The one home of the SVG renderer, so that a picture shows what its SVG says.

use std::sync::{Arc, OnceLock};

use resvg::tiny_skia::{FilterQuality, Pixmap, PixmapPaint, PremultipliedColorU8, Transform};
use resvg::usvg::{Options, Tree, fontdb};

use super::compose::Page;
use super::raster::Placed;
use super::svg::{WIDTH_PX, paper};
use super::{Chart, Figure, Paper, Raster};
use selvedge_foundation::numerics::{to_single, to_whole};

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

impl Chart {
    /// The picture of [`Chart::to_svg`], `width` pixels wide.
    ///
    /// # Errors
    /// A width below 64 or above 8192.
    pub fn to_pixels(&self, width: u32) -> Result<Pixels, FigureError> {
        Ok(drawn(&[&self.to_svg()], width, |_, _| Ok(()))?.into())
    }
}

impl Figure {
    /// Width and height of its picture at the size that it is laid out for, px.
    pub fn size_px(&self) -> [f64; 2] {
        [WIDTH_PX, Page::of(self, Paper::White).height_px()]
    }

    /// The picture of [`Figure::to_svg`], `width` pixels wide.
    ///
    /// # Errors
    /// A width below 64 or above 8192; a raster without cells.
    pub fn to_pixels(&self, width: u32) -> Result<Pixels, FigureError> {
        self.to_pixels_on(Paper::White, width)
    }

    /// The same on another paper.
    ///
    /// # Errors
    /// As [`Figure::to_pixels`].
    pub fn to_pixels_on(&self, on: Paper, width: u32) -> Result<Pixels, FigureError> {
        let page = Page::of(self, on);
        let height_px = page.height_px();
        let ground = match on {
            Paper::White => paper(height_px, on.inks()),
            Paper::OnLight | Paper::OnDark => String::new(),
        };
        // The renderer draws no rasters: they are put between the paper and the rest.
        let ground = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{WIDTH_PX}\" \
             height=\"{height_px:.0}\">{ground}</svg>"
        );
        let layers = [ground.as_str(), &page.document("")];
        let pixmap = drawn(&layers, width, |pixmap, scale| {
            page.pictures()
                .try_for_each(|one| enlarge(&one, pixmap, scale))
        })?;
        Ok(pixmap.into())
    }
}

/// SVG documents of one size drawn over one another, `width` pixels wide; `after_first` draws onto
/// the first, which is as many times as large as its SVG.
fn drawn(
    layers: &[&str],
    width: u32,
    after_first: impl Fn(&mut Pixmap, f64) -> Result<(), FigureError>,
) -> Result<Pixmap, FigureError> {
    if !(64..=8192).contains(&width) {
        return Err(FigureError::Width(width));
    }
    let options = Options {
        fontdb: Arc::clone(fonts()),
        ..Options::default()
    };
    let scale = f64::from(width) / WIDTH_PX;
    let mut page: Option<Pixmap> = None;
    for svg in layers {
        let tree = Tree::from_str(svg, &options)
            .map_err(|error| FigureError::Drawing(error.to_string()))?;
        let is_first = page.is_none();
        let height = rows(f64::from(tree.size().height()) * scale);
        let mut pixmap = match page.take() {
            Some(pixmap) => pixmap,
            None => Pixmap::new(width, height).ok_or(FigureError::Width(width))?,
        };
        let factor = to_single(scale);
        let transform = Transform::from_scale(factor, factor);
        resvg::render(&tree, transform, &mut pixmap.as_mut());
        if is_first {
            after_first(&mut pixmap, scale)?;
        }
        page = Some(pixmap);
    }
    page.ok_or(FigureError::Width(width))
}

/// One pixel a cell.
fn pixmap_of(raster: &Raster) -> Result<Pixmap, FigureError> {
    let side = |n: usize| u32::try_from(n).unwrap_or(u32::MAX);
    let (columns, rows) = (side(raster.n_columns), side(raster.n_rows()));
    let mut pixmap = Pixmap::new(columns, rows)
        .ok_or_else(|| FigureError::Drawing(format!("it has {columns} × {rows} cells")))?;
    for (pixel, cell) in pixmap.pixels_mut().iter_mut().zip(&raster.cells) {
        let opaque = cell.and_then(|[r, g, b]| PremultipliedColorU8::from_rgba(r, g, b, u8::MAX));
        *pixel = opaque.unwrap_or(PremultipliedColorU8::TRANSPARENT);
    }
    Ok(pixmap)
}

/// A raster as PNG, one pixel a cell.
pub(super) fn png(raster: &Raster) -> Result<Vec<u8>, FigureError> {
    let png = pixmap_of(raster)?.encode_png();
    png.map_err(|error| FigureError::Drawing(error.to_string()))
}

/// Draws a raster onto a page that is `scale` times as large, every cell with sharp edges.
fn enlarge(placed: &Placed<'_>, page: &mut Pixmap, scale: f64) -> Result<(), FigureError> {
    let pixmap = pixmap_of(placed.raster)?;
    let along = |axis: usize, n_cells: u32| {
        let size_px = placed.size_px[axis] * scale;
        let start_px = placed.corner_px[axis] * scale;
        (to_single(size_px / f64::from(n_cells)), to_single(start_px))
    };
    let (across, left) = along(0, pixmap.width());
    let (down, top) = along(1, pixmap.height());
    let paint = PixmapPaint {
        quality: FilterQuality::Nearest,
        ..PixmapPaint::default()
    };
    let place = Transform::from_row(across, 0.0, 0.0, down, left, top);
    page.draw_pixmap(0, 0, pixmap.as_ref(), &paint, place, None);
    Ok(())
}

impl From<Pixmap> for Pixels {
    fn from(pixmap: Pixmap) -> Self {
        let straight = |pixel: &PremultipliedColorU8| {
            let colour = pixel.demultiply();
            [colour.red(), colour.green(), colour.blue(), colour.alpha()]
        };
        Self {
            width: pixmap.width() as usize,
            height: pixmap.height() as usize,
            rgba: pixmap.pixels().iter().flat_map(straight).collect(),
        }
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

fn rows(height: f64) -> u32 {
    to_whole(height.ceil().max(1.0))
}

#[cfg(test)]
mod tests {
    use std::fs;
    use std::path::Path;

    use super::*;

    /// The sides in pixels that desktops ask for; windows and packages take them from the files.
    const ICON_SIDES: [u32; 7] = [16, 24, 32, 48, 64, 128, 256];
    /// Largest difference of a channel between two machines' drawings.
    const TOLERANCE: u8 = 2;

    #[test]
    fn the_pictures_of_the_icon_are_its_drawing() {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../assets/packaging");
        let svg = fs::read_to_string(folder.join("selvedge.svg")).expect("the drawing is there");
        let tree = Tree::from_str(&svg, &Options::default()).expect("it is a drawing");
        for side in ICON_SIDES {
            let mut pixmap = Pixmap::new(side, side).expect("a size");
            let scale = to_single(f64::from(side)) / tree.size().width();
            resvg::render(
                &tree,
                Transform::from_scale(scale, scale),
                &mut pixmap.as_mut(),
            );
            let path = folder.join(format!("icons/{side}.png"));
            if std::env::var_os("SELVEDGE_GOLDEN").is_some_and(|word| word == "accept") {
                let png = pixmap.encode_png().expect("it can be packed");
                fs::write(&path, png).expect("it can be written");
            }
            let stored = Pixmap::load_png(&path).expect("the picture is there");
            let size = (stored.width(), stored.height());
            assert_eq!(size, (side, side), "size of {}", path.display());
            let mut pairs = stored.data().iter().zip(pixmap.data());
            let is_same = pairs.all(|(stored, drawn)| stored.abs_diff(*drawn) <= TOLERANCE);
            assert!(
                is_same,
                "{} is not the drawing: SELVEDGE_GOLDEN=accept makes it anew",
                path.display()
            );
        }
    }
}
