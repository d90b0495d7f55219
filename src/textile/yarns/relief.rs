//! The upper surface of a textile on a grid: the highest yarn at every point of a window.

use super::path::{Node, YarnGeometry, YarnPath};
use super::variation::count;
use crate::surface::{HeightMap, SurfaceError};
use selvedge_foundation::numerics::{Grid, to_index};

/// Which way the columns of a window run.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Axis {
    /// Columns along the warp (u), rows along the weft (w).
    Warp,
    /// Columns along the weft (w), rows along the warp (u).
    Weft,
}

/// Where a textile is looked at: grid points `start + index · step`, columns along `axis`.
#[derive(Debug, Clone, Copy)]
pub(super) struct Window {
    pub axis: Axis,
    /// Column and row of point (0, 0), mm.
    pub start_mm: [f64; 2],
    /// Between columns and between rows, mm.
    pub step_mm: [f64; 2],
    /// Columns and rows.
    pub n: [usize; 2],
}

/// The upper surface within a window.
#[derive(Debug, Clone)]
pub(super) struct Relief {
    /// Heights, µm.
    pub height_um: Grid<f64>,
    /// Index of the yarn on top; `u32::MAX` where there is none.
    pub top: Grid<u32>,
}

/// How far beyond its ends a straight piece is drawn, in half widths: bends have no gaps then.
const OVERHANG: f64 = 0.3;
/// What rounding can add to a height, µm, by far.
const ROUNDING_UM: f64 = 1e-6;

/// Two neighbouring nodes in the coordinates of a window.
struct Piece<'a> {
    from: [f64; 2],
    along: [f64; 2],
    length_mm: f64,
    ends: [&'a Node; 2],
    path: &'a YarnPath,
    index: u32,
    /// No point of it is higher, µm.
    highest_um: f64,
}

impl Relief {
    /// The upper surface of `textile` within `window`.
    pub(super) fn of(geometry: &YarnGeometry, window: &Window) -> Self {
        let [columns, rows] = window.n;
        let mut relief = Self {
            height_um: Grid::filled(columns, rows, geometry.floor_um),
            top: Grid::filled(columns, rows, u32::MAX),
        };
        for (path, index) in geometry.paths.iter().zip(0_u32..) {
            for pair in path.nodes.windows(2) {
                let [a, b] = [&pair[0], &pair[1]];
                let reach = a.half_width_mm.max(b.half_width_mm) * (1.0 + OVERHANG);
                window.for_repeats(geometry.size_mm, [a, b], reach, |from, to| {
                    relief.draw(window, &Piece::new([from, to], [a, b], path, index));
                });
            }
        }
        relief
    }

    fn draw(&mut self, window: &Window, piece: &Piece<'_>) {
        let ([first_x, last_x], [first_y, last_y]) = window.cells(piece);
        for row in first_y..last_y {
            let y = window.start_mm[1] + row as f64 * window.step_mm[1] - piece.from[1];
            let heights = self.height_um.row_mut(row);
            let tops = self.top.row_mut(row);
            for column in first_x..last_x {
                let x = window.start_mm[0] + column as f64 * window.step_mm[0] - piece.from[0];
                if piece.highest_um <= heights[column] {
                    continue;
                }
                if let Some(height) = piece.height_above_um(heights[column], [x, y]) {
                    heights[column] = height;
                    tops[column] = piece.index;
                }
            }
        }
    }
}

/// The whole patch of a textile as a periodic height map, with points about `step_mm` apart.
///
/// # Errors
/// A step that no height map may have.
pub(crate) fn relief_map(geometry: &YarnGeometry, step_mm: f64) -> Result<HeightMap, SurfaceError> {
    let n = geometry
        .size_mm
        .map(|mm| count((mm / step_mm).round()).max(1));
    let step_mm = [0, 1].map(|axis| geometry.size_mm[axis] / n[axis] as f64);
    let window = Window {
        axis: Axis::Warp,
        start_mm: [0.0; 2],
        step_mm,
        n,
    };
    let relief = Relief::of(geometry, &window);
    Ok(HeightMap::new(relief.height_um, step_mm)?.periodic())
}

impl Window {
    /// Calls `draw` with both ends of a piece, in window coordinates, for every repeat of the
    /// textile in which it touches the window.
    fn for_repeats(
        &self,
        size_mm: [f64; 2],
        ends: [&Node; 2],
        reach: f64,
        mut draw: impl FnMut([f64; 2], [f64; 2]),
    ) {
        let own = |node: &Node| match self.axis {
            Axis::Warp => [node.u_mm, node.w_mm],
            Axis::Weft => [node.w_mm, node.u_mm],
        };
        let size = match self.axis {
            Axis::Warp => size_mm,
            Axis::Weft => [size_mm[1], size_mm[0]],
        };
        let (a, b) = (own(ends[0]), own(ends[1]));
        let repeats = |k: usize| {
            let (low, high) = (a[k].min(b[k]) - reach, a[k].max(b[k]) + reach);
            let end = self.start_mm[k] + self.n[k].saturating_sub(1) as f64 * self.step_mm[k];
            let first = ((self.start_mm[k] - high) / size[k]).ceil();
            let last = ((end - low) / size[k]).floor();
            (first, last)
        };
        let ((mut x, last_x), (first_y, last_y)) = (repeats(0), repeats(1));
        while x <= last_x {
            let mut y = first_y;
            while y <= last_y {
                let by = [x * size[0], y * size[1]];
                draw([a[0] + by[0], a[1] + by[1]], [b[0] + by[0], b[1] + by[1]]);
                y += 1.0;
            }
            x += 1.0;
        }
    }

