//! Whether the speeds of each subject matter to how a map lies to what was measured.

use super::map::Mapping;
use super::model::{Cell, Table};
use super::properties::{Measure, Own};
use selvedge_statistics::pearson_r;
use selvedge_statistics::properties::BestTurn;

const SPEEDS: [(&str, &str); 11] = [
    ("subject", "subject"),
    ("paths", "trials with a path"),
    ("trials", "of trials"),
    ("moving_s", "moving, s"),
    ("slow_mm_per_s", "speed, 10 %, mm/s"),
    ("median_mm_per_s", "median"),
    ("fast_mm_per_s", "90 %"),
    ("r1", "r of axis 1 with own A40"),
    ("r2", "r of axis 2 with own A320"),
    ("r40", "r of own A40 with that at 100 mm/s"),
    ("r320", "r of own A320"),
];
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
        let mut table = Table::new("own-speeds", title, &SPEEDS);
        let named = |suffix: &str| {
            let of = |name: &str| self.measures.named(&format!("{name}{suffix}"));
            BANDS.map(of)
        };
        let reference = named("");
        let all = |told: &str, measures: [Option<&Measure>; 2]| {
            let mut row = vec![Cell::from(told)];
            row.extend((0..6).map(|_| Cell::none("of every subject below")));
            row.extend(correlations(turn, measures, reference));
            row
        };
        table.push(all("all, at 100 mm/s", reference));
        table.push(all("all, mean of own", named("_own_speed")));
        for own in &self.measures.own {
            let mut row = vec![Cell::from(own.subject.as_str())];
            row.extend(of_subject(own, turn, reference));
            table.push(row);
        }
        Some(table)
    }
}

fn of_subject(own: &Own, turn: Option<&BestTurn>, reference: [Option<&Measure>; 2]) -> Vec<Cell> {
    let Some((speeds, measures)) = &own.moved else {
        let mut row = vec![Cell::from(0_usize), own.n_trials.into()];
        row.extend((2..10).map(|_| Cell::none("no recorded path that moves")));
        return row;
    };
    let mut row = vec![
        speeds.n_paths.into(),
        own.n_trials.into(),
        speeds.moving_s.into(),
    ];
    row.extend(speeds.tenths_mm_per_s.map(Cell::from));
    let own = BANDS.map(|name| measures.iter().find(|measure| measure.name == name));
    row.extend(correlations(turn, own, reference));
    row
}

/// Of the axes with two measures, and of these with the same at the speed of reference.
fn correlations(
    turn: Option<&BestTurn>,
    measures: [Option<&Measure>; 2],
    reference: [Option<&Measure>; 2],
) -> Vec<Cell> {
    let silent = "a textile is silent at these speeds";
    let axis = |at: usize| -> Cell {
        match (turn, measures[at]) {
            (None, _) => Cell::none("the map has no turn"),
            (_, None) => Cell::none(silent),
            (Some(turn), Some(measure)) => {
                let along: Vec<f64> = turn.points.iter().map(|p| p[at]).collect();
                Cell::of(&pearson_r(&along, &measure.values))
            }
        }
    };
    let with = |at: usize| match measures[at].zip(reference[at]) {
        Some((own, other)) => Cell::of(&pearson_r(&own.values, &other.values)),
        None => Cell::none(silent),
    };
    vec![axis(0), axis(1), with(0), with(1)]
}
