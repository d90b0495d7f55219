//! How irregular a cloth is whose recipe does not say, woven or knitted.

/// Standard deviation of crimp or loop size from place to place, share.
pub fn tension_drift() -> f64 {
    0.1
}

/// Over what length tension and bow change, mm.
pub fn drift_mm() -> f64 {
    4.0
}

/// Standard deviation of the places of yarns, share of their pitch.
pub fn pitch_cv() -> f64 {
    0.05
}

/// Size of the puckers, mm.
pub fn pucker_mm() -> f64 {
    2.0
}

/// Noise of the probe, µm rms.
pub fn noise_um() -> f64 {
    0.2
}
