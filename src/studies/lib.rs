//! Error against run time, stability, and what is left out: studies of any floor, one runner.
//!
//! A [`Study`] asks a question and answers it with rows: which method, on which case, how large the
//! error, how long it took. The runner measures all of them alike, marks what nothing else beats in
//! both, and writes tables and plots.
//!
//! ```text
//! Study::run(Bench) ─▶ Findings (rows, plots, notes) ─▶ runner ─▶ CSV, SVG, PNG, *.md
//!                                                  further processes ─┘     └─▶ report.json
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

mod adversarial;
mod areal;
mod bench;
mod bimorph;
mod chart;
mod coding;
mod drape;
mod drive_updates;
mod error;
#[cfg(feature = "friction")]
mod friction;
mod growth;
mod index;
mod listing;
mod machine;
mod mds;
mod models;
mod pareto;
mod picture;
mod readable;
mod readers;
mod record;
mod rendering;
mod rounds;
mod runner;
mod savings;
mod shading;
mod since;
mod spectral_model;
mod stability;
mod staircases;
mod statistics;
mod study;
mod stylus;
#[cfg(test)]
mod tests;
mod textiles;
mod velocity;
mod write;

pub use bench::{Bench, Effort, Timing};
pub use error::ReportError;
pub use pareto::{Front, pareto};
pub use rendering::{Running, ThisSceneStudy};
pub use rounds::times_alone;
pub use runner::{Again, Heard, Options, Outcome, Report, Standing, choose, run};
pub use study::{Findings, Row, Study};

/// Every study of the floors below, in the order of the report: chapter by chapter.
pub fn studies() -> Vec<Study> {
    vec![
        rendering::STUDY,
        rendering::TOTAL,
        rendering::TURNING,
        adversarial::STUDY,
        spectral_model::STUDY,
        areal::STUDY,
        drive_updates::STUDY,
        coding::STUDY,
        bimorph::STUDY,
        velocity::STUDY,
        models::BROWNIAN,
        models::FOURIER,
        models::RESTORATION,
        models::RESAMPLING,
        models::DRAWN,
        models::PROBE,
        readers::STUDY,
        shading::STUDY,
        picture::AUTOCORRELATION,
        picture::LATTICE,
        picture::WEAVES,
        picture::SCALE,
        picture::ROUTE,
        stylus::STUDY,
        stylus::LIMITS,
        drape::STUDY,
        drape::ORDERS,
        drape::STABILITY,
        #[cfg(feature = "friction")]
        friction::griffin_lim::STUDY,
        #[cfg(feature = "friction")]
        friction::pictures::STUDY,
        #[cfg(feature = "friction")]
        friction::training::STUDY,
        statistics::STUDY,
        mds::STUDY,
        staircases::STUDY,
        savings::STUDY,
        stability::STUDY,
        stability::SWEEPS,
    ]
}
