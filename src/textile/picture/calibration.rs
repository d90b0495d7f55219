//! How far a lattice can be believed: counted on generated pictures, by what they showed.
//!
//! The study `weaves` counts the same on pictures of its own. What random phases leave of a picture
//! is no null here: its autocorrelation is the same, and all evidence is of that.

/// With seeds 2 and 3 of that study, by [`Agreement`]: weaves, six ways taken, whose lattice was
/// right, and all that were given one; pictures that repeat nowhere and were given one all the
/// same.
const COUNTED: [[f64; 3]; 4] = [
    [1257.0, 1281.0, 0.0],
    [17.0, 20.0, 0.0],
    [69.0, 91.0, 0.0],
    [26.0, 26.0, 4.0],
];
/// All pictures that repeat nowhere, of nine kinds.
const N_NOTHING: f64 = 432.0;

/// How the two ways to the repeat of a weave agree: by heights of maxima, and by what is predicted.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Agreement {
    /// They do.
    Same,
    /// What is predicted is clearly better by another lattice.
    Predicted,
    /// It is not clear.
    Heights,
    /// Too few cells to predict any.
    Few,
}

impl Agreement {
    /// The share of generated weaves whose lattice was right, of those that were judged so, as if
    /// one more of either were there: a few that were all right prove little.
    pub(super) fn confidence(self) -> f64 {
        let [right, all, _] = COUNTED[self as usize];
        (100.0 * (right + 1.0) / (all + 2.0)).round() / 100.0
    }

    /// The share of generated pictures that repeat nowhere in which a lattice is found that is
    /// judged so, as if one more were there: none of a few hundred is not never.
    pub(super) fn false_alarm_rate(self) -> f64 {
        let [_, _, invented] = COUNTED[self as usize];
        (1e4 * (invented + 1.0) / (N_NOTHING + 1.0)).round() / 1e4
    }
}
