//! The lanes as pictures, one pixel a column: made when something about them has changed and kept
//! on the graphics card until then. Only what is in sight is drawn, however long it is.

use std::hash::{DefaultHasher, Hash as _, Hasher as _};
use std::ops::Range;

use eframe::egui::{Color32, ColorImage, Context, TextureId, TextureOptions};

use crate::bench::recording::tiles::Tiles;
use crate::kit::texture::Texture;
use crate::kit::theme::Palette;
use crate::tools::timeline::axes::LEVELS_DB;
use crate::tools::timeline::code::{GAP, level_of, mirrored, speed_of};
use crate::tools::timeline::columns::{LIMITED, MISSING};
use crate::tools::timeline::span::Span;
use selvedge_foundation::numerics::to_index;
use selvedge_textile::tactile::Band;

/// Pixels from a hatching line of a gap to the next.
const HATCH: usize = 6;
/// Height of the marks of limits and of missing ticks, pixels.
const MARK: usize = 3;

/// The columns in sight, one a pixel.
#[derive(Debug, Default)]
pub(crate) struct Columns {
    key: Option<(u64, Span, usize, u64)>,
    n_rows: usize,
    bytes: Vec<u8>,
    /// Changes whenever they do.
    stamp: u64,
}

impl Columns {
    /// Reads what tiles hold of a span in `n` columns, if anything has changed; `of` says which
    /// exploration the tiles are of.
    pub(crate) fn follow(&mut self, tiles: &Tiles, of: u64, (span, n): (Span, usize)) {
        let key = (of, span, n, tiles.version);
        if self.key == Some(key) && self.n_rows == tiles.n_rows {
            return;
        }
        self.key = Some(key);
        self.stamp += 1;
        self.n_rows = tiles.n_rows;
        self.bytes.resize(n * self.n_rows, 0);
        if self.n_rows > 0 {
            for (x, rows) in self.bytes.chunks_exact_mut(self.n_rows).enumerate() {
                tiles.strongest_into(span.column(x, n), rows);
            }
        }
    }

    /// Every column, left to right.
    pub(crate) fn each(&self) -> impl ExactSizeIterator<Item = &[u8]> {
        self.bytes.chunks_exact(self.n_rows.max(1))
    }
}

/// A lane on the graphics card: of what columns, how large, drawn how.
pub(crate) type Picture = Texture<(u64, [usize; 2], u64)>;

impl Picture {
    /// The picture of columns, made anew if they, its height or how it is drawn have changed.
    pub(crate) fn follow(
        &mut self,
        ctx: &Context,
        (columns, height): (&Columns, usize),
        drawing: &Drawing,
    ) -> TextureId {
        let size = [columns.each().len(), height];
        let mut hasher = DefaultHasher::new();
        drawing.hash(&mut hasher);
        let key = (columns.stamp, size, hasher.finish());
        let how = ("timeline", TextureOptions::NEAREST);
        self.of(ctx, how, key, || drawing.image(columns, size))
    }
}

/// How a lane is drawn.
#[derive(Debug, Clone, Hash)]
pub(crate) enum Drawing {
    /// Rows of colours: the rows of each pixel, from top to bottom, and the colour of every byte.
    Raster {
        rows: Vec<Range<usize>>,
        colours: Box<[Color32; 256]>,
        gap: [Color32; 2],
    },
    /// Speed and mean levels as lines, with the marks of limits and missing ticks.
    Lines(LineInks),
}

/// The colours of lines.
#[derive(Debug, Clone, Copy, Hash)]
pub(crate) struct LineInks {
    ground: Color32,
    speed: Color32,
    bands: [Color32; 2],
    mark: Color32,
    missing: Color32,
    gap: [Color32; 2],
    /// The end of the speed axis, mm/s.
    pub(crate) top_mm_per_s: usize,
}

impl LineInks {
    /// Those of a theme.
    pub(crate) fn of(palette: &Palette, top_mm_per_s: usize) -> Self {
        Self {
            ground: palette.line.gamma_multiply(0.22),
            speed: palette.line,
            bands: Band::ALL.map(|band| palette.band(band)),
            mark: palette.selection,
            missing: palette.dim,
            gap: gap_colours(palette),
            top_mm_per_s,
        }
    }
}

/// Ground and hatching of a gap.
pub(crate) fn gap_colours(palette: &Palette) -> [Color32; 2] {
    [palette.floor, palette.hairline]
}

impl Drawing {
    fn image(&self, columns: &Columns, [width, height]: [usize; 2]) -> ColorImage {
        let mut pixels = vec![Color32::TRANSPARENT; width * height];
        for (x, rows) in columns.each().enumerate() {
            let mut put = |y: usize, ink: Color32| {
                if let Some(pixel) = pixels.get_mut(y * width + x) {
                    *pixel = ink;
                }
            };
            match self {
                Self::Raster {
                    rows: of,
                    colours,
                    gap,
                } => {
                    for (y, of) in of.iter().enumerate().take(height) {
                        let code = rows.get(of.clone()).unwrap_or_default();
                        let code = code.iter().copied().max().unwrap_or(GAP);
                        let is_gap = code == GAP;
                        let ink = colours[usize::from(code)];
                        put(y, if is_gap { hatched(x, y, *gap) } else { ink });
                    }
                }
                Self::Lines(inks) => draw_lines(rows, (x, height), inks, &mut put),
            }
        }
        ColorImage::new([width, height], pixels)
    }
}

