//! The grid of a cloth: which vertices there are, how heavy they are, which are pinned.
//!
//! Vertex (i, j) lies at the material place `(i h_u, j h_w)`, i along the warp; its number is
//! `j n_u + i`.
//! At rest u runs along x to the right, w along y upwards, in the plane z = 0.

use nalgebra::Vector3;

use super::DrapeError;
use selvedge_foundation::files::Flaw;

/// A place, velocity or force.
pub(crate) type Vector = Vector3<f64>;

/// Most vertices along a side.
const MAX_SIDE: usize = 400;

/// The grid of a cloth.
#[derive(Debug, Clone)]
pub(crate) struct Mesh {
    /// Vertices along warp and weft.
    pub(crate) n: [usize; 2],
    /// Spacing along warp and weft, m.
    pub(crate) h: [f64; 2],
    /// Mass of every vertex, kg.
    pub(crate) mass_kg: Vec<f64>,
    pub(crate) is_pinned: Vec<bool>,
}

/// Which vertices are pinned.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum Pins {
    /// The whole upper edge.
    Top,
    /// Both its corners.
    Corners,
    /// All four edges, as in a frame.
    Frame,
    /// The first so many columns, those at u = 0.
    #[cfg(test)]
    Columns(usize),
    /// The columns at both ends of the warp.
    #[cfg(test)]
    Ends,
    None,
}

impl Pins {
    /// Those of the key `pins` in a scene.
    pub(crate) fn named(word: Option<&str>) -> Result<Self, Flaw> {
        match word {
            None | Some("top") => Ok(Self::Top),
            Some("corners") => Ok(Self::Corners),
            Some("frame") => Ok(Self::Frame),
            Some("none") => Ok(Self::None),
            Some(word) => {
                let mend = "give \"top\", \"corners\", \"frame\" or \"none\"";
                let what = format!("the pins are \"{word}\"");
                Err(Flaw::new(("", 0, "pins"), what, mend))
            }
        }
    }
}

impl Pins {
    fn hold(&self, [i, j]: [usize; 2], [n_u, n_w]: [usize; 2]) -> bool {
        let is_side = i == 0 || i + 1 == n_u;
        let is_top = j + 1 == n_w;
        match self {
            Self::Top => is_top,
            Self::Corners => is_top && is_side,
            Self::Frame => is_side || is_top || j == 0,
            #[cfg(test)]
            Self::Columns(columns) => i < *columns,
            #[cfg(test)]
            Self::Ends => is_side,
            Self::None => false,
        }
    }
}

impl Mesh {
    /// A grid of `n` vertices on a cloth of a size in m.
    ///
    /// # Errors
    /// Fewer than 2 or more than 400 vertices a side, a size outside 1 mm–10 m.
    pub(crate) fn new(
        n: [usize; 2],
        size_m: [f64; 2],
        density_kg_per_m2: f64,
        pins: &Pins,
    ) -> Result<Self, DrapeError> {
        for side in 0..2 {
            DrapeError::within(("size", 1e3 * size_m[side], "mm"), [1.0, 1e4])?;
            DrapeError::within(
                ("grid", n[side] as f64, "vertices a side"),
                [2.0, MAX_SIDE as f64],
            )?;
        }
        let h = [0, 1].map(|side| size_m[side] / (n[side] - 1) as f64);
        let places = || (0..n[1]).flat_map(|j| (0..n[0]).map(move |i| [i, j]));
        let share = |[i, j]: [usize; 2]| half_at_ends(i, n[0]) * half_at_ends(j, n[1]);
        let whole_kg = density_kg_per_m2 * h[0] * h[1];
        Ok(Self {
            n,
            h,
            mass_kg: places().map(|at| whole_kg * share(at)).collect(),
            is_pinned: places().map(|at| pins.hold(at, n)).collect(),
        })
    }

    pub(crate) fn n_vertices(&self) -> usize {
        self.n[0] * self.n[1]
    }

