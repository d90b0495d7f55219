//! Symmetric positive definite systems over a grid, factored once: `L D Lᵀ` of few entries.
//!
//! Nodes are put in the order of nested dissection (George 1973): a grid is cut in two by a line of
//! nodes that comes last, and so on within. A factor of n nodes then has of the order of n log n
//! entries.

/// A factored matrix.
#[derive(Debug, Clone)]
pub struct GridFactor {
    /// The node at every place of the order.
    nodes: Vec<usize>,
    /// Where every column of L begins in `rows` and `values`.
    starts: Vec<usize>,
    rows: Vec<usize>,
    values: Vec<f64>,
    /// 1/D.
    inverse: Vec<f64>,
}

impl GridFactor {
    /// Factors the matrix that is the sum of `entries` (row, column, value; both halves) over a
    /// grid of `n` nodes along its axes, numbered row by row. Entries join nodes at most `reach`
    /// apart along an axis. `None` of a matrix that is not positive definite.
    pub fn new(
        n: [usize; 2],
        reach: usize,
        entries: impl IntoIterator<Item = (usize, usize, f64)>,
    ) -> Option<Self> {
        let mut nodes = Vec::with_capacity(n[0] * n[1]);
        dissect([[0, n[0]], [0, n[1]]], (n[0], reach.max(1)), &mut nodes);
        let mut place = vec![0; nodes.len()];
        for (at, node) in nodes.iter().enumerate() {
            place[*node] = at;
        }
        // Above the diagonal, by column.
        let mut columns: Vec<Vec<(usize, f64)>> = vec![Vec::new(); nodes.len()];
        for (a, b, value) in entries {
            if place[a] <= place[b] {
                columns[place[b]].push((place[a], value));
            }
        }
        let parents = elimination_tree(&columns);
        let mut factor = Self {
            inverse: vec![0.0; nodes.len()],
            starts: column_starts(&columns, &parents),
            rows: Vec::new(),
            values: Vec::new(),
            nodes,
        };
        let n_entries = factor.starts[factor.nodes.len()];
        factor.rows.resize(n_entries, 0);
        factor.values.resize(n_entries, 0.0);
        factor.eliminate(&columns, &parents).then_some(factor)
    }

    /// Row after row of L, each solved from those before; says whether all pivots are positive.
    fn eliminate(&mut self, columns: &[Vec<(usize, f64)>], parents: &[usize]) -> bool {
        let n = columns.len();
        let mut filled = self.starts.clone();
        let (mut sums, mut marks) = (vec![0.0; n], vec![usize::MAX; n]);
        let mut pattern = Vec::new();
        for row in 0..n {
            let mut pivot = 0.0;
            marks[row] = row;
            pattern.clear();
            for (start, value) in &columns[row] {
                if *start == row {
                    pivot += value;
                    continue;
                }
                sums[*start] += value;
                let mut at = *start;
                while marks[at] != row {
                    marks[at] = row;
                    pattern.push(at);
                    at = parents[at];
                }
            }
            pattern.sort_unstable();
            for &column in &pattern {
                let sum = std::mem::take(&mut sums[column]);
                let range = self.starts[column]..filled[column];
                for (below, value) in self.rows[range.clone()].iter().zip(&self.values[range]) {
                    sums[*below] -= value * sum;
                }
                let entry = sum * self.inverse[column];
                pivot -= entry * sum;
                self.rows[filled[column]] = row;
                self.values[filled[column]] = entry;
                filled[column] += 1;
            }
            if pivot.is_nan() || pivot <= 0.0 {
                return false;
            }
            self.inverse[row] = pivot.recip();
        }
        true
    }

    /// Entries of L below its diagonal.
    pub fn n_entries(&self) -> usize {
        self.values.len()
    }

    /// Solves for three right sides at once: `read` says them of a node, `write` is told the
    /// solution. `scratch` has a place for every node; nothing is allocated.
    pub fn solve(
        &self,
        read: impl Fn(usize) -> [f64; 3],
        scratch: &mut [[f64; 3]],
        mut write: impl FnMut(usize, [f64; 3]),
    ) {
        for (sum, node) in scratch.iter_mut().zip(&self.nodes) {
            *sum = read(*node);
        }
        let column = |at: usize| {
            let range = self.starts[at]..self.starts[at + 1];
            self.rows[range.clone()].iter().zip(&self.values[range])
        };
        for at in 0..self.nodes.len() {
            let own = scratch[at];
            for (row, value) in column(at) {
                let sum = &mut scratch[*row];
                (0..3).for_each(|side| sum[side] -= value * own[side]);
            }
        }
        for at in (0..self.nodes.len()).rev() {
            let mut own = scratch[at].map(|sum| sum * self.inverse[at]);
            for (row, value) in column(at) {
                let above = scratch[*row];
                (0..3).for_each(|side| own[side] -= value * above[side]);
            }
            scratch[at] = own;
            write(self.nodes[at], own);
        }
    }
}

