//! The block as a mesh: where its points come to lie on the screen, in which order they are
//! painted, and how bright they are.

use eframe::egui::{Color32, Mesh, Pos2, Rect, Vec2, pos2, vec2};

use crate::kit::theme::Palette;
use crate::kit::widgets::relief3d::{Relief3d, View3d};
use selvedge_foundation::numerics::{to_byte, to_single};

/// Room for the numbers around the block, points.
const ROOM: Vec2 = vec2(64.0, 44.0);
/// Towards the light as the viewer has it: from the upper left, before the block.
const LIGHT: [f32; 3] = [-0.55, 0.25, 0.8];
/// How bright what lies in the shade is.
const AMBIENT: f32 = 0.22;
/// How bright the cut sides are.
const SIDE: f32 = 0.32;
/// The least height of a block, as a share of its longer side: what is flat has a side to be seen.
const LEAST_SIDE: f32 = 0.02;

/// Where places in the block lie on the screen: parallel projection.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Projection {
    centre: Pos2,
    /// Points a mm.
    scale: f32,
    yaw: [f32; 2],
    pitch: [f32; 2],
    /// Half the extent along u, w and upwards, mm as drawn.
    pub(crate) half: [f32; 3],
    /// mm as drawn a µm.
    rise: f32,
    middle_um: f32,
}

impl Projection {
    pub(crate) fn of(relief: &Relief3d, view: View3d, rect: Rect) -> Self {
        let [u, w] = relief.size_mm().map(|mm| to_single(0.5 * mm).max(1e-6));
        let rise = to_single(view.exaggeration * 1e-3);
        let up = (0.5 * to_single(relief.relief_um()) * rise).max(LEAST_SIDE * u.max(w));
        let (yaw, pitch) = (view.yaw_deg.to_radians(), view.pitch_deg.to_radians());
        let reach = u.hypot(w);
        let tall = reach * pitch.sin() + up * pitch.cos();
        let room = (rect.size() - 2.0 * ROOM).max(vec2(16.0, 16.0));
        let scale = (0.5 * room.x / reach).min(0.5 * room.y / tall) * view.zoom;
        Self {
            centre: rect.center(),
            scale,
            yaw: [yaw.cos(), yaw.sin()],
            pitch: [pitch.cos(), pitch.sin()],
            half: [u, w, up],
            rise,
            middle_um: to_single(0.5 * (relief.range_um[0] + relief.range_um[1])),
        }
    }

    /// A height as drawn, mm above the middle.
    pub(crate) fn up(&self, height_um: f64) -> f32 {
        (to_single(height_um) - self.middle_um) * self.rise
    }

    /// Turned about the vertical: to the right, and away from the viewer.
    pub(crate) fn turned(&self, [x, y]: [f32; 2]) -> [f32; 2] {
        let [cos, sin] = self.yaw;
        [x * cos - y * sin, x * sin + y * cos]
    }

    /// Where a place (mm from the block's middle) lies on the screen.
    pub(crate) fn at(&self, [x, y, up]: [f32; 3]) -> Pos2 {
        let [right, away] = self.turned([x, y]);
        let [cos, sin] = self.pitch;
        let rise = away * sin + up * cos;
        pos2(
            self.centre.x + self.scale * right,
            self.centre.y - self.scale * rise,
        )
    }

    /// The signs of the corner that is nearest to the viewer.
    pub(crate) fn nearest(&self) -> [f32; 2] {
        // Moving along x goes away by the sine, along y by the cosine of the yaw.
        let sign = |away: f32| if away > 0.0 { -1.0 } else { 1.0 };
        [sign(self.yaw[1]), sign(self.yaw[0])]
    }
}

