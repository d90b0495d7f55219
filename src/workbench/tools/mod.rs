//! The tools: one folder each, with its state, its work, its views and its tests.
//!
//! A tool uses `bench` and `kit`, never the shell and never another tool.

pub(crate) mod accuracy;
pub(crate) mod analysis;
pub(crate) mod bridge;
pub(crate) mod collection;
pub(crate) mod compare;
pub(crate) mod contactors;
pub(crate) mod drape;
pub(crate) mod experiment;
#[cfg(feature = "friction")]
pub(crate) mod friction;
pub(crate) mod import;
pub(crate) mod lab;
pub(crate) mod levels;
pub(crate) mod library;
pub(crate) mod picture;
pub(crate) mod recordings;
pub(crate) mod response;
pub(crate) mod spectra;
pub(crate) mod stage;
pub(crate) mod stylus;
pub(crate) mod timeline;
pub(crate) mod tuning;
pub(crate) mod why;
pub(crate) mod workspace;

use crate::bench::Bench;
use crate::bench::stage::StageOptions;
use crate::bench::tool::{Bar, PublicFace, Tool};

/// Every tool: to add one is a folder and a line here.
pub(crate) fn all() -> Vec<Box<dyn Tool>> {
    vec![
        Box::new(import::Import::default()),
        Box::new(accuracy::Accuracy::default()),
        Box::new(compare::Compare::default()),
        Box::new(response::Response::default()),
        Box::new(spectra::contact::ContactSpectrum::default()),
        Box::new(spectra::drive::DriveSpectrum::default()),
        Box::new(spectra::wave::DriveWave::default()),
        Box::new(spectra::spatial::SpatialSpectra::default()),
        Box::new(why::Why::default()),
        Box::new(stylus::Stylus::default()),
        Box::new(picture::Picture::default()),
        #[cfg(feature = "friction")]
        Box::new(friction::Friction::default()),
        Box::new(drape::Draping::default()),
        Box::new(lab::Lab::default()),
        Box::new(collection::Collection::default()),
        Box::new(library::Library::default()),
        Box::new(recordings::RecordingList::default()),
        Box::new(bridge::Bridge::default()),
        Box::new(contactors::Contactors::default()),
        Box::new(tuning::Tuning::default()),
        Box::new(levels::LevelBench::default()),
        Box::new(workspace::Workspace::default()),
        Box::new(experiment::Experiment::default()),
        Box::new(analysis::Analysis::default()),
    ]
}

/// What a window before the public shows.
pub(crate) fn stage(options: StageOptions, bench: &mut Bench) -> Box<dyn PublicFace> {
    Box::new(stage::Stage::new(options, bench))
}

/// The bar at the bottom of the window.
pub(crate) fn bar() -> Box<dyn Bar> {
    Box::new(timeline::state::Timeline::default())
}
