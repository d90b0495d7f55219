//! All stages in a row: from a picture to its lattice and its tile.
//!
//! Every stage takes what the one before made and its own parameters, so that whoever changes a
//! parameter runs the later ones again only.

use super::autocorrelation::Autocorrelation;
use super::basis::{Basis, mix};
use super::colour::PeriodicColour;
use super::directions::{DirectionOptions, Directions};
use super::lattice::{Lattice, NoLattice};
use super::light::{EvenLight, even_light};
use super::maxima::Maxima;
use super::part::flattest;
use super::significant::SignificantMaxima;
use super::source::Picture;
use super::tile::Tile;
use super::unwarp::{self, Unwarped};
use selvedge_foundation::numerics::Grid;
use selvedge_foundation::progress::{Cancelled, Progress};

/// What an analysis takes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AnalysisOptions {
    /// Whether uneven light is divided out.
    pub light: EvenLight,
    /// How directions are measured.
    pub directions: DirectionOptions,
    /// Threads; the result is the same for any number.
    pub n_threads: usize,
}

/// What was found in a picture, stage by stage.
#[derive(Debug, Clone)]
pub struct Analysis {
    /// The picture in even light.
    pub luminance: Grid<f64>,
    /// Whether its light was evened out.
    pub was_evened: bool,
    /// What could be measured; none of a picture that is tiny or of one colour.
    pub measured: Option<Measurements>,
    /// The lattice and its tile, or why there is none.
    pub found: Result<Found, NoLattice>,
}

/// The autocorrelation and what was read from it.
#[derive(Debug, Clone)]
pub struct Measurements {
    /// The matrix.
    pub rho: Autocorrelation,
    /// Its maxima.
    pub maxima: Maxima,
    /// Those that count.
    pub significant: SignificantMaxima,
    /// The directions that they lie in.
    pub directions: Directions,
}

/// A lattice, its tile, and what they explain.
#[derive(Debug, Clone)]
pub struct Found {
    /// The lattice, refined on the whole picture.
    pub lattice: Lattice,
    /// The vectors before that.
    pub from_maxima: [[f64; 2]; 2],
    /// The mean cell: of the whole picture, or of the part that lies flat.
    pub tile: Tile,
    /// Share of the variance of the whole picture, laid straight where the cloth was bent, that the
    /// mean of all its cells explains.
    pub explained_variance: f64,
    /// The picture laid straight, where the cloth is bent and that explains more.
    pub unwarped: Option<Unwarped>,
    /// Where repeats drift over the picture: the part that the tile is the mean of (left, top,
    /// width, height, px), and the share of its variance that the tile explains.
    pub flat_part: Option<([usize; 4], f64)>,
    /// How much colour varies with it.
    pub colour: PeriodicColour,
}

impl Measurements {
    /// Correlates a picture and reads the maxima.
    ///
    /// # Errors
    /// The work was cancelled.
    pub(crate) fn of(
        luminance: &Grid<f64>,
        options: DirectionOptions,
        n_threads: usize,
        progress: &mut Progress<'_>,
    ) -> Result<Self, Cancelled> {
        progress.step(0.1, "correlating")?;
        let rho = Autocorrelation::of(luminance, n_threads);
        progress.step(0.5, "looking for maxima")?;
        let maxima = Maxima::of(&rho);
        let significant = SignificantMaxima::of(&maxima, &rho);
        progress.step(0.6, "measuring directions")?;
        let directions = Directions::of(&significant, options);
        Ok(Self {
            rho,
            maxima,
            significant,
            directions,
        })
    }

    /// The lattice.
    ///
    /// # Errors
    /// There is none.
    pub fn lattice(&self) -> Result<Lattice, NoLattice> {
        Lattice::find(&self.rho, &self.maxima, &self.significant, &self.directions)
    }
}

/// Where the mean cell explains less than this share of what near repeats agree in, the picture is
/// bent or uneven.
const DRIFT: f64 = 0.6;
/// And from this share on, nothing is to be gained by laying it straight.
const LIES_FLAT: f64 = 0.9;

/// Yarns that lie farther from the picture's rows are not taken for lying along them, radians.
const MAX_TURN: f64 = std::f64::consts::FRAC_PI_8;

impl Found {
    /// How far the yarns that lie along the picture's rows are turned, radians clockwise: by the
    /// short vector of the threads, or of the lattice, that is nearest to x. 0 if none is near.
    pub(crate) fn turn_rad(&self) -> f64 {
        let Basis { p1, p2 } = self
            .lattice
            .thread_grid
            .unwrap_or_else(|| self.lattice.basis());
        let vectors = [p1, p2, mix(p1, 1.0, p2, 1.0), mix(p1, 1.0, p2, -1.0)];
        let turns = vectors.map(|[x, y]| (y * x.signum()).atan2(x.abs()));
        let nearest = turns.into_iter().min_by(|a, b| a.abs().total_cmp(&b.abs()));
        nearest.filter(|turn| turn.abs() <= MAX_TURN).unwrap_or(0.0)
    }

