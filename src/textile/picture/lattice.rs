//! The lattice of translations that repeat a picture, or why there is none.
//!
//! Candidates come from the directions (mean concentration and Hough) and from pairs of maxima; the
//! one that explains the maxima best is checked against finer and coarser lattices, fitted to all
//! maxima by least squares and reduced.

use serde::Serialize;

use super::autocorrelation::Autocorrelation;
use super::basis::{Basis, Place, length, mix};
use super::candidates::{Candidate, Method, judge, pairs, tolerance_px};
use super::directions::Directions;
use super::maxima::Maxima;
use super::multiples::{Evidence, coarser, finer};
use super::significant::SignificantMaxima;

/// Below this score the maxima are not those of a lattice.
const MIN_SCORE: f64 = 0.6;
/// Below this mean correlation at its points a lattice is not distinguished from chance.
const MIN_LEVEL: f64 = 0.05;
/// Between lattice points the correlation must fall by at least this share of its mean there.
const MIN_CONTRAST: f64 = 0.12;
/// A picture must hold this many cells.
const MIN_CELLS: f64 = 5.0;
/// A picture smaller than this on one side cannot hold two repeats that are distinguished.
const MIN_SIDE: usize = 12;
/// A variance below this (of luminance 0…1) is that of one colour.
const MIN_VARIANCE: f64 = 1e-7;

/// Why a picture has no lattice.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum NoLattice {
    /// Too few pixels.
    #[error("the picture is too small to hold repeats: {0} × {1} pixels")]
    TooSmall(usize, usize),
    /// Nothing varies.
    #[error("the picture is of one colour")]
    OneColour,
    /// No shift repeats anything.
    #[error(
        "no shift up to half the picture repeats it: it holds less than two periods, or threads \
         are not resolved in it"
    )]
    NothingRepeats,
    /// Maxima that no lattice explains.
    #[error(
        "threads are not resolved in this picture: what repeats in it (score {score:.2} where \
         0.60 is needed) is not told from chance"
    )]
    NotResolved {
        /// The best candidate's score.
        score: f64,
    },
    /// A correlation that is too small.
    #[error(
        "threads are not resolved in this picture: the best lattice repeats it with a correlation \
         of {level:.3} only"
    )]
    Weak {
        /// Mean correlation at the points of the best lattice.
        level: f64,
    },
    /// Stripes, not threads that cross.
    #[error(
        "the picture repeats along one direction only: along the other it is as even between \
         repeats"
    )]
    OneDirection,
    /// Every vector points the same way.
    #[error("the vectors that repeat the picture are parallel or nearly so")]
    Parallel,
    /// The period is too long for the picture.
    #[error(
        "too few repeats: the picture holds {cells:.1} cells of the lattice where 5 are needed"
    )]
    TooFewRepeats {
        /// Cells in the picture.
        cells: f64,
    },
}

/// The lattice that repeats a picture.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Lattice {
    /// The shorter vector, px: x right, y down.
    pub p1_px: Place,
    /// The longer vector, px.
    pub p2_px: Place,
    /// 0 to 1: the score, lowered by a faint contrast and by a method of directions that disagrees.
    pub confidence: f64,
    /// What proposed it.
    pub method: &'static str,
    /// Whether the directions by mean concentration span the same lattice (or the one it was found
    /// to be a multiple of).
    pub(crate) concentration_agrees: bool,
    /// Whether the directions by Hough transform do.
    pub(crate) hough_agrees: bool,
    /// Mean correlation at its points within a few periods.
    pub level: f64,
    /// The largest of the mean correlations half-way between its points.
    pub(crate) level_between: f64,
    /// Share of the maxima that it explains.
    pub cover: f64,
    /// Share of its points that are maxima.
    pub hit: f64,
}

impl Lattice {
    /// Its vectors.
    pub fn basis(&self) -> Basis {
        Basis::new(self.p1_px, self.p2_px)
    }

    /// The same lattice with other vectors, refined ones for example.
    #[must_use]
    pub(crate) fn with_basis(mut self, basis: Basis) -> Self {
        (self.p1_px, self.p2_px) = (basis.p1, basis.p2);
        self
    }

    /// Whether it is worth looking for a lattice at all.
    ///
    /// # Errors
    /// The picture is tiny or of one colour.
    pub fn worth_looking(width: usize, height: usize, variance: f64) -> Result<(), NoLattice> {
        if width.min(height) < MIN_SIDE {
            return Err(NoLattice::TooSmall(width, height));
        }
        if variance.partial_cmp(&MIN_VARIANCE) != Some(std::cmp::Ordering::Greater) {
            return Err(NoLattice::OneColour);
        }
        Ok(())
    }

