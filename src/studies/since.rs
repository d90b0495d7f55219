//! What changed since an earlier report: what became slower or faster beyond what both reports'
//! processes disagree by, what became less or more exact, what takes more memory or less, which
//! promises broke.
//!
//! Errors and bytes depend on seed and effort alone, so that any change is one; times are compared
//! by their intervals, which have to be apart. The quartiles of one process alone say less than the
//! span of several, and changes that rest on them say so.

use super::record::{Record, RowRecord};

/// Errors closer than this to each other, as a share, are the same: other machines round otherwise.
const SAME: f64 = 1e-6;

/// What is said of a time that one of the reports took in one process alone.
const ONE_PROCESS: &str = " (by quartiles of one process)";

/// The changes, one line a row, worst first; and what could not be compared.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct Since {
    /// When the earlier report was made, and by what.
    pub(crate) of: String,
    /// Promises that broke.
    pub(crate) broken: Vec<String>,
    /// Errors that grew.
    pub(crate) less_exact: Vec<String>,
    /// Errors that fell.
    pub(crate) more_exact: Vec<String>,
    /// Bytes that grew.
    pub(crate) larger: Vec<String>,
    /// Bytes that fell.
    pub(crate) smaller: Vec<String>,
    /// Times that grew.
    pub(crate) slower: Vec<String>,
    /// Times that fell.
    pub(crate) faster: Vec<String>,
    /// Rows that both have.
    pub(crate) n_compared: usize,
    /// Rows that both have a time of.
    pub(crate) n_timed: usize,
    /// Rows that one of them has alone.
    pub(crate) n_alone: usize,
}

impl Since {
    /// Compares a report with an earlier one.
    pub(crate) fn between(old: &Record, new: &Record) -> Self {
        let mut since = Self {
            of: format!(
                "{}, {}, {}, seed {}",
                old.date, old.program, old.effort, old.seed
            ),
            ..Self::default()
        };
        let are_errors_alike = old.effort == new.effort && old.seed == new.seed;
        let mut left: Vec<&RowRecord> = old.rows.iter().collect();
        let mut changes: Vec<(f64, String)> = Vec::new();
        for row in &new.rows {
            let Some(at) = left.iter().position(|before| before.key() == row.key()) else {
                since.n_alone += 1;
                continue;
            };
            let before = left.remove(at);
            since.n_compared += 1;
            let name = row.key().into_iter().filter(|part| !part.is_empty());
            let name = name.collect::<Vec<_>>().join(", ");
            if before.is_kept == Some(true) && row.is_kept == Some(false) {
                since.broken.push(name.clone());
            }
            if are_errors_alike {
                since.compare_numbers(before, row, &name);
            }
            let (Some(was), Some(is)) = (before.time, row.time) else {
                continue;
            };
            since.n_timed += 1;
            if is.cpu_low_s > was.cpu_high_s || is.cpu_high_s < was.cpu_low_s {
                let is_of_one = was.n_processes.min(is.n_processes) == 1;
                let how = if is_of_one { ONE_PROCESS } else { "" };
                changes.push((is.cpu_s / was.cpu_s, format!("{name}{how}")));
            }
        }
        since.n_alone += left.len();
        changes.sort_by(|a, b| b.0.total_cmp(&a.0));
        for (times, name) in changes {
            let words = format!("{name}: {times:.2} × the time");
            if times > 1.0 {
                since.slower.push(words);
            } else {
                since.faster.insert(0, words);
            }
        }
        since
    }

    /// Compares what the seed decides.
    fn compare_numbers(&mut self, before: &RowRecord, row: &RowRecord, name: &str) {
        let number = |x: f64| format!("{x:.3e}");
        let memory = |x: f64| super::readable::bytes(selvedge_foundation::numerics::to_whole(x));
        let bytes = |row: &RowRecord| row.bytes.map(|n| n as f64);
        let (is_more, is_less) = (
            |was: f64, is: f64| is > was * (1.0 + SAME),
            |was: f64, is: f64| is < was * (1.0 - SAME),
        );
        for (what, [was, is]) in [
            ("", [before.error, row.error]),
            (", 99th percentile", [before.error_p99, row.error_p99]),
        ] {
            let (Some(was), Some(is)) = (was, is) else {
                continue;
            };
            let words = format!("{name}{what}: {} → {}", number(was), number(is));
            if is_more(was, is) {
                self.less_exact.push(words);
            } else if is_less(was, is) {
                self.more_exact.push(words);
            }
        }
        if let (Some(was), Some(is)) = (bytes(before), bytes(row)) {
            let words = format!("{name}: {} → {}", memory(was), memory(is));
            if is_more(was, is) {
                self.larger.push(words);
            } else if is_less(was, is) {
                self.smaller.push(words);
            }
        }
    }

