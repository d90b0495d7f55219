//! The panes: what stands in the tiles of the window. Where each stands is the shell's business.

use serde::{Deserialize, Serialize};

/// Declares every pane once: its name in files, its title, its title where there is little room,
/// the width of what its tool adds to the row of tabs, points, whether it has numbers to export,
/// and the condition under which it is built if it is not always.
macro_rules! panes {
    ($(
        $(#[doc = $doc:literal])*
        $name:ident: $title:literal, $short:literal, $corner:literal, $exports:literal
        $(if $condition:meta)?;
    )*) => {
        /// A part of the window that can be moved, stacked and hidden.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
        pub(crate) enum Pane {
            $($(#[doc = $doc])* $(#[cfg($condition)])? $name,)*
        }

        impl Pane {
            /// Every pane, in the order in which they are listed.
            pub(crate) const ALL: [Self; [$($(#[cfg($condition)])? $title),*].len()] =
                [$($(#[cfg($condition)])? Self::$name),*];

            fn facts(self) -> (&'static str, &'static str, f32, bool) {
                match self {
                    $($(#[cfg($condition)])? Self::$name => ($title, $short, $corner, $exports),)*
                }
            }
        }
    };
}

panes! {
    /// The scene in mm with the display moving over it.
    Workspace: "Workspace", "Workspace", 376.0, true;
    /// The textiles of the library and of the scene.
    Library: "Library", "Library", 0.0, false;
    /// Recorded explorations.
    Recordings: "Recordings", "Recordings", 0.0, false;
    /// Gains, compression, filters.
    Tuning: "Tuning", "Tuning", 0.0, true;
    /// Levels of the scene's textiles, and what they are to be.
    Levels: "Levels", "Levels", 56.0, true;
    /// The device.
    Bridge: "Bridge", "Bridge", 0.0, true;
    /// Both bands of every contactor.
    Heatmaps: "Contactors", "Contactors", 184.0, true;
    /// The spectrum that arrives at the selected contactor, over time.
    ContactSpectrum: "Contact spectrum", "Contact", 112.0, true;
    /// The spectrum of what drives the selected contactor, over time.
    DriveSpectrum: "Drive spectrum", "Drive", 112.0, true;
    /// Spatial spectra of the textile under the selected contactor.
    SpatialSpectra: "Spatial spectra", "Spatial", 112.0, true;
    /// The waveform that drives the selected contactor.
    DriveWave: "Drive waveform", "Wave", 112.0, true;
    /// Why the selected contactor does what it does.
    Why: "Why", "Why", 136.0, true;
    /// A textile's amplitudes over direction and speed of movement.
    Response: "Response", "Response", 56.0, true;
    /// How accurate rendering is, and what it costs.
    Accuracy: "Accuracy", "Accuracy", 108.0, true;
    /// Two tunings, textiles or methods set against each other.
    Compare: "Compare", "Compare", 72.0, true;
    /// What a stylus would feel where the display is.
    Stylus: "Stylus", "Stylus", 0.0, true;
    /// The whole library at once.
    Collection: "Collection", "Collection", 0.0, true;
    /// A recipe of a textile, and what becomes of it.
    Lab: "Textile lab", "Lab", 0.0, true;
    /// Measurements that become textiles.
    Import: "Import", "Import", 0.0, true;
    /// A picture of a cloth that becomes a textile.
    Picture: "Picture", "Picture", 0.0, true;
    /// Friction of a cloth from its picture, felt on an electrovibration screen.
    Friction: "Friction", "Friction", 0.0, true if feature = "friction";
    /// A hanging cloth under two fingers.
    Drape: "Drape", "Drape", 0.0, true;
    /// What a participant of an experiment sees.
    Participant: "Participant", "Participant", 0.0, false;
    /// A design of an experiment as blocks, and what it comes to.
    Builder: "Study builder", "Builder", 0.0, false;
    /// The sessions of a study: who took part, how far, what counts, what is missing.
    Board: "Study board", "Board", 0.0, false;
    /// A session of an experiment, as who holds it sees it.
    Experimenter: "Experimenter", "Experimenter", 0.0, false;
    /// What the logs of experiments say.
    Analysis: "Analysis", "Analysis", 0.0, false;
}

impl Pane {
    /// Its title.
    pub(crate) fn title(self) -> &'static str {
        self.facts().0
    }

    /// Its title where there is little room.
    pub(crate) fn short_title(self) -> &'static str {
        self.facts().1
    }

    /// Width of what its tool adds to the row of tabs, points.
    pub(crate) fn corner_width(self) -> f32 {
        self.facts().2
    }

    /// Whether it has numbers to export.
    pub(crate) fn has_export(self) -> bool {
        self.facts().3
    }

    /// Its place in [`Self::ALL`].
    pub(crate) fn index(self) -> usize {
        let mut all = Self::ALL.into_iter();
        all.position(|pane| pane == self).unwrap_or_default()
    }
}

/// Something that can be exported.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) enum Exportable {
    /// What a pane shows.
    Pane(Pane),
    /// The strips at the bottom.
    Timeline,
}

impl Exportable {
    /// What people call it.
    pub(crate) fn title(self) -> &'static str {
        match self {
            Self::Pane(Pane::Tuning) => "Compression curve",
            Self::Pane(Pane::Workspace) => "Map over the cloth",
            Self::Pane(Pane::Bridge) => "Times on the link",
            Self::Pane(pane) => pane.title(),
            Self::Timeline => "Timeline",
        }
    }

    /// What its file is called, with this ending: `contact-spectrum.png`.
    pub(crate) fn file_name(self, ending: &str) -> String {
        let stem = self.title().to_lowercase().replace(' ', "-");
        format!("{stem}.{ending}")
    }
}
