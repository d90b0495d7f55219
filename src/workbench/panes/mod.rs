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

pub(crate) use accuracy::{show as show_accuracy, show_corner as show_accuracy_corner};
pub(crate) use analysis::{
    AnalysisHands, Looks as AnalysisLooks, Sight as AnalysisSight, show as show_analysis,
};
pub(crate) use ask::Ask;
pub(crate) use ask::{AskWords, show as show_ask};
pub(crate) use bridge::BACK;
pub(crate) use bridge::{ArrayView, BridgePane, BridgeTyped, back_notice, show as show_bridge};
pub(crate) use collection::{Typed as CollectionTyped, show as show_collection};
pub(crate) use compare::{
    CompareView, scale_db as scale_of_differences_db, show as show_compare,
    show_corner as show_compare_corner,
};
pub(crate) use contact_spectrum::{
    ContactSpectrogram, ContactSpectrumView, LEVELS_DB as CONTACT_LEVELS_DB,
    share_of as contact_share, show as show_contact_spectrum,
};
pub(crate) use curve::ends_db as compression_ends_db;
pub(crate) use drive_spectrum::{DriveSpectrogram, DriveSpectrumView, show as show_drive_spectrum};
pub(crate) use drive_wave::{DriveWaveView, WaveScale, show as show_drive_wave};
pub(crate) use experimenter::{ExperimenterHands, show as show_experimenter, show_veil};
pub(crate) use export::{SIZE as EXPORT_SIZE, show as show_export};
pub(crate) use header::show as show_header;
pub(crate) use heatmap::{
    HeatmapStyle, digits as cell_digits, show as show_heatmaps, show_corner as show_heatmap_corner,
};
pub(crate) use help::show as show_help;
pub(crate) use import::{ImportView, show as show_import};
pub(crate) use lab::{LabHands, LabPictures, LabView, show as show_lab};
pub(crate) use library::show as show_library;
pub(crate) use menu::Appearance;
pub(crate) use menu::choice as menu_choice;
pub(crate) use notices::{Notices, show as show_notices};
pub(crate) use participant::{
    show as show_participant, show_apart as show_participant_is_apart,
    show_before as show_before_session,
};
pub(crate) use picture::{PictureTextures, show as show_picture};
pub(crate) use question::show as show_question;
pub(crate) use response::{
    ResponseView, ends_db as response_ends_db, fill_range as response_range, show as show_response,
    show_corner as show_response_corner,
};
pub(crate) use spatial::wavenumber_per_mm;
pub(crate) use spatial::{
    LEVELS_DB as SPATIAL_LEVELS_DB, SpatialSource, SpatialSpectra, density_db, means_of,
    show as show_spatial,
};
pub(crate) use spectrogram::ShownColumn;
pub(crate) use transport::Timeline;
pub(crate) use transport::{
    LEVELS_DB as TIMELINE_LEVELS_DB, StripTick, TransportState, TransportView,
    show as show_transport,
};
pub(crate) use tuning::show as show_tuning;
pub(crate) use why::{show as show_why, show_corner as show_why_corner};

use super::command::Command;

/// Where panes put what the user wants.
pub(crate) type Wishes = Vec<Command>;

#[cfg(test)]
mod plot_tests;
#[cfg(test)]
mod tests;