/// The mesh of a relief: its surface from back to front, then the two sides towards the viewer.
pub(crate) fn of(relief: &Relief3d, projection: &Projection, palette: &Palette) -> Mesh {
    let ground = palette.resting_cloth;
    let [width, height] = [relief.heights_um.width(), relief.heights_um.height()];
    let mut mesh = Mesh::default();
    mesh.reserve_vertices(width * height + 4 * (width + height));
    mesh.reserve_triangles(2 * width * height + 4 * (width + height));
    let places = Places::of(relief, projection);
    for row in 0..height {
        for column in 0..width {
            let bright = places.brightness(row, column);
            mesh.colored_vertex(projection.at(places.at(row, column)), lit(ground, bright));
        }
    }
    let [near_x, near_y] = projection.nearest();
    let order = |n: usize, near: f32| -> Vec<usize> {
        let cells = 0..n.saturating_sub(1);
        if near > 0.0 {
            cells.collect()
        } else {
            cells.rev().collect()
        }
    };
    let index = |row: usize, column: usize| u32::try_from(row * width + column).unwrap_or(0);
    let columns = order(width, near_x);
    for row in order(height, near_y) {
        for &column in &columns {
            let corners = [
                index(row, column),
                index(row, column + 1),
                index(row + 1, column),
                index(row + 1, column + 1),
            ];
            mesh.add_triangle(corners[0], corners[1], corners[2]);
            mesh.add_triangle(corners[1], corners[3], corners[2]);
        }
    }
    let row = if near_y > 0.0 { height - 1 } else { 0 };
    let column = if near_x > 0.0 { width - 1 } else { 0 };
    let along: Vec<[f32; 3]> = (0..width).map(|column| places.at(row, column)).collect();
    let across: Vec<[f32; 3]> = (0..height).map(|row| places.at(row, column)).collect();
    for (edge, share) in [(along, 1.0), (across, 0.75)] {
        side(&mut mesh, projection, &edge, lit(ground, SIDE * share));
    }
    mesh
}

/// The cut side below an edge of the surface.
fn side(mesh: &mut Mesh, projection: &Projection, edge: &[[f32; 3]], colour: Color32) {
    let floor = -projection.half[2];
    for pair in edge.windows(2) {
        let first = u32::try_from(mesh.vertices.len()).unwrap_or(0);
        for &[x, y, up] in pair {
            mesh.colored_vertex(projection.at([x, y, up]), colour);
            mesh.colored_vertex(projection.at([x, y, floor]), colour);
        }
        mesh.add_triangle(first, first + 1, first + 2);
        mesh.add_triangle(first + 1, first + 3, first + 2);
    }
}

/// A colour under so much light.
pub(crate) fn lit(colour: Color32, share: f32) -> Color32 {
    let [r, g, b, _] = colour.to_array();
    let [r, g, b] = [r, g, b].map(|c| to_byte(f64::from(c) * f64::from(share.clamp(0.0, 1.0))));
    Color32::from_rgb(r, g, b)
}

/// The points of a relief, mm from the block's middle as drawn.
struct Places<'a> {
    relief: &'a Relief3d,
    projection: &'a Projection,
    step: [f32; 2],
    light: [f32; 3],
}

impl<'a> Places<'a> {
    fn of(relief: &'a Relief3d, projection: &'a Projection) -> Self {
        let length = LIGHT.iter().map(|x| x * x).sum::<f32>().sqrt();
        let n = [relief.heights_um.width(), relief.heights_um.height()];
        // Points stand on the cells' middles; drawn, the outer ones stand on the block's edges.
        let spans = [0, 1].map(|axis| n[axis].saturating_sub(1).max(1) as f64);
        let size = relief.size_mm();
        Self {
            relief,
            projection,
            step: [0, 1].map(|axis| to_single(size[axis] / spans[axis])),
            light: LIGHT.map(|x| x / length),
        }
    }

    fn at(&self, row: usize, column: usize) -> [f32; 3] {
        let [u, w, _] = self.projection.half;
        let height_um = self.relief.heights_um.row(row)[column];
        [
            to_single(column as f64) * self.step[0] - u,
            to_single(row as f64) * self.step[1] - w,
            self.projection.up(height_um),
        ]
    }

    /// How much light a point gets, 0…1: the light stands still while the block turns.
    fn brightness(&self, row: usize, column: usize) -> f32 {
        let heights = &self.relief.heights_um;
        let (width, height) = (heights.width(), heights.height());
        let [left, right] = [column.saturating_sub(1), (column + 1).min(width - 1)];
        let [below, above] = [row.saturating_sub(1), (row + 1).min(height - 1)];
        let up = |row: usize, column: usize| self.projection.up(heights.row(row)[column]);
        let slope = |rise: f32, n: usize, step: f32| rise / (to_single(n.max(1) as f64) * step);
        let p = slope(up(row, right) - up(row, left), right - left, self.step[0]);
        let q = slope(
            up(above, column) - up(below, column),
            above - below,
            self.step[1],
        );
        let [p, q] = self.projection.turned([p, q]);
        let facing = self.light[2] - p * self.light[0] - q * self.light[1];
        let share = (facing / (1.0 + p * p + q * q).sqrt()).max(0.0);
        AMBIENT + (1.0 - AMBIENT) * share
    }
}
