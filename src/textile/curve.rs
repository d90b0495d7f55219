//! Long curves with as many corners as a picture shows, as lines of a chart.

use selvedge_chart::{Chart, Ink, Row, Series, Style, Weight};

/// A line without a name.
pub(crate) fn line(points: Vec<[f64; 2]>, ink: Ink, weight: Weight) -> Series {
    Series {
        points,
        style: Style::Line,
        ink,
        weight,
        ..Series::default()
    }
}

/// Panels side by side.
pub(crate) fn row(panels: Vec<Chart>, height_px: f64) -> Row {
    Row {
        panels,
        height_px,
        bar: None,
    }
}

/// Stretches that a curve is drawn by: two corners each.
const MAX_STRETCHES: usize = 700;

/// Values at `places`, `[place, value]`, with no more corners than a picture shows: of every
/// stretch the least and the greatest value, in their order.
pub(crate) fn corners(place: impl Fn(usize) -> f64, values: &[f64]) -> Vec<[f64; 2]> {
    let n_stretch = values.len().div_ceil(MAX_STRETCHES).max(1);
    let at = |index: usize| [place(index), values[index]];
    if n_stretch < 3 {
        return (0..values.len()).map(at).collect();
    }
    let mut corners = Vec::new();
    for (nth, stretch) in values.chunks(n_stretch).enumerate() {
        let by_value = |a: &usize, b: &usize| stretch[*a].total_cmp(&stretch[*b]);
        let min = (0..stretch.len()).min_by(by_value).unwrap_or(0);
        let greatest = (0..stretch.len()).max_by(by_value).unwrap_or(0);
        let first = nth * n_stretch;
        corners.extend([min.min(greatest), min.max(greatest)].map(|i| at(first + i)));
    }
    corners
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_long_curve_keeps_its_peaks() {
        let mut values = vec![0.0; 100_000];
        values[31_007] = 5.0;
        values[90_001] = -7.0;
        let corners = corners(|i| i as f64, &values);
        assert!(corners.len() <= 2 * MAX_STRETCHES, "{}", corners.len());
        assert!(corners.contains(&[31_007.0, 5.0]), "the peak");
        assert!(corners.contains(&[90_001.0, -7.0]), "the pit");
        assert!(
            corners.windows(2).all(|pair| pair[0][0] <= pair[1][0]),
            "in order"
        );
    }

    #[test]
    fn a_short_curve_is_drawn_as_it_is() {
        assert_eq!(
            corners(|i| 2.0 * i as f64, &[1.0, 3.0]),
            [[0.0, 1.0], [2.0, 3.0]]
        );
    }
}
