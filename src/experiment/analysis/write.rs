//! The files of an analysis: a page to read, every table as CSV and JSON, every figure as SVG, PNG
//! and the CSV of its points. The same analysis gives the same bytes.

use std::path::Path;

use serde::ser::SerializeMap as _;
use serde::{Serialize, Serializer};

use super::model::{Analysis, Cell, Column, Drawn, LEAST_PROBABILITY, Table};
use crate::ExperimentError;
use crate::session::make_folder;
use selvedge_chart::Figure;
use selvedge_foundation::files::{TableWriter, encode_png_rgba, to_json_string, write_atomic};
use selvedge_foundation::numerics::to_whole;
use selvedge_foundation::quantity::fixed;

/// Pixels across a PNG.
const PNG_WIDTH: u32 = 1720;
/// Tables with more rows stand in their files alone.
const MOST_ROWS_ON_THE_PAGE: usize = 60;
/// Likewise with more columns.
const MOST_COLUMNS_ON_THE_PAGE: usize = 21;
/// The column of a CSV table that says what is not computable, and why.
const REASONS: &str = "not_computable";

impl Analysis {
    /// Writes all files into a folder, which is made where it is missing.
    ///
    /// # Errors
    /// A file cannot be written or a figure not be drawn.
    pub fn write(&self, out: &Path) -> Result<(), ExperimentError> {
        make_folder(out)?;
        for section in &self.sections {
            for table in &section.tables {
                let stem = format!("{}-{}", section.key, table.key);
                write_table(table, out, &stem, true)?;
            }
            for drawn in &section.figures {
                write_figure(drawn, out, &format!("{}-{}", section.key, drawn.key))?;
            }
        }
        let page = self.page();
        Ok(write_atomic(&out.join("index.md"), page.as_bytes())?)
    }

    /// The page to read.
    #[must_use]
    pub fn page(&self) -> String {
        let mut page = vec![format!("# {}\n", self.title)];
        for section in &self.sections {
            page.push(format!("## {}\n", section.title));
            page.extend(section.notes.iter().map(|note| format!("- {note}")));
            if !section.notes.is_empty() {
                page.push(String::new());
            }
            for drawn in &section.figures {
                let stem = format!("{}-{}", section.key, drawn.key);
                let title = drawn.figure.title.replace(['[', ']'], "");
                page.push(format!(
                    "![{title}]({stem}.png)\n\n[as SVG]({stem}.svg), [its points]({stem}.csv)\n"
                ));
            }
            for table in &section.tables {
                table_text(table, &format!("{}-{}", section.key, table.key), &mut page);
            }
        }
        page.join("\n") + "\n"
    }
}

fn table_text(table: &Table, stem: &str, page: &mut Vec<String>) {
    let files = format!("[CSV]({stem}.csv), [JSON]({stem}.json)");
    page.push(format!("**{}** ({files})\n", table.title));
    let (n_rows, n_columns) = (table.rows.len(), table.columns.len());
    if n_rows > MOST_ROWS_ON_THE_PAGE || n_columns > MOST_COLUMNS_ON_THE_PAGE {
        page.push(format!(
            "{n_rows} rows, {n_columns} columns: see its files.\n"
        ));
        return;
    }
    let row = |cells: Vec<String>| format!("| {} |", cells.join(" | "));
    page.push(row(table
        .columns
        .iter()
        .map(|c| plain(&c.heading))
        .collect()));
    let is_number = |at: usize| table.rows.iter().any(|row| row[at].number().is_some());
    let rules = (0..n_columns).map(|at| if is_number(at) { "---:" } else { "---" }.to_owned());
    page.push(row(rules.collect()));
    let mut reasons: Vec<&str> = Vec::new();
    for cells in &table.rows {
        let mut described = Vec::with_capacity(n_columns);
        for cell in cells {
            described.push(match cell {
                Cell::Undefined(reason) if reason == LEAST_PROBABILITY => reason.clone(),
                Cell::Number(value) => readable(*value),
                Cell::Text(text) => plain(text),
                Cell::Undefined(reason) => {
                    let known = reasons.iter().position(|r| r == reason);
                    let at = known.unwrap_or_else(|| {
                        reasons.push(reason);
                        reasons.len() - 1
                    });
                    format!("– ({})", at + 1)
                }
            });
        }
        page.push(row(described));
    }
    page.push(String::new());
    for (at, reason) in reasons.iter().enumerate() {
        page.push(format!("({}) not computable: {}  ", at + 1, plain(reason)));
    }
    if !reasons.is_empty() {
        page.push(String::new());
    }
}

/// A text in one cell of a page.
fn plain(text: &str) -> String {
    text.replace('|', "/").replace(['\n', '\r'], " ")
}

