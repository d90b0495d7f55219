//! The Pareto front: what no other row on the same case beats in both error and cost.
//!
//! A row that breaks its promise is not on it, however cheap: it answers another question. Where
//! times do not tell which of two rows is cheaper, the front is open there.

use super::Row;

/// Where a row stands.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Front {
    /// Nothing beats it.
    On,
    /// A more exact row may be as cheap: times do not tell.
    Open,
    /// Another row is surely cheaper and no less exact, or its promise is broken.
    Beaten,
}

impl Front {
    /// As tables spell it.
    pub(crate) fn word(self) -> &'static str {
        match self {
            Self::On => "true",
            Self::Open => "open",
            Self::Beaten => "false",
        }
    }
}

/// For every row where it stands on its case; `None` where error or cost is not known.
pub fn pareto(rows: &[Row]) -> Vec<Option<Front>> {
    let judge = |(index, row): (usize, &Row)| {
        let (error, _) = error_and_cost(row)?;
        if row.is_kept() == Some(false) {
            return Some(Front::Beaten);
        }
        let rivals = rows.iter().enumerate().filter(|(other, rival)| {
            let is_same = rival.case == row.case && rival.size == row.size;
            *other != index && is_same && rival.is_kept() != Some(false)
        });
        let mut front = Front::On;
        for (_, rival) in rivals {
            let Some((other_error, _)) = error_and_cost(rival).filter(|at| at.0 <= error) else {
                continue;
            };
            match rival.cost?.is_cheaper_than(row.cost.as_ref()?) {
                Some(true) => return Some(Front::Beaten),
                None if other_error < error => front = Front::Open,
                Some(false) | None => {}
            }
        }
        Some(front)
    };
    rows.iter().enumerate().map(judge).collect()
}

/// The error and the cost in CPU seconds of a row that has both, as numbers.
pub(super) fn error_and_cost(row: &Row) -> Option<(f64, f64)> {
    let (error, cost_s) = (row.error?, row.cost?.cpu_s);
    (error.is_finite() && cost_s.is_finite()).then_some((error, cost_s))
}

#[cfg(test)]
pub(crate) mod tests {
    use super::Front::{Beaten, On, Open};
    use super::*;
    use crate::Timing;

    /// A row of a case with an error and a cost.
    pub(crate) fn row(case: &str, error: f64, cpu_s: f64) -> Row {
        Row {
            case: case.to_owned(),
            error: Some(error),
            cost: Some(Timing::of(&mut [cpu_s; 3], &mut [cpu_s; 3])),
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
        let expected = [On, Beaten, On, Beaten, On].map(Some);
        assert_eq!(pareto(&rows)[..5], expected);
        assert_eq!(pareto(&rows)[5..], [None, None]);
    }

    #[test]
    fn equals_are_both_on_the_front() {
        let rows = [row("a", 0.1, 1.0), row("a", 0.1, 1.0)];
        assert_eq!(pareto(&rows), [Some(On); 2]);
    }

    #[test]
    fn a_broken_promise_is_not_on_the_front_and_beats_nobody() {
        let mut wrong = row("a", 3.0, 0.1);
        wrong.promised = Some(0.05);
        let mut lying = row("a", 0.06, 0.2);
        lying.promised = Some(0.05);
        let rows = [wrong, lying, row("a", 0.07, 0.3)];
        assert_eq!(pareto(&rows), [Beaten, Beaten, On].map(Some));
    }

    #[test]
    fn the_front_is_open_where_times_do_not_tell() {
        let unsteady = |error: f64, cpu_s: [f64; 3]| Row {
            cost: Some(Timing::of(&mut cpu_s.clone(), &mut [1.0])),
            ..row("a", error, 1.0)
        };
        let rows = [
            unsteady(0.2, [1.0, 2.0, 3.0]),
            unsteady(0.1, [1.5, 2.5, 3.5]),
            unsteady(0.3, [9.0, 9.0, 9.0]),
        ];
        assert_eq!(pareto(&rows), [Open, On, Beaten].map(Some));
    }
}
