//! Rows that are no trials: when the log was opened and by what device, and its closing.

use std::path::Path;

use super::columns::column_names;
use super::{SCHEMA_VERSION, Subject};
use crate::design::Design;
use crate::named::{Named as _, named};
use selvedge_foundation::files::{FileError, Table};

named! { "kind",
    /// What a row marks.
    pub(crate) enum MarkKind {
        /// The log was opened.
        Opening = "opening",
        /// Every trial was answered.
        Closing = "closing",
    }
}

/// A row that is no trial.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Mark {
    /// What it marks.
    pub(crate) kind: MarkKind,
    /// When, UTC as RFC 3339.
    pub(crate) utc: String,
    /// The device.
    pub(crate) device: String,
    /// What else is to be known of it.
    pub(crate) note: String,
    /// Trials before it, as it says.
    pub(crate) rows: usize,
}

/// A mark as it stands in a log.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct MarkInLog {
    /// What it says.
    pub(crate) mark: Mark,
    /// Trials that really stand before it.
    pub(crate) n_trials_before: usize,
    /// Its line.
    pub(crate) line: usize,
}

impl std::ops::Deref for MarkInLog {
    type Target = Mark;

    fn deref(&self) -> &Mark {
        &self.mark
    }
}

impl Mark {
    /// The cells of its row, in the order of the columns.
    pub(crate) fn cells(&self, design: &Design, subject: &Subject) -> Vec<String> {
        let cell = |name: String| match name.as_str() {
            "schema_version" => SCHEMA_VERSION.to_string(),
            "kind" => self.kind.name().to_owned(),
            "study" => design.study.clone(),
            "experiment" => design.experiment.clone(),
            "subject" => subject.pseudonym.clone(),
            "session" => subject.session.to_string(),
            "t_start_utc" => self.utc.clone(),
            "device" => self.device.clone(),
            "seed" => design.seed.to_string(),
            "software" => selvedge_foundation::PROGRAM.to_owned(),
            "note" => self.note.clone(),
            "rows" => self.rows.to_string(),
            _ => String::new(),
        };
        let names = column_names(design, SCHEMA_VERSION).into_iter();
        names.map(cell).collect()
    }
}

/// The marks of a log in order; none in a log of the first version.
///
/// # Errors
/// A row is neither trial nor mark, or a mark does not say how many rows were before it.
pub(crate) fn read_marks(table: &Table, path: &Path) -> Result<Vec<MarkInLog>, FileError> {
    let Some(kinds) = table.text("kind") else {
        return Ok(Vec::new());
    };
    let mut marks = Vec::new();
    let mut n_trials_before = 0;
    for (nth, kind) in kinds.into_iter().enumerate() {
        if kind == super::TRIAL {
            n_trials_before += 1;
            continue;
        }
        let wrong =
            |what: String, mend: &str| FileError::content(path, table.line_of(nth), what, mend);
        let known = MarkKind::named()
            .into_iter()
            .find(|(name, _)| *name == kind);
        let (_, kind) = known.ok_or_else(|| {
            wrong(
                format!("kind is {kind:?}"),
                "give trial, opening or closing",
            )
        })?;
        let cell = |name: &str| table.text(name).map_or("", |cells| cells[nth]).to_owned();
        let rows = cell("rows");
        let mark = Mark {
            kind,
            utc: cell("t_start_utc"),
            device: cell("device"),
            note: cell("note"),
            rows: rows.parse().ok().ok_or_else(|| {
                wrong(
                    format!("rows is {rows:?}"),
                    "restore the row: it counts those before it",
                )
            })?,
        };
        marks.push(MarkInLog {
            mark,
            n_trials_before,
            line: table.line_of(nth),
        });
    }
    Ok(marks)
}
