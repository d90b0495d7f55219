//! Numerical methods that know nothing of textiles: transforms, random numbers, grids.
//!
//! # Invariants
//! - no I/O, no clock, no word of textiles
//! - the one home of the FFT crate (`fft.rs`) and of the random-number crates (`random.rs`)
//! - same input, same seed, same bytes

mod correlation;
mod fft;
mod grid;
mod maxima;
pub mod ode;
mod parallel;
mod plane;
mod random;
mod series;
mod simplex;
mod sparse;
mod stft;
mod whole;

pub use correlation::overlap_autocorrelation;
pub use fft::{ChirpTransform, Complex, RealTransform};
pub use grid::Grid;
pub use maxima::QuadraticPeak;
pub use parallel::{in_pieces, n_threads};
pub use plane::PlaneTransform;
pub use random::Random;
pub use series::{
    LineFit, at_place, autocorrelation, catmull_rom, structure_function, without_line,
};
pub use simplex::Lowest;
pub use sparse::GridFactor;
pub use stft::{GriffinLim, StartPhases, Stft};
pub use whole::{Whole, to_whole};

/// The whole part of a number as an index or a count.
pub fn to_index(x: f64) -> usize {
    to_whole(x)
}

/// The whole part of a number as a byte.
pub fn to_byte(x: f64) -> u8 {
    to_whole(x)
}

/// The nearest number of single precision: a place or a share for the screen, an amplitude that
/// travels.
#[expect(clippy::cast_possible_truncation, reason = "rounds, as is said")]
pub fn to_single(x: f64) -> f32 {
    x as f32
}

/// The lowest and the highest of some values; +∞ and −∞ of none. NaN counts as none.
pub fn extent(values: impl IntoIterator<Item = f64>) -> [f64; 2] {
    let none = [f64::INFINITY, f64::NEG_INFINITY];
    let values = values.into_iter();
    values.fold(none, |[low, high], value| [low.min(value), high.max(value)])
}

/// The middle of what `n` halvings leave of an interval: what is sought lies above the places that
/// `is_below` holds for.
pub fn bisected([mut low, mut high]: [f64; 2], n: u32, is_below: impl Fn(f64) -> bool) -> f64 {
    for _ in 0..n {
        let middle = 0.5 * (low + high);
        let end = if is_below(middle) {
            &mut low
        } else {
            &mut high
        };
        *end = middle;
    }
    0.5 * (low + high)
}

/// The median of some values; of an even number, the mean of the middle two. NaN of none.
///
/// Sorts `values` in place.
pub fn median(values: &mut [f64]) -> f64 {
    values.sort_by(f64::total_cmp);
    let middle = values.len() / 2;
    match values.len() {
        0 => f64::NAN,
        n if n % 2 == 1 => values[middle],
        _ => 0.5 * (values[middle - 1] + values[middle]),
    }
}

/// The smallest value that at least the share `q` (0…1) of the values do not exceed. NaN of none.
///
/// Sorts `values` in place.
pub fn quantile(values: &mut [f64], q: f64) -> f64 {
    values.sort_by(f64::total_cmp);
    let rank = (values.len() as f64 * q.clamp(0.0, 1.0)).ceil();
    values
        .get(to_index(rank).saturating_sub(1))
        .copied()
        .unwrap_or(f64::NAN)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn order_statistics_of_few_values() {
        assert_eq!(median(&mut [3.0, 1.0, 2.0]), 2.0);
        assert_eq!(median(&mut [4.0, 1.0, 2.0, 3.0]), 2.5);
        assert_eq!(quantile(&mut [1.0, 2.0, 3.0, 4.0], 0.99), 4.0);
        assert_eq!(quantile(&mut [1.0, 2.0, 3.0, 4.0], 0.5), 2.0);
        assert!(median(&mut []).is_nan(), "nothing has no median");
    }
}
