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
//! - studies measure only with [`Bench`]: warm-up, repeats, medians, thread CPU time beside wall time
//! - a study's numbers depend on its seed, never on the machine; its times are the machine's
//! - no GUI: the window's own studies are handed in by `app`

mod bench;
mod drive_updates;
mod error;
mod findings;
mod spectral_model;
mod study;
mod velocity;

pub use bench::{Bench, Effort, Timing};
pub use drive_updates::DriveUpdatesStudy;
pub use error::ReportError;
pub use findings::{Findings, Row};
pub use spectral_model::SpectralModelStudy;
pub use study::Study;
pub use velocity::VelocityStudy;
