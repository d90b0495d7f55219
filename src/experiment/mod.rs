//! Experiments on people: schedules, procedures, logs that lose nothing, and their analysis.
//!
//! ```text
//! design, seed, subject ─▶ schedule ─▶ procedure ─▶ log ─▶ analysis
//! ```
//!
//! # Invariants
//! - a schedule is a pure function of design, seed and subject: what was not yet answered can
//!   always be found again
//! - no window here, and no clock that a caller does not hand in

pub mod schedule;
