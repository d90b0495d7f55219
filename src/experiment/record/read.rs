//! Rows back into records.

use std::path::Path;

use super::columns::{Column, Visit, column_names, columns, visit};
use super::values::Value;
use super::{Outcome, Record, SCHEMA_VERSION, TRIAL, blank};
use crate::ExperimentError;
use crate::design::Design;
use selvedge_foundation::files::{FileError, Table};

/// The records of a log.
///
/// # Errors
/// A cell does not hold what its column says, a stimulus is none of the design's, or the log was
/// written by a later version.
pub(crate) fn read_records(
    design: &Design,
    table: &Table,
    path: &Path,
) -> Result<Vec<Record>, ExperimentError> {
    let names = column_names(design, SCHEMA_VERSION);
    let with_cells = |name: &'_ String| Some((name.clone(), table.text(name)?));
    let columns: Vec<(String, Vec<&str>)> = names.iter().filter_map(with_cells).collect();
    let row = |nth: usize| {
        let row = Row {
            columns: &columns,
            nth,
            place: (path, table.line_of(nth)),
            design,
            version: SCHEMA_VERSION,
        };
        row.record()
    };
    let records: Result<Vec<Record>, FileError> = trials(table).map(row).collect();
    Ok(records?)
}

/// The rows that are trials: all, where nothing else was known.
pub(crate) fn trials(table: &Table) -> impl Iterator<Item = usize> {
    let kinds = table.text("kind");
    let is_trial = move |nth: &usize| kinds.as_ref().is_none_or(|kinds| kinds[*nth] == TRIAL);
    (0..table.n_rows()).filter(is_trial)
}

struct Row<'a> {
    columns: &'a [(String, Vec<&'a str>)],
    nth: usize,
    place: (&'a Path, usize),
    design: &'a Design,
    /// Of its columns.
    version: u32,
}

impl Row<'_> {
    fn record(mut self) -> Result<Record, FileError> {
        let (mut version, mut is_aborted) = (0_u32, false);
        let [mut study, mut experiment] = [const { String::new() }; 2];
        columns! { self;
            schema_version: Version, "" => &mut version;
            study: Text, "" => &mut study;
            experiment: Text, "" => &mut experiment;
            aborted: Flag, "" => &mut is_aborted;
        }
        if version > SCHEMA_VERSION {
            let what = format!("the log has version {version} of its columns");
            let mend = format!("this program knows up to {SCHEMA_VERSION}: use a later one");
            return Err(self.wrong(what, mend));
        }
        self.version = version;
        let design = self.design;
        for (column, found, expected) in [
            ("study", study, &design.study),
            ("experiment", experiment, &design.experiment),
        ] {
            if found != *expected {
                let what = format!("{column} is {found:?}, the design's is {expected:?}");
                return Err(self.wrong(what, "keep the logs of each experiment by themselves"));
            }
        }
        let mut record = blank(design);
        if is_aborted {
            record.outcome = Outcome::Aborted;
        }
        visit(&mut record, design, ("", 0), &mut self)?;
        if let Some(answer) = record.answer() {
            let verdict = design.composition.verdict(&record.trial.task, answer);
            record.is_correct =
                verdict.map_err(|error| self.wrong(error.to_string(), "restore the row"))?;
        }
        Ok(record)
    }

    fn wrong(&self, what: impl Into<String>, mend: impl Into<String>) -> FileError {
        FileError::content(self.place.0, self.place.1, what, mend)
    }
}

impl Visit for Row<'_> {
    type Error = FileError;

    fn column(&mut self, column: Column, value: &mut dyn Value) -> Result<(), FileError> {
        if !value.is_read() {
            return Ok(());
        }
        let name = &column.name;
        let found = self.columns.iter().find(|(known, _)| known == name);
        let cell = found.and_then(|(_, cells)| cells.get(self.nth)).copied();
        let Some(cell) = cell else {
            let what = format!("there is no column {name}");
            return Err(self.wrong(what, "restore the log's header"));
        };
        value.take(cell, self.design).map_err(|wrong| {
            let usual = || (format!("{cell:?}"), format!("give {}", column.expected()));
            let (what, mend) = wrong.unwrap_or_else(usual);
            self.wrong(format!("{name} is {what}"), mend)
        })
    }

    fn is_since(&self, version: u32) -> bool {
        self.version >= version
    }
}
