//! How scenes are rendered: a method, and the error that `auto` and `table` may make. Kept per
//! user; no part of a scene.

use serde::{Deserialize, Serialize};

use selvedge_render::array::{Accuracy, Method};

/// The largest budget that can be chosen, dB.
pub(crate) const MOST_BUDGET_DB: f64 = 1.0;

/// How scenes are rendered.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub(crate) struct Rendering {
    /// The method; `auto` chooses by bounds known before the first tick.
    #[serde(rename = "rendering_method")]
    pub method: Method,
    /// The level error that `auto` and `table` may make, dB; 0 is exact.
    #[serde(rename = "error_budget_db")]
    pub budget_db: f64,
}

impl Default for Rendering {
    /// `auto` within the program's default budget.
    fn default() -> Self {
        Self {
            method: Method::Auto,
            budget_db: Accuracy::default().budget_db,
        }
    }
}

impl Rendering {
    /// What renderers are told.
    pub(crate) fn accuracy(self) -> Accuracy {
        Accuracy::within_db(self.budget_db)
    }

    /// Whether the method keeps to the budget; others have an error of their own.
    pub(crate) fn has_budget(self) -> bool {
        matches!(self.method, Method::Auto | Method::Table)
    }

    /// The same with a budget that can be chosen; what is no number is as at first.
    pub(crate) fn in_bounds(self) -> Self {
        let budget_db = if self.budget_db.is_nan() {
            Self::default().budget_db
        } else {
            self.budget_db.clamp(0.0, MOST_BUDGET_DB)
        };
        Self { budget_db, ..self }
    }
}
