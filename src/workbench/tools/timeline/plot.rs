//! The plot of the timeline: its place, its axes, and strips as lines or as columns.
//!
//! Levels share the axis of every level strip, −10…40 dB re 1 µm; speed has one of its own, from 0
//! to a round number.

use eframe::egui::{
    Align2, Color32, Mesh, Painter, Pos2, Rect, Shape, Stroke, epaint::Vertex, epaint::WHITE_UV,
    pos2, vec2,
};

use crate::kit::theme;
use crate::kit::theme::Palette;
use crate::kit::widgets::polyline::corners;
use selvedge_foundation::quantity;

/// Ends of the level axis, dB re 1 µm.
pub(crate) const LEVELS_DB: [f64; 2] = [-10.0, 40.0];
/// Space for the numbers on the left and on the right, points.
const AXES: [f32; 2] = [26.0, 34.0];
/// Space for the title above and for the time below, points.
const TITLE: f32 = 16.0;
const TIMES: f32 = 13.0;
/// Half of a line's width, points.
const HALF: f32 = 0.75;
/// A time axis has a mark at most this often, points.
const MARKS: f64 = 84.0;
/// Words of a time axis stand at least this far apart, points.
const APART: f32 = 4.0;
/// Steps of a time axis, ms.
const STEPS_MS: [u64; 18] = [
    100,
    200,
    500,
    1_000,
    2_000,
    5_000,
    10_000,
    15_000,
    30_000,
    60_000,
    120_000,
    300_000,
    600_000,
    1_800_000,
    3_600_000,
    18_000_000,
    86_400_000,
    432_000_000,
];

/// Where the strips are drawn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Plot {
    /// The plot itself, without its numbers.
    pub(crate) area: Rect,
    /// The end of the speed axis, mm/s.
    pub(crate) top_mm_per_s: f64,
}

impl Plot {
    /// The plot in `rect` when the highest speed is this.
    pub(crate) fn new(rect: Rect, fastest_mm_per_s: f64) -> Self {
        let area = Rect::from_min_max(
            pos2(rect.left() + AXES[0], rect.top() + TITLE),
            pos2(rect.right() - AXES[1], rect.bottom() - TIMES),
        );
        Self {
            area,
            top_mm_per_s: round_above(fastest_mm_per_s),
        }
    }

    /// Whether there is room to draw.
    pub(crate) fn has_room(&self) -> bool {
        self.area.width() > 8.0 && self.area.height() > 8.0
    }

    /// The place at a share of the width.
    pub(crate) fn x_at(&self, share: f64) -> f32 {
        self.area.left() + narrow(share) * self.area.width()
    }

    /// The share of the width at a place, 0…1.
    pub(crate) fn share_at(&self, x: f32) -> f64 {
        let share = f64::from((x - self.area.left()) / self.area.width());
        if share.is_finite() {
            share.clamp(0.0, 1.0)
        } else {
            0.0
        }
    }

    /// How high a level stands.
    pub(crate) fn y_of_level(&self, level_db: f64) -> f32 {
        let [least, most] = LEVELS_DB;
        self.y_at((level_db - least) / (most - least))
    }

    /// How high a speed stands.
    pub(crate) fn y_of_speed(&self, speed_mm_per_s: f64) -> f32 {
        self.y_at(speed_mm_per_s / self.top_mm_per_s)
    }

    fn y_at(&self, share: f64) -> f32 {
        let share = if share.is_nan() { 0.0 } else { share };
        self.area.bottom() - narrow(share.clamp(0.0, 1.0)) * self.area.height()
    }

