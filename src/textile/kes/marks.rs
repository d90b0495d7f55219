//! What in a stroke does not look like the rest of it: run-in, turn-round, outliers. Marked, never
//! changed.
//!
//! **Ends.** The stroke is cut into pieces of 1 mm. Its middle 60 % say what is usual: the median
//! of the pieces' mean heights and of their roughnesses (mean absolute deviations), and the spread
//! of both (1.4826 times the median absolute deviation, at least a fifth of the usual roughness).
//! From either end pieces are marked as long as one of the two lies more than four spreads off.
//!
//! **Outliers** stand off the median of their neighbours (20 µm to either side, two to ten samples)
//! by more than eight spreads of that difference, and by more than the spread of all heights.

use crate::surface::{Direction, mean_deviation};
use selvedge_foundation::named;
use selvedge_foundation::numerics::{median, to_index};

/// The length of a piece, mm.
const PIECE_MM: f64 = 1.0;
/// How many spreads a piece may be off.
const MAX_SPREADS: f64 = 4.0;
/// How many spreads a sample may stand off its neighbours.
const MAX_SPIKE: f64 = 8.0;
/// Smaller spikes than this are never marked, µm.
const MIN_SPIKE_UM: f64 = 1.0;

named! {
    /// What a mark says.
    #[derive(Debug, Clone, Copy, PartialEq, Eq)]
    pub enum MarkKind {
        /// The tester starts.
        RunIn = "run-in",
        /// The tester turns round.
        TurnRound = "turn-round",
        /// Samples that stand off their neighbours.
        Outlier = "outlier",
    }
    /// What it is called.
    pub fn label;
}

/// Samples that do not look like the rest, in the order of travel.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Mark {
    /// What it says.
    pub kind: MarkKind,
    /// Which samples.
    pub samples: std::ops::Range<usize>,
}

/// The marks of a stroke: heights in µm in the order of travel.
pub(super) fn marks_of(heights: &[f64], step_mm: f64, direction: Direction) -> Vec<Mark> {
    let mut marks = Vec::new();
    let (head, tail) = ends(heights, step_mm);
    let (at_start, at_end) = if direction.is_reverse() {
        (MarkKind::TurnRound, MarkKind::RunIn)
    } else {
        (MarkKind::RunIn, MarkKind::TurnRound)
    };
    if head > 0 {
        marks.push(Mark {
            kind: at_start,
            samples: 0..head,
        });
    }
    marks.extend(outliers(heights, step_mm).into_iter().map(|samples| Mark {
        kind: MarkKind::Outlier,
        samples,
    }));
    if tail > 0 {
        marks.push(Mark {
            kind: at_end,
            samples: heights.len() - tail..heights.len(),
        });
    }
    marks
}

/// Samples in so many millimetres, at least one.
pub(crate) fn n_samples(length_mm: f64, step_mm: f64) -> usize {
    to_index((length_mm / step_mm).round()).max(1)
}

/// How many samples at the start and at the end do not look like the middle.
fn ends(heights: &[f64], step_mm: f64) -> (usize, usize) {
    let n_piece = n_samples(PIECE_MM, step_mm).max(2);
    let pieces: Vec<[f64; 2]> = heights
        .chunks_exact(n_piece)
        .map(|piece| {
            let mean = piece.iter().sum::<f64>() / piece.len() as f64;
            [mean, mean_deviation(piece)]
        })
        .collect();
    let fifth = pieces.len() / 5;
    let middle = &pieces[fifth..pieces.len() - fifth];
    if middle.len() < 5 {
        return (0, 0);
    }
    let of = |which: usize| {
        middle
            .iter()
            .map(move |piece| piece[which])
            .collect::<Vec<f64>>()
    };
    let usual = [0, 1].map(|which| median(&mut of(which)));
    let min = 0.2 * usual[1];
    let spread = [0, 1].map(|which| spread(&of(which)).max(min));
    let is_off = |piece: &&[f64; 2]| {
        (0..2).any(|which| (piece[which] - usual[which]).abs() > MAX_SPREADS * spread[which])
    };
    let max = pieces.len() / 3;
    let head = pieces.iter().take(max).take_while(is_off).count();
    let tail = pieces.iter().rev().take(max).take_while(is_off).count();
    let rest = if tail > 0 { heights.len() % n_piece } else { 0 };
    (head * n_piece, tail * n_piece + rest)
}

/// 1.4826 times the median absolute deviation from the median: the standard deviation, were the
/// values normal.
fn spread(values: &[f64]) -> f64 {
    let middle = median(&mut values.to_vec());
    let mut off: Vec<f64> = values.iter().map(|value| (value - middle).abs()).collect();
    1.4826 * median(&mut off)
}

fn outliers(heights: &[f64], step_mm: f64) -> Vec<std::ops::Range<usize>> {
    let reach = n_samples(0.02, step_mm).clamp(2, 10);
    let off_neighbours = |i: usize| {
        let (first, last) = (i.saturating_sub(reach), (i + reach + 1).min(heights.len()));
        heights[i] - median(&mut heights[first..last].to_vec())
    };
    let off: Vec<f64> = (0..heights.len()).map(off_neighbours).collect();
    let min = (MAX_SPIKE * spread(&off))
        .max(spread(heights))
        .max(MIN_SPIKE_UM);
    let mut found: Vec<std::ops::Range<usize>> = Vec::new();
    for index in (0..off.len()).filter(|i| off[*i].abs() > min) {
        match found.last_mut() {
            Some(last) if last.end == index => last.end = index + 1,
            _ => found.push(index..index + 1),
        }
    }
    found
}
