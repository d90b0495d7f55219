//! The Pareto front: what no other row on the same case beats in both error and cost.
//!
//! A row that breaks its promise is not on it, however cheap: it answers another question.

use super::Row;

/// For every row whether it is on the front of its case; `None` where error or cost is not known.
pub fn pareto(rows: &[Row]) -> Vec<Option<bool>> {
    let known: Vec<Option<(f64, f64)>> = rows.iter().map(error_and_cost).collect();
    let is_beaten = |index: usize, (error, cost_s): (f64, f64)| {
        rows.iter()
            .zip(&known)
            .enumerate()
            .any(|(other, (row, at))| {
                let is_rival = other != index && row.is_kept() != Some(false);
                let is_same = row.case == rows[index].case && row.size == rows[index].size;
                let beats =
                    at.is_some_and(|(e, c)| e <= error && c <= cost_s && (e < error || c < cost_s));
                is_rival && is_same && beats
            })
    };
    let judge = |(index, at): (usize, &Option<(f64, f64)>)| {
        let at = (*at)?;
        Some(rows[index].is_kept() != Some(false) && !is_beaten(index, at))
    };
    known.iter().enumerate().map(judge).collect()
}

/// The error and the cost in CPU seconds of a row that has both, as numbers.
pub(super) fn error_and_cost(row: &Row) -> Option<(f64, f64)> {
    let (error, cost_s) = (row.error?, row.cost?.cpu_s);
    (error.is_finite() && cost_s.is_finite()).then_some((error, cost_s))
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use crate::Timing;

    /// A row of a case with an error and a cost.
    pub(crate) fn row(case: &str, error: f64, cpu_s: f64) -> Row {
        Row {
            case: case.to_owned(),
            error: Some(error),
            cost: Some(Timing {
                cpu_s,
                cpu_quartiles_s: [cpu_s; 2],
                wall_s: cpu_s,
                n_repeats: 3,
            }),
            ..Row::default()
        }
    }

    #[test]
    fn the_front_is_what_nothing_on_the_same_case_beats() {
        let rows = [
            row("a", 0.1, 1.0),
            row("a", 0.2, 2.0),
            row("a", 0.01, 3.0),
            row("a", 0.01, 4.0),
            row("b", 0.5, 9.0),
            row("b", f64::NAN, 1.0),
            Row::default(),
        ];
        let expected = [true, false, true, false, true].map(Some);
        assert_eq!(pareto(&rows)[..5], expected);
        assert_eq!(pareto(&rows)[5..], [None, None]);
    }

    #[test]
    fn equals_are_both_on_the_front() {
        let rows = [row("a", 0.1, 1.0), row("a", 0.1, 1.0)];
        assert_eq!(pareto(&rows), [Some(true); 2]);
    }

    #[test]
    fn a_broken_promise_is_not_on_the_front_and_beats_nobody() {
        let mut wrong = row("a", 3.0, 0.1);
        wrong.promised = Some(0.05);
        let mut lying = row("a", 0.06, 0.2);
        lying.promised = Some(0.05);
        let rows = [wrong, lying, row("a", 0.07, 0.3)];
        assert_eq!(pareto(&rows), [Some(false), Some(false), Some(true)]);
    }
}
