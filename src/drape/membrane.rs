//! Stretch along the yarns and shear between them: energies, forces and tangents on the grid.
//!
//! Tangents are made with the forces and are never indefinite: an edge keeps
//! `(b/h)[T′ d̂d̂ᵀ + max(T, 0)/(1+ε) (I − d̂d̂ᵀ)]`, a cell the Gauss–Newton part of its shear.

use super::fabric::Tension;
use super::mesh::{Mesh, Vector};
use super::precondition::LinePreconditioner;
use super::sheet::{Energy, Lag};
use super::slip::{SlipElements, SlipLaw};

/// No shear angle is told of a cell that has folded onto a line.
const LEAST_SINE: f64 = 1e-3;

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
    pub(crate) fn new(axis: usize, tension: Tension, friction: f64, mesh: &Mesh) -> Self {
        let [rows, columns] = mesh.spans(axis, 1);
        let n = if friction > 0.0 { rows * columns } else { 0 };
        // As shear and bending, it is reached in a small part of the range.
        let reach = 0.05 * tension.max_strain.min(1.0);
        Self {
            axis,
            tension,
            loops: (SlipElements::new(n), SlipLaw::reached_in(friction, reach)),
            edges: vec![EdgeTangent::default(); rows * columns],
            largest_n_per_m: [tension.at_rest_n_per_m, 0.0],
            largest_strain: 0.0,
        }
    }

    pub(crate) fn evaluate(&mut self, mesh: &Mesh, x: &[Vector], grad: &mut [Vector]) -> Energy {
        let [rows, columns] = mesh.spans(self.axis, 1);
        let (stride, h) = (mesh.stride(self.axis), mesh.h[self.axis]);
        let mut energy = Energy::default();
        let mut largest = [0.0_f64; 3];
        for row in 0..rows {
            for column in 0..columns {
                let (edge, a) = (row * columns + column, row * mesh.n[0] + column);
                let b = a + stride;
                let width = mesh.width_m(self.axis, [row, column]);
                let span = x[b] - x[a];
                let length = span.norm();
                let strain = length / h - 1.0;
                let direction = if length > 0.0 {
                    span / length
                } else {
                    Vector::zeros()
                };
                let [stored, mut tension, mut tangent] = self.tension.at(strain);
                let (elements, law) = &self.loops;
                let slip = elements.at(edge, strain, *law);
                energy.stored += (stored + slip.stored) * h * width;
                energy.lost += slip.lost * h * width;
                tension += slip.force;
                tangent += slip.tangent;
                largest = [
                    largest[0].max(tangent),
                    largest[1].max(tension),
                    largest[2].max(strain),
                ];
                let force = direction * (tension * width);
                grad[a] -= force;
                grad[b] += force;
                let across = tension.max(0.0) * width / length.max(0.01 * h);
                self.edges[edge] = EdgeTangent {
                    direction,
                    along: tangent * width / h - across,
                    across,
                };
            }
        }
        self.largest_n_per_m = [largest[0], largest[1]];
        self.largest_strain = largest[2];
        energy
    }

    pub(crate) fn product(&self, mesh: &Mesh, p: &[Vector], out: &mut [Vector]) {
        let [rows, columns] = mesh.spans(self.axis, 1);
        let stride = mesh.stride(self.axis);
        for row in 0..rows {
            let edges = &self.edges[row * columns..(row + 1) * columns];
            for (column, edge) in edges.iter().enumerate() {
                let a = row * mesh.n[0] + column;
                let b = a + stride;
                let span = p[b] - p[a];
                let along = edge.along * edge.direction.dot(&span);
                let force = span * edge.across + edge.direction * along;
                out[a] -= force;
                out[b] += force;
            }
        }
    }

    pub(crate) fn precondition(&self, mesh: &Mesh, lines: &mut LinePreconditioner) {
        let stride = mesh.stride(self.axis);
        for (edge, (_, a, _)) in self.edges.iter().zip(mesh.lines(self.axis, 1)) {
            lines.add_edge(self.axis, [a, a + stride], [edge.along, edge.across]);
        }
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
        let mut energy = Energy::default();
        for row in 0..mesh.n[1] - 1 {
            for column in 0..mesh.n[0] - 1 {
                let (cell, first) = (row * (mesh.n[0] - 1) + column, row * mesh.n[0] + column);
                let corners = mesh.corners(first);
                let (angle, far, near) = angle_of(mesh, corners.map(|corner| x[corner]));
                let off = angle - lag.angles[cell];
                let slip = self.elements.at(cell, angle, self.laws[cell]);
                energy.stored += area * (0.5 * self.stiffness * angle * angle + slip.stored);
                energy.lost += area * (0.5 * damped * off * off + slip.lost);
                let stress = area * (self.stiffness * angle + damped * off + slip.force);
                spread(grad, corners, far * stress, near * stress);
                self.angles[cell] = angle;
                let stiffness = area * (self.stiffness + damped + slip.tangent);
                self.cells[cell] = CellTangent {
                    far,
                    near,
                    stiffness,
                };
            }
        }
        energy
    }

    pub(crate) fn product(&self, mesh: &Mesh, p: &[Vector], out: &mut [Vector]) {
        let columns = mesh.n[0] - 1;
        for row in 0..mesh.n[1] - 1 {
            let cells = &self.cells[row * columns..(row + 1) * columns];
            for (column, cell) in cells.iter().enumerate() {
                let corners = mesh.corners(row * mesh.n[0] + column);
                let [p00, p10, p01, p11] = corners.map(|corner| p[corner]);
                let turned = cell.far.dot(&(p11 - p00)) + cell.near.dot(&(p10 - p01));
                let stress = cell.stiffness * turned;
                spread(out, corners, cell.far * stress, cell.near * stress);
            }
        }
    }

    pub(crate) fn precondition(&self, mesh: &Mesh, lines: &mut LinePreconditioner) {
        let columns = mesh.n[0] - 1;
        for (index, cell) in self.cells.iter().enumerate() {
            let [c00, c10, c01, c11] = mesh.corners(index / columns * mesh.n[0] + index % columns);
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

#[inline]
fn spread(out: &mut [Vector], [c00, c10, c01, c11]: [usize; 4], far: Vector, near: Vector) {
    out[c11] += far;
    out[c00] -= far;
    out[c10] += near;
    out[c01] -= near;
}

/// Shear angle of a cell, and how it follows its corners 11 and 10.
#[inline]
pub(crate) fn angle_of(mesh: &Mesh, [x00, x10, x01, x11]: [Vector; 4]) -> (f64, Vector, Vector) {
    let (across, along) = (x11 - x00, x10 - x01);
    let x_u = (across + along) * (0.5 / mesh.h[0]);
    let x_w = (across - along) * (0.5 / mesh.h[1]);
    let [length_u, length_w] = [x_u.norm(), x_w.norm()];
    if length_u == 0.0 || length_w == 0.0 {
        return (0.0, Vector::zeros(), Vector::zeros());
    }
    let (u, w) = (x_u / length_u, x_w / length_w);
    let (cosine, sine) = (u.dot(&w), u.cross(&w).norm());
    let divisor = sine.max(LEAST_SINE);
    let by_u = (w - u * cosine) * (0.5 / (mesh.h[0] * length_u.max(LEAST_SINE) * divisor));
    let by_w = (u - w * cosine) * (0.5 / (mesh.h[1] * length_w.max(LEAST_SINE) * divisor));
    (cosine.atan2(sine), by_u + by_w, by_u - by_w)
}
