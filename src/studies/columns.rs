//! The tidy table of a study: one row a method, setting and case, a column a quantity.
//!
//! Numbers have shortest round-trip digits; what is not known is an empty cell.

use std::path::Path;

use super::{Findings, ReportError, Row, Study, pareto};
use selvedge_foundation::files::TableWriter;

/// Columns that every study has, with the unit of its error in their names.
fn fixed_columns(unit: &str) -> Vec<String> {
    let with_unit = |name: &str| match key_of_unit(unit) {
        key if key.is_empty() => name.to_owned(),
        key => format!("{name}_{key}"),
    };
    let mut columns: Vec<String> = ["method", "setting", "case", "size"]
        .map(str::to_owned)
        .into();
    columns.extend(["error", "error_p99", "promised"].map(with_unit));
    let rest = [
        "kept",
        "cpu_s",
        "cpu_q25_s",
        "cpu_q75_s",
        "wall_s",
        "n_repeats",
        "bytes",
        "pareto",
    ];
    columns.extend(rest.map(str::to_owned));
    columns
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

/// A further cell of a row; empty where it has none.
pub(super) fn further_cell<'a>(row: &'a Row, name: &str) -> &'a str {
    row.further(name).unwrap_or_default()
}

/// The CSV text of what a study found. `path` only names it in errors.
pub(super) fn csv_of(
    study: &dyn Study,
    findings: &Findings,
    path: &Path,
) -> Result<String, ReportError> {
    let further = further_columns(&findings.rows);
    let columns = fixed_columns(study.error_measure().1);
    let header: Vec<&str> = columns
        .iter()
        .map(String::as_str)
        .chain(further.clone())
        .collect();
    let mut table = TableWriter::new(Vec::new(), path, &header)?;
    for (row, is_on_front) in findings.rows.iter().zip(pareto(&findings.rows)) {
        table.text(&row.method).text(&row.setting).text(&row.case);
        for number in [row.size, row.error, row.error_p99, row.promised] {
            optional(&mut table, number);
        }
        optional(&mut table, row.is_kept());
        let cost = row.cost.as_ref();
        optional(&mut table, cost.map(|cost| cost.cpu_s));
        for quartile in 0..2 {
            optional(&mut table, cost.map(|cost| cost.cpu_quartiles_s[quartile]));
        }
        optional(&mut table, cost.map(|cost| cost.wall_s));
        optional(&mut table, cost.map(|cost| cost.n_repeats));
        optional(&mut table, row.bytes);
        optional(&mut table, is_on_front);
        for name in &further {
            table.text(further_cell(row, name));
        }
        table.end_row()?;
    }
    Ok(String::from_utf8_lossy(&table.finish()?).into_owned())
}

fn optional(table: &mut TableWriter<Vec<u8>>, value: Option<impl std::fmt::Display>) {
    match value {
        Some(value) => table.number(value),
        None => table.text(""),
    };
}

/// A unit as names of columns spell it: `mm/s` is `mm_per_s`, `µm` is `um`.
fn key_of_unit(unit: &str) -> String {
    let spelt = unit
        .replace('/', " per ")
        .replace(['µ', 'μ'], "u")
        .replace('%', "percent");
    let words: Vec<String> = spelt
        .split(|c: char| !c.is_ascii_alphanumeric())
        .filter(|word| !word.is_empty())
        .map(|word| {
            if word == "dB" {
                "db".to_owned()
            } else {
                word.to_owned()
            }
        })
        .collect();
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
