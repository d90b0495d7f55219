//! Exports of the Kawabata surface tester (KES-FB4): read, looked at, and made into a textile.
//!
//! ```text
//! files ─▶ text ─▶ dialect (cells, decimal sign) ─▶ columns (what they are) ─▶ places (steps)
//!       ─▶ strokes (order of travel, one tilt off) ─▶ marks ─▶ section ─▶ figures ─▶ files
//! ```
//!
//! No public file of the tester was found: the layouts are a convention gathered from the
//! literature and from how laboratories describe their exports. What a file does not say is asked
//! for, never assumed: see [`KesAsk`].
//!
//! # Invariants
//! - pure: bytes in, bytes out; a window shows the [`crate::KesImport`] before anything is written
//! - one straight line is taken off every stroke of heights, over its whole length, laid through
//!   what is not marked; nothing else
//! - nothing is resampled: uneven steps are refused

mod columns;
mod look;
mod marks;
#[cfg(test)]
mod mutations;
mod places;
mod reading;
mod returns;
mod section;
mod strokes;
#[cfg(test)]
mod tests;
mod text;
mod units;

pub use crate::number_table::DecimalSign;
pub use columns::{ColumnRole, StrokeSide, TextileAxis};
pub use look::KesLine;
pub use look::{KesColumn, KesKnown, KesLook};
pub(crate) use marks::n_samples;
pub use marks::{Mark, MarkKind};
pub use reading::KesFriction;
pub use reading::{KesFile, KesReading, KesStroke};
pub use section::KesSection;
pub(crate) use section::{covered_mm, suggested};

use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use crate::error::{KesAsk, TextileError};
use crate::number_table::{NoTable, table_of};
use crate::unit::{LengthUnit, Unit};

/// What is known of files beyond what they say. The default knows nothing.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct KesOptions {
    /// The direction of each file, in their order; missing ones go by the file's name.
    pub directions: Vec<Option<KesPlace>>,
    /// The distance between samples, mm: where no column says it, or says it wrongly.
    pub step_mm: Option<f64>,
    /// The speed of the stroke, mm/s: with a rate or a column of times.
    pub speed_mm_per_s: Option<f64>,
    /// Samples a second.
    pub rate_hz: Option<f64>,
    /// What 1 V stands for, µm: heights are in volts then.
    pub um_per_volt: Option<f64>,
    /// The unit of places.
    pub x_unit: Option<LengthUnit>,
    /// The unit of heights.
    pub height_unit: Option<Unit>,
    /// The decimal sign.
    pub decimal: Option<DecimalSign>,
    /// What the columns are.
    pub columns: Option<Vec<ColumnRole>>,
    /// How return strokes are stored whose places rise.
    pub return_order: Option<ReturnOrder>,
}

/// What a file holds: an axis, and one way along it or whatever its columns say.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct KesPlace {
    /// Warp or weft.
    pub axis: TextileAxis,
    /// Out or back.
    pub side: Option<StrokeSide>,
}

/// How the rows of a return stroke follow one another.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum ReturnOrder {
    /// As they were measured, from the turn back.
    Travel,
    /// Mirrored: by their places on the textile, like the way out.
    Mirrored,
}

/// An error that asks: what is wrong, where, and what must be said.
pub(crate) fn asks(path: &Path, line: usize, what: impl Into<String>, ask: KesAsk) -> TextileError {
    TextileError::Kes {
        path: PathBuf::from(path),
        line,
        what: what.into(),
        ask,
    }
}

/// Whether a text may be an export of the tester: columns that are strokes by their names or by
/// their number, none of which marks valid points, under no header of a matrix.
pub(crate) fn is_export(bytes: &[u8]) -> bool {
    let path = Path::new("-");
    let Ok(text) = text::text_of(bytes, path) else {
        return false;
    };
    let table = match table_of(&text, None) {
        Ok(table) => table,
        Err(NoTable::Ambiguous { .. }) => return true,
        Err(_) => return false,
    };
    let is_foreign = |line: &String| {
        let words = columns::tokens(line);
        let is_word = |word: &String| matches!(word.as_str(), "valid" | "width" | "channel");
        words.iter().any(is_word)
    };
    !table.header.iter().any(is_foreign) && columns::columns_of(&table, None).is_ok()
}
