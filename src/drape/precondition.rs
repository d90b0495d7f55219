//! The preconditioner `line`: lines of yarn are solved as they pull, everything else by its
//! diagonal.
//!
//! In a frame (û, ŵ, n) of every vertex the û components are a tridiagonal system along each warp
//! line, the ŵ components one along each weft line, and n is diagonal. Positive definite, one pass
//! over the vertices, and hardly a worse one the stiffer the yarns are.

use super::mesh::{Mesh, Vector};

/// Factors of the lines, made anew at every Newton step.
#[derive(Debug, Clone)]
pub(crate) struct LinePreconditioner {
    n: [usize; 2],
    /// Whether lines are solved; else each vertex by its diagonal alone.
    pub(crate) is_coupled: bool,
    frames: Vec<[Vector; 3]>,
    /// Along û, ŵ, n; once factored, 1/D.
    diagonals: Vec<[f64; 3]>,
    /// Between a vertex and the next along its warp and weft line; once factored, L.
    couplings: Vec<[f64; 2]>,
    /// Nodes beside the cloth have a diagonal of their own; once factored its inverse.
    proxies: Vec<Vector>,
    scratch: Vec<[f64; 3]>,
}

impl LinePreconditioner {
    pub(crate) fn new(mesh: &Mesh, n_proxies: usize) -> Self {
        let n = mesh.n_vertices();
        Self {
            n: mesh.n,
            is_coupled: true,
            frames: vec![[Vector::x(), Vector::y(), Vector::z()]; n],
            diagonals: vec![[0.0; 3]; n],
            couplings: vec![[0.0; 2]; n],
            proxies: vec![Vector::zeros(); n_proxies],
            scratch: vec![[0.0; 3]; n],
        }
    }

    /// Begins anew: frames of where the cloth is, masses times μ on the diagonal.
    pub(crate) fn begin(&mut self, mesh: &Mesh, x: &[Vector], inertia: impl Fn(usize) -> f64) {
        for vertex in 0..self.frames.len() {
            self.frames[vertex] = frame(mesh, x, vertex);
            self.diagonals[vertex] = [inertia(vertex); 3];
            self.couplings[vertex] = [0.0; 2];
        }
        for (proxy, diagonal) in self.proxies.iter_mut().enumerate() {
            *diagonal = Vector::repeat(inertia(self.frames.len() + proxy));
        }
    }

    /// An edge along an axis: its stiffness along itself beyond that across.
    #[inline]
    pub(crate) fn add_edge(&mut self, axis: usize, ends: [usize; 2], [along, across]: [f64; 2]) {
        let whole = (along + across).max(0.0);
        for vertex in ends {
            let diagonal = &mut self.diagonals[vertex];
            *diagonal = diagonal.map(|entry| entry + across);
            diagonal[axis] += whole - across;
        }
        if self.is_coupled {
            self.couplings[ends[0]][axis] -= whole;
        }
    }

    /// Stiffness in all directions alike.
    #[inline]
    pub(crate) fn add_everywhere(&mut self, vertex: usize, stiffness: f64) {
        self.diagonals[vertex]
            .iter_mut()
            .for_each(|entry| *entry += stiffness);
    }

    #[inline]
    pub(crate) fn add_normal(&mut self, vertex: usize, stiffness: f64) {
        self.diagonals[vertex][2] += stiffness;
    }

    /// `k vvᵀ`, by its diagonal in the vertex' frame.
    #[inline]
    pub(crate) fn add_direction(&mut self, vertex: usize, v: Vector, stiffness: f64) {
        for (entry, axis) in self.diagonals[vertex].iter_mut().zip(&self.frames[vertex]) {
            *entry += stiffness * axis.dot(&v).powi(2);
        }
    }

    pub(crate) fn add_proxy(&mut self, proxy: usize, diagonal: Vector) {
        self.proxies[proxy] += diagonal;
    }

    /// Factors the lines. Pinned vertices do not move.
    pub(crate) fn factor(&mut self, is_pinned: &[bool]) {
        for vertex in 0..self.frames.len() {
            for axis in 0..2 {
                let next = vertex + [1, self.n[0]][axis];
                let is_held = is_pinned[vertex] || is_pinned.get(next).is_none_or(|pinned| *pinned);
                let coupling = &mut self.couplings[vertex][axis];
                if is_held || *coupling == 0.0 {
                    *coupling = 0.0;
                    continue;
                }
                let ratio = *coupling / self.diagonals[vertex][axis];
                self.diagonals[next][axis] -= ratio * *coupling;
                *coupling = ratio;
            }
            let pinned = is_pinned[vertex];
            let inverse = |entry: f64| {
                if pinned || entry <= 0.0 {
                    0.0
                } else {
                    entry.recip()
                }
            };
            let diagonal = &mut self.diagonals[vertex];
            // The next along the line has been told above.
            *diagonal = diagonal.map(inverse);
        }
        for diagonal in &mut self.proxies {
            *diagonal = diagonal.map(|entry| if entry > 0.0 { entry.recip() } else { 0.0 });
        }
    }

    /// `z = P⁻¹ r`.
    pub(crate) fn apply(&mut self, r: &[Vector], z: &mut [Vector]) {
        let n = self.frames.len();
        let [n_u, _] = self.n;
        for (vertex, (frame, r)) in self.frames.iter().zip(r).enumerate() {
            let mut turned = frame.map(|axis| axis.dot(r));
            if vertex > 0 {
                turned[0] -= self.couplings[vertex - 1][0] * self.scratch[vertex - 1][0];
            }
            if vertex >= n_u {
                turned[1] -= self.couplings[vertex - n_u][1] * self.scratch[vertex - n_u][1];
            }
            self.scratch[vertex] = turned;
        }
        for vertex in (0..n).rev() {
            let [d_u, d_w, d_n] = self.diagonals[vertex];
            let [u, w, normal] = self.scratch[vertex];
            let mut solved = [u * d_u, w * d_w, normal * d_n];
            if vertex + 1 < n {
                solved[0] -= self.couplings[vertex][0] * self.scratch[vertex + 1][0];
            }
            if vertex + n_u < n {
                solved[1] -= self.couplings[vertex][1] * self.scratch[vertex + n_u][1];
            }
            self.scratch[vertex] = solved;
            let frame = &self.frames[vertex];
            z[vertex] = frame[0] * solved[0] + frame[1] * solved[1] + frame[2] * solved[2];
        }
        for (proxy, inverse) in self.proxies.iter().enumerate() {
            z[n + proxy] = r[n + proxy].component_mul(inverse);
        }
    }
}

/// Unit vectors along warp, weft and across the cloth at a vertex; (x, y, z) where it has no area.
pub(crate) fn frame(mesh: &Mesh, x: &[Vector], vertex: usize) -> [Vector; 3] {
    let at = [vertex % mesh.n[0], vertex / mesh.n[0]];
    let along = |axis: usize| {
        let stride = mesh.stride(axis);
        let before = if at[axis] > 0 {
            vertex - stride
        } else {
            vertex
        };
        let after = if at[axis] + 1 < mesh.n[axis] {
            vertex + stride
        } else {
            vertex
        };
        (x[after] - x[before]).try_normalize(0.0)
    };
    let frame = along(0).zip(along(1)).and_then(|(u, w)| {
        let normal = u.cross(&w).try_normalize(1e-6)?;
        Some([u, w, normal])
    });
    frame.unwrap_or_else(|| [Vector::x(), Vector::y(), Vector::z()])
}
