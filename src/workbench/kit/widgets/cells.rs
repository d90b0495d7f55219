//! A grid of cells for each of the two bands side by side, with room for a colour bar.

use eframe::egui::{self, Pos2, Rect, pos2, vec2};

/// Height of a title, points.
pub(crate) const TITLE: f32 = 20.0;
/// Space between cells, points.
pub(crate) const GAP: f32 = 2.0;
/// Width of the colour bar with its numbers, points.
const BAR: f32 = 48.0;
/// Space between the two heatmaps, points.
const BETWEEN: f32 = 16.0;
/// A cell narrower than this has no room for a number, points.
pub(crate) const NUMBER_WIDTH: f32 = 20.0;

/// Where the cells of both bands are.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Places {
    /// The upper left corner of either heatmap.
    pub(crate) corners: [Pos2; 2],
    /// Width and height of a cell with its gap.
    pub(crate) cell: egui::Vec2,
    n_columns: usize,
}

impl Places {
    /// As large as fits, in the middle of `rect`; cells are at most half as wide again as high.
    pub(crate) fn new(rect: Rect, (n_rows, n_columns): (usize, usize)) -> Self {
        let height = ((rect.height() - TITLE) / n_rows.max(1) as f32).max(2.0);
        let room = (rect.width() - BAR - BETWEEN) / 2.0;
        let width = (room / n_columns.max(1) as f32).clamp(2.0, 1.9 * height);
        let height = height.min(1.4 * width);
        let cell = vec2(width, height).floor().max(vec2(2.0, 2.0));
        let map_width = n_columns as f32 * cell.x;
        let left = rect.center().x - 0.5 * (2.0 * map_width + BETWEEN + BAR);
        let top = rect.top() + TITLE;
        let corner = |band: usize| pos2(left + band as f32 * (map_width + BETWEEN), top).round();
        Self {
            corners: [corner(0), corner(1)],
            cell,
            n_columns: n_columns.max(1),
        }
    }

    pub(crate) fn cell(&self, band: usize, index: usize) -> Rect {
        let (row, column) = (index / self.n_columns, index % self.n_columns);
        let corner = self.corners[band] + vec2(column as f32, row as f32) * self.cell;
        Rect::from_min_size(corner, self.cell - vec2(GAP, GAP))
    }

    /// The contactor and band whose cell is at a place.
    pub(crate) fn at(&self, place: Pos2, n_contactors: usize) -> Option<(usize, usize)> {
        let cells = (0..2).flat_map(|band| (0..n_contactors).map(move |index| (band, index)));
        cells
            .into_iter()
            .find(|&(band, index)| self.cell(band, index).expand(0.5 * GAP).contains(place))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_fit_the_pane_and_are_found_again() {
        for size in [vec2(300.0, 200.0), vec2(500.0, 120.0), vec2(200.0, 600.0)] {
            let rect = Rect::from_min_size(pos2(10.0, 20.0), size);
            let places = Places::new(rect, (6, 4));
            for (band, index) in [(0, 0), (0, 23), (1, 0), (1, 23), (1, 5)] {
                let cell = places.cell(band, index);
                assert!(rect.contains_rect(cell), "{size:?}: {cell:?}");
                assert_eq!(places.at(cell.center(), 24), Some((band, index)));
            }
            assert_eq!(places.at(rect.min, 24), None);
        }
    }

    #[test]
    fn a_pane_without_room_and_a_display_without_contactors_are_harmless() {
        let places = Places::new(Rect::ZERO, (0, 0));
        assert_eq!(places.at(pos2(0.0, 0.0), 0), None);
        assert!(places.cell(0, 7).is_finite());
    }
}
