//! What a study is: a question, methods that answer it, and an honest measure of how well.

use super::{Bench, Findings, ReportError};

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
