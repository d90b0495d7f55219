//! Number by number: printed beside obtained.

use super::comparison::{Comparison, Options};
use crate::analysis::{Cell, Section, Table, cells, known};

const COLUMNS: &str = "paper; quantity; printed; obtained; low: 95 of 100 studies from; high: to; \
    within: printed lies within; se: SE of obtained; studies; observer; assumed; difference: \
    obtained less printed";

pub(super) fn section(comparisons: &[Comparison], options: &Options) -> Section {
    let mut section = Section::new("published", "Published against obtained");
    let judged: Vec<bool> = comparisons
        .iter()
        .filter_map(Comparison::is_within)
        .collect();
    let n_within = judged.iter().filter(|is_within| **is_within).count();
    section.note(format!(
        "**{n_within} of {} printed numbers lie where 95 of 100 simulated studies do.**",
        judged.len()
    ));
    section.note(format!(
        "Obtained is the mean over {} simulated studies of the papers' own size; intervals of all \
         tables and figures are where 95 of 100 of them lie. Nothing was fitted: noise is from \
         published just noticeable differences, and observers differ in it by {} (standard \
         deviation of its logarithm). Textiles are those that the program ships, not the papers'.",
        options.n_studies, options.spread
    ));
    let mut table = Table::new("numbers", "Printed and obtained", COLUMNS);
    for one in comparisons {
        let why = "nothing printed to compare with";
        let spread = one.obtained;
        let within = one.is_within().map_or_else(|| Cell::none(why), Cell::from);
        table.push(cells![
            one.paper,
            &one.quantity,
            known(one.printed, why),
            [spread.mean, spread.low, spread.high],
            within,
            spread.se,
            spread.n,
            one.observer,
            one.assumed,
            known(one.printed.map(|printed| spread.mean - printed), why),
        ]);
    }
    section.table(table);
    section
}
