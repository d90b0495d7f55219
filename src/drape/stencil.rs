//! What joins neighbours on a grid, row by row: differences in, forces out.
//!
//! A law of the cloth is a function of a difference of places; what it answers is spread over the
//! same vertices by the transposed difference. Rows are slices of their own, so that nothing is
//! looked up by its index inside.

use super::mesh::{Mesh, Vector, half_at_ends};

impl Mesh {
    /// Two rows of every field that lie one above the other.
    fn two_rows<'a>(&self, field: &'a [Vector], row: usize) -> (&'a [Vector], &'a [Vector]) {
        let n = self.n[0];
        field[row * n..(row + 2) * n].split_at(n)
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
        let ([n, n_rows], mut items) = (self.n, items.into_iter());
        if axis == 0 {
            for row in 0..n_rows {
                let width = self.width_m(0, [row, 0]);
                let (x, out) = (&x[row * n..][..n], &mut out[row * n..][..n]);
                let mut before = Vector::zeros();
                for ((pair, out), item) in x.windows(2).zip(&mut *out).zip(&mut items) {
                    let pulled = force(item, pair[1] - pair[0], width);
                    *out += before - pulled;
                    before = pulled;
                }
                out[n - 1] += before;
            }
            return;
        }
        for row in 0..n_rows - 1 {
            let (low, high) = self.two_rows(x, row);
            let (out_low, out_high) = out[row * n..][..2 * n].split_at_mut(n);
            let ends = low.iter().zip(high).zip(out_low.iter_mut().zip(out_high));
            for (column, (((low, high), (out_low, out_high)), item)) in
                ends.zip(&mut items).enumerate()
            {
                let width = self.h[0] * half_at_ends(column, n);
                let pulled = force(item, high - low, width);
                *out_low -= pulled;
                *out_high += pulled;
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
            let (low, high) = self.two_rows(x, row);
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
        let [n, n_rows] = self.n;
        let mut place = 0;
        if axis == 0 {
            for row in 0..n_rows {
                let width = self.width_m(0, [row, 0]);
                let fields = fields.map(|field| &field[row * n..][..n]);
                let out = &mut out[row * n..][..n];
                for end in 2..n {
                    let bent = fields.map(|x| x[end - 2] - x[end - 1] * 2.0 + x[end]);
                    let pushed = force([place, row * n + end - 1], bent, width);
                    out[end - 2] += pushed;
                    out[end - 1] -= pushed * 2.0;
                    out[end] += pushed;
                    place += 1;
                }
            }
            return;
        }
        for row in 2..n_rows {
            let first = (row - 2) * n;
            let fields = fields.map(|field| {
                let (below, rest) = field[first..first + 3 * n].split_at(n);
                let (middle, above) = rest.split_at(n);
                [below, middle, above].map(|row| &row[..n])
            });
            let (below, rest) = out[first..first + 3 * n].split_at_mut(n);
            let (middle, above) = rest.split_at_mut(n);
            let (below, middle, above) = (&mut below[..n], &mut middle[..n], &mut above[..n]);
            for column in 0..n {
                let width = self.h[0] * half_at_ends(column, n);
                let bent = fields.map(|[a, b, c]| a[column] - b[column] * 2.0 + c[column]);
                let pushed = force([place, first + n + column], bent, width);
                below[column] += pushed;
                middle[column] -= pushed * 2.0;
                above[column] += pushed;
                place += 1;
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
            let fields = fields.map(|field| {
                let (low, high) = self.two_rows(field, row);
                [&low[..n], &high[..n]]
            });
            let (out_low, out_high) = out[row * n..][..2 * n].split_at_mut(n);
            let (out_low, out_high) = (&mut out_low[..n], &mut out_high[..n]);
            let across = |column: usize| fields.map(|[low, high]| low[column] - high[column]);
            let (mut left, mut before) = (across(0), Vector::zeros());
            for column in 1..n {
                let right = across(column);
                let pushed = force(std::array::from_fn(|field| left[field] - right[field]));
                out_low[column - 1] += pushed - before;
                out_high[column - 1] += before - pushed;
                (left, before) = (right, pushed);
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
