//! The axes of a block: mm along the two lower edges towards the viewer, µm up the edge at the
//! left.

use eframe::egui::{Align2, Painter, Pos2, Stroke, Vec2};

use crate::kit::theme;
use crate::kit::theme::Palette;
use crate::kit::widgets::axis::{Axis, Tick};
use crate::kit::widgets::relief3d::Relief3d;
use crate::kit::widgets::relief3d::mesh::Projection;
use crate::kit::widgets::text::paint_quiet;
use selvedge_foundation::numerics::to_single;
use selvedge_foundation::quantity;

/// Between numbers, points.
const APART: f32 = 44.0;
/// Length of a tick, and from the edge to its number, points.
const TICK: f32 = 4.0;
const GAP: f32 = 7.0;

/// An edge that is measured: its ends on the screen, and the numbers there.
struct Edge {
    ends: [Pos2; 2],
    numbers: [f64; 2],
    unit: &'static str,
    /// The end at which another edge has its numbers already.
    shared: Option<usize>,
    /// Away from the block.
    outwards: Vec2,
}

/// The far lower edges, behind the block.
pub(crate) fn paint_frame(painter: &Painter, relief: &Relief3d, projection: &Projection) {
    let palette = Palette::of(painter.ctx().theme());
    let stroke = Stroke::new(1.0, palette.hairline);
    let [x, y] = projection.nearest();
    let [u, w, up] = projection.half;
    for height in [-up, projection.up(relief.range_um[1])] {
        let corner = |sx: f32, sy: f32| projection.at([sx * u, sy * w, height]);
        painter.line_segment([corner(-x, y), corner(-x, -y)], stroke);
        painter.line_segment([corner(-x, -y), corner(x, -y)], stroke);
    }
    let far = |height: f32| projection.at([-x * u, -y * w, height]);
    painter.line_segment([far(-up), far(projection.up(relief.range_um[1]))], stroke);
}

/// Axes with their numbers, before the block.
pub(crate) fn paint(painter: &Painter, relief: &Relief3d, projection: &Projection) {
    for edge in edges(relief, projection) {
        edge.paint(painter);
    }
}

fn edges(relief: &Relief3d, projection: &Projection) -> [Edge; 3] {
    let [x, y] = projection.nearest();
    let [u, w, up] = projection.half;
    let size_mm = relief.size_mm();
    let floor = |sx: f32, sy: f32| projection.at([sx * u, sy * w, -up]);
    let middle = projection.at([0.0, 0.0, -up]);
    let outwards = |a: Pos2, b: Pos2| {
        let way = a + 0.5 * (b - a) - middle;
        // A number stands beside or below its edge, never on the block.
        let normal = (b - a).rot90().normalized();
        if normal.dot(way) < 0.0 {
            -normal
        } else {
            normal
        }
    };
    let along = [floor(-1.0, y), floor(1.0, y)];
    let across = [floor(x, -1.0), floor(x, 1.0)];
    // The corner that is farthest to the left.
    let corners = [[-1.0, -1.0], [-1.0, 1.0], [1.0, -1.0], [1.0, 1.0]];
    let leftmost = corners
        .into_iter()
        .min_by(|a: &[f32; 2], b: &[f32; 2]| floor(a[0], a[1]).x.total_cmp(&floor(b[0], b[1]).x));
    let [sx, sy] = leftmost.unwrap_or([-1.0, -1.0]);
    let standing = |um: f64| projection.at([sx * u, sy * w, projection.up(um)]);
    let [low, high] = relief.range_um;
    [
        Edge {
            ends: along,
            numbers: [0.0, size_mm[0]],
            unit: "mm",
            shared: None,
            outwards: outwards(along[0], along[1]),
        },
        Edge {
            ends: across,
            numbers: [0.0, size_mm[1]],
            unit: "mm",
            shared: Some(usize::from(y > 0.0)),
            outwards: outwards(across[0], across[1]),
        },
        Edge {
            ends: [standing(low), standing(high)],
            numbers: [0.0, high - low],
            unit: "µm",
            shared: Some(0),
            outwards: Vec2::new(-1.0, 0.0),
        },
    ]
}

impl Edge {
    fn paint(&self, painter: &Painter) {
        let palette = Palette::of(painter.ctx().theme());
        let stroke = Stroke::new(1.0, palette.line);
        painter.line_segment(self.ends, stroke);
        let [from, to] = self.ends;
        let length = (to - from).length();
        if length < 12.0 {
            return;
        }
        let axis = Axis::linear(self.numbers[0], self.numbers[1]);
        let mut ticks = axis.ticks(length, APART.min(0.9 * length));
        if self.unit == "µm" && ticks.len() < 3 {
            // Too short for round numbers: the relief itself.
            ticks = vec![Tick::named(axis.most, &quantity::fixed(axis.most, 0))];
        }
        let is_shared = |tick: &Tick| {
            let share = axis.share(tick.value);
            self.shared
                .is_some_and(|end| (share - end as f64).abs() * f64::from(length) < 12.0)
        };
        ticks.retain(|tick| !is_shared(tick));
        let n = ticks.len();
        for (i, tick) in ticks.into_iter().enumerate() {
            self.paint_tick(painter, &axis, &tick, i + 1 == n);
        }
    }

    fn paint_tick(&self, painter: &Painter, axis: &Axis, tick: &Tick, is_last: bool) {
        let palette = Palette::of(painter.ctx().theme());
        let [from, to] = self.ends;
        let at = from + (to - from) * to_single(axis.share(tick.value));
        let stroke = Stroke::new(1.0, palette.line);
        painter.line_segment([at, at + self.outwards * TICK], stroke);
        let anchor = if self.outwards.x > 0.3 {
            Align2::LEFT_CENTER
        } else if self.outwards.x < -0.3 {
            Align2::RIGHT_CENTER
        } else {
            Align2::CENTER_TOP
        };
        let mut at = at + self.outwards * GAP;
        if !is_last {
            painter.text(at, anchor, &tick.label, theme::small_number(), palette.dim);
            return;
        }
        // The unit stands after the last number, whichever side the number hangs on.
        let gap = Vec2::new(4.0, 0.0);
        if anchor == Align2::RIGHT_CENTER {
            let unit = paint_quiet(painter, at, anchor, self.unit);
            at = unit.left_center() - gap;
            painter.text(at, anchor, &tick.label, theme::small_number(), palette.dim);
        } else {
            let number = painter.text(at, anchor, &tick.label, theme::small_number(), palette.dim);
            let at = number.right_center() + gap;
            paint_quiet(painter, at, Align2::LEFT_CENTER, self.unit);
        }
    }
}
