//! Distances of fabrics from how easily they were told apart.

use super::kept::Experiment;
use super::map::undefined;
use super::model::{Cell, Section, Table, ends, matrix};
use super::odd_one_out::{interval, weights};
use crate::statistics::ranking::{GradeWeights, OddOneOut, TriadAnswer};
use crate::statistics::{Ranks, pearson_r};

/// Weights that distances are tried with besides the design's.
const OTHER_WEIGHTS: [[f64; 3]; 2] = [[1.0, 0.6, 0.3], [1.0, 1.0, 1.0]];

/// Sums of weights, errors by fabric, and the same with other weights.
pub(super) fn section(
    experiment: &Experiment<'_>,
    found: &OddOneOut,
    all: &[TriadAnswer],
    names: &[String],
) -> Section {
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
    let columns = [
        ("weights", "weights"),
        ("ceiling", "pairs at the ceiling"),
        ("floor", "at the floor"),
        ("n", "pairs"),
        ("spearman", "rank correlation with the design's"),
    ];
    let mut table = Table::new("weights", "The same with other weights", &columns);
    for other in OTHER_WEIGHTS {
        let told = other.map(|w| w.to_string()).join(" / ");
        let row = match OddOneOut::of(names.len(), all, weights(other)) {
            Ok(with) => {
                let of = |o: &OddOneOut| o.pairs.iter().map(|p| p.distance).collect::<Vec<f64>>();
                let rank = |o: &OddOneOut| Ranks::of(&of(o)).ranks;
                let r = pearson_r(&rank(found), &rank(&with));
                vec![
                    told.into(),
                    with.n_ceiling.into(),
                    with.n_floor.into(),
                    with.pairs.len().into(),
                    Cell::of(&r),
                ]
            }
            Err(why) => {
                let mut row = vec![Cell::from(told)];
                row.extend(undefined(&why, 4));
                row
            }
        };
        table.push(row);
    }
    section.tables.push(table);
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
