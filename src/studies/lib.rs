//! Error against run time, stability, and what is left out: studies of any floor, one runner.
//!
//! A [`Study`] asks a question and answers it with rows: which method, on which case, how large the
//! error, how long it took. The runner measures all of them alike, marks what nothing else beats in
//! both, and writes tables and plots.
//!
//! ```text
//! Study::run(Bench) ─▶ Findings (rows, plots, notes) ─▶ runner ─▶ CSV, SVG, PNG, index.md
//! ```
//!
//! # Invariants
//! - studies measure only with [`Bench`]: warm-up, repeats, medians, CPU time beside wall time
//! - a study's numbers depend on its seed, never on the machine; its times are the machine's
//! - no GUI: the window's own studies are handed in by `workbench`
#![cfg_attr(
    test,
    expect(clippy::float_cmp, reason = "tests compare exact results on purpose")
)]

mod areal;
mod bench;
mod bimorph;
mod chart;
mod clips;
mod drive_updates;
mod error;
mod growth;
mod index;
mod left_out;
mod listing;
mod machine;
mod mds;
mod models;
mod pareto;
mod picture;
mod readable;
mod readers;
mod rendering;
mod runner;
mod shading;
mod spectral_model;
mod stability;
mod staircases;
mod study;
#[cfg(test)]
mod tests;
mod velocity;
mod write;

pub(crate) use areal::ArealStudy;
pub use bench::{Bench, Effort, Timing};
pub(crate) use bimorph::BimorphStudy;
pub use clips::ClipsStudy;
pub(crate) use drive_updates::DriveUpdatesStudy;
pub use error::ReportError;
pub(crate) use growth::GrowthStudy;
pub(crate) use left_out::LeftOutStudy;
pub(crate) use machine::Machine;
pub(crate) use mds::MdsStudy;
pub(crate) use models::{
    BrownianStudy, FourierStudy, ProbeStudy, ResamplingStudy, RestorationStudy,
};
pub use pareto::pareto;
pub(crate) use picture::{
    AutocorrelationStudy, LatticeStudy, PictureRouteStudy, PictureScaleStudy,
};
pub(crate) use readers::ReadersStudy;
pub(crate) use rendering::RenderingStudy;
pub use rendering::{Running, ThisSceneStudy};
pub use runner::{Options, Outcome, Report, Standing, choose, run};
pub(crate) use shading::ShadingStudy;
pub(crate) use spectral_model::SpectralModelStudy;
pub(crate) use staircases::StaircasesStudy;
pub use study::{Findings, Row, Study};
pub(crate) use velocity::VelocityStudy;

/// Every study of the floors below, in the order of the report.
pub fn studies() -> Vec<Box<dyn Study>> {
    vec![
        Box::new(RenderingStudy),
        Box::new(SpectralModelStudy),
        Box::new(ArealStudy),
        Box::new(DriveUpdatesStudy),
        Box::new(ClipsStudy),
        Box::new(VelocityStudy),
        Box::new(GrowthStudy),
        Box::new(BrownianStudy),
        Box::new(FourierStudy),
        Box::new(RestorationStudy),
        Box::new(ResamplingStudy),
        Box::new(ProbeStudy),
        Box::new(ShadingStudy),
        Box::new(AutocorrelationStudy),
        Box::new(LatticeStudy),
        Box::new(PictureScaleStudy),
        Box::new(PictureRouteStudy),
        Box::new(BimorphStudy),
        Box::new(ReadersStudy),
        Box::new(MdsStudy),
        Box::new(StaircasesStudy),
        Box::new(LeftOutStudy),
        Box::new(stability::Stability),
    ]
}
