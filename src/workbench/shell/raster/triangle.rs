//! One triangle: which pixels it covers, and what is interpolated across it.
//!
//! Corners are snapped to 1/256 pixel and edges are evaluated in whole numbers, so two triangles
//! that share an edge cover every pixel along it exactly once.

use eframe::egui::{Color32, Pos2, Vec2, pos2, vec2};
use selvedge_foundation::numerics::to_single;

/// Sub-pixel steps in a pixel.
const SUB: i64 = 256;
/// Half a pixel in sub-pixel steps: where pixels are sampled.
const HALF: i64 = SUB / 2;

/// A corner in pixels, with its place in the texture and its colour.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Corner {
    place: [i64; 2],
    uv: Pos2,
    colour: [f32; 4],
}

/// The columns of one row that are covered: from (inclusive), to (exclusive).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Span {
    pub(crate) from: i64,
    pub(crate) to: i64,
}

/// A triangle whose corners run so that its inside is on the positive side of every edge.
#[derive(Debug)]
pub(crate) struct Triangle {
    corners: [Corner; 3],
    edges: [Edge; 3],
    double_area: i64,
}

/// `a·x + b·y + c`, positive inside; the bias makes the top-left rule a plain comparison.
#[derive(Debug, Clone, Copy)]
struct Edge {
    a: i64,
    b: i64,
    c: i64,
    bias: i64,
}

/// What is interpolated, at one pixel, and how it changes to the pixel on the right.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Interpolated {
    pub(crate) uv: Pos2,
    pub(crate) colour: [f32; 4],
    uv_step: Vec2,
    colour_step: [f32; 4],
}

impl Corner {
    /// A corner at `place` in pixels. Places that are not finite become the origin.
    pub(crate) fn new(place: Pos2, uv: Pos2, colour: Color32) -> Self {
        Self {
            place: [snapped(place.x), snapped(place.y)],
            uv,
            colour: colour.to_array().map(f32::from),
        }
    }
}

impl Edge {
    fn between(from: [i64; 2], to: [i64; 2]) -> Self {
        let (a, b) = (from[1] - to[1], to[0] - from[0]);
        let c = -(a * from[0] + b * from[1]);
        // Left edges and top edges own their pixels; the others give them away.
        let owns = a > 0 || (a == 0 && b > 0);
        Self {
            a,
            b,
            c,
            bias: if owns { 0 } else { -1 },
        }
    }

    fn at(self, x: i64, y: i64) -> i64 {
        self.a * x + self.b * y + self.c
    }
}

impl Triangle {
    /// The triangle over three corners in any order; `None` when it has no area.
    pub(crate) fn new(mut corners: [Corner; 3]) -> Option<Self> {
        let doubled =
            |[p, q, r]: [Corner; 3]| Edge::between(p.place, q.place).at(r.place[0], r.place[1]);
        let mut double_area = doubled(corners);
        if double_area < 0 {
            corners.swap(1, 2);
            double_area = -double_area;
        }
        if double_area == 0 {
            return None;
        }
        let [p, q, r] = corners.map(|corner| corner.place);
        // Edge i lies opposite corner i, so its value there is the corner's weight.
        let edges = [
            Edge::between(q, r),
            Edge::between(r, p),
            Edge::between(p, q),
        ];
        Some(Self {
            corners,
            edges,
            double_area,
        })
    }

    /// The pixel rows that it may touch: from (inclusive), to (exclusive).
    pub(crate) fn rows(&self) -> [i64; 2] {
        let ys = self.corners.map(|corner| corner.place[1]);
        let top = ys.into_iter().fold(i64::MAX, i64::min);
        let bottom = ys.into_iter().fold(i64::MIN, i64::max);
        [top.div_euclid(SUB), bottom.div_euclid(SUB) + 1]
    }

    /// The columns of `row` that it covers within `columns`; `None` when there are none.
    pub(crate) fn span(&self, row: i64, columns: [i64; 2]) -> Option<Span> {
        let [mut from, mut to] = columns;
        let y = row * SUB + HALF;
        for edge in self.edges {
            // Covered where a·(SUB·x + HALF) + rest ≥ 0.
            let rest = edge.at(HALF, y) + edge.bias;
            let step = edge.a * SUB;
            match step.signum() {
                1 => from = from.max((-rest + step - 1).div_euclid(step)),
                -1 => to = to.min(rest.div_euclid(-step) + 1),
                _ if rest < 0 => return None,
                _ => {}
            }
        }
        (from < to).then_some(Span { from, to })
    }

    /// What is interpolated at the middle of a pixel.
    pub(crate) fn at(&self, column: i64, row: i64) -> Interpolated {
        let (x, y) = (column * SUB + HALF, row * SUB + HALF);
        let weights = self
            .edges
            .map(|edge| share(edge.at(x, y), self.double_area));
        let steps = self.edges.map(|edge| share(edge.a * SUB, self.double_area));
        let (uv, colour) = self.weighted(weights);
        let (uv_step, colour_step) = self.weighted(steps);
        Interpolated {
            uv: uv.to_pos2(),
            colour,
            uv_step,
            colour_step,
        }
    }

    /// The largest change of the texture place over one pixel, along either axis.
    pub(crate) fn uv_per_pixel(&self) -> Vec2 {
        let along = |pick: fn(&Edge) -> i64| {
            self.weighted(
                self.edges
                    .map(|edge| share(pick(&edge) * SUB, self.double_area)),
            )
            .0
        };
        let (right, down) = (along(|edge| edge.a), along(|edge| edge.b));
        vec2(
            right.x.abs().max(down.x.abs()),
            right.y.abs().max(down.y.abs()),
        )
    }

    fn weighted(&self, weights: [f32; 3]) -> (Vec2, [f32; 4]) {
        let mut uv = Vec2::ZERO;
        let mut colour = [0.0; 4];
        for (corner, weight) in self.corners.iter().zip(weights) {
            uv += corner.uv.to_vec2() * weight;
            for (sum, channel) in colour.iter_mut().zip(corner.colour) {
                *sum += channel * weight;
            }
        }
        (uv, colour)
    }
}

impl Interpolated {
    /// Goes one pixel to the right.
    pub(crate) fn advance(&mut self) {
        self.uv = pos2(self.uv.x + self.uv_step.x, self.uv.y + self.uv_step.y);
        for (channel, step) in self.colour.iter_mut().zip(self.colour_step) {
            *channel += step;
        }
    }
}

/// A part of the whole.
fn share(part: i64, whole: i64) -> f32 {
    to_single(part as f64 / whole as f64)
}

/// A pixel coordinate in sub-pixel steps, bounded so that edges cannot overflow.
#[expect(
    clippy::cast_possible_truncation,
    reason = "clamped before; NaN becomes 0"
)]
fn snapped(at: f32) -> i64 {
    (f64::from(at) * SUB as f64).round().clamp(-1e8, 1e8) as i64
}