    /// A picture as its cells lie straight.
    pub fn laid<'a>(&'a self, luminance: &'a Grid<f64>) -> &'a Grid<f64> {
        let unwarped = self.unwarped.as_ref();
        unwarped.map_or(luminance, |unwarped| &unwarped.luminance)
    }

    /// Whether repeats drift over the picture, so that the mean of all cells is blurred.
    pub fn drifts(&self) -> bool {
        self.explained_variance < DRIFT * self.lattice.level
    }

    /// Refines a lattice on a picture, averages its cells and lays bent cloth straight: from 0.8 of
    /// the whole work on.
    ///
    /// # Errors
    /// The work was cancelled.
    pub fn of(
        luminance: &Grid<f64>,
        colour: Option<&Grid<[u16; 2]>>,
        lattice: Lattice,
        n_threads: usize,
        progress: &mut Progress<'_>,
    ) -> Result<Self, Cancelled> {
        let mut found = Self::averaged(luminance, colour, lattice, n_threads, progress)?;
        if !found.lies_flat() {
            found.lay(luminance, n_threads, progress)?;
        }
        Ok(found)
    }

    /// Whether nothing is to be gained by laying it straight.
    pub fn lies_flat(&self) -> bool {
        self.explained_variance >= LIES_FLAT * self.lattice.level
    }

    /// Refines a lattice on a picture and averages its cells, bent as they may be.
    ///
    /// # Errors
    /// The work was cancelled.
    pub fn averaged(
        luminance: &Grid<f64>,
        colour: Option<&Grid<[u16; 2]>>,
        lattice: Lattice,
        n_threads: usize,
        progress: &mut Progress<'_>,
    ) -> Result<Self, Cancelled> {
        let all = |share: f64| progress.step(0.8 + 0.06 * share, "averaging the cells");
        let (whole, explained_variance) = Tile::refine(luminance, lattice.basis(), n_threads, all)?;
        let basis = whole.basis();
        let colour = PeriodicColour::of(&whole, colour, basis, n_threads);
        let from_maxima = [lattice.p1_px, lattice.p2_px];
        let drifts = explained_variance < DRIFT * lattice.level;
        Ok(Self {
            lattice: if drifts {
                lattice
            } else {
                lattice.with_basis(basis)
            },
            from_maxima,
            flat_part: None,
            tile: whole,
            explained_variance,
            unwarped: None,
            colour,
        })
    }

    /// Lays bent cloth straight, or looks for its flattest part: from 0.86 of the whole work on.
    ///
    /// # Errors
    /// The work was cancelled.
    pub fn lay(
        &mut self,
        luminance: &Grid<f64>,
        n_threads: usize,
        progress: &mut Progress<'_>,
    ) -> Result<(), Cancelled> {
        let wanted = LIES_FLAT * self.lattice.level;
        let basis = self.lattice.basis();
        let parts = |share: f64| progress.step(0.86 + 0.07 * share, "looking for a flat part");
        let Some(flat) = flattest(luminance, basis, wanted, n_threads, parts)? else {
            return Ok(());
        };
        let lattices = (&self.lattice, self.tile.basis());
        let bent = |share: f64| progress.step(0.93 + 0.07 * share, "laying bent cloth straight");
        let straight = unwarp::straight(luminance, lattices, &flat, n_threads, bent)?;
        let least = self.explained_variance.max(DRIFT * flat.explained_variance);
        match straight.filter(|all| all.explained_variance > least) {
            Some(straight) => {
                self.lattice = self.lattice.with_basis(straight.tile.basis());
                self.tile = straight.tile;
                self.explained_variance = straight.explained_variance;
                self.unwarped = Some(straight.unwarped);
            }
            None if self.drifts() && flat.explained_variance > self.explained_variance => {
                self.flat_part = Some((flat.place, flat.explained_variance));
                self.tile = flat.tile;
            }
            None => {}
        }
        Ok(())
    }
}

impl Analysis {
    /// Runs every stage.
    ///
    /// # Errors
    /// The work was cancelled. A picture without a lattice is no error.
    pub fn of(
        Picture { luminance, colour }: Picture,
        options: &AnalysisOptions,
        progress: &mut Progress<'_>,
    ) -> Result<Self, Cancelled> {
        progress.step(0.0, "evening out the light")?;
        let (luminance, was_evened) = even_light(luminance, options.light);
        if let Err(reason) = Lattice::worth_looking(&luminance) {
            return Ok(Self {
                luminance,
                was_evened,
                measured: None,
                found: Err(reason),
            });
        }
        let measured =
            Measurements::of(&luminance, options.directions, options.n_threads, progress)?;
        progress.step(0.7, "fitting the lattice")?;
        let lattice = measured.lattice();
        let found = match lattice {
            Ok(lattice) => Ok(Found::of(
                &luminance,
                colour.as_ref(),
                lattice,
                options.n_threads,
                progress,
            )?),
            Err(reason) => Err(reason),
        };
        progress.step(1.0, "done")?;
        Ok(Self {
            luminance,
            was_evened,
            measured: Some(measured),
            found,
        })
    }
}
