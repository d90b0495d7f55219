//! Ranking four alternatives by their likeness to a target (Philpott & Summers 2012, experiments 1
//! and 2): every textile is the target as often as there are triples of the others.
//!
//! With 16 textiles the 80 trials are the pairs of a line of the affine plane of order 4 and a
//! point of it: every incorrect alternative meets each target exactly once, every two textiles are
//! incorrect alternatives together exactly twice, the correct one stands in each position 20 times,
//! each textile in each position 5 times. 13 textiles have a plane too. For other numbers each
//! target's others are dealt into triples by chance, and how often two meet is only nearly even.

use thiserror::Error;

use super::blocks;
use super::plane::{LINE_POINTS, Lines, product};
use selvedge_foundation::numerics::Random;

/// Alternatives of a trial.
const N_ALTERNATIVES: usize = LINE_POINTS;

/// One trial: textiles by number.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) struct RankingTrial {
    /// The block, from 0.
    pub block: usize,
    /// The textile that is felt as the target.
    pub target: usize,
    /// The alternatives by position; the target is one of them.
    pub alternatives: [usize; N_ALTERNATIVES],
}

/// Why there is no schedule.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
pub enum ScheduleError {
    /// The others of a target do not split into triples.
    #[error(
        "{n} textiles cannot be ranked in fours: the {} others of a target do not split into \
         triples; give 4, 7, 10, 13, 16 … textiles",
        n.saturating_sub(1)
    )]
    NoTriples {
        /// How many textiles were given.
        n: usize,
    },
}

/// All trials of one subject, in order.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct RankingSchedule {
    /// The trials.
    pub trials: Vec<RankingTrial>,
    /// Whether every two textiles are incorrect alternatives together equally often.
    pub(crate) is_pair_balanced: bool,
}

impl RankingSchedule {
    /// The schedule of a subject over `n_textiles`.
    ///
    /// # Errors
    /// The number of textiles less one is no multiple of three, or is 0.
    pub(crate) fn of(n_textiles: usize, subject: &Random) -> Result<Self, ScheduleError> {
        if !is_ranked(n_textiles) {
            return Err(ScheduleError::NoTriples { n: n_textiles });
        }
        let plane = Lines::over(n_textiles);
        let is_pair_balanced = plane.is_some() || n_textiles == N_ALTERNATIVES;
        let mut blocks = match plane {
            Some(plane) => of_plane(&plane, subject),
            None => of_triples(n_textiles, subject),
        };
        order(&mut blocks, &mut subject.branch("order"));
        let numbered = blocks.into_iter().enumerate();
        let trials = numbered.flat_map(|(block, trials)| {
            trials
                .into_iter()
                .map(move |trial| RankingTrial { block, ..trial })
        });
        Ok(Self {
            trials: trials.collect(),
            is_pair_balanced,
        })
    }
}

/// Whether so many textiles can be ranked in fours: the others of a target split into triples.
pub(crate) fn is_ranked(n_textiles: usize) -> bool {
    n_textiles >= N_ALTERNATIVES && n_textiles % 3 == 1
}

/// Blocks of the flags of a plane whose points are textiles in an order by chance.
fn of_plane(plane: &Lines, subject: &Random) -> Vec<Vec<RankingTrial>> {
    let mut textiles: Vec<usize> = (0..plane.n_points).collect();
    subject.branch("relabelling").shuffle(&mut textiles);
    let mut positions = subject.branch("positions");
    let columns: Vec<[usize; N_ALTERNATIVES]> = plane
        .lines
        .iter()
        .map(|_| {
            let mut columns = [0, 1, 2, 3];
            positions.shuffle(&mut columns);
            columns
        })
        .collect();
    let through = |point| plane.through(point).collect();
    let sets_of: Vec<Vec<usize>> = (0..plane.n_points).map(through).collect();
    let split = blocks::split(&sets_of, plane.lines.len(), &mut subject.branch("blocks"));
    let trial = |(point, &line): (usize, &usize)| {
        let points = plane.lines[line];
        let row = points.iter().position(|&p| p == point).unwrap_or(0);
        RankingTrial {
            block: 0,
            target: textiles[point],
            alternatives: columns[line].map(|column| textiles[points[latin(row, column)]]),
        }
    };
    let block = |lines: &Vec<usize>| lines.iter().enumerate().map(trial).collect();
    split.unwrap_or_default().iter().map(block).collect()
}

/// A Latin square of order 4 whose diagonal is 0…3: row i has i in column i, and every row and
/// column has each number once. ωi + (1 + ω)j over the field of four elements.
fn latin(row: usize, column: usize) -> usize {
    product(2, row) ^ product(3, column)
}

/// Blocks in which each textile is the target once, its others dealt into triples by chance.
fn of_triples(n_textiles: usize, subject: &Random) -> Vec<Vec<RankingTrial>> {
    let n_blocks = (n_textiles - 1) / 3;
    let (mut deal, mut positions) = (subject.branch("triples"), subject.branch("positions"));
    let mut blocks = vec![Vec::with_capacity(n_textiles); n_blocks];
    for target in 0..n_textiles {
        let mut others: Vec<usize> = (0..n_textiles).filter(|&other| other != target).collect();
        deal.shuffle(&mut others);
        // The correct one stands in every position as often as may be.
        let first = positions.index(N_ALTERNATIVES);
        for (nth, triple) in others.chunks_exact(3).enumerate() {
            let correct = (first + nth) % N_ALTERNATIVES;
            let mut rest = triple.iter().copied();
            let alternatives = [0, 1, 2, 3].map(|position| {
                let other = if position == correct {
                    None
                } else {
                    rest.next()
                };
                other.unwrap_or(target)
            });
            blocks[nth].push(RankingTrial {
                block: nth,
                target,
                alternatives,
            });
        }
    }
    blocks
}

/// Puts blocks and their trials in an order by chance; no target stands twice in a row.
fn order(blocks: &mut [Vec<RankingTrial>], random: &mut Random) {
    random.shuffle(blocks);
    let mut last = None;
    for block in blocks {
        random.shuffle(block);
        let is_again = block.first().map(|trial| trial.target) == last && last.is_some();
        if is_again && block.len() > 1 {
            let other = 1 + random.index(block.len() - 1);
            block.swap(0, other);
        }
        last = block.last().map(|trial| trial.target);
    }
}

#[cfg(test)]
mod tests;
