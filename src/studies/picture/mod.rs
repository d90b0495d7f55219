//! Cloth from pictures: the autocorrelation, the lattice, how small a picture may be, and the way
//! of pictures beside that of the surface tester.
//!
//! Every picture is drawn of something that is known: a formula with a lattice, a model cloth with
//! a relief.

mod autocorrelation;
mod costs;
mod drawings;
mod lattice;
mod route;
mod scale;
mod spoilt;
mod sweeps;
#[cfg(test)]
mod tests;
mod weaves;
mod woven;

pub(crate) use autocorrelation::STUDY as AUTOCORRELATION;
pub(crate) use lattice::STUDY as LATTICE;
pub(crate) use route::STUDY as ROUTE;
pub(crate) use scale::STUDY as SCALE;
pub(crate) use weaves::STUDY as WEAVES;

use selvedge_foundation::numerics::Grid;
use selvedge_foundation::progress::Progress;
use selvedge_textile::picture::{
    Analysis, AnalysisOptions, Basis, DirectionOptions, EvenLight, Picture,
};

/// A lattice whose vectors are this share of its shorter one away from the truth is another.
const RIGHT: f64 = 0.05;

/// The whole analysis of a picture, on one thread; nothing where it was cancelled.
pub(crate) fn analysed(luminance: &Grid<f64>) -> Option<Analysis> {
    let options = AnalysisOptions {
        light: EvenLight::Auto,
        directions: DirectionOptions::default(),
        n_threads: 1,
    };
    let picture = Picture::grey(luminance.clone());
    Progress::unheard(|progress| Analysis::of(picture, &options, progress)).ok()
}

/// How far a lattice is from the truth, as a share of the truth's shorter vector; 1 of none, and
/// of what is farther than that.
pub(crate) fn share_off(truth: &Basis, found: Option<Basis>) -> f64 {
    let off = found.map_or(f64::INFINITY, |found| {
        truth.distance_to(&found.reduced()) / truth.shorter()
    });
    // Not a number is no lattice.
    if off < 1.0 { off } else { 1.0 }
}
