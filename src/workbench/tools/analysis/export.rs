//! A figure of an analysis with the numbers that it is drawn from.

use crate::bench::export::origin::Origin;
use crate::bench::export::{Exported, Sheet};
use crate::tools::analysis::findings::Findings;
use selvedge_experiment::analysis::{Cell, Drawn, Table};

/// A figure as it would stand in the report, and its points.
pub(crate) fn figure(found: &Findings, drawn: &Drawn) -> Exported {
    let program = selvedge_foundation::PROGRAM;
    let options = found.asked.options();
    let origin = Origin::default()
        .and("program", program, "")
        .and("analysed", &found.analysis.title, "")
        .and("sessions", &found.n_sessions.to_string(), "")
        .and("seed", &options.seed.to_string(), "")
        .and("resamples", &options.n_resamples.to_string(), "")
        .and("permutations", &options.n_permutations.to_string(), "");
    Exported {
        sheet: sheet(&drawn.points),
        figure: drawn.figure.clone(),
        origin,
    }
}

/// The same table by its columns; a cell is empty where there is no number.
fn sheet(table: &Table) -> Sheet {
    let mut sheet = Sheet::default();
    for (at, column) in table.columns.iter().enumerate() {
        let cells: Vec<&Cell> = table.rows.iter().filter_map(|row| row.get(at)).collect();
        let has_words = cells.iter().any(|cell| matches!(cell, Cell::Text(_)));
        let name = column.name.clone();
        sheet = if has_words {
            let words: Vec<String> = cells.into_iter().map(word).collect();
            sheet.with(name, words)
        } else {
            let number = |cell: &Cell| cell.number().unwrap_or(f64::NAN);
            let numbers: Vec<f64> = cells.into_iter().map(number).collect();
            sheet.with(name, numbers)
        };
    }
    sheet
}

fn word(cell: &Cell) -> String {
    match cell {
        Cell::Number(value) => value.to_string(),
        Cell::Text(text) => text.clone(),
        Cell::Undefined(_) => String::new(),
    }
}
