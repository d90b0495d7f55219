//! Scores of held-back windows: read, written, and their means.

use std::path::Path;

use selvedge_foundation::files::{FileError, Table, TableWriter, read_text, write_atomic};

use crate::FrictionError;
use crate::example::Example;
use crate::score::{Measure, Measures};

/// Scores of held-back windows, each by [`Measure`].
#[derive(Debug, Clone, PartialEq)]
pub struct Scores {
    /// The family, or the fabric that was given, of each window.
    cloths: Vec<String>,
    all: Vec<Measures>,
}

impl Scores {
    fn header() -> Vec<&'static str> {
        let place = ["family", "seed", "column"];
        place.into_iter().chain(Measure::COLUMNS).collect()
    }

    pub(crate) fn read(path: &Path) -> Result<Self, FrictionError> {
        let table = Table::read(&read_text(path)?, path, &Self::header(), &[])?;
        let cloths = table.text("family").unwrap_or_default();
        Ok(Self {
            cloths: cloths.into_iter().map(ToOwned::to_owned).collect(),
            all: Self::rows_of(&table)?,
        })
    }

    /// What each row of a table says of the measures.
    pub(crate) fn rows_of(table: &Table) -> Result<Vec<Measures>, FileError> {
        let columns = Measure::COLUMNS.map(|measure| table.required_numbers(measure));
        let columns: Result<Vec<Vec<f64>>, FileError> = columns.into_iter().collect();
        let columns = columns?;
        let row = |row: usize| std::array::from_fn(|measure| columns[measure][row]);
        Ok((0..table.n_rows()).map(row).collect())
    }

    /// Of windows, each with its scores.
    pub(crate) fn of(windows: &[Example], all: Vec<Measures>) -> Self {
        let cloths = windows.iter().map(|window| window.cloth.clone()).collect();
        Self { cloths, all }
    }

    /// The scores of each window.
    #[cfg(test)]
    pub(crate) fn windows(&self) -> &[Measures] {
        &self.all
    }

    /// Each measure's mean over the windows.
    pub fn mean(&self) -> Measures {
        Self::mean_of(self.all.iter())
    }

    /// The mean over the windows of each family, or fabric that was given, in order.
    pub fn by_cloth(&self) -> Vec<(&str, Measures)> {
        let mut names: Vec<&str> = self.cloths.iter().map(String::as_str).collect();
        names.sort_unstable();
        names.dedup();
        let of = |name| {
            let windows = self.cloths.iter().zip(&self.all);
            let of_cloth = windows.filter(|(cloth, _)| *cloth == name);
            (name, Self::mean_of(of_cloth.map(|(_, scores)| scores)))
        };
        names.into_iter().map(of).collect()
    }

    fn mean_of<'a>(windows: impl Iterator<Item = &'a Measures>) -> Measures {
        let (mut n, mut sums) = (0.0, [0.0; Measure::N]);
        for scores in windows {
            n += 1.0;
            for (sum, score) in sums.iter_mut().zip(scores) {
                *sum += score;
            }
        }
        sums.map(|sum| sum / f64::max(n, 1.0))
    }

    /// Writes them, a row a window.
    pub(crate) fn write(&self, windows: &[Example], path: &Path) -> Result<(), FrictionError> {
        let mut table = TableWriter::new(Vec::new(), path, &Self::header())?;
        for (example, scores) in windows.iter().zip(&self.all) {
            table
                .text(&example.cloth)
                .number(example.window.map_or(0, |window| window.seed))
                .number(example.column);
            for score in scores {
                table.number(score);
            }
            table.end_row()?;
        }
        Ok(write_atomic(path, &table.finish()?)?)
    }
}
