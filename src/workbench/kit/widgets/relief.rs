//! A relief of heights over an area: coloured by height, lit from the upper left, with what is
//! missing hatched, and the bar that says which colour is which height.
//!
//! [`Relief::of`] looks at every height once and may run on any thread; what is drawn from then on
//! has as many points as the screen can show.

use std::sync::Arc;

use eframe::egui::{Align2, Color32, ColorImage, Painter, Rect, TextureOptions, Theme, vec2};

use crate::kit::texture::{Same, Texture, WHOLE};
use crate::kit::theme::Palette;
use crate::kit::theme::colour_map::ColourMap;
use crate::kit::widgets::axis::{Axis, Side, paint_outer_ticks};
use crate::kit::widgets::bar::colour_bar;
use crate::kit::widgets::text::paint_quiet;
use selvedge_foundation::numerics::{Grid, to_byte, to_index, to_single};
use selvedge_textile::surface::HeightMap;

/// Points along the longer side at most.
const MOST_POINTS: f64 = 720.0;
/// Pixels along the longer side at least, so that hatching is fine.
const LEAST_PIXELS: usize = 360;
/// The share of the heights that lies beyond either end of the colours.
const BEYOND: f64 = 0.005;
/// How much light and shade change a colour.
const DEPTH: f64 = 0.4;
/// Width of a bar with its numbers, points.
pub(crate) const BAR_ROOM: f32 = 58.0;

/// Heights as they are drawn.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Relief {
    heights_um: Grid<f64>,
    /// Extent along u and w, mm.
    pub(crate) size_mm: [f64; 2],
    /// The heights at the ends of the colours, µm: all but 0.5 % at either end lie between.
    pub(crate) range_um: [f64; 2],
    /// Points of the map without a height.
    pub(crate) n_missing: usize,
}

impl Relief {
    /// The relief of a map: means over cells as wide as a pixel; a cell is missing where most of
    /// its points are.
    pub(crate) fn of(map: &HeightMap) -> Self {
        let size_mm = map.size_mm();
        let cell_mm = size_mm[0].max(size_mm[1]) / MOST_POINTS;
        let n_points = [map.heights_um().width(), map.heights_um().height()];
        let n_cells = [0, 1].map(|axis| {
            let n = to_index((size_mm[axis] / cell_mm).round()).max(1);
            n.min(n_points[axis])
        });
        let heights_um = pooled(map.heights_um(), n_cells);
        Self {
            range_um: range_of(&heights_um),
            heights_um,
            size_mm,
            n_missing: map.n_missing(),
        }
    }

    /// The cells that are drawn, µm, rows in the order of rising w; NaN where missing.
    pub(crate) fn heights_um(&self) -> &Grid<f64> {
        &self.heights_um
    }

    /// The height at a place in mm, µm; `None` off the map and where it is missing.
    pub(crate) fn height_at(&self, place_mm: [f64; 2]) -> Option<f64> {
        let n = [self.heights_um.width(), self.heights_um.height()];
        let cell = |axis: usize| {
            let share = place_mm[axis] / self.size_mm[axis];
            let is_within = (0.0..1.0).contains(&share);
            is_within.then(|| to_index(share * n[axis] as f64))
        };
        let height = self.heights_um.row(cell(1)?)[cell(0)?];
        height.is_finite().then_some(height)
    }

    /// The largest rectangle of the map's shape in the middle of a room.
    pub(crate) fn fitted(&self, room: Rect) -> Rect {
        let shape = to_single(self.size_mm[0] / self.size_mm[1]);
        let width = room.width().min(room.height() * shape);
        Rect::from_center_size(room.center(), vec2(width, width / shape))
    }

