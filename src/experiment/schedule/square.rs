//! Orders by squares: every set stands at every place of a block as often, over subjects.

use std::ops::Range;

/// Rows of a square of 0…n−1, which begins anew after its last row.
///
/// A Latin square shifts one order. In Williams' each follows every other as often (Williams 1949):
/// 0, 1, n−1, 2, n−2 … shifted, and for odd n the same backwards in as many rows again.
pub(crate) fn square_rounds(n: usize, rows: Range<usize>, is_williams: bool) -> Vec<Vec<usize>> {
    let row = |nth: usize| -> Vec<usize> {
        let shift = nth % n.max(1);
        let is_turned = is_williams && n % 2 == 1 && (nth / n) % 2 == 1;
        let at = |place: usize| match (is_williams, place % 2) {
            (false, _) => place,
            (true, 1) => place.div_ceil(2),
            (true, _) => (n - place / 2) % n,
        };
        let mut row: Vec<usize> = (0..n).map(|place| (at(place) + shift) % n).collect();
        if is_turned {
            row.reverse();
        }
        row
    };
    rows.map(row).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_one_stands_everywhere_and_follows_every_other_as_often() {
        for n in 2..9 {
            let n_rows = if n % 2 == 0 { n } else { 2 * n };
            let rows = square_rounds(n, 0..n_rows, true);
            let mut at = vec![vec![0; n]; n];
            let mut after = vec![vec![0; n]; n];
            for row in &rows {
                for (place, &one) in row.iter().enumerate() {
                    at[one][place] += 1;
                }
                for pair in row.windows(2) {
                    after[pair[0]][pair[1]] += 1;
                }
            }
            assert!(
                at.iter().flatten().all(|&times| times == n_rows / n),
                "{rows:?}"
            );
            for (one, followers) in after.iter().enumerate() {
                for (other, &times) in followers.iter().enumerate() {
                    let expected = if one == other { 0 } else { n_rows / n };
                    assert_eq!(times, expected, "{other} after {one} of {n}");
                }
            }
        }
    }

    #[test]
    fn a_latin_square_begins_anew_after_its_last_row() {
        assert_eq!(square_rounds(3, 2..4, false), [[2, 0, 1], [0, 1, 2]]);
        assert_eq!(square_rounds(0, 0..1, false), [[0_usize; 0]]);
    }
}