    /// The half-open ranges of columns and rows that a piece can touch.
    fn cells(&self, piece: &Piece<'_>) -> ([usize; 2], [usize; 2]) {
        let half_width = piece.ends[0].half_width_mm.max(piece.ends[1].half_width_mm);
        let range = |k: usize| {
            let to = piece.from[k] + piece.along[k] * piece.length_mm;
            let run = OVERHANG * half_width * piece.along[k].abs();
            let side = half_width * piece.along[1 - k].abs();
            let reach = if piece.length_mm > 0.0 {
                run + side
            } else {
                half_width
            };
            let index = |x: f64| (x - self.start_mm[k]) / self.step_mm[k];
            let first = index(piece.from[k].min(to) - reach).ceil();
            let end = index(piece.from[k].max(to) + reach).floor() + 1.0;
            [first, end].map(|x| to_index(x).min(self.n[k]))
        };
        (range(0), range(1))
    }
}

impl<'a> Piece<'a> {
    fn new(places: [[f64; 2]; 2], ends: [&'a Node; 2], path: &'a YarnPath, index: u32) -> Self {
        let [from, to] = places;
        let (dx, dy) = (to[0] - from[0], to[1] - from[1]);
        let length_mm = dx.hypot(dy);
        let along = if length_mm > 1e-9 {
            [dx / length_mm, dy / length_mm]
        } else {
            [1.0, 0.0]
        };
        let length_mm = if length_mm > 1e-9 { length_mm } else { 0.0 };
        let [a, b] = ends;
        let highest_um = a.z_um.max(b.z_um) + a.half_thickness_um.max(b.half_thickness_um);
        Self {
            from,
            along,
            length_mm,
            ends,
            path,
            index,
            highest_um: highest_um + ROUNDING_UM,
        }
    }

    /// Height of the yarn at (x, y) from the start of the piece, µm; `None` beside it and where
    /// it is not above `above_um`.
    fn height_above_um(&self, above_um: f64, [x, y]: [f64; 2]) -> Option<f64> {
        let [a, b] = self.ends;
        let run = x * self.along[0] + y * self.along[1];
        let side = y * self.along[0] - x * self.along[1];
        let slack = OVERHANG * a.half_width_mm;
        let (share, off) = if self.length_mm > 0.0 {
            if run < -slack || run > self.length_mm + slack {
                return None;
            }
            ((run / self.length_mm).clamp(0.0, 1.0), side)
        } else {
            (0.0, x.hypot(y))
        };
        let mix = |from: f64, to: f64| from + (to - from) * share;
        let across = off / mix(a.half_width_mm, b.half_width_mm);
        if across.abs() >= 1.0 {
            return None;
        }
        let thickness = mix(a.half_thickness_um, b.half_thickness_um);
        let height = mix(a.z_um, b.z_um) + thickness * racetrack(across, self.path.flatness);
        if height <= above_um || self.path.ridge_um <= 0.0 {
            return (height > above_um).then_some(height);
        }
        // A ridge climbs over the yarn while it runs along: half a turn from flank to flank.
        let phase = mix(a.twist_rad, b.twist_rad) + 2.5 * across;
        let height = height - self.path.ridge_um * (0.5 - 0.5 * phase.cos());
        (height > above_um).then_some(height)
    }
}

/// Upper outline of a racetrack section, 1 in the flat middle, 0 at the edges ±1.
fn racetrack(across: f64, flatness: f64) -> f64 {
    let flank = ((across.abs() - flatness) / (1.0 - flatness)).max(0.0);
    (1.0 - flank * flank).max(0.0).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn node(u_mm: f64, w_mm: f64) -> Node {
        Node {
            u_mm,
            w_mm,
            z_um: 10.0,
            half_width_mm: 0.2,
            half_thickness_um: 100.0,
            twist_rad: 0.0,
        }
    }

    fn yarn_geometry(nodes: Vec<Node>) -> YarnGeometry {
        let path = YarnPath {
            nodes,
            flatness: 0.0,
            ridge_um: 0.0,
            colour: [1.0; 3],
        };
        YarnGeometry {
            size_mm: [2.0, 3.0],
            paths: vec![path],
            floor_um: -50.0,
        }
    }

    #[test]
    fn a_straight_yarn_shows_its_section_in_every_repeat() {
        let geometry = yarn_geometry(vec![node(0.0, 0.5), node(1.0, 0.5), node(2.0, 0.5)]);
        for axis in [Axis::Warp, Axis::Weft] {
            let window = Window {
                axis,
                start_mm: [0.0; 2],
                step_mm: [0.1; 2],
                n: [40, 40],
            };
            let relief = Relief::of(&geometry, &window);
            let at = |along: usize, across: usize| match axis {
                Axis::Warp => relief.height_um.row(across)[along],
                Axis::Weft => relief.height_um.row(along)[across],
            };
            for along in 0..40 {
                let section = 10.0 + 100.0 * 0.75_f64.sqrt();
                assert!((at(along, 5) - 110.0).abs() < 1e-9, "crown");
                assert!((at(along, 4) - section).abs() < 1e-9, "flank");
                assert!((at(along, 35) - 110.0).abs() < 1e-9, "the next repeat");
                assert_eq!(at(along, 10), -50.0, "beside it");
            }
        }
    }
}