/// A number with four digits that count; whole ones as they are.
fn readable(value: f64) -> String {
    let magnitude = value.abs();
    if magnitude < 1e6 && (value - value.round()).abs() < 1e-12 {
        return fixed(value, 0);
    }
    if !(1e-4..1e6).contains(&magnitude) {
        return format!("{value:.2e}").replace('-', "−");
    }
    fixed(
        value,
        to_whole((3.0 - magnitude.log10().floor()).clamp(0.0, 7.0)),
    )
}

impl Table {
    /// The table as its CSV file has it: what is not computable is empty, its reason in a column of
    /// its own.
    ///
    /// # Errors
    /// None that a text in memory could have.
    pub fn to_csv(&self) -> Result<String, ExperimentError> {
        let bytes = csv_of(self, Path::new("table"))?;
        Ok(String::from_utf8_lossy(&bytes).into_owned())
    }
}

fn write_table(
    table: &Table,
    out: &Path,
    stem: &str,
    as_json: bool,
) -> Result<(), ExperimentError> {
    let path = out.join(format!("{stem}.csv"));
    write_atomic(&path, &csv_of(table, &path)?)?;
    if as_json {
        let path = out.join(format!("{stem}.json"));
        let document = Document {
            title: &table.title,
            columns: &table.columns,
            rows: table.rows.iter().map(|row| Row(table, row)).collect(),
        };
        write_atomic(&path, to_json_string(&document, &path)?.as_bytes())?;
    }
    Ok(())
}

fn csv_of(table: &Table, path: &Path) -> Result<Vec<u8>, ExperimentError> {
    let is_undefined = |cell: &Cell| matches!(cell, Cell::Undefined(_));
    let has_reasons = table.rows.iter().flatten().any(is_undefined);
    let mut header: Vec<&str> = table.columns.iter().map(|c| c.name.as_str()).collect();
    if has_reasons {
        header.push(REASONS);
    }
    let mut writer = TableWriter::new(Vec::new(), path, &header)?;
    for row in &table.rows {
        for cell in row {
            match cell {
                // Without a row of zeros before its digits.
                Cell::Number(value) if (f64::MIN_POSITIVE..1e-6).contains(&value.abs()) => {
                    writer.number(format_args!("{value:e}"))
                }
                Cell::Number(value) => writer.number(value),
                Cell::Text(text) => writer.text(text),
                Cell::Undefined(_) => writer.text(""),
            };
        }
        if has_reasons {
            writer.text(&reasons_of(table, row).join("; "));
        }
        writer.end_row()?;
    }
    Ok(writer.finish()?)
}

/// Why cells of a row are empty; a reason that several share is said once.
fn reasons_of(table: &Table, row: &[Cell]) -> Vec<String> {
    let mut found: Vec<(Vec<&str>, &str)> = Vec::new();
    for (column, cell) in table.columns.iter().zip(row) {
        if let Cell::Undefined(reason) = cell {
            match found.iter_mut().find(|(_, known)| known == reason) {
                Some((names, _)) => names.push(&column.name),
                None => found.push((vec![&column.name], reason)),
            }
        }
    }
    let described = |(names, reason): (Vec<&str>, &str)| format!("{}: {reason}", names.join(", "));
    found.into_iter().map(described).collect()
}

#[derive(Serialize)]
struct Document<'a> {
    title: &'a str,
    columns: &'a [Column],
    rows: Vec<Row<'a>>,
}

/// A row as an object; what is not computable is null, its reason under `NAME_reason`.
struct Row<'a>(&'a Table, &'a [Cell]);

impl Serialize for Row<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(None)?;
        for (column, cell) in self.0.columns.iter().zip(self.1) {
            match cell {
                Cell::Number(value) => map.serialize_entry(&column.name, value)?,
                Cell::Text(text) => map.serialize_entry(&column.name, text)?,
                Cell::Undefined(reason) => {
                    map.serialize_entry(&column.name, &())?;
                    map.serialize_entry(&format!("{}_reason", column.name), reason)?;
                }
            }
        }
        map.end()
    }
}

fn write_figure(drawn: &Drawn, out: &Path, stem: &str) -> Result<(), ExperimentError> {
    let path = |ending: &str| out.join(format!("{stem}.{ending}"));
    let (svg, png) = pictures(&drawn.figure, &path("png"))?;
    write_atomic(&path("svg"), svg.as_bytes())?;
    write_atomic(&path("png"), &png)?;
    write_table(&drawn.points, out, stem, false)
}

/// A figure as SVG and as PNG.
pub(super) fn pictures(figure: &Figure, path: &Path) -> Result<(String, Vec<u8>), ExperimentError> {
    let failed = |error: selvedge_chart::FigureError| {
        ExperimentError::value(
            format!("{}: {error}", path.display()),
            "the tables of the analysis hold the same numbers",
        )
    };
    let svg = figure.to_svg().map_err(failed)?;
    let pixels = figure.to_pixels(PNG_WIDTH).map_err(failed)?;
    let png = encode_png_rgba(&pixels.rgba, pixels.width, pixels.height, path)?;
    Ok((svg, png))
}
