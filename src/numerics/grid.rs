//! A rectangular grid of numbers, row by row.
//!
//! Row 0 comes first in memory; whether that is the top or the bottom is the caller's convention.

/// Values on a grid of `width` × `height`, row-major.
#[derive(Debug, Clone, PartialEq)]
pub struct Grid<T> {
    width: usize,
    values: Vec<T>,
}

impl<T: Copy> Grid<T> {
    /// A grid filled with one value.
    pub fn filled(width: usize, height: usize, value: T) -> Self {
        Self {
            width,
            values: vec![value; width * height],
        }
    }

    /// A grid over `values`, row-major; `None` unless they fill whole rows.
    pub fn from_rows(width: usize, values: Vec<T>) -> Option<Self> {
        let is_whole = width > 0 && values.len().is_multiple_of(width);
        is_whole.then_some(Self { width, values })
    }

    /// Values in a row.
    pub fn width(&self) -> usize {
        self.width
    }

    /// Number of rows.
    pub fn height(&self) -> usize {
        self.values.len().checked_div(self.width).unwrap_or(0)
    }

    /// One row.
    pub fn row(&self, row: usize) -> &[T] {
        &self.values[row * self.width..(row + 1) * self.width]
    }

    /// One row, to write.
    pub fn row_mut(&mut self, row: usize) -> &mut [T] {
        &mut self.values[row * self.width..(row + 1) * self.width]
    }

    /// All values, row by row.
    pub fn values(&self) -> &[T] {
        &self.values
    }

    /// All values, row by row, to write.
    pub fn values_mut(&mut self) -> &mut [T] {
        &mut self.values
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_are_what_was_written() {
        let mut grid = Grid::filled(3, 2, 0);
        grid.row_mut(1)[2] = 7;
        assert_eq!(grid.values(), [0, 0, 0, 0, 0, 7]);
        assert_eq!((grid.width(), grid.height()), (3, 2));
        assert!(
            Grid::from_rows(3, vec![1, 2]).is_none(),
            "half a row is no grid"
        );
    }
}
