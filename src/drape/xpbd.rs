//! Position-based dynamics with compliance (XPBD), one pass a step: for pictures, and to compare.
//!
//! A pass answers as a stiffness `K/(1 + K dt²/ρh²)` would, so a cloth of stiff yarns looks right
//! and pulls far too little: no finger feels it, and how much softer it is is said.

use super::cloth::Cloth;
use super::membrane::angle_of;
use super::mesh::Vector;
use super::sheet::Sheet;

impl Sheet {
    /// By how much yarns seem softer in one pass of a step: `1 + K dt²/ρh²` of the stiffer ones.
    pub(crate) fn softening(&self, step_s: f64) -> f64 {
        let h = self.mesh.h[0].min(self.mesh.h[1]);
        let [warp, weft] = self
            .stretch
            .each_ref()
            .map(|one| one.tension.at_rest_n_per_m);
        1.0 + warp.max(weft) * step_s * step_s / (self.fabric.density_kg_per_m2 * h * h)
    }
}

/// How readily every vertex moves: 1/kg, 0 where it is pinned, and the step's inverse square, 1/s².
struct Moves {
    per_kg: Vec<f64>,
    per_s2: f64,
}

impl Moves {
    /// Moves vertices along the gradient of a constraint of this value and compliance.
    fn solve<const N: usize>(
        &self,
        x: &mut [Vector],
        gradient: [(usize, Vector); N],
        (value, compliance): (f64, f64),
    ) {
        let mut divisor = compliance * self.per_s2;
        for (vertex, along) in &gradient {
            divisor += self.per_kg[*vertex] * along.norm_squared();
        }
        if divisor > 0.0 {
            let multiplier = value / divisor;
            for (vertex, along) in &gradient {
                x[*vertex] -= along * (self.per_kg[*vertex] * multiplier);
            }
        }
    }
}

impl Cloth {
    /// One step: free motion, then every constraint once. Fingers are led, and touch nothing.
    pub(crate) fn pass_constraints(&mut self) {
        let step_s = self.stepping.step_s;
        self.remember();
        let Self { system, x, v, .. } = self;
        let mesh = &system.sheet.mesh;
        for node in 0..x.len() {
            let is_pinned = mesh.is_pinned.get(node).copied();
            match is_pinned {
                Some(true) => v[node] = Vector::zeros(),
                Some(false) => v[node] += self.gravity * step_s,
                None => {
                    v[node] = (system.fingers[node - mesh.n_vertices()].target - x[node]) / step_s;
                }
            }
            x[node] += v[node] * step_s;
        }
        let moves = Moves {
            per_kg: std::mem::take(&mut self.per_kg),
            per_s2: (step_s * step_s).recip(),
        };
        pull(&system.sheet, &moves, x);
        shear(&system.sheet, &moves, x);
        bend(&system.sheet, &moves, x);
        self.per_kg = moves.per_kg;
        for (node, x) in x.iter().enumerate() {
            v[node] = (x - self.past[0].x[node]) / step_s;
        }
    }
}

/// Edges: `C = ℓ − h`, compliance `h/(K b)`.
fn pull(sheet: &Sheet, moves: &Moves, x: &mut [Vector]) {
    let mesh = &sheet.mesh;
    for axis in 0..2 {
        let (stride, h) = (mesh.stride(axis), mesh.h[axis]);
        let whole = h / sheet.stretch[axis].tension.at_rest_n_per_m;
        for (_, a, width) in mesh.lines(axis, 1) {
            let b = a + stride;
            let span = x[b] - x[a];
            let length = span.norm();
            if length > 0.0 {
                let along = span * length.recip();
                moves.solve(x, [(a, -along), (b, along)], (length - h, whole / width));
            }
        }
    }
}

/// Cells: `C = γ`, compliance `1/(G h²)`.
fn shear(sheet: &Sheet, moves: &Moves, x: &mut [Vector]) {
    let mesh = &sheet.mesh;
    if sheet.fabric.shear_n_per_m <= 0.0 {
        return;
    }
    let halves = mesh.h.map(|h| 0.5 / h);
    let compliance = 1.0 / (sheet.fabric.shear_n_per_m * mesh.h[0] * mesh.h[1]);
    for [c00, c10, c01, c11] in mesh.cells() {
        let (angle, far, near) = angle_of(halves, [x[c11] - x[c00], x[c10] - x[c01]]);
        let gradient = [(c11, far), (c00, -far), (c10, near), (c01, -near)];
        moves.solve(x, gradient, (angle, compliance));
    }
}

/// Bends: `C = |x₋ − 2x₀ + x₊|`, compliance `h³/(B b)`.
fn bend(sheet: &Sheet, moves: &Moves, x: &mut [Vector]) {
    let mesh = &sheet.mesh;
    for axis in 0..2 {
        let (stride, rigidity) = (mesh.stride(axis), sheet.fabric.bending_n_m[axis]);
        if rigidity <= 0.0 {
            continue;
        }
        let whole = mesh.h[axis].powi(3) / rigidity;
        for (_, a, width) in mesh.lines(axis, 2) {
            let (b, c) = (a + stride, a + 2 * stride);
            let bent = x[a] - x[b] * 2.0 + x[c];
            let size = bent.norm();
            if size > 0.0 {
                let along = bent * size.recip();
                let gradient = [(a, along), (b, along * -2.0), (c, along)];
                moves.solve(x, gradient, (size, whole / width));
            }
        }
    }
}
