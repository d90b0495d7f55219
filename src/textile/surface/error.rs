//! Why heights are no surface.

/// The highest height, up or down, µm: far above anything physical, and so far below what single
/// precision holds that no power, gain or amplitude of a surface overflows.
pub(super) const MAX_HEIGHT_UM: f64 = 1e13;

/// What can be wrong with a surface.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum SurfaceError {
    /// The samples lie too close or too far apart.
    #[error("the step is {step_mm:?} mm; sample at 0.0005 to 0.5 mm")]
    Step {
        /// The step found, mm.
        step_mm: f64,
    },
    /// The samples are not evenly spaced.
    #[error(
        "row {row} of {n_rows}: x rises by {step_mm} mm where the mean step is {mean_mm} mm; \
         resample to even steps (within 1 %)"
    )]
    Uneven {
        /// The row, from 1.
        row: usize,
        /// How many rows there are.
        n_rows: usize,
        /// The step to it, mm.
        step_mm: f64,
        /// The mean step, mm.
        mean_mm: f64,
    },
    /// A height is NaN or infinite.
    #[error("row {row} of {n_rows}: the height is {height_um}; fill or cut missing points")]
    NotFinite {
        /// The row, from 1.
        row: usize,
        /// How many rows there are.
        n_rows: usize,
        /// The height found, µm.
        height_um: f64,
    },
    /// A height that no surface has.
    #[error(
        "row {row} of {n_rows}: the height is {height_um:e} µm; check its unit, heights end at \
         1e13 µm (ten thousand kilometres)"
    )]
    TooHigh {
        /// The row, from 1.
        row: usize,
        /// How many rows there are.
        n_rows: usize,
        /// The height found, µm.
        height_um: f64,
    },
    /// The profile is shorter than one window.
    #[error(
        "{n_samples} samples where one window takes {n_window}; \
         measure at least 4.35 mm (20 mm give 16 points)"
    )]
    TooShort {
        /// How many samples there are.
        n_samples: usize,
        /// How many one window takes.
        n_window: usize,
    },
    /// A friction trace of less than two samples.
    #[error("{n_rows} samples of friction; at least two are needed")]
    TooFew {
        /// How many there are.
        n_rows: usize,
    },
    /// A coefficient of friction that none can be.
    #[error(
        "row {row} of {n_rows}: the friction is {mu}; give the coefficient, force over load, \
         from -10 to 10"
    )]
    NoFriction {
        /// The row, from 1.
        row: usize,
        /// How many rows there are.
        n_rows: usize,
        /// What was found.
        mu: f64,
    },
    /// A height map without a single height.
    #[error("every height is missing; there is no surface to feel")]
    AllMissing,
    /// Neither warp profile is there.
    #[error("no warp profile; give warp_forward or warp_reverse")]
    NoWarp,
}
