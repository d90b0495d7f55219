//! What can be said of all visits: shares with their intervals, beside what chance gives.

use std::collections::BTreeMap;
use std::path::Path;

use selvedge_foundation::files::{FileError, Table, TableWriter, read_text, write_atomic};
use selvedge_statistics::{Interval, Sides, Summary, exact_binomial};

use super::{
    COMMENT_COLUMNS, COMMENTS, GUESS_COLUMNS, GUESSES, N_CLOTHS, VISIT_COLUMNS, VISITS, VisitEnd,
};

/// Confidence of every interval.
const LEVEL: f64 = 0.95;
const COLUMNS: [&str; 8] = ["what", "n", "of", "value", "low", "high", "chance", "p"];

/// What the log of a stage says.
#[derive(Debug)]
pub struct Totals {
    logs: Vec<(&'static str, String)>,
    table: Vec<u8>,
    n_visits: usize,
}

impl Totals {
    /// Reads the log in a folder; a stage may go on writing it meanwhile.
    ///
    /// # Errors
    /// There is no log, or it is none of a stage.
    pub fn of_folder(folder: &Path) -> Result<Self, FileError> {
        let [visits, guesses, comments] = [
            (VISITS, &VISIT_COLUMNS[..]),
            (GUESSES, &GUESS_COLUMNS),
            (COMMENTS, &COMMENT_COLUMNS),
        ]
        .map(|(name, columns)| complete_rows(folder, name, columns));
        let (visits, guesses, comments) = (visits?, guesses?, comments?);
        let n_visits = visits.table.n_rows();
        let mut rows = Rows(TableWriter::new(Vec::new(), Path::new(""), &COLUMNS)?);
        rows.visits(&visits.table)?;
        rows.guesses(&guesses.table)?;
        rows.comments(&comments.table)?;
        Ok(Self {
            table: rows.0.finish()?,
            logs: [visits, guesses, comments]
                .map(|log| (log.name, log.text))
                .into(),
            n_visits,
        })
    }

    /// How many visits there were.
    pub fn n_visits(&self) -> usize {
        self.n_visits
    }

    /// Writes the rows and `totals.csv` into a folder.
    ///
    /// # Errors
    /// It cannot be written.
    pub fn write(&self, folder: &Path) -> Result<(), FileError> {
        std::fs::create_dir_all(folder).map_err(FileError::write(folder))?;
        for (name, text) in &self.logs {
            write_atomic(&folder.join(name), text.as_bytes())?;
        }
        write_atomic(&folder.join("totals.csv"), &self.table)
    }
}

struct Log {
    name: &'static str,
    text: String,
    table: Table,
}

/// The rows that are complete: a crash leaves a piece of one.
fn complete_rows(folder: &Path, name: &'static str, columns: &[&str]) -> Result<Log, FileError> {
    let path = folder.join(name);
    let mut text = read_text(&path)?;
    text.truncate(text.rfind('\n').map_or(0, |end| end + 1));
    let table = Table::read(&text, &path, columns, &[])?;
    Ok(Log { name, text, table })
}

struct Rows(TableWriter<Vec<u8>>);

impl Rows {
    fn visits(&mut self, table: &Table) -> Result<(), FileError> {
        let n = table.n_rows();
        self.0.text("visits").number(n);
        self.empty(6)?;
        let ends = table.text("end").unwrap_or_default();
        for end in VisitEnd::ALL.map(VisitEnd::word) {
            let hits = ends.iter().filter(|word| **word == end).count();
            self.share(&format!("visits that ended by {end}"), (hits, n), None)?;
        }
        let guesses = table.required_numbers("guesses")?;
        let hits = guesses.iter().filter(|n| **n >= 3.0).count();
        self.share("visits with all guesses", (hits, n), None)?;
        let arrays = table.text("array").unwrap_or_default();
        let hits = arrays.iter().filter(|word| **word == "armed").count();
        self.share("visits with an armed array", (hits, n), None)?;
        self.mean("duration, s", &table.required_numbers("duration_s")?)
    }

    /// Guesses together, and for each textile that was felt.
    fn guesses(&mut self, table: &Table) -> Result<(), FileError> {
        let column = |name| table.text(name).unwrap_or_default();
        let mut right: BTreeMap<&str, (usize, usize)> = BTreeMap::new();
        for (truth, choice) in column("truth").into_iter().zip(column("choice")) {
            let (hits, n) = right.entry(truth).or_default();
            *hits += usize::from(truth == choice);
            *n += 1;
        }
        let all = right
            .values()
            .fold((0, 0), |(hits, n), more| (hits + more.0, n + more.1));
        let chance = Some(1.0 / N_CLOTHS as f64);
        self.share("right guesses", all, chance)?;
        for (truth, counted) in right {
            self.share(&format!("right guesses of {truth}"), counted, chance)?;
        }
        self.mean("guess, ms", &table.required_numbers("ms")?)
    }

    fn comments(&mut self, table: &Table) -> Result<(), FileError> {
        let mut counts: BTreeMap<String, usize> = BTreeMap::new();
        for face in table.text("face").unwrap_or_default() {
            if !face.is_empty() {
                *counts.entry(format!("face {face}")).or_default() += 1;
            }
        }
        for words in table.text("words").unwrap_or_default() {
            for word in words.split_whitespace() {
                *counts.entry(format!("word {word}")).or_default() += 1;
            }
        }
        for (what, hits) in counts {
            self.share(&what, (hits, table.n_rows()), None)?;
        }
        Ok(())
    }

    /// A share with its interval by Wilson, and where chance is known how likely it gives as much.
    fn share(
        &mut self,
        what: &str,
        (hits, n): (usize, usize),
        chance: Option<f64>,
    ) -> Result<(), FileError> {
        self.0.text(what).number(hits).number(n);
        let Ok(interval) = Interval::wilson(hits as u64, n as u64, LEVEL) else {
            return self.empty(5);
        };
        self.0
            .number(hits as f64 / n as f64)
            .number(interval.low)
            .number(interval.high);
        let Some(chance) = chance else {
            return self.empty(2);
        };
        self.0.number(chance);
        match exact_binomial(hits as u64, n as u64, chance, Sides::Two) {
            Ok(outcome) => self.0.number(outcome.p).end_row(),
            Err(_undefined) => self.empty(1),
        }
    }

    /// A mean with its interval by Student.
    fn mean(&mut self, what: &str, values: &[f64]) -> Result<(), FileError> {
        self.0.text(what).number(values.len()).text("");
        let Ok(summary) = Summary::of(values) else {
            return self.empty(5);
        };
        self.0.number(summary.mean);
        let Ok(interval) = summary.interval(LEVEL) else {
            return self.empty(4);
        };
        self.0.number(interval.low).number(interval.high);
        self.empty(2)
    }

    fn empty(&mut self, n_cells: usize) -> Result<(), FileError> {
        for _ in 0..n_cells {
            self.0.text("");
        }
        self.0.end_row()
    }
}
