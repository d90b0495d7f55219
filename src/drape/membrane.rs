//! Stretch along the yarns and shear between them: energies, forces and tangents on the grid.
//!
//! Tangents are made with the forces and are never indefinite: an edge keeps
//! `(b/h)[T′ d̂d̂ᵀ + max(T, 0)/(1+ε) (I − d̂d̂ᵀ)]`, a cell the Gauss–Newton part of its shear.

use super::fabric::{Tension, polynomial};
use super::mesh::{Mesh, Vector};
use super::precondition::LinePreconditioner;
use super::sheet::{Energy, Lag};
use super::slip::{SlipElements, SlipLaw};

/// The least squares of the sine between yarns, and of their stretch, by which a shear angle is
/// followed: a cell that has folded onto a line has none.
const LEAST_SINE2: f64 = 1e-6;

/// Stretch of the yarns along one axis.
#[derive(Debug, Clone)]
pub(crate) struct Stretch {
    axis: usize,
    pub(crate) tension: Tension,
    loops: (SlipElements, SlipLaw),
    edges: Vec<EdgeTangent>,
    /// The largest tangent and tension of the last evaluation, N/m.
    pub(crate) largest_n_per_m: [f64; 2],
    pub(crate) largest_strain: f64,
}

#[derive(Debug, Clone, Copy, Default)]
struct EdgeTangent {
    direction: Vector,
    along: f64,
    across: f64,
}

impl Stretch {
    pub(crate) fn new(axis: usize, tension: &Tension, friction: f64, mesh: &Mesh) -> Self {
        let [rows, columns] = mesh.spans(axis, 1);
        let n = if friction > 0.0 { rows * columns } else { 0 };
        // As shear and bending, it is reached in a small part of the range.
        let reach = 0.05 * tension.max_strain.min(1.0);
        Self {
            axis,
            tension: *tension,
            loops: (SlipElements::new(n), SlipLaw::reached_in(friction, reach)),
            edges: vec![EdgeTangent::default(); rows * columns],
            largest_n_per_m: [tension.at_rest_n_per_m, 0.0],
            largest_strain: 0.0,
        }
    }

    pub(crate) fn evaluate(&mut self, mesh: &Mesh, x: &[Vector], grad: &mut [Vector]) -> Energy {
        let h = mesh.h[self.axis];
        let (per_h, per_shortest) = (h.recip(), (0.01 * h).recip());
        let mut energy = Energy::default();
        let mut largest = [0.0_f64; 3];
        let (tension, (elements, law)) = (&self.tension, &self.loops);
        let has_loops = !elements.is_empty();
        let edges = self.edges.iter_mut().enumerate();
        mesh.pull(self.axis, (x, grad), edges, |(nth, edge), span, width| {
            let length = span.norm();
            let per_length = if length > 0.0 { length.recip() } else { 0.0 };
            let strain = length * per_h - 1.0;
            let direction = span * per_length;
            let [stored, mut tension, mut tangent] = tension.at(strain);
            energy.stored += stored * width;
            if has_loops {
                let slip = elements.at(nth, strain, *law);
                energy.stored += slip.stored * width;
                energy.lost += slip.lost * width;
                tension += slip.force;
                tangent += slip.tangent;
            }
            for (largest, seen) in largest.iter_mut().zip([tangent, tension, strain]) {
                *largest = if seen > *largest { seen } else { *largest };
            }
            let across = tension.max(0.0) * width * per_length.min(per_shortest);
            *edge = EdgeTangent {
                direction,
                along: tangent * width * per_h - across,
                across,
            };
            direction * (tension * width)
        });
        self.largest_n_per_m = [largest[0], largest[1]];
        self.largest_strain = largest[2];
        Energy {
            stored: energy.stored * h,
            lost: energy.lost * h,
        }
    }

    pub(crate) fn product(&self, mesh: &Mesh, p: &[Vector], out: &mut [Vector]) {
        mesh.pull(self.axis, (p, out), &self.edges, |edge, span, _| {
            span * edge.across + edge.direction * (edge.along * edge.direction.dot(&span))
        });
    }

    pub(crate) fn precondition(&self, mesh: &Mesh, lines: &mut LinePreconditioner) {
        let stride = mesh.stride(self.axis);
        for (edge, (_, a, _)) in self.edges.iter().zip(mesh.lines(self.axis, 1)) {
            lines.add_edge(self.axis, [a, a + stride], [edge.along, edge.across]);
        }
    }

