//! What the pane shows, and from where it is looked at.

use crate::tools::drape::camera::Camera;

/// What the pane shows how. Never undoable.
#[derive(Debug, Default)]
pub(crate) struct Look {
    pub(crate) camera: Camera,
    pub(crate) shows_strain: bool,
    /// The largest strain since the cloth was hung, rounded up.
    pub(crate) strain_top: f32,
    /// The instant that is looked back at, s; the cloth waits meanwhile.
    pub(crate) looked_at_s: Option<f64>,
    /// The cloth whose figures the sliders change.
    pub(crate) cloth: usize,
}
