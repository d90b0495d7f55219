//! Studies of surfaces that are made from numbers: Brownian generators, Fourier coefficients,
//! restoration, resampling, and the virtual probe that is drawn over any of them.
//!
//! Each is set beside a truth that is known: an exponent, a sum of waves, a formula.

mod brownian;
mod drawn;
mod fourier;
mod probe;
mod resampling;
mod restoration;
#[cfg(test)]
mod tests;

pub(crate) use brownian::STUDY as BROWNIAN;
pub(crate) use drawn::STUDY as DRAWN;
pub(crate) use fourier::STUDY as FOURIER;
pub(crate) use probe::STUDY as PROBE;
pub(crate) use resampling::STUDY as RESAMPLING;
pub(crate) use restoration::STUDY as RESTORATION;
