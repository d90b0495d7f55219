//! The two vibrotactile channels: what of a surface's spectrum a fingertip is given, and how loud.
//!
//! A surface moved under the skin is heard by two filters around 40 and 320 Hz; levels say how
//! strong a textile is as a whole; tuning says how strong the user wants it.
//!
//! # Invariants
//! - no scenes, no devices
//! - amplitudes are peak, µm; gains are applied to amplitudes, never to spectra
//! - a speed that cannot be felt (below 0.01 mm/s, at or above 1000/0.23 mm/s, NaN) gives exactly 0

mod filters;
mod levels;
mod perception;
mod response;
mod tuning;

pub use filters::Filters;
pub(crate) use levels::level_of_means;
pub use levels::{LEVEL_SPEED_MM_PER_S, Levels, loudest_um};
pub use perception::{Perception, just_noticeable_db, vibrating_mean_um};
pub use response::{
    MAX_FREQUENCY_HZ, MAX_SPEED_MM_PER_S, MIN_SPEED_MM_PER_S, SpeedResponse, n_audible_bins,
};
pub use tuning::{Tuning, TuningError};

/// One of the two carriers and the filter around it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Band {
    /// 40 Hz.
    Low,
    /// 320 Hz.
    High,
}

impl Band {
    /// Both, in the order of their indices.
    pub const ALL: [Self; 2] = [Self::Low, Self::High];

    /// 0 for 40 Hz, 1 for 320 Hz.
    pub fn index(self) -> usize {
        self as usize
    }

    /// The carrier and the centre of the filter, Hz.
    pub fn carrier_hz(self) -> f64 {
        match self {
            Self::Low => 40.0,
            Self::High => 320.0,
        }
    }
}
