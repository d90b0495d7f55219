//! Friction from a picture: how a trace is found from its spectra, what a worse picture costs, what
//! wider networks and longer training gain.

pub(crate) mod griffin_lim;
pub(crate) mod pictures;
pub(crate) mod training;
