//! What other tools want of the pane that shows friction.

use std::sync::Arc;

use selvedge_foundation::numerics::Grid;

/// A picture of cloth that another tool has at hand; equal are only clones of one another.
#[derive(Debug, Clone)]
pub(crate) struct PictureAtHand {
    /// What its file is called.
    pub(crate) name: String,
    /// From 0 to 1.
    pub(crate) brightness: Arc<Grid<f32>>,
    /// Its scale.
    pub(crate) px_per_mm: f64,
}

impl PartialEq for PictureAtHand {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.brightness, &other.brightness)
    }
}