    /// As a part of the index.
    pub(crate) fn text(&self) -> String {
        let mut out = vec![format!("## Since {}\n", self.of)];
        let n_apart = self.slower.len() + self.faster.len();
        let share = 100.0 * (1.0 - n_apart as f64 / self.n_timed.max(1) as f64);
        out.push(format!(
            "{} rows compared, {} in one of the reports alone. A time counts as changed where the \
             intervals of both reports are apart: intervals of {share:.1} % overlap.\n",
            self.n_compared, self.n_alone
        ));
        for (what, lines) in [
            ("Promises that broke", &self.broken),
            ("Less exact", &self.less_exact),
            ("Slower", &self.slower),
            ("More memory", &self.larger),
            ("More exact", &self.more_exact),
            ("Faster", &self.faster),
            ("Less memory", &self.smaller),
        ] {
            if lines.is_empty() {
                out.push(format!("- {what}: none"));
                continue;
            }
            out.push(format!("- {what}: {}", lines.len()));
            out.extend(lines.iter().map(|line| format!("  - {line}")));
        }
        out.push(String::new());
        out.join("\n")
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::record::TimeRecord;

    fn row(case: &str, error: f64, is_kept: Option<bool>, cpu_s: [f64; 3]) -> RowRecord {
        RowRecord {
            study: "made-up".to_owned(),
            method: "m".to_owned(),
            setting: String::new(),
            case: case.to_owned(),
            error: Some(error),
            error_p99: Some(0.5 * error),
            bytes: Some(1000),
            is_kept,
            time: Some(TimeRecord {
                cpu_s: cpu_s[1],
                cpu_low_s: cpu_s[0],
                cpu_high_s: cpu_s[2],
                wall_s: cpu_s[1],
                n_repeats: 5,
                n_processes: 5,
            }),
        }
    }

    fn record(rows: Vec<RowRecord>) -> Record {
        Record {
            rows,
            effort: "quick".to_owned(),
            ..Record::default()
        }
    }

    #[test]
    fn changes_beyond_doubt_are_told_and_others_are_not() {
        let kept = Some(true);
        let old = record(vec![
            row("slower", 0.1, kept, [1.0, 1.1, 1.2]),
            row("in doubt", 0.1, kept, [1.0, 1.1, 1.2]),
            row("faster", 0.1, kept, [1.0, 1.1, 1.2]),
            row("worse", 0.1, kept, [1.0, 1.1, 1.2]),
            row("gone", 0.1, kept, [1.0, 1.1, 1.2]),
        ]);
        let new = record(vec![
            row("slower", 0.1, kept, [2.0, 2.2, 2.4]),
            row("in doubt", 0.1, kept, [1.15, 1.6, 2.0]),
            row("faster", 0.05, kept, [0.4, 0.55, 0.6]),
            row("worse", 0.3, Some(false), [1.0, 1.1, 1.2]),
            row("new", 0.1, kept, [1.0, 1.1, 1.2]),
        ]);
        let since = Since::between(&old, &new);
        assert_eq!(since.slower, ["made-up, m, slower: 2.00 × the time"]);
        assert_eq!(since.faster, ["made-up, m, faster: 0.50 × the time"]);
        let worse = [
            "made-up, m, worse: 1.000e-1 → 3.000e-1",
            "made-up, m, worse, 99th percentile: 5.000e-2 → 1.500e-1",
        ];
        assert_eq!(since.less_exact, worse);
        assert_eq!(since.more_exact.len(), 2);
        assert!(since.larger.is_empty() && since.smaller.is_empty());
        assert_eq!(since.broken, ["made-up, m, worse"]);
        assert_eq!((since.n_compared, since.n_alone), (4, 2));
        let text = since.text();
        assert!(
            text.contains("- Slower: 1\n  - made-up, m, slower")
                && text.contains("intervals of 50.0 % overlap"),
            "{text}"
        );
        // Memory, and times of one process.
        let mut alone = new.clone();
        alone.rows[0].bytes = Some(2_000_000);
        alone.rows[0].time = new.rows[0].time.map(|time| TimeRecord {
            n_processes: 1,
            ..time
        });
        let told = Since::between(&old, &alone);
        assert_eq!(told.larger, ["made-up, m, slower: 1.0 kB → 2.00 MB"]);
        let words = "made-up, m, slower (by quartiles of one process): 2.00 × the time";
        assert_eq!(told.slower, [words]);
        assert!(
            told.text().contains("- More memory: 1\n"),
            "{}",
            told.text()
        );
        // Errors of another seed are no change.
        let other = Record { seed: 2, ..new };
        assert!(Since::between(&old, &other).less_exact.is_empty());
    }
}
