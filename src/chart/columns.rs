//! The numbers of a chart as named columns, and their CSV with the lines that say where they come
//! from.

use std::borrow::Cow;
use std::path::Path;

use selvedge_foundation::files::{FileError, TableWriter};

/// Named columns of one length.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Columns {
    columns: Vec<(Cow<'static, str>, Values)>,
}

/// What a column holds.
#[derive(Debug, Clone, PartialEq)]
pub enum Values {
    /// Whole numbers.
    Whole(Vec<u64>),
    /// Numbers in single precision; a cell is empty where one is not finite.
    Single(Vec<f32>),
    /// Numbers; a cell is empty where one is not finite.
    Double(Vec<f64>),
    /// Words.
    Words(Vec<String>),
}

macro_rules! from_columns {
    ($($kind:ident $cell:ty),+) => {$(
        impl From<Vec<$cell>> for Values {
            fn from(values: Vec<$cell>) -> Self {
                Self::$kind(values)
            }
        }
    )+};
}

from_columns!(Whole u64, Single f32, Double f64, Words String);

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

impl Columns {
    /// The same with another column, whose name holds its unit.
    #[must_use]
    pub fn with(mut self, name: impl Into<Cow<'static, str>>, values: impl Into<Values>) -> Self {
        self.columns.push((name.into(), values.into()));
        self
    }

    /// Rows that every column has.
    pub fn n_rows(&self) -> usize {
        let lengths = self.columns.iter().map(|(_, values)| values.len());
        lengths.min().unwrap_or(0)
    }

    /// The rows of these, then those of others with the same columns.
    #[must_use]
    pub fn followed_by(mut self, others: Self) -> Self {
        for ((_, values), (_, more)) in self.columns.iter_mut().zip(others.columns) {
            match (values, more) {
                (Values::Whole(values), Values::Whole(more)) => values.extend(more),
                (Values::Single(values), Values::Single(more)) => values.extend(more),
                (Values::Double(values), Values::Double(more)) => values.extend(more),
                (Values::Words(values), Values::Words(more)) => values.extend(more),
                _ => {}
            }
        }
        self
    }

    /// The points that two columns of numbers make; none where there is no such column.
    pub fn points(&self, x: &str, y: &str) -> Vec<[f64; 2]> {
        let (x, y) = (self.numbers(x), self.numbers(y));
        x.into_iter().zip(y).map(|(x, y)| [x, y]).collect()
    }

    /// The numbers of a column.
    fn numbers(&self, name: &str) -> Vec<f64> {
        let column = self.columns.iter().find(|(known, _)| known == name);
        match column.map(|(_, values)| values) {
            Some(Values::Whole(values)) => values.iter().map(|value| *value as f64).collect(),
            Some(Values::Single(values)) => values.iter().copied().map(f64::from).collect(),
            Some(Values::Double(values)) => values.clone(),
            Some(Values::Words(_)) | None => Vec::new(),
        }
    }

    /// The columns as CSV below lines `# key = value`. `path` only names it in errors.
    ///
    /// # Errors
    /// None that a text in memory could have.
    pub fn to_csv(&self, about: &[(String, String)], path: &Path) -> Result<Vec<u8>, FileError> {
        let mut head = String::new();
        for (key, value) in about {
            head.extend(["# ", key, " = ", value, "\n"]);
        }
        let header: Vec<&str> = self.columns.iter().map(|(name, _)| name.as_ref()).collect();
        let mut writer = TableWriter::new(head.into_bytes(), path, &header)?;
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
        let sheet = Columns::default()
            .with("tick", vec![7_u64, 8])
            .with("level_db", vec![0.1_f32, f32::NEG_INFINITY])
            .with("x_mm", vec![f64::NAN, 0.1])
            .with("textile", vec!["a, b".to_owned(), String::new()]);
        let about = [("scene".to_owned(), "A, \"b\" c".to_owned())];
        let path = Path::new("a.csv");
        let text = String::from_utf8(sheet.to_csv(&about, path).unwrap()).unwrap();
        assert_eq!(
            text,
            "# scene = A, \"b\" c\ntick,level_db,x_mm,textile\n7,0.1,,\"a, b\"\n8,,0.1,\n"
        );
        assert_eq!(sheet.points("tick", "x_mm")[1], [8.0, 0.1]);
        assert!(sheet.points("tick", "textile").is_empty());
        let columns = ["tick", "level_db", "x_mm", "textile"];
        let table = Table::read(&text, path, &columns, &[]).unwrap();
        assert_eq!(table.required_numbers("tick").unwrap(), [7.0, 8.0]);
        assert_eq!(table.text("level_db").unwrap(), ["0.1", ""]);
    }
}
