//! What a scene keeps for the window that it is shown in.

use serde::{Deserialize, Serialize};

/// How a window stands, in its own words: held for it, and not understood here.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Arrangement {
    /// What it is arranged for.
    pub perspective: String,
    /// Which pane stands where.
    pub panes: String,
}