    /// The colour of a cell, lit by its slope against the rms slope; `None`: missing.
    pub(crate) fn colours(&self, map: ColourMap) -> Grid<Option<Color32>> {
        let (width, height) = (self.heights_um.width(), self.heights_um.height());
        let [low, high] = self.range_um;
        let slopes: Vec<f64> = (0..height)
            .flat_map(|row| (0..width).map(move |column| (row, column)))
            .map(|(row, column)| self.slope(row, column))
            .collect();
        let present = slopes.iter().filter(|slope| slope.is_finite());
        let n = present.clone().count().max(1) as f64;
        let rms = (present.map(|slope| slope * slope).sum::<f64>() / n).sqrt();
        let colour = |(height, slope): (&f64, &f64)| {
            let share = (height - low) / (high - low).max(f64::MIN_POSITIVE);
            let light = if rms > 0.0 {
                (0.7 * slope / rms).tanh()
            } else {
                0.0
            };
            height
                .is_finite()
                .then(|| lit(map.colour(share), DEPTH * light))
        };
        let colours = self.heights_um.values().iter().zip(&slopes).map(colour);
        Grid::from_rows(width, colours.collect()).unwrap_or_else(|| Grid::filled(1, 1, None))
    }

    /// How a cell leans to the upper left, µm; what is missing leans nowhere.
    fn slope(&self, row: usize, column: usize) -> f64 {
        let (width, height) = (self.heights_um.width(), self.heights_um.height());
        let here = self.heights_um.row(row)[column];
        let at = |row: usize, column: usize| {
            let there = self.heights_um.row(row.min(height - 1))[column.min(width - 1)];
            if there.is_finite() { there } else { here }
        };
        at(row, column + 1) - at(row, column.saturating_sub(1)) + at(row.saturating_sub(1), column)
            - at(row + 1, column)
    }

    /// The picture, its upper row at the highest w.
    fn image(&self, map: ColourMap, palette: &Palette) -> ColorImage {
        let colours = self.colours(map);
        let (width, height) = (colours.width(), colours.height());
        let times = LEAST_PIXELS.div_ceil(width.max(height)).max(1);
        let size = [width * times, height * times];
        let mut pixels = Vec::with_capacity(size[0] * size[1]);
        for y in 0..size[1] {
            let row = colours.row(height - 1 - y / times);
            for x in 0..size[0] {
                let hatch = if (x + y) % 8 < 2 {
                    palette.line
                } else {
                    palette.floor
                };
                pixels.push(row[x / times].unwrap_or(hatch));
            }
        }
        ColorImage::new(size, pixels)
    }
}

/// Lighter (up to 1) or darker (down to −1).
fn lit(colour: Color32, light: f64) -> Color32 {
    let towards = if light > 0.0 { 255.0 } else { 0.0 };
    let [r, g, b, _] = colour.to_array().map(|channel| {
        let channel = f64::from(channel);
        to_byte(channel + (towards - channel) * light.abs().min(1.0))
    });
    Color32::from_rgb(r, g, b)
}

/// Means over cells; NaN where most points of a cell are missing.
fn pooled(values: &Grid<f64>, n_cells: [usize; 2]) -> Grid<f64> {
    let n_points = [values.width(), values.height()];
    let span = |cell: usize, axis: usize| {
        let first = cell * n_points[axis] / n_cells[axis];
        first..((cell + 1) * n_points[axis] / n_cells[axis]).max(first + 1)
    };
    let mut cells = Grid::filled(n_cells[0], n_cells[1], f64::NAN);
    for row in 0..n_cells[1] {
        for column in 0..n_cells[0] {
            let rows = span(row, 1);
            let n_all = rows.len() * span(column, 0).len();
            let (mut n, mut sum) = (0_usize, 0.0);
            for height in rows.flat_map(|r| &values.row(r)[span(column, 0)]) {
                if height.is_finite() {
                    n += 1;
                    sum += height;
                }
            }
            if 2 * n >= n_all && n > 0 {
                cells.row_mut(row)[column] = sum / n as f64;
            }
        }
    }
    cells
}

/// The heights that all but a few at either end lie between.
fn range_of(heights: &Grid<f64>) -> [f64; 2] {
    let mut present: Vec<f64> = heights
        .values()
        .iter()
        .copied()
        .filter(|z| z.is_finite())
        .collect();
    if present.is_empty() {
        return [0.0, 1.0];
    }
    present.sort_by(f64::total_cmp);
    let beyond = to_index(BEYOND * present.len() as f64);
    let range = [present[beyond], present[present.len() - 1 - beyond]];
    if range[1] > range[0] {
        range
    } else {
        [range[0] - 0.5, range[0] + 0.5]
    }
}

