//! The four directions in which a textile is stroked, and whether that is all that is felt.

use selvedge_foundation::named;
use serde::{Deserialize, Serialize};

named! {
    /// A principal direction of a stroke over a textile.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
    pub enum Direction {
        /// Along the warp, u rising.
        WarpForward = "warp forward", "warp_forward",
        /// Along the warp, u falling.
        WarpReverse = "warp reverse", "warp_reverse",
        /// Along the weft, w rising.
        WeftForward = "weft forward", "weft_forward",
        /// Along the weft, w falling.
        WeftReverse = "weft reverse", "weft_reverse",
    }
    /// The name of the direction for people.
    pub fn label;
    /// The name of the direction as files spell it.
    pub fn key;
}

impl Direction {
    /// Forward and reverse along the warp, then along the weft.
    pub(crate) const BY_AXIS: [[Self; 2]; 2] = [
        [Self::WarpForward, Self::WarpReverse],
        [Self::WeftForward, Self::WeftReverse],
    ];

    /// Whether the stroke runs along the weft.
    pub(crate) fn is_weft(self) -> bool {
        matches!(self, Self::WeftForward | Self::WeftReverse)
    }

    /// 0 … 3.
    pub fn index(self) -> usize {
        self as usize
    }

    /// Whether the stroke runs against its axis.
    pub fn is_reverse(self) -> bool {
        matches!(self, Self::WarpReverse | Self::WeftReverse)
    }
}

/// How the spectra of a surface that is known over an area are laid out.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Representation {
    /// One profile a direction, repeated across: what the tester measures.
    #[default]
    Economical,
    /// Spectra at every point of a grid.
    Areal,
}

impl Representation {
    /// The words of files, in order.
    pub(crate) const WORDS: &'static [&'static str] = &["economical", "areal"];

    /// Whether files need not say it.
    #[expect(clippy::trivially_copy_pass_by_ref, reason = "as serde calls it")]
    pub(crate) fn is_default(&self) -> bool {
        *self == Self::default()
    }
}
