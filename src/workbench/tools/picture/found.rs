//! What was made of a picture, stage by stage.

use std::sync::Arc;

use crate::bench::keep::NewTextile;
use crate::kit::widgets::relief3d::Relief3d;
use crate::tools::picture::draft::Draft;
use crate::tools::picture::images::Image;
use selvedge_foundation::numerics::Grid;
use selvedge_textile::picture::{
    Autocorrelation, Directions, Found as Tiled, Lattice, Maxima, Picture, Relief,
    SignificantMaxima, Turned, TurnedPicture,
};
use selvedge_textile::surface::Direction;

/// A step of the pane.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Step {
    /// Which picture.
    Picture = 1,
    /// Light and height.
    Light = 4,
    /// The textile.
    Felt = 5,
}

/// The decoded picture.
#[derive(Debug)]
pub(crate) struct Loaded {
    pub(crate) picture: Picture,
    pub(crate) sha256: String,
    /// As it is shown.
    pub image: Image,
    /// Columns and rows.
    pub size: [usize; 2],
}

/// The part that is looked at, and its autocorrelation.
#[derive(Debug)]
pub(crate) struct Correlated {
    pub(crate) picture: Picture,
    pub(crate) luminance: Grid<f64>,
    /// Whether its light was evened out.
    pub was_evened: bool,
    /// The autocorrelation and its maxima; why there are none.
    pub(crate) read: Result<(Autocorrelation, Maxima, SignificantMaxima), String>,
}

/// Directions, lattice and tile.
#[derive(Debug, Clone)]
pub(crate) struct Cloth {
    /// The autocorrelation, and the shift at its edge, px.
    pub correlation: Option<(Image, usize)>,
    /// The maxima that count, px and height, the most dominant first.
    pub maxima: Vec<([f64; 2], f64)>,
    /// Directions by both measures.
    pub directions: Option<Directions>,
    /// The lattice that is found by itself, if one is, and those next to it, each with a piece of
    /// the cloth that it folds the picture to.
    pub(crate) found_by_itself: Option<Lattice>,
    pub(crate) offered: Vec<(Lattice, Image)>,
    /// Lattice and tile; why there are none, in a sentence.
    pub found: Result<Box<Tiled>, String>,
    /// The lattice on the picture, cloth of the tile, what that leaves.
    pub images: Option<[Image; 3]>,
    /// Pixels of the picture along the images.
    pub(crate) shown_px: f64,
    /// Whether other lattices were not looked for yet, and bent cloth is not laid straight.
    pub(crate) is_first: bool,
}

/// A textile, ready to be kept.
#[derive(Debug)]
pub(crate) struct Made {
    /// Its files.
    pub textile: Arc<Vec<NewTextile>>,
    /// What was cut from the photograph, and what is felt of it under the same lamp.
    pub(crate) compared: [Image; 2],
    /// The relief in its true scale.
    pub relief: Relief3d,
    /// From the lowest to the highest point, µm.
    pub relief_um: f64,
    /// Mean roughness of the four strokes, µm.
    pub smd_um: f64,
    /// How far levels may be off, in a line, and what to do where that is far.
    pub known: [Option<String>; 2],
    /// Heights along the strokes with their step: µm and mm.
    pub profiles: Vec<(Direction, Vec<f64>, f64)>,
}

/// A further picture laid over the first and as a textile names it; why it could not be.
pub(crate) type Laid = Result<(Turned, TurnedPicture), String>;

/// What was made of a draft, as far as it went.
#[derive(Debug, Clone, Default)]
pub(crate) struct Found {
    /// Of what.
    pub(crate) inputs: Draft,
    /// Stage by stage.
    pub loaded: Option<Arc<Loaded>>,
    /// See [`Correlated`].
    pub correlated: Option<Arc<Correlated>>,
    /// See [`Cloth`].
    pub cloth: Option<Arc<Cloth>>,
    /// Further pictures, one for each that was chosen: laid over the first, or why not.
    pub(crate) turned: Option<Arc<Vec<Laid>>>,
    /// Heights in pixels, and what they were found on.
    pub shaped: Option<Arc<Relief>>,
    /// See [`Made`].
    pub made: Option<Arc<Made>>,
    /// What is wrong, where.
    pub failure: Option<(Step, String)>,
    /// Whether stages are still to come.
    pub(crate) is_partial: bool,
}

impl Found {
    /// Nothing but what is wrong.
    pub(crate) fn failed(inputs: Draft, step: Step, line: String) -> Self {
        Self {
            failure: Some((step, line)),
            ..Self::begun(inputs)
        }
    }

    pub(crate) fn begun(inputs: Draft) -> Self {
        Self {
            inputs,
            ..Self::default()
        }
    }

    /// The lattice, once it is found.
    pub(crate) fn lattice(&self) -> Option<&Lattice> {
        let tiled = self.cloth.as_deref()?.found.as_deref().ok()?;
        Some(&tiled.lattice)
    }

    /// The picture's hash, once it is read.
    pub(crate) fn sha256(&self) -> Option<&str> {
        self.loaded.as_deref().map(|loaded| loaded.sha256.as_str())
    }
}