    /// The largest tangent of what was measured, with that of its friction, N/m.
    pub(crate) fn stiffest_n_per_m(&self) -> f64 {
        let [_, _, tangent] = self.tension.at(self.tension.max_strain.min(1.0));
        let slip = if self.loops.0.is_empty() {
            0.0
        } else {
            self.loops.1.stiffness
        };
        tangent.max(self.tension.at_rest_n_per_m) + slip
    }

    /// Ends a step: what has slipped stays.
    pub(crate) fn settle(&mut self, mesh: &Mesh, x: &[Vector]) {
        if self.loops.0.is_empty() {
            return;
        }
        let stride = mesh.stride(self.axis);
        let (elements, law) = &mut self.loops;
        for (edge, a, _) in mesh.lines(self.axis, 1) {
            let strain = (x[a + stride] - x[a]).norm() / mesh.h[self.axis] - 1.0;
            elements.settle(edge, strain, *law);
        }
    }
}

/// Shear of every cell.
#[derive(Debug, Clone)]
pub(crate) struct Shear {
    stiffness: f64,
    viscosity_s: f64,
    /// Full widths 2HG, 2HG5.
    loops_n_per_m: [f64; 2],
    elements: SlipElements,
    cells: Vec<CellTangent>,
    /// Angles of the last evaluation, rad.
    pub(crate) angles: Vec<f64>,
    /// Friction of every cell as it was at the start of the step.
    laws: Vec<SlipLaw>,
}

/// `∂γ/∂x` of the corners 11 and 10; 00 and 01 have the opposite.
#[derive(Debug, Clone, Copy, Default)]
struct CellTangent {
    far: Vector,
    near: Vector,
    stiffness: f64,
}

impl Shear {
    pub(crate) fn new(stiffness: f64, loops: [f64; 2], viscosity_s: f64, mesh: &Mesh) -> Self {
        let [rows, columns] = [mesh.n[1] - 1, mesh.n[0] - 1];
        let n = rows * columns;
        let n_loops = if loops[0] > 0.0 { n } else { 0 };
        let mut shear = Self {
            stiffness,
            viscosity_s,
            loops_n_per_m: loops,
            elements: SlipElements::new(n_loops),
            cells: vec![CellTangent::default(); n],
            angles: vec![0.0; n],
            laws: vec![SlipLaw::default(); n],
        };
        shear.begin();
        shear
    }

    /// Begins a step: friction is that of the angles now.
    pub(crate) fn begin(&mut self) {
        if self.elements.is_empty() {
            return;
        }
        let [narrow, wide] = self.loops_n_per_m;
        for (law, angle) in self.laws.iter_mut().zip(&self.angles) {
            let share = ((angle.to_degrees().abs() - 0.5) / 4.5).clamp(0.0, 1.0);
            let friction = 0.5 * (narrow + (wide - narrow) * share);
            *law = SlipLaw::reached_in(friction, 0.25_f64.to_radians());
        }
    }

    pub(crate) fn evaluate(
        &mut self,
        mesh: &Mesh,
        (x, lag): (&[Vector], &Lag),
        grad: &mut [Vector],
    ) -> Energy {
        let area = mesh.h[0] * mesh.h[1];
        let damped = lag.sigma * self.viscosity_s * self.stiffness;
        let (stiffness, elements, laws) = (self.stiffness, &self.elements, &self.laws);
        let mut energy = Energy::default();
        let cells = self.cells.iter_mut().zip(&mut self.angles);
        let cells = cells.zip(&lag.angles).enumerate();
        let (halves, has_loops) = (mesh.h.map(|h| 0.5 / h), !elements.is_empty());
        mesh.shear(
            (x, grad),
            cells,
            |(nth, ((cell, kept), before)), diagonals| {
                let (angle, far, near) = angle_of(halves, diagonals);
                let off = angle - before;
                energy.stored += 0.5 * stiffness * angle * angle;
                energy.lost += 0.5 * damped * off * off;
                let (mut stress, mut tangent) = (stiffness * angle + damped * off, 0.0);
                if has_loops {
                    let slip = elements.at(nth, angle, laws[nth]);
                    energy.stored += slip.stored;
                    energy.lost += slip.lost;
                    stress += slip.force;
                    tangent = slip.tangent;
                }
                *kept = angle;
                *cell = CellTangent {
                    far,
                    near,
                    stiffness: area * (stiffness + damped + tangent),
                };
                [far * (area * stress), near * (area * stress)]
            },
        );
        Energy {
            stored: energy.stored * area,
            lost: energy.lost * area,
        }
    }

