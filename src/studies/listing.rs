//! The table of a study in the index, with readable units.
//!
//! The CSV has every row and every digit; here is what a reader looks for.

use super::readable::{self, bytes, number, time};
use super::write::{further_cell, further_columns};
use super::{Findings, Row, Study, Timing, pareto, write};

/// More rows than this are folded away below a plot.
const ROWS_UNFOLDED: usize = 24;
/// More rows than this are left to the CSV, but for broken promises and the Pareto front.
const ROWS_LISTED: usize = 200;

/// A column: its heading and what it says of a row.
type Column<'a> = (String, Box<dyn Fn(usize, &Row) -> String + 'a>);

/// The table of what a study found: columns that say anything, rows that matter.
pub(super) fn table(study: &dyn Study, findings: &Findings, out: &mut Vec<String>) {
    let on_front = pareto(&findings.rows);
    let is_long = findings.rows.len() > ROWS_LISTED;
    let is_listed = |(index, row): &(usize, &Row)| {
        !is_long || on_front[*index] == Some(true) || row.is_kept() == Some(false)
    };
    let rows: Vec<(usize, &Row)> = findings.rows.iter().enumerate().filter(is_listed).collect();
    let has_any = |column: &Column<'_>| rows.iter().any(|(i, row)| !column.1(*i, row).is_empty());
    let columns: Vec<Column<'_>> = columns(study, findings, &on_front)
        .into_iter()
        .filter(has_any)
        .collect();
    if rows.is_empty() || columns.is_empty() {
        return;
    }
    if is_long {
        let (n, n_all) = (rows.len(), findings.rows.len());
        out.push(format!(
            "{n} of {n_all} rows: the Pareto front and broken promises.\n"
        ));
    }
    // A table that no plot stands for is what the reader came for.
    let has_plot = !write::plots(study, findings).is_empty();
    let is_folded = has_plot && rows.len() > ROWS_UNFOLDED;
    if is_folded {
        out.push(format!("<details><summary>{} rows</summary>\n", rows.len()));
    }
    let heading: Vec<&str> = columns.iter().map(|(name, _)| name.as_str()).collect();
    out.push(format!("| {} |", heading.join(" | ")));
    out.push(format!("|{}", "---|".repeat(columns.len())));
    for (index, row) in rows {
        let cells: Vec<String> = columns
            .iter()
            .map(|(_, say)| cell(&say(index, row)))
            .collect();
        out.push(format!("| {} |", cells.join(" | ")));
    }
    out.push(if is_folded { "\n</details>\n" } else { "" }.to_owned());
}

fn columns<'a>(
    study: &dyn Study,
    findings: &Findings,
    on_front: &'a [Option<bool>],
) -> Vec<Column<'a>> {
    let said = |value: Option<f64>| value.map(number).unwrap_or_default();
    let mut columns = vec![
        column("method", |_, row| row.method.clone()),
        column("setting", |_, row| row.setting.clone()),
        column("case", |_, row| row.case.clone()),
        column("size", move |_, row| said(row.size)),
    ];
    let is_told = |row: &Row| !further_cell(row, "came_back").is_empty();
    if !findings.rows.iter().any(is_told) {
        columns.extend(error_columns(study));
    }
    columns.extend(cost_columns(study));
    let ring = move |index: usize, _: &Row| {
        let is_on_front = on_front[index] == Some(true);
        if is_on_front { "●" } else { "" }.to_owned()
    };
    columns.push(column("front", ring));
    for name in further_columns(&findings.rows) {
        let say = move |_: usize, row: &Row| readable::cell(further_cell(row, name));
        columns.push(column(&readable::heading(name), say));
    }
    columns.push(column("kept", |_, row| kept(row).to_owned()));
    columns
}

fn error_columns<'a>(study: &dyn Study) -> [Column<'a>; 3] {
    let (measure, unit) = study.error_measure();
    let named = |name: &str| match unit {
        "" => name.to_owned(),
        unit => format!("{name}, {unit}"),
    };
    let said = |value: Option<f64>| value.map(number).unwrap_or_default();
    [
        column(&named(measure), move |_, row| said(row.error)),
        column(&named("99th percentile"), move |_, row| said(row.error_p99)),
        column(&named("promised"), move |_, row| said(row.promised)),
    ]
}

fn cost_columns<'a>(study: &dyn Study) -> [Column<'a>; 4] {
    let cost = study.cost_of();
    let said = |row: &Row, of: fn(&Timing) -> f64| {
        let seconds = row.cost.as_ref().map(of);
        seconds.map(time).unwrap_or_default()
    };
    [
        column(&format!("CPU a {cost}"), move |_, row| {
            said(row, |t| t.cpu_s)
        }),
        column("quartiles", |_, row| quartiles(row)),
        column(&format!("wall a {cost}"), move |_, row| {
            said(row, |t| t.wall_s)
        }),
        column("memory", |_, row| row.bytes.map(bytes).unwrap_or_default()),
    ]
}

fn column<'a>(heading: &str, say: impl Fn(usize, &Row) -> String + 'a) -> Column<'a> {
    (heading.to_owned(), Box::new(say))
}

fn kept(row: &Row) -> &'static str {
    match row.is_kept() {
        Some(true) => "yes",
        Some(false) => "**no**",
        None => "",
    }
}

fn quartiles(row: &Row) -> String {
    let Some(cost) = &row.cost else {
        return String::new();
    };
    let [low, high] = cost.cpu_quartiles_s.map(time);
    format!("{low} … {high}")
}

/// A text as a cell of a table may hold it.
pub(super) fn cell(text: &str) -> String {
    let words: Vec<&str> = text.split_whitespace().collect();
    words.join(" ").replace('|', "\\|").replace('<', "&lt;")
}
