//! `report.json`: every row of a report with its error and its time, for programs and for the next
//! report, which says what changed since.

use std::path::Path;

use serde::{Deserialize, Serialize};

use super::{Findings, ReportError, Row};
use selvedge_foundation::files::{from_json_str, read_text, to_json_string};

/// What its file is called.
pub(crate) const NAME: &str = "report.json";

/// What a report came to.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct Record {
    /// The program that made it.
    pub(crate) program: String,
    /// When, UTC.
    pub(crate) date: String,
    /// `quick` or `full`: errors of one say nothing of the other's.
    pub(crate) effort: String,
    pub(crate) seed: u64,
    pub(crate) rows: Vec<RowRecord>,
}

/// One row.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct RowRecord {
    pub(crate) study: String,
    pub(crate) method: String,
    pub(crate) setting: String,
    pub(crate) case: String,
    pub(crate) error: Option<f64>,
    pub(crate) error_p99: Option<f64>,
    pub(crate) bytes: Option<u64>,
    pub(crate) is_kept: Option<bool>,
    pub(crate) time: Option<TimeRecord>,
}

/// How long it took, s a unit of work.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub(crate) struct TimeRecord {
    pub(crate) cpu_s: f64,
    pub(crate) cpu_low_s: f64,
    pub(crate) cpu_high_s: f64,
    pub(crate) wall_s: f64,
    pub(crate) n_repeats: usize,
    pub(crate) n_processes: usize,
}

impl Record {
    /// Reads one.
    ///
    /// # Errors
    /// There is none, or it is something else.
    pub(crate) fn read(path: &Path) -> Result<Self, ReportError> {
        Ok(from_json_str(&read_text(path)?, path)?)
    }

    /// Reads what a further process printed.
    pub(crate) fn parse(text: &str) -> Result<Self, ReportError> {
        Ok(from_json_str(text, Path::new(NAME))?)
    }

    pub(crate) fn to_json(&self) -> Result<String, ReportError> {
        Ok(to_json_string(self, Path::new(NAME))?)
    }

    /// Takes up the rows of a study.
    pub(crate) fn add(&mut self, study: &str, findings: &Findings) {
        let finite = |value: f64| value.is_finite().then_some(value);
        self.rows.extend(findings.rows.iter().map(|row| RowRecord {
            study: study.to_owned(),
            method: row.method.clone(),
            setting: row.setting.clone(),
            case: row.case.clone(),
            error: row.error.and_then(finite),
            error_p99: row.error_p99.and_then(finite),
            bytes: row.bytes,
            is_kept: row.is_kept(),
            time: row.cost.map(|cost| TimeRecord {
                cpu_s: cost.cpu_s,
                cpu_low_s: cost.cpu_interval_s[0],
                cpu_high_s: cost.cpu_interval_s[1],
                wall_s: cost.wall_s,
                n_repeats: cost.n_repeats,
                n_processes: cost.n_processes(),
            }),
        }));
    }

    /// The rows of a study, in their order.
    pub(crate) fn of_study(&self, study: &str) -> impl Iterator<Item = &RowRecord> {
        self.rows.iter().filter(move |row| row.study == study)
    }
}

impl RowRecord {
    /// What tells it from others.
    pub(crate) fn key(&self) -> [&str; 4] {
        [&self.study, &self.method, &self.setting, &self.case].map(String::as_str)
    }

    /// Whether it is of this row.
    pub(crate) fn is_of(&self, row: &Row) -> bool {
        self.method == row.method && self.setting == row.setting && self.case == row.case
    }
}
