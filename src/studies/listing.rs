//! The table of a study in the index, with readable units.
//!
//! The CSV has every row and every digit; here is what a reader looks for.

use super::readable::{self, bytes, number, time};
use super::write::further_columns;
use super::{Findings, Front, Row, Study, Timing, pareto, write};

/// More rows than this are folded away below a plot.
const ROWS_UNFOLDED: usize = 24;
/// More rows than this are left to the CSV, but for broken promises and the Pareto front.
const ROWS_LISTED: usize = 200;

/// A column: its heading and what it says of a row.
type Column<'a> = (String, Box<dyn Fn(usize, &Row) -> String + 'a>);

/// The table of what a study found: columns that say anything, rows that matter.
pub(super) fn table(study: &Study, findings: &Findings, out: &mut Vec<String>) {
    let on_front = pareto(&findings.rows);
    let is_long = findings.rows.len() > ROWS_LISTED;
    let is_listed = |(index, row): &(usize, &Row)| {
        !is_long
            || on_front[*index].is_some_and(|at| at != Front::Beaten)
            || row.is_kept() == Some(false)
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
    study: &Study,
    findings: &Findings,
    on_front: &'a [Option<Front>],
) -> Vec<Column<'a>> {
    let (measure, unit) = study.error;
    let of_error = |name: &str| match unit {
        "" => name.to_owned(),
        unit => format!("{name}, {unit}"),
    };
    let mut columns = vec![
        column("method", |_, row| row.method.clone()),
        column("setting", |_, row| row.setting.clone()),
        column("case", |_, row| row.case.clone()),
        numbers("size", |row| row.size),
    ];
    let is_told = |row: &Row| !row.further("came_back").is_empty();
    if !findings.rows.iter().any(is_told) {
        columns.extend([
            numbers(&of_error(measure), |row| row.error),
            numbers(&of_error("99th percentile"), |row| row.error_p99),
            numbers(&of_error("promised"), |row| row.promised),
        ]);
    }
    let cost = study.cost_of;
    let said =
        |row: &Row, say: fn(&Timing) -> String| row.cost.as_ref().map(say).unwrap_or_default();
    columns.extend([
        column(&format!("CPU a {cost}"), move |_, row| {
            said(row, |t| time(t.cpu_s))
        }),
        column("interval", move |_, row| {
            said(row, |t| t.cpu_interval_s.map(time).join(" … "))
        }),
        column(&format!("wall a {cost}"), move |_, row| {
            said(row, |t| time(t.wall_s))
        }),
        column("memory", |_, row| row.bytes.map(bytes).unwrap_or_default()),
        column("front", move |index, _| {
            let mark = match on_front[index] {
                Some(Front::On) => "●",
                Some(Front::Open) => "○",
                Some(Front::Beaten) | None => "",
            };
            mark.to_owned()
        }),
    ]);
    for name in further_columns(&findings.rows) {
        let say = move |_: usize, row: &Row| readable::cell(row.further(name));
        columns.push(column(&readable::heading(name), say));
    }
    columns.push(column("kept", |_, row| {
        let said = row
            .is_kept()
            .map(|is_kept| if is_kept { "yes" } else { "**no**" });
        said.unwrap_or_default().to_owned()
    }));
    columns
}

fn column<'a>(heading: &str, say: impl Fn(usize, &Row) -> String + 'a) -> Column<'a> {
    (heading.to_owned(), Box::new(say))
}

fn numbers<'a>(heading: &str, of: fn(&Row) -> Option<f64>) -> Column<'a> {
    column(heading, move |_, row| {
        let known = of(row).filter(|value| value.is_finite());
        known.map(number).unwrap_or_default()
    })
}

/// A text as a cell of a table may hold it.
pub(super) fn cell(text: &str) -> String {
    let words: Vec<&str> = text.split_whitespace().collect();
    words.join(" ").replace('|', "\\|").replace('<', "&lt;")
}
