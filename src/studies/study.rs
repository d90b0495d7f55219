//! What a study is (a question, methods that answer it, and an honest measure of how well) and what
//! it finds: rows of error and cost, plots, and sentences.

use super::{Bench, ReportError, Timing};
use selvedge_chart::Chart;

/// A question about error against run time, or about what holds in extreme cases.
#[derive(Debug, Clone, Copy)]
pub struct Study {
    /// Its name: lower case, words joined by hyphens; files are called by it.
    pub name: &'static str,
    /// What it belongs to, which a report tells on one page: `CHAPTER.md`.
    pub chapter: &'static str,
    /// What it asks, one sentence.
    pub question: &'static str,
    /// What errors are measured against, one sentence.
    pub reference: &'static str,
    /// What the error is and its unit, for axes and columns: `("level error", "dB")`.
    pub error: (&'static str, &'static str),
    /// What a cost is the cost of, for axes and columns: `"tick"`.
    pub cost_of: &'static str,
    /// Answers the question, unless it was cancelled or something that it needs failed.
    pub run: fn(&mut Bench<'_>) -> Result<Findings, ReportError>,
}

/// What a study found.
#[derive(Debug, Clone, Default)]
pub struct Findings {
    /// One row a method, setting and case.
    pub rows: Vec<Row>,
    /// Plots beside that of error against cost, with the names of their files.
    pub plots: Vec<(String, Chart)>,
    /// What a reader should know, a sentence each.
    pub notes: Vec<String>,
    /// What costs grow with, where that is asked about: what a row's size counts.
    pub(crate) grows_with: Option<&'static str>,
    /// What follows from times: done when rows are timed, and again when further processes have
    /// timed them too.
    pub(crate) judge: Option<fn(&mut [Row])>,
}

/// One method with one setting on one case.
#[derive(Debug, Clone, Default)]
pub struct Row {
    /// The method: what is drawn as one line or one kind of dot.
    pub method: String,
    /// Its setting: `48 nodes an octave`; empty without any.
    pub setting: String,
    /// What it was tried on: a textile, a stroke, an extreme case.
    pub case: String,
    /// The size of the problem, where that is what is asked about.
    pub size: Option<f64>,
    /// The largest error, in the study's measure; `None` where only cost is asked about.
    pub error: Option<f64>,
    /// The 99th percentile of the errors.
    pub error_p99: Option<f64>,
    /// The error that is promised, where one is.
    pub promised: Option<f64>,
    /// What it costs; `None` where nothing is measured.
    pub cost: Option<Timing>,
    /// Bytes of memory that it keeps, where that matters.
    pub bytes: Option<u64>,
    /// Further columns with their names (units in them).
    pub more: Vec<(&'static str, String)>,
}

impl Findings {
    /// Rows, plots, and what a reader should know.
    pub(crate) fn new(
        rows: Vec<Row>,
        plots: Vec<(String, Chart)>,
        notes: impl IntoIterator<Item = impl Into<String>>,
    ) -> Self {
        Self {
            rows,
            plots,
            notes: notes.into_iter().map(Into::into).collect(),
            grows_with: None,
            judge: None,
        }
    }

    /// With ratios and verdicts that follow from times.
    #[must_use]
    pub(crate) fn judged(mut self, judge: fn(&mut [Row])) -> Self {
        self.judge = Some(judge);
        self.judge_times();
        self
    }

    /// Draws from times what follows from them: they are known better now.
    pub(crate) fn judge_times(&mut self) {
        if let Some(judge) = self.judge {
            judge(&mut self.rows);
        }
    }

    /// The rows that do not keep their promise.
    pub fn broken(&self) -> impl Iterator<Item = &Row> {
        self.rows.iter().filter(|row| row.is_kept() == Some(false))
    }

    /// How many those are.
    pub fn n_broken(&self) -> usize {
        self.broken().count()
    }
}

impl Row {
    /// A row of a method with a setting on a case, without any number.
    pub fn of(
        method: impl Into<String>,
        setting: impl Into<String>,
        case: impl Into<String>,
    ) -> Self {
        Self {
            method: method.into(),
            setting: setting.into(),
            case: case.into(),
            ..Self::default()
        }
    }

    /// With its error, if there is one.
    #[must_use]
    pub fn error(mut self, error: impl Into<Option<f64>>) -> Self {
        self.error = error.into();
        self
    }

    /// With the error that is promised, if one is.
    #[must_use]
    pub fn promised(mut self, promised: impl Into<Option<f64>>) -> Self {
        self.promised = promised.into();
        self
    }

    /// With what it costs, if that was measured.
    #[must_use]
    pub fn cost(mut self, cost: impl Into<Option<Timing>>) -> Self {
        self.cost = cost.into();
        self
    }

    /// With the size of the problem.
    #[must_use]
    pub(crate) fn size(mut self, size: f64) -> Self {
        self.size = Some(size);
        self
    }

    /// With the 99th percentile of the errors.
    #[must_use]
    pub(crate) fn p99(mut self, error: f64) -> Self {
        self.error_p99 = Some(error);
        self
    }

    /// With the bytes that it keeps.
    #[must_use]
    pub(crate) fn bytes(mut self, n_bytes: usize) -> Self {
        self.bytes = u64::try_from(n_bytes).ok();
        self
    }

    /// With a further column.
    #[must_use]
    #[expect(
        clippy::needless_pass_by_value,
        reason = "cells are made where they are given"
    )]
    pub fn with(mut self, column: &'static str, cell: impl ToString) -> Self {
        self.more.push((column, cell.to_string()));
        self
    }

    /// With a number in a further column; what is no number leaves the cell empty.
    #[must_use]
    pub(crate) fn number(self, column: &'static str, decimals: usize, value: f64) -> Self {
        let is_known = value.is_finite();
        let text = is_known.then(|| format!("{value:.decimals$}"));
        self.with(column, text.unwrap_or_default())
    }

    /// Puts a cell in a further column, in place of what stood there.
    pub(crate) fn set(&mut self, column: &'static str, cell: String) {
        match self.more.iter_mut().find(|(name, _)| *name == column) {
            Some((_, known)) => *known = cell,
            None => self.more.push((column, cell)),
        }
    }

    /// Whether the promise is kept; `None` without one. A missing or senseless error keeps none.
    pub fn is_kept(&self) -> Option<bool> {
        let promised = self.promised?;
        Some(self.error.is_some_and(|error| error <= promised))
    }

    /// What stands in a further column; empty where it has no such cell.
    pub fn further(&self, column: &str) -> &str {
        let found = self.more.iter().find(|(name, _)| *name == column);
        found.map_or("", |(_, text)| text)
    }

    /// The number in a further column; `None` where there is none.
    pub(crate) fn further_number(&self, column: &str) -> Option<f64> {
        self.further(column).parse().ok()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_promise_is_kept_by_a_number_within_it_alone() {
        let row = |error: Option<f64>, promised: Option<f64>| {
            Row::of("", "", "").error(error).promised(promised)
        };
        assert_eq!(row(Some(0.04), Some(0.05)).is_kept(), Some(true));
        assert_eq!(row(Some(0.06), Some(0.05)).is_kept(), Some(false));
        assert_eq!(row(Some(f64::NAN), Some(0.05)).is_kept(), Some(false));
        assert_eq!(row(None, Some(0.05)).is_kept(), Some(false));
        assert_eq!(row(Some(0.04), None).is_kept(), None);
    }
}
