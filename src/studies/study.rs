//! What a study is (a question, methods that answer it, and an honest measure of how well) and what
//! it finds: rows of error and cost, plots, and sentences.

use super::{Bench, ReportError, Timing};
use selvedge_chart::Chart;

/// A question about error against run time, or about what holds in extreme cases.
pub trait Study: Send + Sync {
    /// Its name: lower case, words joined by hyphens; files are called by it.
    fn name(&self) -> &'static str;

    /// What it asks, one sentence.
    fn question(&self) -> &'static str;

    /// What errors are measured against, one sentence.
    fn reference(&self) -> &'static str;

    /// What the error is and its unit, for axes and columns: `("level error", "dB")`.
    fn error_measure(&self) -> (&'static str, &'static str);

    /// What a cost is the cost of, for axes and columns: `"tick"`.
    fn cost_of(&self) -> &'static str;

    /// Whether it runs only when long studies are asked for.
    fn is_long(&self) -> bool {
        false
    }

    /// Answers the question.
    ///
    /// # Errors
    /// It was cancelled, or something it needs failed.
    fn run(&self, bench: &mut Bench<'_>) -> Result<Findings, ReportError>;
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
    /// Whether the promise is kept; `None` without one. A missing or senseless error keeps none.
    pub fn is_kept(&self) -> Option<bool> {
        let promised = self.promised?;
        Some(self.error.is_some_and(|error| error <= promised))
    }

    /// What stands in a further column; `None` where it has no such cell.
    pub fn further(&self, column: &str) -> Option<&str> {
        let found = self.more.iter().find(|(name, _)| *name == column);
        found.map(|(_, text)| text.as_str())
    }

    /// The number in a further column; `None` where there is none.
    pub(crate) fn further_number(&self, column: &str) -> Option<f64> {
        self.further(column)?.parse().ok()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_promise_is_kept_by_a_number_within_it_alone() {
        let row = |error, promised| Row {
            error,
            promised,
            ..Row::default()
        };
        assert_eq!(row(Some(0.04), Some(0.05)).is_kept(), Some(true));
        assert_eq!(row(Some(0.06), Some(0.05)).is_kept(), Some(false));
        assert_eq!(row(Some(f64::NAN), Some(0.05)).is_kept(), Some(false));
        assert_eq!(row(None, Some(0.05)).is_kept(), Some(false));
        assert_eq!(row(Some(0.04), None).is_kept(), None);
    }
}
