//! Whether the speeds of each subject matter to how a map lies to what was measured.

use super::map::Mapping;
use super::model::{Cell, Table, cells};
use super::properties::{Measure, Own};
use selvedge_statistics::pearson_r;
use selvedge_statistics::properties::BestTurn;

const SPEEDS: &str = "subject; paths: trials with a path; trials: of trials; moving_s: moving, s; \
    slow_mm_per_s: speed, 10 %, mm/s; median_mm_per_s: median; fast_mm_per_s: 90 %; r1: r of axis \
    1 with own A40; r2: r of axis 2 with own A320; r40: r of own A40 with that at 100 mm/s; r320: \
    r of own A320";
/// Measures of both axes.
const BANDS: [&str; 2] = ["a40_db", "a320_db"];

impl Mapping<'_> {
    /// How each subject moved, and how the group's map, turned to levels at the speed of reference,
    /// lies to levels at the subject's own speeds; `None` where no path was recorded.
    pub(super) fn own_speeds(&self, turn: Option<&BestTurn>) -> Option<Table> {
        if self.measures.own.is_empty() {
            return None;
        }
        let title = "Subjects' own speeds: the turned map against levels at them";
        let mut table = Table::new("own-speeds", title, SPEEDS);
        let named = |suffix: &str| {
            let of = |name: &str| self.measures.named(&format!("{name}{suffix}"));
            BANDS.map(of)
        };
        let reference = named("");
        let all = |described: &str, measures: [Option<&Measure>; 2]| {
            let blank = vec![Cell::none("of every subject below"); 6];
            cells![described, blank, correlations(turn, measures, reference)]
        };
        table.push(all("all, at 100 mm/s", reference));
        table.push(all("all, mean of own", named("_own_speed")));
        for own in &self.measures.own {
            table.push(cells![&own.subject, of_subject(own, turn, reference)]);
        }
        Some(table)
    }
}

fn of_subject(own: &Own, turn: Option<&BestTurn>, reference: [Option<&Measure>; 2]) -> Vec<Cell> {
    let Some((speeds, measures)) = &own.moved else {
        let blank = vec![Cell::none("no recorded path that moves"); 8];
        return cells![0_usize, own.n_trials, blank];
    };
    let bands = BANDS.map(|name| measures.iter().find(|measure| measure.name == name));
    cells![
        speeds.n_paths,
        own.n_trials,
        speeds.moving_s,
        speeds.tenths_mm_per_s,
        correlations(turn, bands, reference),
    ]
}

/// Of the axes with two measures, and of these with the same at the speed of reference.
fn correlations(
    turn: Option<&BestTurn>,
    measures: [Option<&Measure>; 2],
    reference: [Option<&Measure>; 2],
) -> Vec<Cell> {
    let silent = "a textile is silent at these speeds";
    let axis = |at: usize| match (turn, measures[at]) {
        (None, _) => Cell::none("the map has no turn"),
        (_, None) => Cell::none(silent),
        (Some(turn), Some(measure)) => {
            let along: Vec<f64> = turn.points.iter().map(|p| p[at]).collect();
            Cell::from(&pearson_r(&along, &measure.values))
        }
    };
    let with = |at: usize| match measures[at].zip(reference[at]) {
        Some((own, other)) => Cell::from(&pearson_r(&own.values, &other.values)),
        None => Cell::none(silent),
    };
    cells![[0, 1].map(axis), [0, 1].map(with)]
}
