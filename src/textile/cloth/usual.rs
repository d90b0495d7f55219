//! How irregular a cloth is whose recipe does not say, woven or knitted.

/// Standard deviation of crimp or loop size from place to place, share.
pub(crate) fn tension_drift() -> f64 {
    0.1
}

/// Over what length tension and bow change, mm.
pub(crate) fn drift_mm() -> f64 {
    4.0
}

/// Standard deviation of the places of yarns, share of their pitch.
pub(crate) fn pitch_cv() -> f64 {
    0.05
}

/// Size of the puckers, mm.
pub(crate) fn pucker_mm() -> f64 {
    2.0
}

/// Noise of the probe, µm rms.
pub(crate) fn noise_um() -> f64 {
    0.2
}