    pub(crate) fn product(&self, mesh: &Mesh, p: &[Vector], out: &mut [Vector]) {
        mesh.shear((p, out), &self.cells, |cell, [across, along]| {
            let stress = cell.stiffness * (cell.far.dot(&across) + cell.near.dot(&along));
            [cell.far * stress, cell.near * stress]
        });
    }

    pub(crate) fn precondition(&self, mesh: &Mesh, lines: &mut LinePreconditioner) {
        for (cell, [c00, c10, c01, c11]) in self.cells.iter().zip(mesh.cells()) {
            for (corners, part) in [([c00, c11], cell.far), ([c10, c01], cell.near)] {
                for corner in corners {
                    lines.add_direction(corner, part, cell.stiffness);
                }
            }
        }
    }

    pub(crate) fn settle(&mut self) {
        if self.elements.is_empty() {
            return;
        }
        for (cell, angle) in self.angles.iter().enumerate() {
            self.elements.settle(cell, *angle, self.laws[cell]);
        }
    }

    /// The stiffness that a small motion meets, and its damped part, N/m.
    pub(crate) fn stiffest_n_per_m(&self) -> [f64; 2] {
        let slip = self.laws.iter().map(|law| law.stiffness);
        let slip = if self.elements.is_empty() {
            0.0
        } else {
            slip.fold(0.0, f64::max)
        };
        [self.stiffness + slip, self.stiffness * self.viscosity_s]
    }
}

/// Shear angle of a cell of these diagonals, from corner 00 to 11 and from 01 to 10, and how it
/// follows either; `halves` are `½/h`.
///
/// `γ = atan2(x_u·x_w, |x_u×x_w|)`, `∂γ/∂x_u = (x_w − x_u (x_u·x_w)/|x_u|²)/|x_u×x_w|`.
#[inline]
pub(crate) fn angle_of(halves: [f64; 2], [across, along]: [Vector; 2]) -> (f64, Vector, Vector) {
    let x_u = (across + along) * halves[0];
    let x_w = (across - along) * halves[1];
    let (uu, ww, uw) = (x_u.norm_squared(), x_w.norm_squared(), x_u.dot(&x_w));
    if uu == 0.0 || ww == 0.0 {
        return (0.0, Vector::zeros(), Vector::zeros());
    }
    let (long_u, long_w) = (uu.max(LEAST_SINE2), ww.max(LEAST_SINE2));
    let (area, least) = (x_u.cross(&x_w).norm(), LEAST_SINE2 * long_u * long_w);
    let (per_area, angle) = if area * area > least {
        let per_area = area.recip();
        (per_area, arctangent(uw * per_area))
    } else {
        (least.sqrt().recip(), uw.atan2(area))
    };
    let by_u = (x_w - x_u * (uw / long_u)) * (halves[0] * per_area);
    let by_w = (x_u - x_w * (uw / long_w)) * (halves[1] * per_area);
    (angle, by_u + by_w, by_u - by_w)
}

/// `atan t`: by a polynomial up to 19°, which nearly every cell keeps to. Chebyshev's fit of
/// `atan(√z)/√z` on 0…0.35², within 4e-17.
#[inline]
fn arctangent(t: f64) -> f64 {
    if t.abs() > 0.35 {
        return t.atan();
    }
    let even = [
        0.999_999_999_999_999_96,
        0.199_999_999_982_153_54,
        0.111_111_010_792_220_87,
        0.076_864_502_003_012_26,
        0.053_750_002_646_261_04,
    ];
    let odd = [
        -0.333_333_333_333_267_27,
        -0.142_857_140_982_418_5,
        -0.090_905_994_294_621_3,
        -0.065_973_141_948_035_92,
        -0.030_947_179_211_511_3,
    ];
    t * polynomial([even, odd], t * t)
}

#[cfg(test)]
mod tests {
    use super::arctangent;

    #[test]
    fn the_polynomial_is_the_arctangent() {
        for step in -500..=500 {
            let t = 1e-3 * f64::from(step);
            let off = arctangent(t) - t.atan();
            assert!(off.abs() <= 2.0 * f64::EPSILON * t.abs(), "{t}: {off}");
        }
    }
}
