//! The rows of spectrograms: 10 Hz to 1 kHz in even steps of log frequency.

use selvedge_foundation::numerics::to_index;
use selvedge_render::array::VibrationBin;

/// Lowest frequency, Hz.
pub(crate) const LEAST_HZ: f64 = 10.0;
/// Highest frequency, Hz.
pub(crate) const MOST_HZ: f64 = 1000.0;
/// Number of rows: 48 a decade, each 4.9 % wide.
pub(crate) const N_ROWS: usize = 96;

/// One value for every row, low frequencies first.
pub(crate) type Rows = [f32; N_ROWS];

/// The borders between rows, Hz; row i lies between the i-th and the next.
#[derive(Debug, Clone)]
pub(crate) struct RowEdges([f64; N_ROWS + 1]);

impl Default for RowEdges {
    fn default() -> Self {
        Self(std::array::from_fn(edge_hz))
    }
}

impl RowEdges {
    /// The borders of every row, Hz.
    pub(crate) fn each(&self) -> impl Iterator<Item = [f64; 2]> {
        self.0.windows(2).map(|pair| [pair[0], pair[1]])
    }

    /// Adds every bin's power to the rows that it reaches: spread evenly over
    /// `[f − Δf/2, f + Δf/2]`, so that a bin wider than a row does not leave rows empty. What lies
    /// outside 10 Hz to 1 kHz is left out.
    pub(crate) fn add(&self, bins: &[VibrationBin], powers_um2: &mut [f64; N_ROWS]) {
        let edges = &self.0;
        let mut first = 0;
        let mut last_hz = 0.0;
        for bin in bins {
            let half = 0.5 * bin.spacing_hz;
            let (low, high) = (bin.frequency_hz - half, bin.frequency_hz + half);
            if !(half > 0.0 && high.is_finite()) {
                continue;
            }
            // Bins rise within a direction, so the search goes on where it was.
            if bin.frequency_hz < last_hz {
                first = 0;
            }
            last_hz = bin.frequency_hz;
            while first < N_ROWS && edges[first + 1] <= low {
                first += 1;
            }
            let density = bin.power_um2 / bin.spacing_hz;
            let reached = (first..N_ROWS).take_while(|row| edges[*row] < high);
            for row in reached {
                let overlap = edges[row + 1].min(high) - edges[row].max(low);
                powers_um2[row] += density * overlap.max(0.0);
            }
        }
    }
}

/// The lower border of a row, Hz; that of the row behind the last is the highest frequency.
pub(crate) fn edge_hz(row: usize) -> f64 {
    LEAST_HZ * (MOST_HZ / LEAST_HZ).powf(row as f64 / N_ROWS as f64)
}

/// The middle of a row on the logarithmic axis, Hz.
pub(crate) fn row_centre_hz(row: usize) -> f64 {
    (edge_hz(row) * edge_hz(row + 1)).sqrt()
}

/// The row of a frequency, Hz; the nearest beyond the ends.
pub(crate) fn row_at(frequency_hz: f64) -> usize {
    let share = (frequency_hz / LEAST_HZ).ln() / (MOST_HZ / LEAST_HZ).ln();
    let place = (share * N_ROWS as f64).floor();
    to_index(place).min(N_ROWS - 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn bin(frequency_hz: f64, spacing_hz: f64, power_um2: f64) -> VibrationBin {
        VibrationBin {
            frequency_hz,
            spacing_hz,
            power_um2,
        }
    }

    fn spread(bins: &[VibrationBin]) -> [f64; N_ROWS] {
        let mut powers = [0.0; N_ROWS];
        RowEdges::default().add(bins, &mut powers);
        powers
    }

    #[test]
    fn power_is_neither_lost_nor_made() {
        let bins: Vec<_> = (1..=40)
            .map(|k| bin(23.0 * f64::from(k), 23.0, 2.0))
            .collect();
        let sum: f64 = spread(&bins).iter().sum();
        // The first bin reaches from 11.5 Hz, the last to 931.5 Hz: all of it lies on the axis.
        assert!((sum - 80.0).abs() < 1e-9, "{sum}");
    }

    #[test]
    fn a_wide_bin_fills_its_rows_evenly_a_narrow_one_its_own() {
        let wide = spread(&[bin(100.0, 46.0, 1.0)]);
        let lit = wide.iter().filter(|power| **power > 0.0).count();
        assert!((9..=11).contains(&lit), "77 to 123 Hz: {lit} rows");
        let narrow = spread(&[bin(100.1, 0.1, 1.0)]);
        assert!(
            (narrow[row_at(100.0)] - 1.0).abs() < 1e-9,
            "its own row alone"
        );
    }

    #[test]
    fn a_second_direction_begins_low_again() {
        let both = spread(&[bin(800.0, 10.0, 1.0), bin(20.0, 1.0, 3.0)]);
        assert!((both.iter().sum::<f64>() - 4.0).abs() < 1e-9, "both count");
    }

    #[test]
    fn what_lies_off_the_axis_or_is_no_number_is_left_out() {
        let nan = f64::NAN;
        let bins = [
            bin(3.0, 1.0, 1.0),
            bin(nan, 1.0, 1.0),
            bin(50.0, 0.0, 1.0),
            bin(9e9, 1.0, 1.0),
        ];
        assert_eq!(spread(&bins), [0.0; N_ROWS]);
        assert_eq!((row_at(nan), row_at(1.0), row_at(1e5)), (0, 0, N_ROWS - 1));
    }
}