    /// The axes of level and speed.
    pub(crate) fn paint_axes(&self, painter: &Painter, has_levels: bool) {
        let palette = Palette::of(painter.ctx().theme());
        let area = self.area;
        let hairline = Stroke::new(1.0, palette.hairline);
        for share in [0.0, 0.5, 1.0] {
            let y = painter.round_to_pixel_center(self.y_at(share));
            painter.hline(area.x_range(), y, hairline);
        }
        let write = |x: f32, y: f32, anchor: Align2, words: &str| {
            painter.text(
                pos2(x, y),
                anchor,
                words,
                theme::small_number(),
                palette.dim,
            );
        };
        let (left, right) = (area.left() - 5.0, area.right() + 5.0);
        let (top, middle, bottom) = (area.top() + 2.0, area.center().y, area.bottom() - 2.0);
        if has_levels {
            let digits = |level_db| quantity::fixed(level_db, 0);
            write(left, top, Align2::RIGHT_CENTER, &digits(LEVELS_DB[1]));
            write(left, middle, Align2::RIGHT_CENTER, "dB");
            write(left, bottom, Align2::RIGHT_CENTER, &digits(LEVELS_DB[0]));
        }
        let digits = quantity::fixed(self.top_mm_per_s, 0);
        write(right, top, Align2::LEFT_CENTER, &digits);
        write(right, middle, Align2::LEFT_CENTER, "mm/s");
        write(right, bottom, Align2::LEFT_CENTER, "0");
    }

    /// The marks of the time axis with their words, by share of the width; the ends first, since
    /// words that would touch others are left out.
    pub(crate) fn paint_times(&self, painter: &Painter, marks: &[(f64, String)]) {
        let mut taken: Vec<Rect> = Vec::new();
        for (share, words) in marks {
            self.paint_time(painter, *share, words, &mut taken);
        }
    }

    fn paint_time(&self, painter: &Painter, share: f64, words: &str, taken: &mut Vec<Rect>) {
        let palette = Palette::of(painter.ctx().theme());
        let x = painter.round_to_pixel_center(self.x_at(share));
        let area = self.area;
        painter.vline(x, area.y_range(), Stroke::new(1.0, palette.hairline));
        let below = pos2(x, area.bottom() + 2.0);
        // Words at the ends stay within the plot.
        let anchor = if share < 0.02 {
            Align2::LEFT_TOP
        } else if share > 0.98 {
            Align2::RIGHT_TOP
        } else {
            Align2::CENTER_TOP
        };
        let words = words.to_owned();
        let galley = painter.layout_no_wrap(words, theme::small_number(), palette.dim);
        let place = anchor.anchor_size(below, galley.size());
        let room = place.expand2(vec2(APART, 0.0));
        if !taken.iter().any(|other| other.intersects(room)) {
            painter.galley(place.min, galley, palette.dim);
            taken.push(place);
        }
    }
}

/// The distance between two marks of a time axis that is this long, ms.
pub(crate) fn step_ms(duration_ms: u64, width: f32) -> u64 {
    let most = (f64::from(width) / MARKS).max(1.0);
    let is_wide = |step: &u64| duration_ms as f64 / *step as f64 <= most;
    STEPS_MS.into_iter().find(is_wide).unwrap_or(u64::MAX)
}

/// A time on an axis whose marks are this far apart.
pub(crate) fn time_words(time_ms: u64, step_ms: u64) -> String {
    if step_ms < 1000 {
        return quantity::with_unit(time_ms as f64 / 1000.0, 1, "s");
    }
    let clock = quantity::clock(time_ms);
    clock.split('.').next().unwrap_or_default().to_owned()
}

/// The smallest of 100, 200, 500, 1000 … that is no less; a slow exploration has the same axis as
/// most others.
pub(crate) fn round_above(speed_mm_per_s: f64) -> f64 {
    let rounds = (2..6).flat_map(|power| [1.0, 2.0, 5.0].map(|digit| digit * 10_f64.powi(power)));
    let last = 1e6;
    rounds
        .into_iter()
        .find(|round| speed_mm_per_s <= *round)
        .unwrap_or(last)
}

/// One strip in columns side by side: from the least to the most of each, and up or down to where
/// the one before it ended, so that it reads as one line. `None` is a gap.
pub(crate) fn columns_mesh(
    left: f32,
    width: f32,
    extents: &[Option<[f32; 2]>],
    ink: Color32,
) -> Mesh {
    let mut mesh = Mesh::default();
    let mut before: Option<[f32; 2]> = None;
    for (index, extent) in extents.iter().enumerate() {
        if let Some([top, bottom]) = *extent {
            let [above, below] = before.unwrap_or([top, bottom]);
            let (top, bottom) = (top.min(below), bottom.max(above));
            let x = left + index as f32 * width;
            let rect = Rect::from_min_max(pos2(x, top - HALF), pos2(x + width, bottom + HALF));
            mesh.add_colored_rect(rect, ink);
        }
        before = *extent;
    }
    mesh
}

