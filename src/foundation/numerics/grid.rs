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

    /// A grid of what `value` gives for every column and row, row by row.
    pub fn from_fn(width: usize, height: usize, mut value: impl FnMut(usize, usize) -> T) -> Self {
        let mut values = Vec::with_capacity(width * height);
        for row in 0..height {
            values.extend((0..width).map(|column| value(column, row)));
        }
        Self { width, values }
    }

    /// The same grid of other values.
    pub fn map<U: Copy>(&self, value: impl FnMut(T) -> U) -> Grid<U> {
        Grid {
            width: self.width,
            values: self.values.iter().copied().map(value).collect(),
        }
    }

    /// Rows as columns.
    #[must_use]
    pub fn transposed(&self) -> Self {
        Self::from_fn(self.height(), self.width(), |column, row| {
            self.row(column)[row]
        })
    }

    /// The same with the first row as the last.
    #[must_use]
    pub fn turned_over(&self) -> Self {
        let height = self.height();
        Self::from_fn(self.width, height, |column, row| {
            self.row(height - 1 - row)[column]
        })
    }

    /// A grid over `values`, row-major; `None` unless they fill whole rows.
    pub fn from_rows(width: usize, values: Vec<T>) -> Option<Self> {
        let is_whole = width > 0 && values.len().is_multiple_of(width);
        is_whole.then_some(Self { width, values })
    }

    /// The part from x, y of this width and height; `None` if it is empty or not inside.
    pub fn part(&self, [x, y, width, height]: [usize; 4]) -> Option<Self> {
        let holds = |from: usize, n: usize, all: usize| {
            n > 0 && from.checked_add(n).is_some_and(|end| end <= all)
        };
        let is_inside = holds(x, width, self.width()) && holds(y, height, self.height());
        let row = |row: usize| &self.row(row)[x..x + width];
        is_inside.then(|| Self {
            width,
            values: (y..y + height).map(row).collect::<Vec<_>>().concat(),
        })
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
        assert_eq!(grid.part([1, 1, 2, 1]).unwrap().values(), [0, 7]);
        for outside in [
            [2, 0, 2, 1],
            [0, 0, 3, 3],
            [0, 0, 0, 1],
            [usize::MAX, 0, 1, 1],
        ] {
            assert_eq!(grid.part(outside), None, "{outside:?}");
        }
        assert!(
            Grid::from_rows(3, vec![1, 2]).is_none(),
            "half a row is no grid"
        );
    }
}
