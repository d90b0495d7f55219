//! The panes: what stands in the tiles of the window. Where each stands is the shell's business.

use serde::{Deserialize, Serialize};

/// A part of the window that can be moved, stacked and hidden.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
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
    /// Why the selected contactor does what it does.
    Why,
    /// Two tunings, textiles or methods set against each other.
    Compare,
    /// How accurate rendering is, and what it costs.
    Accuracy,
    /// A textile's amplitudes over direction and speed of movement.
    Response,
    /// The whole library at once.
    Collection,
    /// A recipe of a textile, and what becomes of it.
    Lab,
    /// Measurements that become textiles.
    Import,
    /// A picture of a cloth that becomes a textile.
    Picture,
    /// What a participant of an experiment sees.
    Participant,
    /// A session of an experiment, as who holds it sees it.
    Experimenter,
    /// What the logs of experiments say.
    Analysis,
}

impl Pane {
    /// Every pane, in the order in which they are listed.
    pub(crate) const ALL: [Self; 20] = [
        Self::Workspace,
        Self::Library,
        Self::Tuning,
        Self::Bridge,
        Self::Heatmaps,
        Self::ContactSpectrum,
        Self::DriveSpectrum,
        Self::SpatialSpectra,
        Self::DriveWave,
        Self::Why,
        Self::Response,
        Self::Accuracy,
        Self::Compare,
        Self::Collection,
        Self::Lab,
        Self::Import,
        Self::Picture,
        Self::Participant,
        Self::Experimenter,
        Self::Analysis,
    ];

    /// Its title.
    pub(crate) fn title(self) -> &'static str {
        match self {
            Self::Workspace => "Workspace",
            Self::Library => "Library",
            Self::Tuning => "Tuning",
            Self::Bridge => "Bridge",
            Self::Heatmaps => "Contactors",
            Self::ContactSpectrum => "Contact spectrum",
            Self::DriveSpectrum => "Drive spectrum",
            Self::DriveWave => "Drive waveform",
            Self::SpatialSpectra => "Spatial spectra",
            Self::Why => "Why",
            Self::Compare => "Compare",
            Self::Accuracy => "Accuracy",
            Self::Response => "Response",
            Self::Collection => "Collection",
            Self::Lab => "Textile lab",
            Self::Import => "Import",
            Self::Picture => "Picture",
            Self::Participant => "Participant",
            Self::Experimenter => "Experimenter",
            Self::Analysis => "Analysis",
        }
    }

    /// Its title where there is little room.
    pub(crate) fn short_title(self) -> &'static str {
        match self {
            Self::ContactSpectrum => "Contact",
            Self::DriveSpectrum => "Drive",
            Self::DriveWave => "Wave",
            Self::Lab => "Lab",
            Self::SpatialSpectra => "Spatial",
            Self::Workspace
            | Self::Library
            | Self::Tuning
            | Self::Bridge
            | Self::Heatmaps
            | Self::Why
            | Self::Response
            | Self::Accuracy
            | Self::Compare
            | Self::Collection
            | Self::Import
            | Self::Picture
            | Self::Participant
            | Self::Experimenter
            | Self::Analysis => self.title(),
        }
    }

    /// Its place in [`Self::ALL`].
    pub(crate) fn index(self) -> usize {
        Self::ALL
            .iter()
            .position(|pane| *pane == self)
            .unwrap_or_default()
    }
}
