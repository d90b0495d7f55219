//! Scales from rankings: how like each target the others are, free of who else was there
//! (Plackett & Luce), and how rankings by chance would look.

use super::kept::Experiment;
use super::model::{Cell, Section, Table, ends, tests};
use super::ranking::Rankings;
use crate::statistics::ranking::{Prior, plackett_luce};
use crate::statistics::{Computed, Outcome};

/// Strength of the prior that keeps worths finite where a target was always ranked first.
const STRENGTH: f64 = 0.5;

/// Likeness to every target by Plackett and Luce's model.
pub(super) fn section(experiment: &Experiment<'_>, all: &[Rankings<'_>]) -> Section {
    let title = format!("{}: likeness by Plackett and Luce", experiment.design.title);
    let mut section = Section::new(experiment.key("scale"), title);
    section.note(format!(
        "Log-worth of each alternative for each target, counted from the target: 0 is taken \
         for the target as often as itself. Gamma prior of strength {STRENGTH}, as if every \
         textile had been chosen so many times more, keeps worths finite. Errors are by \
         curvature and take rankings for independent."
    ));
    let names = experiment.ids();
    let columns = [
        ("target", "target"),
        ("alternative", "alternative"),
        ("rankings", "rankings"),
        ("log_worth", "log-worth"),
        ("se", "SE"),
        ("ci_low", "95 % CI from"),
        ("ci_high", "to"),
    ];
    let mut table = Table::new("likeness", "Likeness to each target", &columns);
    let mut against: Vec<(String, Computed<Outcome>)> = Vec::new();
    for (target, name) in names.iter().enumerate() {
        let rankings: Vec<Vec<usize>> = all
            .iter()
            .flat_map(|r| r.trials.iter().filter(|t| t.target == target))
            .map(crate::statistics::ranking::RankTrial::best_first)
            .collect();
        let fit = plackett_luce(names.len(), &rankings, Prior::Gamma(STRENGTH));
        for (alternative, other) in names.iter().enumerate().filter(|(a, _)| *a != target) {
            let lead = fit
                .clone()
                .and_then(|fit| fit.scale.difference(alternative, target));
            let mut row = vec![
                Cell::from(name.as_str()),
                other.as_str().into(),
                rankings.len().into(),
            ];
            row.push(Cell::of(
                &lead.as_ref().map(|l| l.value).map_err(Clone::clone),
            ));
            row.push(Cell::of(&lead.as_ref().map(|l| l.se).map_err(Clone::clone)));
            row.extend(ends(&lead.and_then(|l| l.interval(0.95))));
            table.push(row);
        }
        let without = plackett_luce(names.len(), &rankings, Prior::None);
        against.push((
            format!("target {name}"),
            without.and_then(|fit| fit.against_chance()),
        ));
    }
    section.tables.push(table);
    let title = "Worths against rankings by chance, without a prior";
    section
        .tables
        .push(tests("against-chance", title, &against));
    section
}