/// Nodes of a rectangle in the order of nested dissection.
fn dissect([u, w]: [[usize; 2]; 2], (stride, reach): (usize, usize), nodes: &mut Vec<usize>) {
    let [wide, high] = [u, w].map(|[from, to]| to - from);
    if wide.max(high) <= 2 * reach + 1 {
        nodes.extend((w[0]..w[1]).flat_map(|j| (u[0]..u[1]).map(move |i| j * stride + i)));
        return;
    }
    let side = if wide >= high { u } else { w };
    let cut = side[0] + (side[1] - side[0] - reach) / 2;
    let parts = [[side[0], cut], [cut + reach, side[1]], [cut, cut + reach]];
    for (nth, part) in parts.into_iter().enumerate() {
        let rectangle = if wide >= high { [part, w] } else { [u, part] };
        if nth < 2 {
            dissect(rectangle, (stride, reach), nodes);
        } else {
            let [u, w] = rectangle;
            nodes.extend((w[0]..w[1]).flat_map(|j| (u[0]..u[1]).map(move |i| j * stride + i)));
        }
    }
}

/// The first row below a column's diagonal that its elimination fills (Liu 1990).
fn elimination_tree(columns: &[Vec<(usize, f64)>]) -> Vec<usize> {
    let none = usize::MAX;
    let (mut parents, mut ancestors) = (vec![none; columns.len()], vec![none; columns.len()]);
    for (row, column) in columns.iter().enumerate() {
        for (start, _) in column {
            let mut at = *start;
            while at != none && at < row {
                let next = std::mem::replace(&mut ancestors[at], row);
                if next == none {
                    parents[at] = row;
                }
                at = next;
            }
        }
    }
    parents
}

/// Where columns of L begin: a row has an entry in every column on the tree's way up to it.
fn column_starts(columns: &[Vec<(usize, f64)>], parents: &[usize]) -> Vec<usize> {
    let mut starts = vec![0; columns.len() + 1];
    let mut marks = vec![usize::MAX; columns.len()];
    for (row, column) in columns.iter().enumerate() {
        marks[row] = row;
        for (start, _) in column {
            let mut at = *start;
            while marks[at] != row {
                marks[at] = row;
                starts[at + 1] += 1;
                at = parents[at];
            }
        }
    }
    for at in 0..columns.len() {
        starts[at + 1] += starts[at];
    }
    starts
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Springs to the next and against bending along both axes, as a sheet has them.
    fn sheet([n_u, n_w]: [usize; 2], held: f64) -> Vec<(usize, usize, f64)> {
        let mut entries: Vec<_> = (0..n_u * n_w).map(|node| (node, node, held)).collect();
        let mut join = |stencil: &[(usize, f64)]| {
            for (a, of_a) in stencil {
                entries.extend(stencil.iter().map(|(b, of_b)| (*a, *b, of_a * of_b)));
            }
        };
        for j in 0..n_w {
            for i in 0..n_u {
                for (is_in, stride) in [(i + 2 < n_u, 1), (j + 2 < n_w, n_u)] {
                    let first = j * n_u + i;
                    if is_in {
                        join(&[(first, 1.0), (first + stride, -1.0)]);
                        join(&[
                            (first, 0.3),
                            (first + stride, -0.6),
                            (first + 2 * stride, 0.3),
                        ]);
                    }
                }
            }
        }
        entries
    }

    #[test]
    fn a_factored_system_is_solved_to_the_last_digits() {
        for n in [[1, 1], [2, 9], [13, 7], [26, 26]] {
            let entries = sheet(n, 0.01);
            let factor = GridFactor::new(n, 2, entries.clone()).unwrap();
            let side = |node: usize| [0.0, 1.0, 2.0].map(|of| (of + node as f64).sin());
            let zeros = vec![[0.0; 3]; n[0] * n[1]];
            let (mut scratch, mut x, mut left) = (zeros.clone(), zeros.clone(), zeros);
            factor.solve(side, &mut scratch, |node, solved| x[node] = solved);
            for (a, b, value) in &entries {
                (0..3).for_each(|of| left[*a][of] += value * x[*b][of]);
            }
            for (node, left) in left.iter().enumerate() {
                for (left, right) in left.iter().zip(side(node)) {
                    let residual = left - right;
                    assert!(residual.abs() < 1e-11, "{n:?} {node}: {residual}");
                }
            }
        }
    }

    #[test]
    fn dissection_leaves_few_entries_and_what_is_not_positive_has_no_factor() {
        let n = [51, 51];
        let factor = GridFactor::new(n, 2, sheet(n, 1.0)).unwrap();
        // A band 2·51 wide would have 265 000.
        assert!(factor.n_entries() < 160_000, "{}", factor.n_entries());
        assert!(GridFactor::new([3, 3], 2, sheet([3, 3], -1.0)).is_none());
        assert!(GridFactor::new([3, 3], 2, sheet([3, 3], f64::NAN)).is_none());
    }
}