/// The ground under a strip: from `bottom` up to each point.
pub(crate) fn ground_mesh(points: &[Pos2], bottom: f32, ink: Color32) -> Mesh {
    let mut mesh = Mesh::default();
    let vertex = |pos: Pos2| Vertex {
        pos,
        uv: WHITE_UV,
        color: ink,
    };
    for (index, &point) in (0_u32..).zip(points) {
        mesh.vertices.push(vertex(point));
        mesh.vertices.push(vertex(pos2(point.x, bottom)));
        if index > 0 {
            let at = 2 * (index - 1);
            mesh.add_triangle(at, at + 1, at + 2);
            mesh.add_triangle(at + 1, at + 2, at + 3);
        }
    }
    mesh
}

/// One strip as lines, broken where there is nothing.
pub(crate) fn lines(points: &[Option<Pos2>], ink: Color32) -> Vec<Shape> {
    let line = |stroke: &[Option<Pos2>]| match *stroke {
        [] => None,
        // A single tick is a dot.
        [Some(alone)] => Some(Shape::circle_filled(alone, 1.5 * HALF, ink)),
        _ => {
            let points: Vec<Pos2> = stroke.iter().flatten().copied().collect();
            Some(Shape::line(corners(&points), Stroke::new(2.0 * HALF, ink)))
        }
    };
    points.split(Option::is_none).filter_map(line).collect()
}

/// A share of the screen in the toolkit's numbers.
fn narrow(share: f64) -> f32 {
    #[expect(clippy::cast_possible_truncation, reason = "a share, for the screen")]
    let share = share as f32;
    share
}

#[cfg(test)]
mod tests {
    use super::*;

    fn plot() -> Plot {
        Plot::new(Rect::from_min_size(Pos2::ZERO, vec2(900.0, 68.0)), 130.0)
    }

    #[test]
    fn speed_axes_end_at_round_numbers() {
        for (fastest, top) in [
            (0.0, 100.0),
            (100.0, 100.0),
            (130.0, 200.0),
            (2_100.0, 5_000.0),
        ] {
            assert_eq!(round_above(fastest), top, "{fastest}");
        }
        assert!(round_above(f64::NAN).is_finite() && round_above(f64::INFINITY).is_finite());
    }

    #[test]
    fn what_is_off_the_scale_stays_in_the_plot() {
        let plot = plot();
        for level_db in [-300.0, f64::NEG_INFINITY, f64::NAN, -10.0] {
            assert_eq!(plot.y_of_level(level_db), plot.area.bottom(), "{level_db}");
        }
        assert_eq!(plot.y_of_level(f64::INFINITY), plot.area.top());
        assert_eq!(plot.y_of_speed(f64::MAX), plot.area.top());
    }

    #[test]
    fn marks_of_time_are_never_crowded() {
        assert_eq!(step_ms(12_000, 900.0), 2_000);
        assert_eq!(step_ms(4 * 3_600_000, 900.0), 1_800_000);
        for duration_ms in [0, 25, 900, 61_000, 1_000_000_000] {
            let n = duration_ms / step_ms(duration_ms, 500.0);
            assert!(n as f64 * MARKS <= 500.0, "{duration_ms} ms: {n}");
        }
        assert_eq!(time_words(65_000, 5_000), "01:05");
        assert_eq!(time_words(500, 100), "0.5 s");
    }

    #[test]
    fn columns_touch_their_neighbours_and_gaps_stay_open() {
        let extents = [
            Some([10.0, 12.0]),
            Some([20.0, 22.0]),
            None,
            Some([5.0, 5.0]),
        ];
        let mesh = columns_mesh(0.0, 1.0, &extents, Color32::WHITE);
        assert_eq!(mesh.vertices.len(), 3 * 4);
        let top_of_second = mesh.vertices[4..8].iter().map(|v| v.pos.y);
        assert!(top_of_second.fold(f32::MAX, f32::min) < 12.0);
        assert!(mesh.vertices[8..].iter().all(|v| v.pos.x >= 3.0));
    }

    #[test]
    fn lines_break_at_gaps() {
        let at = |x| Some(pos2(x, 0.0));
        let shapes = lines(&[at(0.0), at(1.0), None, None, at(4.0)], Color32::WHITE);
        assert_eq!(shapes.len(), 2);
    }
}
