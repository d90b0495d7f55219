//! Times from several processes: each runs the studies once more for their times alone, one process
//! after the other, so that minutes lie between two measurements of the same thing.
//!
//! Why processes, and why the smallest and the largest of their medians: where a process's memory
//! lies, how its threads fall on cores and what else the machine does in that minute stay the same
//! for all of its repeats, so that repeats agree with each other far better than with those of
//! another run. The medians of processes differ by all of that. The span of five holds the median
//! of their distribution with probability 1 − 2·2⁻⁵ = 94 %, whatever that distribution is; a
//! bootstrap of five values promises more than they hold. Of two reports whose processes are
//! exchangeable, spans fail to meet in 2·5!·5!/10! = 0.8 % of rows.

use std::sync::{Mutex, PoisonError};

use super::record::{Record, RowRecord};
use super::runner::{guarded, lock, n_at_a_time, side_by_side, unless};
use super::{Bench, Effort, Findings, ReportError, Study};
use selvedge_foundation::progress::{CancelFlag, Progress};

/// Processes that measure, the first among them: the fewer of a quick report say with 88 % what
/// five say with 94 %.
pub(crate) fn n_processes(effort: Effort) -> usize {
    effort.pick(4, 5)
}

/// Runs studies for their times alone: what a further process prints, as `report.json` is written.
///
/// # Errors
/// A study fails, or it was cancelled.
pub fn times_alone(
    studies: &[Study],
    (effort, seed): (Effort, u64),
    cancel: &CancelFlag,
) -> Result<String, ReportError> {
    let found: Mutex<Vec<Option<_>>> = Mutex::new(studies.iter().map(|_| None).collect());
    side_by_side(n_at_a_time(), studies, |nth, study| {
        let mut unheard = |_: f64, _: &str| {};
        let mut progress = Progress::new(&mut unheard, cancel.clone());
        let mut bench = Bench::new(effort, seed, &mut progress).again();
        let findings = guarded(study, &mut bench);
        let is_failed = findings.is_err();
        lock(&found)[nth] = Some(findings);
        unless(is_failed)
    });
    let found = found.into_inner().unwrap_or_else(PoisonError::into_inner);
    let mut record = Record::default();
    for (study, findings) in studies.iter().zip(found) {
        if let Some(findings) = findings {
            record.add(study.name, &findings?);
        }
    }
    record.to_json()
}

/// Joins the times of further processes to those of a study; says of how many rows a process had
/// none.
pub(crate) fn join(study: &str, findings: &mut Findings, others: &[Record]) -> usize {
    let others: Vec<Vec<_>> =
        (others.iter().map(|other| other.of_study(study).collect())).collect();
    let mut n_missing = 0;
    // Rows come in the same order, some of them left out where errors are not asked for.
    let mut next = vec![0; others.len()];
    for row in &mut findings.rows {
        let Some(cost) = row.cost else { continue };
        let same = |(rows, next): (&Vec<&RowRecord>, &mut usize)| {
            let at = *next + rows[*next..].iter().position(|known| known.is_of(row))?;
            *next = at + 1;
            let time = rows[at].time?;
            Some((time.cpu_s, time.wall_s, time.n_repeats))
        };
        let times: Vec<_> = others.iter().zip(&mut next).filter_map(same).collect();
        n_missing += usize::from(times.len() < others.len());
        row.cost = Some(cost.and(&times));
    }
    n_missing
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Timing;
    use crate::pareto::tests::row;

    fn found(cpu_s: f64) -> Findings {
        let mut untimed = row("b", 0.1, 1.0);
        untimed.cost = None;
        Findings {
            rows: vec![row("a", 0.1, cpu_s), untimed, row("c", 0.2, 2.0 * cpu_s)],
            ..Findings::default()
        }
    }

    fn record(findings: &Findings) -> Record {
        let mut record = Record::default();
        record.add("made-up", findings);
        record
    }

    #[test]
    fn times_of_all_processes_are_joined_row_by_row() {
        let others: Vec<Record> = [2.0, 5.0, 3.0, 4.0].map(|s| record(&found(s))).into();
        let mut findings = found(1.0);
        assert_eq!(join("made-up", &mut findings, &others), 0);
        let of = |nth: usize| -> Timing { findings.rows[nth].cost.unwrap() };
        assert_eq!((of(0).cpu_s, of(0).cpu_interval_s), (3.0, [1.0, 5.0]));
        assert_eq!((of(2).cpu_s, of(2).cpu_interval_s), (6.0, [2.0, 10.0]));
        assert_eq!((of(0).n_processes(), of(0).n_repeats), (5, 15));
        assert_eq!(findings.rows[1].cost, None);
    }

    #[test]
    fn a_process_that_has_other_rows_is_left_out_and_counted() {
        let mut other = found(2.0);
        other.rows[2].case = "d".to_owned();
        let mut findings = found(1.0);
        assert_eq!(join("made-up", &mut findings, &[record(&other)]), 1);
        assert_eq!(findings.rows[0].cost.unwrap().n_processes(), 2);
        assert_eq!(findings.rows[2].cost.unwrap().n_processes(), 1);
        assert_eq!(join("another", &mut findings, &[record(&other)]), 2);
    }
}
