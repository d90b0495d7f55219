//! Signals of the contactor that is looked at closer: the spectrum that arrives, the spectrum and
//! the waveform that drive, and the spatial spectra under it.

pub(crate) mod contact;
pub(crate) mod drive;
pub(crate) mod export_spatial;
pub(crate) mod export_spectrograms;
pub(crate) mod spatial;
#[cfg(test)]
mod tests;
pub(crate) mod wave;