    /// Finds the lattice.
    ///
    /// # Errors
    /// There is none; that is an answer.
    pub fn find(
        rho: &Autocorrelation,
        maxima: &Maxima,
        significant: &SignificantMaxima,
        directions: &Directions,
    ) -> Result<Self, NoLattice> {
        let evidence = Evidence {
            rho,
            maxima,
            significant,
        };
        let (first, method) = best(&evidence, directions)?;
        if first.score() < MIN_SCORE {
            return Err(NoLattice::NotResolved {
                score: first.score(),
            });
        }
        let basis = coarser(&evidence, finer(&evidence, first.basis));
        let (level, between) = levels(&evidence, &basis)?;
        let cells = 4.0 * rho.reach()[0] as f64 * rho.reach()[1] as f64 / basis.area();
        if cells < MIN_CELLS {
            return Err(NoLattice::TooFewRepeats { cells });
        }
        let tolerance = 0.15 * first.basis.shorter();
        let agrees = |other: Option<Basis>| {
            let same = |b: Basis| {
                [basis, first.basis]
                    .iter()
                    .any(|a| a.distance_to(&b.reduced()) < tolerance)
            };
            other.is_some_and(same)
        };
        let concentration_agrees = agrees(directions.by_concentration.basis);
        let hough_agrees = agrees(directions.by_hough.basis);
        let contrast = ((level - between) / level).clamp(0.0, 1.0);
        let n_agree = f64::from(u8::from(concentration_agrees) + u8::from(hough_agrees));
        Ok(Self {
            p1_px: basis.p1,
            p2_px: basis.p2,
            confidence: first.score() * (2.0 * contrast).min(1.0).sqrt() * (0.8 + 0.1 * n_agree),
            method: method.name(),
            concentration_agrees,
            hough_agrees,
            level,
            level_between: between,
            cover: first.cover,
            hit: first.hit,
        })
    }
}

/// The candidate that explains the maxima best; of equals the one from directions.
fn best(
    evidence: &Evidence<'_>,
    directions: &Directions,
) -> Result<(Candidate, Method), NoLattice> {
    let significant = evidence.significant;
    if significant.all().is_empty() {
        return Err(NoLattice::NothingRepeats);
    }
    let longest = evidence.rho.radius();
    let of = |method: Method, basis: Basis| {
        let found = judge(evidence.maxima, significant, basis, longest)?;
        Some((found, method))
    };
    let proposed = [
        (Method::MeanConcentration, directions.by_concentration.basis),
        (Method::Hough, directions.by_hough.basis),
    ];
    let from_directions = proposed
        .into_iter()
        .filter_map(|(method, basis)| of(method, basis?));
    let from_pairs = pairs(significant)
        .into_iter()
        .filter_map(|basis| of(Method::Pair, basis));
    // A pair must explain clearly more than the directions to be preferred.
    let rank = |(found, method): &(Candidate, Method)| {
        let bonus = if *method == Method::Pair { 0.0 } else { 0.02 };
        found.score() + bonus
    };
    let all = from_directions.chain(from_pairs);
    let best = all.fold(None, |best: Option<(Candidate, Method)>, next| match best {
        Some(best) if rank(&best) >= rank(&next) => Some(best),
        _ => Some(next),
    });
    best.ok_or_else(|| {
        if are_on_a_line(significant) {
            NoLattice::Parallel
        } else if significant.all().len() > 2 {
            NoLattice::NotResolved { score: 0.0 }
        } else {
            NoLattice::NothingRepeats
        }
    })
}

/// Whether all maxima, and there are some, lie about on one line through the origin.
fn are_on_a_line(significant: &SignificantMaxima) -> bool {
    let all = significant.all();
    let Some(longest) = all.last().map(|m| m.place).filter(|_| all.len() > 2) else {
        return false;
    };
    let off = |p: Place| (p[0] * longest[1] - p[1] * longest[0]).abs() / length(longest);
    all.iter()
        .all(|m| off(m.place) <= 0.2 * length(m.place).max(1.0))
}

/// Mean correlation at the points of a lattice, and the largest half-way between them.
fn levels(evidence: &Evidence<'_>, basis: &Basis) -> Result<(f64, f64), NoLattice> {
    let reach = evidence.near(basis);
    let level = evidence.level(basis, reach, [0.0; 2]);
    let half = |a: f64, b: f64| mix(basis.p1, 0.5 * a, basis.p2, 0.5 * b);
    let tolerance = tolerance_px(basis);
    // Half-way along a diagonal there may be a lower maximum, as from thread to thread in a weave.
    let is_even = |place: Place| evidence.maxima.nearest(place, tolerance).is_none();
    let diagonals = [half(1.0, 1.0), half(1.0, -1.0)];
    let diagonals = diagonals.into_iter().filter(|&place| is_even(place));
    let halves = [half(1.0, 0.0), half(0.0, 1.0)]
        .into_iter()
        .chain(diagonals);
    let between = halves.map(|half| evidence.level(basis, reach, half));
    let between = between.fold(f64::NEG_INFINITY, f64::max);
    if level.is_nan() || level < MIN_LEVEL {
        return Err(NoLattice::Weak { level });
    }
    if level - between < MIN_CONTRAST * level {
        return Err(NoLattice::OneDirection);
    }
    Ok((level, between))
}
