//! Statistics of experiments on people: tests, scales and maps of what was felt.
//!
//! Plain numbers in, plain numbers out: nothing here knows of textiles, files or clocks. What
//! cannot be computed is [`Undefined`] with its reason, never a number that stands for nothing.

pub mod mds;
pub mod procrustes;
pub mod properties;

use thiserror::Error;

/// Why a number cannot be computed, in words that stand in a report: `one subject alone`.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("not computable: {reason}")]
pub struct Undefined {
    /// What is missing or wrong.
    pub reason: String,
}

impl Undefined {
    /// With this reason.
    pub fn because(reason: impl Into<String>) -> Self {
        Self {
            reason: reason.into(),
        }
    }
}
