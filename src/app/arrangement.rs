//! Which pane stands where: a tree of tiles that the user may rearrange and that is kept.

use serde::{Deserialize, Serialize};

/// A part of the window that can be moved, stacked and hidden.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub(crate) enum Pane {
    /// The scene in mm with the display moving over it.
    Workspace,
    /// The textiles of the library and of the scene.
    Library,
    /// Gains, compression, filters.
    Tuning,
    /// The device.
    Bridge,
    /// Both bands of every contactor.
    Heatmaps,
    /// The spectrum that arrives at the selected contactor, over time.
    ContactSpectrum,
    /// The spectrum of what drives the selected contactor, over time.
    DriveSpectrum,
    /// The waveform that drives the selected contactor.
    DriveWave,
    /// Spatial spectra of the textile under the selected contactor.
    SpatialSpectra,
}
