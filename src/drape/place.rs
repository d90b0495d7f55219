//! Where on the cloth something is: material places, and the one below a point of a pad.

use super::mesh::{Mesh, Vector};

/// A material place on the cloth, with the vertices and shares that it is made of.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Spot {
    /// Along warp and weft, m.
    pub(crate) place: [f64; 2],
    vertices: [usize; 4],
    weights: [f64; 4],
    /// Unit normal of the face as it was found.
    pub(crate) normal: Vector,
}

impl Spot {
    /// A material place; `None` off the cloth, or where the cloth has no area.
    pub(crate) fn new(mesh: &Mesh, x: &[Vector], place: [f64; 2]) -> Option<Self> {
        let (cell, [s, t]) = mesh.cell_at(place)?;
        let mut spot = Self {
            place,
            vertices: mesh.corners(cell),
            weights: [(1.0 - s) * (1.0 - t), s * (1.0 - t), (1.0 - s) * t, s * t],
            normal: Vector::z(),
        };
        let [x_u, x_w] = spot.tangents(mesh, x);
        spot.normal = x_u.cross(&x_w).try_normalize(1e-9)?;
        Some(spot)
    }

    /// What it makes of values at the vertices.
    #[inline]
    pub(crate) fn at(&self, x: &[Vector]) -> Vector {
        let [a, b, c, d] = self.vertices;
        let [wa, wb, wc, wd] = self.weights;
        x[a] * wa + x[b] * wb + x[c] * wc + x[d] * wd
    }

    /// Its vertices with their shares.
    pub(crate) fn shares(&self) -> impl Iterator<Item = (usize, f64)> {
        self.vertices.into_iter().zip(self.weights)
    }

    /// Spreads a force over the vertices.
    #[inline]
    pub(crate) fn add(&self, out: &mut [Vector], force: Vector) {
        for (vertex, weight) in self.shares() {
            out[vertex] += force * weight;
        }
    }

    /// `∂x/∂u` and `∂x/∂w`.
    fn tangents(&self, mesh: &Mesh, x: &[Vector]) -> [Vector; 2] {
        let [x00, x10, x01, x11] = self.vertices.map(|vertex| x[vertex]);
        let s = self.weights[1] + self.weights[3];
        let t = self.weights[2] + self.weights[3];
        [
            ((x10 - x00) * (1.0 - t) + (x11 - x01) * t) / mesh.h[0],
            ((x01 - x00) * (1.0 - s) + (x11 - x10) * s) / mesh.h[1],
        ]
    }

    /// The material displacement whose image is nearest to a displacement in space.
    pub(crate) fn material(&self, mesh: &Mesh, x: &[Vector], moved: Vector) -> Option<[f64; 2]> {
        let [u, w] = self.tangents(mesh, x);
        let (uu, uw, ww) = (u.norm_squared(), u.dot(&w), w.norm_squared());
        let determinant = uu * ww - uw * uw;
        let (along_u, along_w) = (u.dot(&moved), w.dot(&moved));
        (determinant > 1e-9).then(|| {
            [
                (ww * along_u - uw * along_w) / determinant,
                (uu * along_w - uw * along_u) / determinant,
            ]
        })
    }
}

/// Most steps of a search.
const MAX_STEPS: usize = 12;
/// Within this it is found, m.
const FOUND_M: f64 = 1e-9;

/// The place of the cloth that lies on the line through `at` along z; `from` is where one was last.
/// `None` where the line misses the cloth, or the cloth has turned away from it.
pub(crate) fn find(mesh: &Mesh, x: &[Vector], at: Vector, from: Option<[f64; 2]>) -> Option<Spot> {
    let size = mesh.size_m();
    let clamped = |place: [f64; 2]| [0, 1].map(|axis| place[axis].clamp(0.0, size[axis]));
    let start = from.unwrap_or([at.x, at.y]);
    if !(start[0].is_finite() && start[1].is_finite()) {
        return None;
    }
    let mut place = clamped(start);
    for _ in 0..MAX_STEPS {
        let spot = Spot::new(mesh, x, place)?;
        let off = at - spot.at(x);
        if off.x.hypot(off.y) < FOUND_M {
            return Some(spot);
        }
        let [u, w] = spot.tangents(mesh, x);
        let determinant = u.x * w.y - u.y * w.x;
        if determinant.is_nan() || determinant < 0.05 {
            return None;
        }
        let step = [
            (w.y * off.x - w.x * off.y) / determinant,
            (u.x * off.y - u.y * off.x) / determinant,
        ];
        place = clamped([place[0] + step[0], place[1] + step[1]]);
    }
    // At an edge the search stays where the cloth ends.
    let spot = Spot::new(mesh, x, place)?;
    let off = at - spot.at(x);
    (off.x.hypot(off.y) < 1e-3 * mesh.h[0]).then_some(spot)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::Pins;

    #[test]
    fn a_place_is_found_on_a_sheared_and_bent_cloth_and_not_beside_it() {
        let mesh = Mesh::new([11, 11], [0.1, 0.1], 0.2, &Pins::None).unwrap();
        let bent = |at: Vector| Vector::new(at.x + 0.2 * at.y, at.y, 0.03 * (20.0 * at.x).sin());
        let x: Vec<Vector> = mesh.at_rest().map(bent).collect();
        let at = Vector::new(0.06, 0.05, 1.0);
        let spot = find(&mesh, &x, at, None).unwrap();
        assert!((spot.place[0] - 0.05).abs() < 1e-9 && (spot.place[1] - 0.05).abs() < 1e-9);
        let from_afar = find(&mesh, &x, at, Some([0.0, 0.1])).unwrap();
        assert!((from_afar.place[0] - spot.place[0]).abs() < 1e-9);
        assert!(find(&mesh, &x, Vector::new(-0.01, 0.05, 0.0), None).is_none());
        let moved = spot
            .material(&mesh, &x, Vector::new(0.002, 0.01, 0.0))
            .unwrap();
        assert!(
            moved[0].abs() < 1e-12 && (moved[1] - 0.01).abs() < 1e-12,
            "{moved:?}"
        );
    }
}
