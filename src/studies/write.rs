//! The files of a study: its tidy table (one row a method, setting and case, a column a quantity),
//! plots as SVG and PNG. Each appears when it is whole.
//!
//! Numbers have shortest round-trip digits; what is not known is an empty cell, and so is what is
//! no finite number.

use std::path::Path;

use super::chart::error_against_time;
use super::{Findings, Front, ReportError, Row, Study, pareto};
use selvedge_chart::Chart;
use selvedge_foundation::files::{TableWriter, encode_png_rgba, write_atomic};

/// Pixels across a PNG.
const PNG_WIDTH: u32 = 1720;

/// Writes `NAME.csv`, `NAME.svg`, `NAME.png` and the further plots of a study.
pub(super) fn findings(study: &Study, findings: &Findings, out: &Path) -> Result<(), ReportError> {
    let name = format!("{}.csv", study.name);
    text(&name, out, &csv_of(study, findings, &out.join(&name))?)?;
    for (name, plot) in plots(study, findings) {
        text(&format!("{name}.svg"), out, &plot.to_svg())?;
        let path = out.join(format!("{name}.png"));
        let pixels = plot.to_pixels(PNG_WIDTH)?;
        let png = encode_png_rgba(&pixels.rgba, pixels.width, pixels.height, &path)?;
        write_atomic(&path, &png)?;
    }
    Ok(())
}

/// Every plot of a study with the name of its files: error against run time first.
pub(super) fn plots(study: &Study, findings: &Findings) -> Vec<(String, Chart)> {
    let first = error_against_time(study, findings).map(|plot| (study.name.to_owned(), plot));
    let further = findings.plots.iter().map(|(name, plot)| {
        let begins_with_study = name.starts_with(study.name);
        let name = if begins_with_study && name != study.name {
            name.clone()
        } else {
            format!("{}-{name}", study.name)
        };
        (name, plot.clone())
    });
    first.into_iter().chain(further).collect()
}

/// Writes a text file of the report.
pub(super) fn text(name: &str, out: &Path, text: &str) -> Result<(), ReportError> {
    Ok(write_atomic(&out.join(name), text.as_bytes())?)
}

/// Columns that every study has; those of errors end with the study's unit.
const COLUMNS: [&str; 16] = [
    "method",
    "setting",
    "case",
    "size",
    "error",
    "error_p99",
    "promised",
    "kept",
    "cpu_s",
    "cpu_low_s",
    "cpu_high_s",
    "wall_s",
    "n_repeats",
    "n_processes",
    "bytes",
    "pareto",
];

fn fixed_columns(unit: &str) -> Vec<String> {
    let key = key_of_unit(unit);
    let of_error =
        |name: &str| !key.is_empty() && ["error", "error_p99", "promised"].contains(&name);
    let named = |name: &str| {
        if of_error(name) {
            format!("{name}_{key}")
        } else {
            name.to_owned()
        }
    };
    COLUMNS.into_iter().map(named).collect()
}

/// The names of a study's further columns, in order of their first appearance.
pub(super) fn further_columns(rows: &[Row]) -> Vec<&'static str> {
    let mut names = Vec::new();
    for (name, _) in rows.iter().flat_map(|row| &row.more) {
        if !names.contains(name) {
            names.push(*name);
        }
    }
    names
}

/// The CSV text of what a study found. `path` only names it in errors.
fn csv_of(study: &Study, findings: &Findings, path: &Path) -> Result<String, ReportError> {
    let further = further_columns(&findings.rows);
    let columns = fixed_columns(study.error.1);
    let header: Vec<&str> = columns
        .iter()
        .map(String::as_str)
        .chain(further.clone())
        .collect();
    let mut table = TableWriter::new(Vec::new(), path, &header)?;
    for (row, is_on_front) in findings.rows.iter().zip(pareto(&findings.rows)) {
        table.text(&row.method).text(&row.setting).text(&row.case);
        for value in [row.size, row.error, row.error_p99, row.promised] {
            number(&mut table, value);
        }
        table.optional(row.is_kept());
        let timing = row.cost.map(|cost| {
            let [low_s, high_s] = cost.cpu_interval_s;
            [cost.cpu_s, low_s, high_s, cost.wall_s]
        });
        for nth in 0..4 {
            number(&mut table, timing.map(|timing| timing[nth]));
        }
        table.optional(row.cost.map(|cost| cost.n_repeats));
        table.optional(row.cost.map(|cost| cost.n_processes()));
        table.optional(row.bytes);
        table.optional(is_on_front.map(Front::word));
        for name in &further {
            table.text(finite(row.further(name)));
        }
        table.end_row()?;
    }
    Ok(String::from_utf8_lossy(&table.finish()?).into_owned())
}

/// A number, where it is one: a bound that does not hold may be infinite.
fn number(table: &mut TableWriter<Vec<u8>>, value: Option<f64>) {
    table.optional(value.filter(|value| value.is_finite()));
}

/// A cell of words or a number, empty where it is `inf` or `NaN`, as which other programs take it
/// for a text or for nothing.
pub(super) fn finite(cell: &str) -> &str {
    let is_no_number = |value: f64| !value.is_finite();
    if cell.parse().is_ok_and(is_no_number) {
        return "";
    }
    cell
}

/// A unit as names of columns spell it: `mm/s` is `mm_per_s`, `µm` is `um`.
fn key_of_unit(unit: &str) -> String {
    let spelt = unit
        .replace('/', " per ")
        .replace(['µ', 'μ'], "u")
        .replace('%', "percent");
    let words = spelt.split(|c: char| !c.is_ascii_alphanumeric());
    let words: Vec<&str> = words.filter(|word| !word.is_empty()).collect();
    words.join("_").to_lowercase()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_become_parts_of_names() {
        assert_eq!(key_of_unit("mm/s"), "mm_per_s");
        assert_eq!(key_of_unit("dB"), "db");
        assert_eq!(key_of_unit("µm"), "um");
        assert_eq!(key_of_unit("%"), "percent");
        assert_eq!(fixed_columns("")[4..7], ["error", "error_p99", "promised"]);
        assert_eq!(fixed_columns("dB")[5], "error_p99_db");
    }
}
