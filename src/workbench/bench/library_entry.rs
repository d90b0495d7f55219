//! A textile of a library as panes draw it: what its manifest and the index say, and its dot on the
//! compression curve.

use std::sync::Arc;

use selvedge_textile::MeasuredFigure;

/// A textile of the library as the library shows it.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct LibraryEntry {
    /// What scenes call it.
    pub id: String,
    /// The library that it stands in, as people call it.
    pub(crate) home: Arc<str>,
    /// What people call it.
    pub name: String,
    /// How it is made and of what, in a few words.
    pub kind: String,
    /// How it is made, as files spell it; empty when its manifest cannot be read.
    pub construction: &'static str,
    /// Its weave or knit in words; `None` for what is no cloth of yarns.
    pub structure: Option<&'static str>,
    /// The figures that its manifest states, in the testers' order.
    pub measured: Vec<MeasuredFigure>,
    /// The gain that its manifest states, dB.
    pub gain_db: f64,
    /// Its level by the library's index, dB re 1 µm.
    pub level_db: Option<f64>,
    /// Its mean amplitudes by the library's index, without any gain, µm.
    pub mean_um: [f64; 2],
    /// Why it cannot be used.
    pub flaw: Option<String>,
}

/// A textile of the library as the compression curve shows it.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct LibraryDot {
    /// What scenes call it.
    pub id: String,
    /// The textile's name.
    pub name: String,
    /// Its mean amplitudes without any gain, µm.
    pub mean_um: [f64; 2],
    /// The gain that its manifest states, dB.
    pub gain_db: f64,
    /// Its level, dB re 1 µm.
    pub level_db: f64,
    /// Whether the scene places it.
    pub is_placed: bool,
}
