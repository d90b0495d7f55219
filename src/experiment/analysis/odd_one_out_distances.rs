//! Distances of fabrics from how easily they were told apart.

use super::kept::Experiment;
use super::model::{Cell, Section, Table, ends, matrix};
use super::odd_one_out::interval;
use selvedge_statistics::ranking::{GradeWeights, OddOneOut};

/// Sums of weights, and errors by fabric.
pub(super) fn section(experiment: &Experiment<'_>, found: &OddOneOut, names: &[String]) -> Section {
    let title = format!("{}: distances", experiment.design.title);
    let mut section = Section::new(experiment.key("distances"), title);
    let GradeWeights { easy, normal, hard } = found.weights;
    section.note(format!(
        "A right answer counts {easy}, {normal} or {hard} as it was easy, normal or hard, a \
         wrong one 0; the distance of two fabrics is the sum over all answers. {} pairs are \
         at the ceiling (always right and easy), {} at the floor, {} were never asked.",
        found.n_ceiling, found.n_floor, found.n_missing
    ));
    let cells = found.distances().into_iter();
    let cells = cells.map(|d| d.map_or_else(|| Cell::none("itself, or never asked"), Cell::from));
    section.tables.push(matrix(
        "distances",
        "Sums of weights",
        names,
        cells.collect(),
    ));
    section.tables.push(errors(found, names));
    section
}

fn errors(found: &OddOneOut, names: &[String]) -> Table {
    let columns = [
        ("item", "fabric"),
        ("triads", "triads with it"),
        ("wrong", "wrong"),
        ("percent", "%"),
        ("ci_low_percent", "95 % CI from"),
        ("ci_high_percent", "to"),
    ];
    let title = "Wrong answers by fabric; both fabrics of a triad count";
    let mut table = Table::new("errors", title, &columns);
    for (name, errors) in names.iter().zip(&found.errors) {
        let (wrong, n) = (errors.n_wrong as u64, errors.n_triads as u64);
        let mut row = vec![Cell::from(name.as_str()), n.into(), wrong.into()];
        row.push(if n > 0 {
            (100.0 * wrong as f64 / n as f64).into()
        } else {
            Cell::none("never asked")
        });
        row.extend(ends(&interval(wrong, n)));
        table.push(row);
    }
    table
}
