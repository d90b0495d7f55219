//! What was taken for what: confusions, mean ranks, and how far they are from symmetric.

use super::answers::CHANCE_PERCENT;
use super::draw::{Bar, bars};
use super::draw_map::heat;
use super::included_trials::Experiment;
use super::model::{Cell, Drawn, Section, Table, cells, known, percent_interval, percent_of};
use super::tables::matrix;
use crate::design::Standard;
use selvedge_foundation::quantity::fixed;
use selvedge_statistics::ranking::MeanRanks;

/// Matrices of targets and alternatives, all subjects together.
pub(super) fn section(experiment: &Experiment<'_>, ranks: &MeanRanks, names: &[String]) -> Section {
    let mut section = experiment.section("confusions", "what was taken for what");
    let kind = match experiment.design.composition.presentation.reference {
        Standard::RealCloth => "real cloth",
        Standard::Virtual | Standard::None => "virtual",
    };
    section.note(format!(
        "Rows are targets ({kind}), columns alternatives; all subjects together. The \
         diagonal is the target itself."
    ));
    let (counts, first) = (ranks.counts(), ranks.confusions());
    section.table(targets(counts, first, names));
    let of = |values: &[usize]| values.iter().map(|v| Cell::from(*v)).collect::<Vec<Cell>>();
    section.table(matrix("first", "Ranked first, trials", names, of(first)));
    section.table(matrix("presented", "Presented, trials", names, of(counts)));
    let means = ranks.means();
    let cells = means.iter().map(|mean| known(*mean, "never met"));
    section.table(matrix("mean-ranks", "Mean rank", names, cells));
    section.figure(heat(
        "mean-ranks-map",
        &experiment.titled("mean ranks, rows are targets"),
        "mean rank",
        names,
        &means,
    ));
    section.figure(by_target(experiment, ranks, names));
    asymmetry(ranks, names, &mut section);
    section
}

/// Targets identified, subjects pooled.
fn by_target(experiment: &Experiment<'_>, ranks: &MeanRanks, names: &[String]) -> Drawn {
    let (n, counts, first) = (names.len(), ranks.counts(), ranks.confusions());
    let bar = |(target, name): (usize, &String)| {
        let cell = target * n + target;
        Bar::share(name, first[cell] as u64, counts[cell] as u64)
    };
    let shown = names.iter().enumerate().map(bar);
    let shown: Vec<Bar> = shown.filter(|bar| bar.interval.is_some()).collect();
    let title = experiment.titled("identified by target, subjects pooled");
    let label = "identified, % (95 % interval)";
    let shown = (shown.as_slice(), Some([0.0, 100.0]));
    bars(
        "targets-bars",
        &title,
        label,
        shown,
        &[(CHANCE_PERCENT, "chance")],
    )
}

fn targets(counts: &[usize], first: &[usize], names: &[String]) -> Table {
    let columns = "target; trials; first: identified; percent: %; ci_low_percent: 95 % CI from; \
        ci_high_percent: to; most_taken_for: most often taken for";
    let title = "Identification by target, subjects pooled";
    let mut table = Table::new("targets", title, columns);
    let n = names.len();
    for (target, name) in names.iter().enumerate() {
        let row = target * n..(target + 1) * n;
        let (of, n_first) = (
            counts[row.clone()][target] as u64,
            first[row.clone()][target] as u64,
        );
        let wrong = first[row].iter().enumerate().filter(|(a, _)| *a != target);
        let most = wrong.clone().map(|(_, v)| *v).max().unwrap_or(0);
        let taken: Vec<&str> = wrong
            .filter(|(_, v)| **v == most && most > 0)
            .map(|(a, _)| names[a].as_str())
            .collect();
        let share = percent_of(n_first, of, "never a target");
        let taken_for = if most > 0 {
            format!("{} ({most})", taken.join(", ")).into()
        } else {
            Cell::none("never mistaken")
        };
        let interval = percent_interval(n_first, of);
        table.push(cells![name, of, n_first, share, interval, taken_for]);
    }
    table
}

fn asymmetry(ranks: &MeanRanks, names: &[String], section: &mut Section) {
    let found = match ranks.asymmetry() {
        Ok(found) => found,
        Err(why) => return section.note(format!("No asymmetry: {}.", why.reason)),
    };
    section.note(format!(
        "Asymmetry of mean ranks, |M − Mᵀ|: mean {}, largest {} over {} pairs.",
        fixed(found.mean, 3),
        fixed(found.largest, 3),
        found.pairs.len()
    ));
    let columns = "one: textile; other: and; difference: |M − Mᵀ|";
    let mut table = Table::new(
        "asymmetry",
        "Asymmetry of mean ranks, largest first",
        columns,
    );
    let mut pairs = found.pairs;
    pairs.sort_by(|a, b| b.1.total_cmp(&a.1).then(a.0.cmp(&b.0)));
    for ([i, j], difference) in pairs {
        table.push(cells![&names[i], &names[j], difference]);
    }
    section.table(table);
}