fn hatched(x: usize, y: usize, [ground, line]: [Color32; 2]) -> Color32 {
    if (x + y).is_multiple_of(HATCH) {
        line
    } else {
        ground
    }
}

/// One column of lines: from the least to the most of each.
fn draw_lines(
    rows: &[u8],
    (x, height): (usize, usize),
    inks: &LineInks,
    put: &mut impl FnMut(usize, Color32),
) {
    if rows.first().is_none_or(|code| *code == GAP) {
        (0..height).for_each(|y| put(y, hatched(x, y, inks.gap)));
        return;
    }
    let top = inks.top_mm_per_s.max(1) as f64;
    let speed_y = |code| speed_of(code).map(|speed| y_at(speed / top, height));
    if let Some((high, low)) = speed_y(rows[0]).zip(speed_y(mirrored(rows[1]))) {
        (high..height).for_each(|y| put(y, inks.ground));
        (high..=low).for_each(|y| put(y, inks.speed));
    }
    let [least, most] = LEVELS_DB;
    let level_y = |code| {
        let level = level_of(code).filter(|level| level.is_finite())?;
        Some(y_at((level - least) / (most - least), height))
    };
    for band in Band::ALL {
        let at = 2 + 2 * band.index();
        if let Some(high) = level_y(rows[at]) {
            let low = level_y(mirrored(rows[at + 1])).unwrap_or(height - 1);
            let next = (low + 1).max(high + 2).min(height);
            (high..next).for_each(|y| put(y, inks.bands[band.index()]));
        }
    }
    if rows[LIMITED] > 1 {
        (0..MARK.min(height)).for_each(|y| put(y, inks.mark));
    }
    if rows[MISSING] > 1 {
        (0..height).step_by(2).for_each(|y| put(y, inks.missing));
    }
}

/// The pixel from the top at a share of the height.
fn y_at(share: f64, height: usize) -> usize {
    let most = height.saturating_sub(1);
    most - to_index((share.clamp(0.0, 1.0) * most as f64).round()).min(most)
}

/// Which of `n` rows each pixel shows, from top to bottom; where there are fewer pixels than rows,
/// several.
pub(crate) fn even_rows(first: usize, n: usize, height: usize) -> Vec<Range<usize>> {
    let of = |y: usize| {
        let start = y * n / height;
        let end = ((y + 1) * n).div_ceil(height);
        first + start..first + end.max(start + 1).min(n)
    };
    (0..height).map(of).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tools::timeline::code::{amplitude_code, table};
    use crate::tools::timeline::columns::N_LINES;

    #[test]
    fn every_row_has_a_pixel_and_every_pixel_a_row() {
        for (n, height) in [(24, 24), (24, 7), (24, 100), (1, 3), (96, 41)] {
            let rows = even_rows(8, n, height);
            assert_eq!(rows.len(), height);
            assert!(
                rows.iter()
                    .all(|rows| !rows.is_empty() && rows.end <= 8 + n)
            );
            for row in 8..8 + n {
                assert!(rows.iter().any(|rows| rows.contains(&row)), "{row} of {n}");
            }
        }
    }

    #[test]
    fn a_gap_is_hatched_and_silence_is_not() {
        let mut tiles = Tiles::new(2, 20);
        tiles.put(0, &[1, 1]);
        tiles.put(1, &[amplitude_code(5.0), 1]);
        let mut columns = Columns::default();
        columns.follow(&tiles, 0, (Span::new(0.0, 20.0), 20));
        let drawing = Drawing::Raster {
            rows: even_rows(0, 2, 12),
            colours: Box::new(table(Color32::from_gray)),
            gap: [Color32::BLACK, Color32::RED],
        };
        let image = drawing.image(&columns, [20, 12]);
        let at = |x: usize, y: usize| image.pixels[y * 20 + x];
        assert_eq!(at(0, 0), Color32::from_gray(1));
        assert_eq!(at(1, 0), Color32::from_gray(amplitude_code(5.0)));
        assert_eq!(at(1, 11), Color32::from_gray(1));
        let gap: Vec<Color32> = (2..20).map(|x| at(x, 3)).collect();
        assert!(gap.contains(&Color32::RED) && gap.contains(&Color32::BLACK));
    }

    #[test]
    fn a_picture_is_made_only_when_something_changed() {
        let ctx = Context::default();
        let (mut picture, mut columns) = (Picture::default(), Columns::default());
        let mut tiles = Tiles::new(N_LINES, 5_000);
        let lines = |top| Drawing::Lines(LineInks::of(Palette::of(ctx.theme()), top));
        let mut show = |tiles: &Tiles, end: f64, top: usize| {
            columns.follow(tiles, 0, (Span::new(0.0, end), 300));
            picture.follow(&ctx, (&columns, 20), &lines(top));
            picture.n_made
        };
        assert_eq!(show(&tiles, 90.0, 100), 1);
        assert_eq!(show(&tiles, 90.0, 100), 1, "nothing has changed");
        assert_eq!(show(&tiles, 80.0, 100), 2, "another span");
        assert_eq!(show(&tiles, 80.0, 200), 3, "another axis");
        tiles.put(7, &[3; N_LINES]);
        assert_eq!(show(&tiles, 80.0, 200), 4, "more is known");
    }
}
