//! The lattice of translations that repeat a picture, or why there is none.
//!
//! Candidates come from the directions (mean concentration and Hough) and from pairs of maxima; the
//! one that explains the maxima best is checked against finer and coarser lattices, fitted to all
//! maxima by least squares and reduced. Whether it is one at all, and whether it is the repeat of a
//! weave or only its threads, is for what it predicts where it was not looked at.

use selvedge_foundation::numerics::Grid;
use serde::Serialize;

use super::autocorrelation::Autocorrelation;
use super::basis::{Basis, Place, length, mix};
use super::calibration::Agreement;
use super::candidates::{Candidate, Method, judge, pairs, tolerance_px};
use super::directions::Directions;
use super::held_out::{self, HeldOut, Repeat};
use super::light::mean_and_variance;
use super::maxima::Maxima;
use super::multiples::{Evidence, coarser, finer};
use super::significant::SignificantMaxima;
use super::weave_name::weave_name;

/// Below this score the maxima are not those of a lattice.
const MIN_SCORE: f64 = 0.6;
/// Below this mean correlation at its points a lattice is not distinguished from chance.
const MIN_LEVEL: f64 = 0.05;
/// Between lattice points the correlation must fall by at least this share of its mean there.
const MIN_CONTRAST: f64 = 0.12;
/// What is explained where it was not looked at must be this share of the variance, and this share
/// of it without looking along the same threads.
const MIN_EXPLAINED: f64 = 0.05;
const MIN_APART: f64 = 0.4;
/// Maxima that a lattice explains badly may be those of bent cloth, if it is predicted this well.
const MIN_EXPLAINED_OF_POOR: f64 = 0.3;
/// Where a picture holds too few cells for that, the score must be higher.
const MIN_SCORE_OF_FEW: f64 = 0.9;
/// A coarser lattice must explain more by this factor, one that is another by that, each from this
/// many neighbours.
const MIN_GAIN_OF_COARSER: f64 = 1.015;
const MIN_GAIN_OF_OTHER: f64 = 1.15;
const MIN_NEIGHBOURS: usize = 9;
/// Candidates whose threads are looked for.
const N_STARTS: usize = 8;
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
    /// Maxima that predict nothing.
    #[error(
        "nothing repeats: the cells of the best lattice explain {share:.2} of what is beside them, \
         where {MIN_EXPLAINED} is needed"
    )]
    NotPredicted {
        /// Share of the variance.
        share: f64,
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
    /// The share of generated cloths with evidence like this whose lattice was right.
    pub confidence: f64,
    /// The share of generated pictures that repeat nowhere which were given a lattice on evidence
    /// of this kind.
    pub false_alarm_rate: f64,
    /// What proposed it.
    pub method: &'static str,
    /// The lattice from thread to thread, where it is finer.
    #[serde(skip)]
    pub thread_grid: Option<Basis>,
    /// Share of the variance that cells explain in the cells beside them; `None` where the picture
    /// holds too few.
    pub held_out: Option<f64>,
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

    /// What weavers call it, as far as it tells.
    pub fn weave_name(&self) -> Option<String> {
        weave_name(&self.thread_grid?, &self.basis())
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
    pub fn worth_looking(luminance: &Grid<f64>) -> Result<(), NoLattice> {
        let (width, height) = (luminance.width(), luminance.height());
        let variance = mean_and_variance(luminance).1;
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
        let candidates = candidates(&evidence, directions)?;
        let (first, method) = candidates[0];
        let finest = finer(&evidence, first.basis);
        let starts = starts(&evidence, finest, &candidates);
        let by_heights = coarser(&evidence, finest);
        let repeat = held_out::repeat(&evidence, &starts);
        let before = held_out::explained(&evidence, &by_heights);
        let (basis, agreement) = agreed(by_heights, &before[0], repeat.as_ref());
        let [explained, apart] = if agreement == Agreement::Predicted {
            held_out::explained(&evidence, &basis)
        } else {
            before
        };
        if first.score() < MIN_SCORE && explained.share < MIN_EXPLAINED_OF_POOR {
            return Err(NoLattice::NotResolved {
                score: first.score(),
            });
        }
        let (level, between) = levels(&evidence, &basis)?;
        let cells = 4.0 * rho.reach()[0] as f64 * rho.reach()[1] as f64 / basis.area();
        if cells < MIN_CELLS {
            return Err(NoLattice::TooFewRepeats { cells });
        }
        let is_known = explained.n_neighbours > 0;
        let is_predicted = explained.share >= MIN_EXPLAINED
            && (apart.n_neighbours == 0 || apart.share >= MIN_APART * explained.share);
        let is_sure = apart.n_neighbours > 0 || first.score() >= MIN_SCORE_OF_FEW;
        if (is_known && !is_predicted) || !is_sure {
            let share = explained.share.min(apart.share);
            return Err(NoLattice::NotPredicted { share });
        }
        let agreement = if is_known { agreement } else { Agreement::Few };
        Ok(Self {
            p1_px: basis.p1,
            p2_px: basis.p2,
            confidence: agreement.confidence(),
            false_alarm_rate: agreement.false_alarm_rate(),
            method: method.name(),
            thread_grid: held_out::thread_grid(&evidence, &starts, &basis),
            held_out: is_known.then_some(explained.share),
            level,
            level_between: between,
            cover: first.cover,
            hit: first.hit,
        })
    }
}

/// Lattices in which threads are looked for: the best candidates, each made finer and as it is.
fn starts(
    evidence: &Evidence<'_>,
    finest: Basis,
    candidates: &[(Candidate, Method)],
) -> Vec<Basis> {
    let mut starts = vec![finest];
    for (nth, (candidate, _)) in candidates.iter().enumerate() {
        let made = (nth > 0).then(|| finer(evidence, candidate.basis));
        for basis in made.into_iter().chain([candidate.basis]) {
            let is_known = |known: &Basis| known.distance_to(&basis) < 0.08 * known.shorter();
            if !starts.iter().any(is_known) {
                starts.push(basis);
            }
            if starts.len() == N_STARTS {
                return starts;
            }
        }
    }
    starts
}

/// The lattice that is to be believed, and why.
fn agreed(by_heights: Basis, before: &HeldOut, repeat: Option<&Repeat>) -> (Basis, Agreement) {
    let Some(repeat) = repeat else {
        return (by_heights, Agreement::Heights);
    };
    let basis = repeat.basis;
    if by_heights.distance_to(&basis) < 0.12 * basis.shorter() {
        return (by_heights, Agreement::Same);
    }
    let is_better = |factor: f64, of: &HeldOut| {
        repeat.explained.share >= factor * of.share
            && repeat.explained.n_neighbours >= MIN_NEIGHBOURS
    };
    let is_coarser = held_out::holds(&by_heights, &basis);
    let takes = repeat.stands_out
        && if is_coarser {
            is_better(MIN_GAIN_OF_COARSER, before)
        } else {
            before.n_neighbours >= MIN_NEIGHBOURS && is_better(MIN_GAIN_OF_OTHER, before)
        };
    if takes {
        (basis, Agreement::Predicted)
    } else {
        (by_heights, Agreement::Heights)
    }
}

/// Candidates, at least one: those that explain the maxima best first, of equals those from
/// directions.
pub(super) fn candidates(
    evidence: &Evidence<'_>,
    directions: &Directions,
) -> Result<Vec<(Candidate, Method)>, NoLattice> {
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
    let mut all: Vec<(Candidate, Method)> = from_directions.chain(from_pairs).collect();
    all.sort_by(|a, b| rank(b).total_cmp(&rank(a)));
    if all.is_empty() {
        return Err(if are_on_a_line(significant) {
            NoLattice::Parallel
        } else if significant.all().len() > 2 {
            NoLattice::NotResolved { score: 0.0 }
        } else {
            NoLattice::NothingRepeats
        });
    }
    Ok(all)
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
pub(super) fn levels(evidence: &Evidence<'_>, basis: &Basis) -> Result<(f64, f64), NoLattice> {
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