/// The picture of a relief: in what colours, in the dark theme or the light one.
pub(crate) type ReliefPicture = Texture<(Same<Relief>, ColourMap, bool)>;

impl ReliefPicture {
    /// Paints the relief into a rectangle of its shape.
    pub(crate) fn paint(
        &mut self,
        painter: &Painter,
        rect: Rect,
        relief: &Arc<Relief>,
        map: ColourMap,
    ) {
        let theme = painter.ctx().theme();
        let key = (Same(Arc::clone(relief)), map, theme == Theme::Dark);
        let options = TextureOptions::LINEAR;
        let texture = self.of(painter.ctx(), ("relief", options), key, || {
            relief.image(map, Palette::of(theme))
        });
        painter.image(texture, rect, WHOLE, Color32::WHITE);
    }
}

/// Paints the bar of heights, its numbers on the right and the unit above.
pub(crate) fn paint_height_bar(painter: &Painter, bar: Rect, relief: &Relief, map: ColourMap) {
    colour_bar(painter, bar, |share| map.colour(share));
    let [low, high] = relief.range_um;
    let axis = Axis::linear(low, high);
    let ticks = axis.ticks(bar.height(), 28.0);
    paint_outer_ticks(painter, bar, (&axis, Side::Right), &ticks);
    paint_quiet(
        painter,
        bar.left_top() - vec2(0.0, 4.0),
        Align2::LEFT_BOTTOM,
        "µm",
    );
}

#[cfg(test)]
mod tests {
    use eframe::egui::Pos2;

    use super::*;

    /// A ramp along u with a hole, 2000 × 500 points of 0.01 mm.
    fn map() -> HeightMap {
        let heights = (0..2000 * 500_usize).map(|i| {
            let (column, row) = (i % 2000, i / 2000);
            let is_hole = column < 200 && row < 100;
            if is_hole {
                f64::NAN
            } else {
                column as f64 * 0.01
            }
        });
        let grid = Grid::from_rows(2000, heights.collect()).unwrap();
        HeightMap::new(grid, [0.01, 0.01]).unwrap()
    }

    #[test]
    fn a_relief_keeps_heights_shape_and_holes() {
        let relief = Relief::of(&map());
        assert_eq!(
            (relief.heights_um.width(), relief.heights_um.height()),
            (720, 180)
        );
        assert_eq!(relief.n_missing, 200 * 100);
        assert_eq!(relief.height_at([0.5, 0.5]), None, "the hole");
        let found = relief.height_at([10.0, 4.0]).unwrap();
        assert!((found - 10.0).abs() < 0.05, "{found}");
        assert_eq!(relief.height_at([20.5, 1.0]), None, "off the map");
        let fitted = relief.fitted(Rect::from_min_size(Pos2::ZERO, vec2(400.0, 400.0)));
        assert_eq!(fitted.size(), vec2(400.0, 100.0));
        let [low, high] = relief.range_um;
        assert!(
            low > 0.0 && low < 0.4 && high > 19.5 && high < 20.0,
            "{low} {high}"
        );
    }

    #[test]
    fn holes_have_no_colour_and_the_upper_row_is_the_highest_w() {
        let relief = Relief::of(&map());
        let colours = relief.colours(ColourMap::Grey);
        assert_eq!(colours.row(0)[0], None);
        assert!(colours.row(179)[0].is_some());
        let brightness = |column: usize| colours.row(100)[column].unwrap().r();
        assert!(brightness(700) > brightness(360) && brightness(360) > brightness(20));
        let image = relief.image(ColourMap::Grey, Palette::of(Theme::Dark));
        let corner = image.pixels[(image.size[1] - 1) * image.size[0]];
        assert!(
            [0x0b, 0x6c].contains(&corner.r()),
            "the hole is hatched at the lower left"
        );
    }

    #[test]
    fn a_level_map_has_one_colour_and_a_bar_with_two_ends() {
        let grid = Grid::filled(30, 20, 7.0);
        let relief = Relief::of(&HeightMap::new(grid, [0.1, 0.1]).unwrap());
        assert_eq!(relief.range_um, [6.5, 7.5]);
        let colours = relief.colours(ColourMap::Viridis);
        assert!(
            colours
                .values()
                .iter()
                .all(|colour| *colour == colours.row(0)[0])
        );
    }
}
