//! What is done to measured heights before a tester is drawn over them: a part is taken, spikes
//! are taken for missing, and what bends or leans slowly is taken off.

use std::ops::Range;

use super::HeightMap;
use selvedge_foundation::named;
use selvedge_foundation::numerics::{Grid, in_pieces, median, n_threads, quantile};
use serde::{Deserialize, Serialize};

/// What is to be done to measured heights, in this order.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Preparation {
    /// The part that is taken: from u, w to u, w, mm from the lower left corner.
    pub crop_mm: Option<[f64; 4]>,
    /// Heights so many robust spreads from those around them are taken for missing.
    pub despike: Option<f64>,
    /// What is taken off; `None`: the best plane, or nothing of what repeats.
    pub level: Option<Levelling>,
}

named! {
    /// What is taken off heights.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
    #[serde(rename_all = "lowercase")]
    pub enum Levelling {
        /// Nothing.
        None = "none",
        /// The plane that fits best.
        Plane = "plane",
        /// The polynomial of second order that fits best.
        Quadratic = "quadratic",
        /// The plane that fits best, then the median of every row.
        Rows = "rows",
    }
    /// The word that files use.
    pub fn word;
}

/// The share of deviations that the spread is read at, and how many standard deviations that is of
/// what is normal. High, so that on what is smooth the steepest places are none.
const SHARE: f64 = 0.9;
const SIGMAS: f64 = 1.645;
/// Points on either side of one whose median it is compared with.
const AROUND: usize = 2;
/// Powers of u and w of a polynomial of second order.
const POWERS: [[i32; 2]; 6] = [[0, 0], [1, 0], [2, 0], [0, 1], [1, 1], [0, 2]];
/// Deviations that the spread is taken of, about.
const MAX_DEVIATIONS: usize = 1 << 20;

/// The indices around one, as many on either side: fewer near an end, where one-sided medians would
/// take a slope for a spike, but not itself alone.
fn near(index: usize, n: usize) -> Range<usize> {
    let reach = AROUND.min(index).min(n - 1 - index).max(1);
    index.saturating_sub(reach)..(index + reach + 1).min(n)
}

/// Takes heights for missing that lie more than so many robust standard deviations from the median
/// of the 5 × 5 points around them: what nine of ten such deviations do not exceed, over 1.645, or
/// their mean where most are 0. How many they were.
pub(crate) fn despiked(heights: &Grid<f64>, spreads: f64) -> (Grid<f64>, usize) {
    let (width, height) = (heights.width(), heights.height());
    let mut off = heights.clone();
    let work = |around: &mut Vec<f64>, row: usize, values: &mut [f64]| {
        let rows = near(row, height);
        for (column, value) in values.iter_mut().enumerate() {
            let columns = near(column, width);
            around.clear();
            let near = rows
                .clone()
                .flat_map(|row| &heights.row(row)[columns.clone()]);
            around.extend(near.filter(|height| !height.is_nan()));
            *value = (*value - median(around)).abs();
        }
    };
    in_pieces(off.values_mut(), width, n_threads(), Vec::new, work);
    let every = (off.values().len() / MAX_DEVIATIONS).max(1);
    let known = off.values().iter().step_by(every).copied();
    let mut known: Vec<f64> = known.filter(|off| !off.is_nan()).collect();
    let mean = known.iter().sum::<f64>() / known.len().max(1) as f64;
    let robust = quantile(&mut known, SHARE) / SIGMAS;
    let spread = if robust > 0.0 { robust } else { mean };
    let (mut left, mut n) = (heights.clone(), 0);
    for (height, off) in left.values_mut().iter_mut().zip(off.values()) {
        if *off > spreads * spread {
            *height = f64::NAN;
            n += 1;
        }
    }
    (left, n)
}

impl HeightMap {
    /// The map with something taken off it that was fitted to what is there (least squares).
    #[must_use]
    pub(crate) fn levelled(&self, by: Levelling) -> Self {
        let order = match by {
            Levelling::None => return self.clone(),
            Levelling::Plane | Levelling::Rows => 1,
            Levelling::Quadratic => 2,
        };
        let mut heights = self.heights_um().clone();
        self.take_off_polynomial(&mut heights, order);
        if by == Levelling::Rows && heights.height() > 1 {
            for row in 0..heights.height() {
                let values = heights.row_mut(row);
                let mut present: Vec<f64> =
                    values.iter().copied().filter(|z| !z.is_nan()).collect();
                let middle = median(&mut present);
                for height in values {
                    *height -= middle;
                }
            }
        }
        self.with_heights(heights)
    }

