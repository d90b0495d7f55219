//! A table by its columns, and its CSV with the lines that say where it comes from.

use std::borrow::Cow;
use std::path::Path;

use crate::bench::export::origin::Origin;
use selvedge_foundation::files::{FileError, TableWriter};

/// A table: named columns of one length.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct Sheet {
    columns: Vec<(Cow<'static, str>, Values)>,
}

/// What a column holds.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Values {
    /// Whole numbers.
    Whole(Vec<u64>),
    /// Numbers in single precision; a cell is empty where one is not finite.
    Single(Vec<f32>),
    /// Numbers; a cell is empty where one is not finite.
    Double(Vec<f64>),
    /// Words.
    Words(Vec<String>),
}

impl From<Vec<u64>> for Values {
    fn from(values: Vec<u64>) -> Self {
        Self::Whole(values)
    }
}

impl From<Vec<f32>> for Values {
    fn from(values: Vec<f32>) -> Self {
        Self::Single(values)
    }
}

impl From<Vec<f64>> for Values {
    fn from(values: Vec<f64>) -> Self {
        Self::Double(values)
    }
}

impl From<Vec<String>> for Values {
    fn from(values: Vec<String>) -> Self {
        Self::Words(values)
    }
}

impl Values {
    fn len(&self) -> usize {
        match self {
            Self::Whole(values) => values.len(),
            Self::Single(values) => values.len(),
            Self::Double(values) => values.len(),
            Self::Words(values) => values.len(),
        }
    }

    fn write(&self, row: usize, writer: &mut TableWriter<Vec<u8>>) {
        match self {
            Self::Whole(values) => writer.number(values[row]),
            Self::Single(values) if values[row].is_finite() => writer.number(values[row]),
            Self::Double(values) if values[row].is_finite() => writer.number(values[row]),
            Self::Words(values) => writer.text(&values[row]),
            Self::Single(_) | Self::Double(_) => writer.text(""),
        };
    }
}

impl Sheet {
    /// The same with another column, whose name holds its unit.
    pub(crate) fn with(
        mut self,
        name: impl Into<Cow<'static, str>>,
        values: impl Into<Values>,
    ) -> Self {
        self.columns.push((name.into(), values.into()));
        self
    }

    /// Rows that every column has.
    pub(crate) fn n_rows(&self) -> usize {
        let lengths = self.columns.iter().map(|(_, values)| values.len());
        lengths.min().unwrap_or(0)
    }

    /// The table as CSV. `path` only names it in errors.
    ///
    /// # Errors
    /// None that a text in memory could have.
    pub(crate) fn to_csv(&self, origin: &Origin, path: &Path) -> Result<Vec<u8>, FileError> {
        let mut told = String::new();
        for (key, value) in origin.pairs() {
            told.extend(["# ", &key, " = ", &value, "\n"]);
        }
        let header: Vec<&str> = self.columns.iter().map(|(name, _)| name.as_ref()).collect();
        let mut writer = TableWriter::new(told.into_bytes(), path, &header)?;
        for row in 0..self.n_rows() {
            for (_, values) in &self.columns {
                values.write(row, &mut writer);
            }
            writer.end_row()?;
        }
        writer.finish()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use selvedge_foundation::files::Table;

    #[test]
    fn a_table_says_where_it_comes_from_and_reads_back() {
        let sheet = Sheet::default()
            .with("tick", vec![7_u64, 8])
            .with("level_db", vec![0.1_f32, f32::NEG_INFINITY])
            .with("x_mm", vec![f64::NAN, 0.1])
            .with("textile", vec!["a, b".to_owned(), String::new()]);
        let origin = Origin::default().and("scene", "A, \"b\"\nc", "");
        let path = Path::new("a.csv");
        let text = String::from_utf8(sheet.to_csv(&origin, path).unwrap()).unwrap();
        assert_eq!(
            text,
            "# scene = A, \"b\" c\ntick,level_db,x_mm,textile\n7,0.1,,\"a, b\"\n8,,0.1,\n"
        );
        let columns = ["tick", "level_db", "x_mm", "textile"];
        let table = Table::read(&text, path, &columns, &[]).unwrap();
        assert_eq!(table.required_numbers("tick").unwrap(), [7.0, 8.0]);
        assert_eq!(table.text("level_db").unwrap(), ["0.1", ""]);
    }
}
