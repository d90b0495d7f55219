//! How to render: the options of every command that does.

use clap::Args;

use selvedge_render::array::{Accuracy, Method};

/// The method, and the error that it may make.
#[derive(Debug, Args)]
pub(super) struct MethodArgs {
    /// How to render: reference, banded, table or auto
    #[arg(long, value_name = "METHOD", default_value = "auto")]
    pub(super) method: Method,
    /// Largest level error that auto and table may make, dB: auto takes the cheapest method that is
    /// proved to keep to it, 0 takes reference
    #[arg(
        long,
        value_name = "DB",
        default_value_t = Accuracy::default().budget_db,
        value_parser = budget_db,
        allow_negative_numbers = true
    )]
    budget_db: f64,
}

impl MethodArgs {
    /// What the method keeps to.
    pub(super) fn accuracy(&self) -> Accuracy {
        Accuracy::within_db(self.budget_db)
    }
}

/// An error budget as it is typed, dB.
fn budget_db(text: &str) -> Result<f64, String> {
    let budget_db = text.parse().ok();
    let is_budget = |budget_db: &f64| *budget_db >= 0.0 && budget_db.is_finite();
    budget_db
        .filter(is_budget)
        .ok_or_else(|| "give a number of dB, 0 or above".to_owned())
}