    /// Where its vertices are at rest, m.
    pub(crate) fn at_rest(&self) -> impl Iterator<Item = Vector> + '_ {
        (0..self.n_vertices()).map(|vertex| {
            let [i, j] = [vertex % self.n[0], vertex / self.n[0]];
            Vector::new(i as f64 * self.h[0], j as f64 * self.h[1], 0.0)
        })
    }

    /// Length along warp and weft, m.
    pub(crate) fn size_m(&self) -> [f64; 2] {
        [0, 1].map(|side| (self.n[side] - 1) as f64 * self.h[side])
    }

    /// From a vertex to its neighbour along an axis.
    pub(crate) fn stride(&self, axis: usize) -> usize {
        [1, self.n[0]][axis]
    }

    /// Rows and columns of whatever joins `reach + 1` vertices along an axis: from where each
    /// begins.
    pub(crate) fn spans(&self, axis: usize, reach: usize) -> [usize; 2] {
        let along = |side: usize| self.n[side].saturating_sub(if side == axis { reach } else { 0 });
        [along(1), along(0)]
    }

    /// The cell below a material place, and where in it, 0…1; `None` off the cloth.
    pub(crate) fn cell_at(&self, [u, w]: [f64; 2]) -> Option<(usize, [f64; 2])> {
        let scaled = [u / self.h[0], w / self.h[1]];
        let most = [0, 1].map(|side| (self.n[side] - 1) as f64);
        let is_on = (0..2).all(|side| scaled[side] >= 0.0 && scaled[side] <= most[side]);
        let cell = [0, 1].map(|side| scaled[side].floor().min(most[side] - 1.0));
        is_on.then(|| {
            let index = cell.map(selvedge_foundation::numerics::to_index);
            (
                index[1] * self.n[0] + index[0],
                [scaled[0] - cell[0], scaled[1] - cell[1]],
            )
        })
    }

    /// The corners of all cells, row by row.
    pub(crate) fn cells(&self) -> impl Iterator<Item = [usize; 4]> + '_ {
        let [n_u, n_w] = self.n;
        let rows = (0..n_w - 1).map(move |row| row * n_u);
        rows.flat_map(move |first| (first..first + n_u - 1).map(move |cell| self.corners(cell)))
    }

    /// The four corners of the cell that begins at a vertex.
    pub(crate) fn corners(&self, vertex: usize) -> [usize; 4] {
        [
            vertex,
            vertex + 1,
            vertex + self.n[0],
            vertex + self.n[0] + 1,
        ]
    }
}

#[inline]
pub(crate) fn half_at_ends(index: usize, n: usize) -> f64 {
    if index == 0 || index + 1 == n {
        0.5
    } else {
        1.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_mass_of_all_vertices_is_that_of_the_cloth() {
        let mesh = Mesh::new([5, 3], [0.4, 0.3], 0.2, &Pins::Top).unwrap();
        let total: f64 = mesh.mass_kg.iter().sum();
        assert!((total - 0.2 * 0.12).abs() < 1e-15);
        assert_eq!(mesh.is_pinned.iter().filter(|pinned| **pinned).count(), 5);
        assert_eq!(mesh.size_m(), [0.4, 0.3]);
    }

    #[test]
    fn places_have_a_cell_up_to_the_far_edge() {
        let mesh = Mesh::new([5, 3], [0.4, 0.2], 0.2, &Pins::None).unwrap();
        let (cell, at) = mesh.cell_at([0.4, 0.05]).unwrap();
        assert_eq!(mesh.corners(cell), [3, 4, 8, 9]);
        assert!((at[0] - 1.0).abs() < 1e-12 && (at[1] - 0.5).abs() < 1e-12);
        assert_eq!(mesh.cell_at([-1e-9, 0.0]), None);
        assert_eq!(mesh.cell_at([f64::NAN, 0.0]), None);
        assert!(Mesh::new([1, 3], [0.1; 2], 0.2, &Pins::None).is_err());
        assert!(Mesh::new([4, 3], [f64::NAN, 0.1], 0.2, &Pins::None).is_err());
    }
}
