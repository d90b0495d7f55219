//! What joins neighbours on a grid, row by row: differences in, forces out.
//!
//! A law of the cloth is a function of a difference of places; what it answers is spread over the
//! same vertices by the transposed difference. Rows are slices, so that nothing is looked up by its
//! index inside, and each law is called at one place only, so that the compiler puts it there.

use std::cell::Cell;

use super::mesh::{Mesh, Vector, half_at_ends};

/// Adds to a sum that lies in a cell.
#[inline]
fn add(sum: &Cell<Vector>, more: Vector) {
    sum.set(sum.get() + more);
}

impl Mesh {
    /// Widths of what joins `reach + 1` vertices along an axis, row by row: of which vertices it
    /// begins, and the width of the row's first, other and last ones, m.
    fn rows(
        &self,
        axis: usize,
        reach: usize,
    ) -> impl Iterator<Item = (std::ops::Range<usize>, [f64; 2])> + '_ {
        let [rows, columns] = self.spans(axis, reach);
        let whole = self.h[1 - axis];
        let rows = if columns == 0 { 0 } else { rows };
        (0..rows).map(move |row| {
            let own = whole * half_at_ends(row, self.n[1]);
            let widths = if axis == 0 {
                [own; 2]
            } else {
                [0.5 * whole, whole]
            };
            let first = row * self.n[0];
            (first..first + columns, widths)
        })
    }

    /// All that joins `reach + 1` vertices along an axis, row by row: its index, its first vertex,
    /// the width that it stands for, m: half at free edges.
    pub(crate) fn lines(
        &self,
        axis: usize,
        reach: usize,
    ) -> impl Iterator<Item = (usize, usize, f64)> + '_ {
        let rows = self.rows(axis, reach).enumerate();
        rows.flat_map(|(row, (vertices, [at_ends, inside]))| {
            let n = vertices.len();
            vertices.enumerate().map(move |(nth, vertex)| {
                let is_end = nth == 0 || nth + 1 == n;
                let width = if is_end { at_ends } else { inside };
                (row * n + nth, vertex, width)
            })
        })
    }

    /// Every edge along an axis: of its item, its span and the width that it stands for, m, the
    /// force on its end.
    #[inline]
    pub(crate) fn pull<T>(
        &self,
        axis: usize,
        (x, out): (&[Vector], &mut [Vector]),
        items: impl IntoIterator<Item = T>,
        mut force: impl FnMut(T, Vector, f64) -> Vector,
    ) {
        let (stride, mut items) = (self.stride(axis), items.into_iter());
        let out = Cell::from_mut(out).as_slice_of_cells();
        for (row, [at_ends, inside]) in self.rows(axis, 1) {
            let next = row.start + stride..row.end + stride;
            let last = row.len() - 1;
            let spans = x[row.clone()].iter().zip(&x[next.clone()]);
            let ends = out[row].iter().zip(&out[next]);
            for (nth, (((a, b), (from, to)), item)) in spans.zip(ends).zip(&mut items).enumerate() {
                let width = if nth == 0 || nth == last {
                    at_ends
                } else {
                    inside
                };
                let pulled = force(item, b - a, width);
                add(from, -pulled);
                add(to, pulled);
            }
        }
    }

    /// Every cell: of its item and its diagonals, from corner 00 to 11 and from 01 to 10, the force
    /// on the end of either.
    #[inline]
    pub(crate) fn shear<T>(
        &self,
        (x, out): (&[Vector], &mut [Vector]),
        items: impl IntoIterator<Item = T>,
        mut force: impl FnMut(T, [Vector; 2]) -> [Vector; 2],
    ) {
        let ([n, n_rows], mut items) = (self.n, items.into_iter());
        for row in 0..n_rows - 1 {
            let [low, high] = [row, row + 1].map(|row| &x[row * n..][..n]);
            let (out_low, out_high) = out[row * n..][..2 * n].split_at_mut(n);
            // What the cell before does to the vertices that it shares with the next.
            let mut before = [Vector::zeros(); 2];
            let corners = low.windows(2).zip(high.windows(2));
            let outs = out_low.iter_mut().zip(out_high.iter_mut());
            for (((low, high), (out_low, out_high)), item) in corners.zip(outs).zip(&mut items) {
                let [far, near] = force(item, [high[1] - low[0], low[1] - high[0]]);
                *out_low += before[1] - far;
                *out_high += before[0] - near;
                before = [far, near];
            }
            out_low[n - 1] += before[1];
            out_high[n - 1] += before[0];
        }
    }

    /// Every three vertices in a line along an axis: of the number of the line's place, its middle
    /// vertex, the second differences of some fields and the width that it stands for, m, the force
    /// on its ends; twice that pulls the middle back.
    #[inline]
    pub(crate) fn bend<const N: usize>(
        &self,
        axis: usize,
        (fields, out): ([&[Vector]; N], &mut [Vector]),
        mut force: impl FnMut([usize; 2], [Vector; N], f64) -> Vector,
    ) {
        let stride = self.stride(axis);
        let out = Cell::from_mut(out).as_slice_of_cells();
        let mut place = 0;
        for (row, [at_ends, inside]) in self.rows(axis, 2) {
            let n = row.len();
            let starts = [0, 1, 2].map(|nth| row.start + nth * stride);
            let fields = fields.map(|field| starts.map(|start| &field[start..][..n]));
            let [a, b, c] = starts.map(|start| &out[start..][..n]);
            // What is still to be added to the two vertices that lie ahead.
            let mut ahead = [Vector::zeros(); 2];
            for column in 0..n {
                let is_end = column == 0 || column + 1 == n;
                let width = if is_end { at_ends } else { inside };
                let mut bent = [Vector::zeros(); N];
                for (bent, [a, b, c]) in bent.iter_mut().zip(&fields) {
                    *bent = a[column] - b[column] * 2.0 + c[column];
                }
                let pushed = force([place, starts[1] + column], bent, width);
                place += 1;
                if axis == 0 {
                    add(&a[column], ahead[0] + pushed);
                    ahead = [ahead[1] - pushed * 2.0, pushed];
                    continue;
                }
                add(&a[column], pushed);
                add(&b[column], pushed * -2.0);
                add(&c[column], pushed);
            }
            if axis == 0 {
                add(&b[n - 1], ahead[0]);
                add(&c[n - 1], ahead[1]);
            }
        }
    }

    /// Every cell: of the twists `x₀₀ − x₁₀ − x₀₁ + x₁₁` of some fields the force on its corners 00
    /// and 11; the others are pulled back.
    #[inline]
    pub(crate) fn twist<const N: usize>(
        &self,
        (fields, out): ([&[Vector]; N], &mut [Vector]),
        mut force: impl FnMut([Vector; N]) -> Vector,
    ) {
        let [n, n_rows] = self.n;
        for row in 0..n_rows - 1 {
            let starts = [row * n, (row + 1) * n];
            let fields = fields.map(|field| starts.map(|start| &field[start..][..n]));
            let (out_low, out_high) = out[row * n..][..2 * n].split_at_mut(n);
            let mut left = fields.map(|[low, high]| low[0] - high[0]);
            let mut before = Vector::zeros();
            for column in 1..n {
                let mut twisted = [Vector::zeros(); N];
                for ((twisted, left), [low, high]) in twisted.iter_mut().zip(&mut left).zip(&fields)
                {
                    let right = low[column] - high[column];
                    *twisted = *left - right;
                    *left = right;
                }
                let pushed = force(twisted);
                out_low[column - 1] += pushed - before;
                out_high[column - 1] += before - pushed;
                before = pushed;
            }
            out_low[n - 1] -= before;
            out_high[n - 1] += before;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::Pins;

    /// What is spread is the transposed of what is read: the forces' work is the differences'.
    #[test]
    #[expect(clippy::too_many_lines, reason = "one check of four stencils")]
    fn forces_are_spread_as_differences_are_taken() {
        for n in [[2, 2], [2, 5], [7, 4]] {
            let mesh = Mesh::new(n, [0.06, 0.04], 0.2, &Pins::None).unwrap();
            let field = |phase: f64| -> Vec<Vector> {
                let at = |vertex: usize| vertex as f64 + phase;
                let vertices = 0..mesh.n_vertices();
                vertices
                    .map(|v| Vector::new(at(v).sin(), (2.0 * at(v)).cos(), at(v)))
                    .collect()
            };
            let (x, moved) = (field(0.0), field(0.7));
            let zeros = vec![Vector::zeros(); x.len()];
            let check = |spread: &dyn Fn(&[Vector], &mut [Vector]) -> f64, what: &str| {
                let (mut of_x, mut of_moved) = (zeros.clone(), zeros.clone());
                let own = spread(&x, &mut of_x);
                spread(&moved, &mut of_moved);
                let dot = |a: &[Vector], b: &[Vector]| crate::newton::dot(a, b);
                assert!(
                    (dot(&of_x, &x) - own).abs() < 1e-9 * own.max(1.0),
                    "{what} {n:?}"
                );
                let [there, back] = [dot(&of_x, &moved), dot(&of_moved, &x)];
                assert!(
                    (there - back).abs() < 1e-9 * there.abs().max(1.0),
                    "{what} {n:?}"
                );
            };
            for axis in 0..2 {
                let pull = |x: &[Vector], out: &mut [Vector]| {
                    let mut sum = 0.0;
                    mesh.pull(axis, (x, out), 1_u32.., |nth, span, width| {
                        let k = f64::from(nth) * width;
                        sum += k * span.norm_squared();
                        span * k
                    });
                    sum
                };
                check(&pull, "edges");
                let bend = |x: &[Vector], out: &mut [Vector]| {
                    let mut sum = 0.0;
                    mesh.bend(axis, ([x], out), |[place, middle], [bent], width| {
                        let k = (1 + place + middle) as f64 * width;
                        sum += k * bent.norm_squared();
                        bent * k
                    });
                    sum
                };
                check(&bend, "lines");
            }
            let shear = |x: &[Vector], out: &mut [Vector]| {
                let mut sum = 0.0;
                mesh.shear((x, out), 1_u32.., |nth, [a, b]| {
                    let k = f64::from(nth);
                    sum += k * a.norm_squared() + 2.0 * k * b.norm_squared();
                    [a * k, b * (2.0 * k)]
                });
                sum
            };
            check(&shear, "diagonals");
            let twist = |x: &[Vector], out: &mut [Vector]| {
                let mut sum = 0.0;
                mesh.twist(([x], out), |[twisted]| {
                    sum += twisted.norm_squared();
                    twisted
                });
                sum
            };
            check(&twist, "twists");
        }
    }
}