    fn take_off_polynomial(&self, heights: &mut Grid<f64>, order: i32) {
        let n = [heights.width(), heights.height()];
        let half = n.map(|n| 0.5 * n as f64);
        let mut powers = POWERS.to_vec();
        // A single row has no second way.
        powers.retain(|[u, w]| u + w <= order && (n[1] > 1 || *w == 0));
        let n_terms = powers.len();
        // Places from −1 to 1, so that powers are of one size.
        let terms = |column: usize, row: usize| {
            let u = (column as f64 - half[0]) / half[0];
            let w = (row as f64 - half[1]) / half[1];
            let mut terms = [0.0; POWERS.len()];
            for (term, [of_u, of_w]) in terms.iter_mut().zip(&powers) {
                *term = u.powi(*of_u) * w.powi(*of_w);
            }
            terms
        };
        let mut matrix = vec![vec![0.0; n_terms]; n_terms];
        let mut right = vec![0.0; n_terms];
        let mean = self.mean_um();
        for row in 0..n[1] {
            for (column, height) in heights.row(row).iter().enumerate() {
                if height.is_nan() {
                    continue;
                }
                let terms = terms(column, row);
                for ((sums, side), a) in matrix.iter_mut().zip(&mut right).zip(terms) {
                    for (sum, b) in sums.iter_mut().zip(terms) {
                        *sum += a * b;
                    }
                    *side += a * (height - mean);
                }
            }
        }
        let fitted = solve(matrix, right).unwrap_or_else(|| vec![0.0; n_terms]);
        for row in 0..n[1] {
            for (column, height) in heights.row_mut(row).iter_mut().enumerate() {
                let pairs = terms(column, row).into_iter().zip(&fitted);
                *height -= mean + pairs.map(|(term, share)| term * share).sum::<f64>();
            }
        }
    }
}

/// Linear equations by elimination; `None` if they do not determine the answer.
fn solve(mut matrix: Vec<Vec<f64>>, mut right: Vec<f64>) -> Option<Vec<f64>> {
    let n = right.len();
    let scale = matrix
        .iter()
        .flatten()
        .fold(0.0_f64, |max, x| max.max(x.abs()));
    for pivot in 0..n {
        let best = (pivot..n).max_by(|&a, &b| {
            let [a, b] = [a, b].map(|row| matrix[row][pivot].abs());
            a.total_cmp(&b)
        })?;
        matrix.swap(pivot, best);
        right.swap(pivot, best);
        if matrix[pivot][pivot].abs() <= 1e-12 * scale {
            return None;
        }
        let (upper, lower) = matrix.split_at_mut(pivot + 1);
        let (known, rest) = right.split_at_mut(pivot + 1);
        for (row, side) in lower.iter_mut().zip(rest) {
            let factor = row[pivot] / upper[pivot][pivot];
            let pairs = row.iter_mut().zip(&upper[pivot]);
            pairs.for_each(|(value, above)| *value -= factor * above);
            *side -= factor * known[pivot];
        }
    }
    let mut answer = vec![0.0; n];
    for row in (0..n).rev() {
        let known: f64 = (row + 1..n).map(|c| matrix[row][c] * answer[c]).sum();
        answer[row] = (right[row] - known) / matrix[row][row];
    }
    Some(answer)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn map(of: impl Fn(f64, f64) -> f64) -> HeightMap {
        let grid = Grid::from_fn(60, 41, |column, row| of(column as f64, row as f64));
        HeightMap::new(grid, [0.1, 0.2]).unwrap()
    }

    fn largest(map: &HeightMap) -> f64 {
        let values = map.heights_um().values().iter();
        values.fold(0.0, |max, z| z.abs().max(max))
    }

    #[test]
    fn a_bowl_is_taken_off_by_the_second_order_and_not_by_a_plane() {
        let bowl = map(|u, w| 7.0 + 0.3 * u - w + 0.02 * u * u - 0.01 * u * w + 0.03 * w * w);
        let flat = bowl.levelled(Levelling::Quadratic);
        assert!(largest(&flat) < 1e-9, "{}", largest(&flat));
        let plane = bowl.levelled(Levelling::Plane);
        assert!(largest(&plane) > 5.0, "{}", largest(&plane));
        assert_eq!(bowl.levelled(Levelling::None), bowl);
    }

    #[test]
    fn rows_that_jump_are_brought_to_one_height() {
        let jumps = map(|u, w| (0.7 * u).sin() + 100.0 * (3.1 * w).sin());
        let level = jumps.levelled(Levelling::Rows);
        assert!(largest(&level) < 2.0, "{}", largest(&level));
        assert!(largest(&jumps.levelled(Levelling::Plane)) > 50.0, "jumps");
    }

    #[test]
    fn spikes_go_and_the_weave_stays() {
        let weave = |u: f64, w: f64| 20.0 * ((0.5 * u).sin() + (0.4 * w).cos());
        let mut grid = map(weave).heights_um().clone();
        let clean = despiked(&grid, 8.0);
        assert_eq!(clean.1, 0);
        grid.row_mut(7)[9] = 400.0;
        grid.row_mut(0)[0] = -300.0;
        grid.row_mut(40)[59] = f64::NAN;
        let (left, n) = despiked(&grid, 8.0);
        assert_eq!(n, 2);
        assert!(left.row(7)[9].is_nan() && left.row(0)[0].is_nan(), "gone");
        assert_eq!(left.row(7)[10], grid.row(7)[10]);
        let flat = despiked(&Grid::filled(9, 9, 1.0), 3.0);
        assert_eq!(flat.1, 0, "nothing stands out of nothing");
    }
}
