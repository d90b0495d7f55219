//! Why no shape was found.

use selvedge_foundation::progress::Cancelled;

/// Most points of a tile: 4096 × 4096.
pub(super) const MAX_POINTS: usize = 1 << 24;

/// Why no shape was found.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ShadingError {
    /// No pixel.
    #[error("the tile has no pixel; give one of at least 1 × 1")]
    Empty,
    /// Too many.
    #[error("{width} × {height} pixels are more than {MAX_POINTS}; scale the picture down")]
    TooLarge {
        /// Columns.
        width: usize,
        /// Rows.
        height: usize,
    },
    /// A brightness that none is.
    #[error("row {row}, column {column}: brightness is {value}; give 0 (black) to 1 (white)")]
    Brightness {
        /// The row, from 1.
        row: usize,
        /// The column, from 1.
        column: usize,
        /// What is there.
        value: f64,
    },
    /// All black.
    #[error("the tile is black, so it shows no shading; give a picture with light in it")]
    Black,
    /// A light that is none.
    #[error("the light's {key} is {value}°; give {range}")]
    Light {
        /// `slant` or `tilt`.
        key: &'static str,
        /// What was given.
        value: f64,
        /// What is possible.
        range: &'static str,
    },
    /// Light from the front.
    #[error(
        "light from the front (slant {slant_deg:.1}°) shows no direction of slopes; \
         take a picture with the light at 30° to 60° from the vertical"
    )]
    Frontal {
        /// The slant.
        slant_deg: f64,
    },
    /// The light along which Tsai & Shah's iteration stands still.
    #[error(
        "Tsai & Shah's iteration stands still under this light (cos tilt + sin tilt ≈ 0, at 135° \
         or −45°, or nearly frontal); turn the picture by 90°, or take another method"
    )]
    Singular,
    /// A number out of range.
    #[error("{key} is {value}; give {range}")]
    Option {
        /// Which.
        key: &'static str,
        /// What was given.
        value: f64,
        /// What is possible.
        range: &'static str,
    },
    /// No relief was found.
    #[error("the shape is flat, so there is nothing to feel; give a picture that shows shading")]
    Flat,
    /// Heights without a scale.
    #[error(
        "the heights are in pixels, unscaled; say the scale: the relief from the lowest to the \
         highest point in µm, or the roughness SMD that a surface tester reads, in µm"
    )]
    Unscaled,
    /// Too small a tile for a textile.
    #[error("{width} × {height} px are no relief; give a repeat of at least 2 × 2 px")]
    TooSmall {
        /// Columns.
        width: usize,
        /// Rows.
        height: usize,
    },
    /// A roughness that the relief never has.
    #[error(
        "no height of this relief reads an SMD of {smd_um} µm on the tester (the last try read \
         {found_um:.3} µm); its own noise reads about 0.16 µm: give another SMD, or the relief"
    )]
    Smd {
        /// What was asked for.
        smd_um: f64,
        /// What was read last.
        found_um: f64,
    },
    /// The work was stopped.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}
