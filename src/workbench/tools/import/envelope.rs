//! A long curve as it is drawn: in so many pieces that no screen shows more, each with its lowest
//! and its highest value.

use selvedge_foundation::numerics::extent;

/// Pieces of a curve: as many as a wide pane has pixels.
const MOST_PIECES: usize = 1500;

/// A curve for the screen.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Envelope {
    /// Samples to a piece.
    n_piece: usize,
    /// The lowest and the highest value of every piece, in the order in which they occur.
    pieces: Vec<[f64; 2]>,
}

impl Envelope {
    /// The envelope of a curve.
    pub(crate) fn of(values: &[f64]) -> Self {
        let n_piece = values.len().div_ceil(MOST_PIECES).max(1);
        let piece = |piece: &[f64]| {
            let mut ends = [0, 0];
            for (i, value) in piece.iter().enumerate() {
                if *value < piece[ends[0]] {
                    ends[0] = i;
                }
                if *value > piece[ends[1]] {
                    ends[1] = i;
                }
            }
            ends.sort_unstable();
            ends.map(|i| piece[i])
        };
        Self {
            n_piece,
            pieces: values.chunks(n_piece).map(piece).collect(),
        }
    }

    /// Values with the samples that they are of, in order: all of a short curve, two of every piece
    /// of a long one.
    pub(crate) fn points(&self) -> impl Iterator<Item = (f64, f64)> + '_ {
        let each: u8 = if self.n_piece == 1 { 1 } else { 2 };
        self.pieces.iter().enumerate().flat_map(move |(nth, ends)| {
            let first = (nth * self.n_piece) as f64;
            let apart = self.n_piece as f64 / f64::from(each);
            (0..each)
                .zip(*ends)
                .map(move |(end, value)| (first + apart * f64::from(end), value))
        })
    }

    /// Lowest and highest value.
    pub(crate) fn range(&self) -> [f64; 2] {
        extent(self.pieces.iter().flatten().copied())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_short_curve_is_itself() {
        let points: Vec<(f64, f64)> = Envelope::of(&[3.0, 1.0, 2.0]).points().collect();
        assert_eq!(points, [(0.0, 3.0), (1.0, 1.0), (2.0, 2.0)]);
    }

    #[test]
    fn no_peak_of_a_long_curve_is_lost_and_few_points_are_left() {
        let mut values: Vec<f64> = (0..1_000_000).map(|i| f64::from(i % 7)).collect();
        values[123_456] = 99.0;
        values[654_321] = -99.0;
        let envelope = Envelope::of(&values);
        assert_eq!(envelope.range(), [-99.0, 99.0]);
        let points: Vec<(f64, f64)> = envelope.points().collect();
        assert!(points.len() <= 2 * MOST_PIECES, "{}", points.len());
        assert!(
            points.windows(2).all(|pair| pair[0].0 < pair[1].0),
            "in order"
        );
        let peak = points.iter().find(|point| point.1 > 90.0).unwrap();
        assert!((peak.0 - 123_456.0).abs() <= 667.0, "{peak:?}");
    }
}
