//! The panes: each draws plain data and says what the user wants.
//!
//! A pane takes views (`view.rs`), pushes [`Command`]s, and changes nothing. What it computes
//! before it paints is a pure query with tests of its own.

mod accuracy;
mod analysis;
mod ask;
mod bridge;
mod collection;
mod compare;
mod contact_spectrum;
mod curve;
mod drive_spectrum;
mod drive_wave;
mod experimenter;
mod export;
mod header;
mod heatmap;
mod help;
mod import;
mod lab;
mod library;
mod menu;
mod notices;
mod participant;
mod picture;
mod question;
mod response;
mod spatial;
mod spectrogram;
mod swatch;
mod transport;
mod tuning;
mod why;

pub use accuracy::{show as show_accuracy, show_corner as show_accuracy_corner};
pub use analysis::{
    AnalysisHands, Looks as AnalysisLooks, Sight as AnalysisSight, show as show_analysis,
};
pub use ask::{Ask, AskWords, show as show_ask};
pub use bridge::{ArrayView, BACK, BridgePane, BridgeTyped, back_notice, show as show_bridge};
pub use collection::{Typed as CollectionTyped, show as show_collection};
pub use compare::{
    CompareView, scale_db as scale_of_differences_db, show as show_compare,
    show_corner as show_compare_corner,
};
pub use contact_spectrum::{
    ContactSpectrogram, ContactSpectrumView, LEVELS_DB as CONTACT_LEVELS_DB,
    share_of as contact_share, show as show_contact_spectrum,
};
pub use curve::ends_db as compression_ends_db;
pub use drive_spectrum::{DriveSpectrogram, DriveSpectrumView, show as show_drive_spectrum};
pub use drive_wave::{DriveWaveView, WaveScale, show as show_drive_wave};
pub use experimenter::{ExperimenterHands, show as show_experimenter, show_veil};
pub use export::{SIZE as EXPORT_SIZE, show as show_export};
pub use header::show as show_header;
pub use heatmap::{
    HeatmapStyle, digits as cell_digits, show as show_heatmaps, show_corner as show_heatmap_corner,
};
pub use help::show as show_help;
pub use import::{ImportView, show as show_import};
pub use lab::{LabHands, LabPictures, LabView, show as show_lab};
pub use library::show as show_library;
pub use menu::{Appearance, choice as menu_choice};
pub use notices::{Notices, show as show_notices};
pub use participant::{
    show as show_participant, show_apart as show_participant_is_apart,
    show_before as show_before_session,
};
pub use picture::{PictureTextures, show as show_picture};
pub use question::show as show_question;
pub use response::{
    ResponseView, ends_db as response_ends_db, fill_range as response_range, show as show_response,
    show_corner as show_response_corner,
};
pub use spatial::{
    LEVELS_DB as SPATIAL_LEVELS_DB, SpatialSource, SpatialSpectra, density_db, means_of,
    show as show_spatial, wavenumber_per_mm,
};
pub use spectrogram::ShownColumn;
pub use transport::{
    LEVELS_DB as TIMELINE_LEVELS_DB, StripTick, Timeline, TransportState, TransportView,
    show as show_transport,
};
pub use tuning::show as show_tuning;
pub use why::{show as show_why, show_corner as show_why_corner};

use super::command::Command;

/// Where panes put what the user wants.
pub type Wishes = Vec<Command>;

#[cfg(test)]
mod plot_tests;
#[cfg(test)]
mod tests;
