//! The table of all methods on a split, as people read it: the best of each column is marked, and
//! who is best by what means something is told in words.

use selvedge_foundation::quantity::fixed;
use selvedge_friction::{Baseline, Measure, Method};

/// A row of the table: who, how many runs, each measure's mean and deviation over seeds.
pub(super) struct Row {
    pub(super) name: &'static str,
    pub(super) n_runs: usize,
    pub(super) measures: [[f64; 2]; Measure::N],
}

/// What is read first: spectra, level, deviations, the paper's own measures.
pub(super) const SHOWN: [(Measure, &str, usize); 9] = [
    (Measure::LogSpectral, "spectrum dB", 2),
    (Measure::LevelError, "level %", 2),
    (Measure::BandEnergy, "bands dB", 2),
    (Measure::DeviationRatio, "deviations", 2),
    (Measure::DominantPeriod, "period mm", 2),
    (Measure::Correlation, "correlation", 2),
    (Measure::SpectrogramRmse, "spectrogram RMSE", 3),
    (Measure::SignalRmsePercent, "signal RMSE %", 2),
    (Measure::SignalMaePercent, "signal MAE %", 2),
];

/// What a measure is at best, and how far from it a value is.
fn off(measure: Measure, value: f64) -> f64 {
    match measure {
        Measure::DeviationRatio => value.ln().abs(),
        Measure::Correlation => -value,
        _ => value,
    }
}

/// The row that is best by a measure, among those that are told nothing of the answer.
fn best(rows: &[Row], measure: Measure) -> Option<&Row> {
    let told_nothing = rows.iter().filter(|row| !is_told_answer(row.name));
    told_nothing.min_by(|a, b| {
        let [a, b] = [a, b].map(|row| off(measure, measure.of(&row.measures)[0]));
        a.total_cmp(&b)
    })
}

/// Whether a row knows something of the trace itself: it cannot win.
fn is_told_answer(name: &str) -> bool {
    let told = Baseline::ALL.into_iter().filter(|one| one.is_told_answer());
    told.map(Baseline::word).any(|word| word == name)
}

/// Who is best by what means something, and by how much before ours.
fn winners(rows: &[Row]) -> Vec<String> {
    let ours = rows.iter().find(|row| row.name == Method::Ours.word());
    let sentence = |(measure, what, unit): (Measure, &str, &str)| {
        let best = best(rows, measure)?;
        let value = |row: &Row| measure.of(&row.measures)[0];
        let before = ours.filter(|ours| ours.name != best.name).map(|ours| {
            let far = fixed(value(ours) - value(best), 2);
            format!(", {far} {unit} before {}", ours.name)
        });
        let told = if best.name == Baseline::Class.word() {
            " (is told the family)"
        } else {
            ""
        };
        Some(format!(
            "best {what}: {}{told}, {} {unit}{}",
            best.name,
            fixed(value(best), 2),
            before.unwrap_or_default()
        ))
    };
    let judged = [
        (Measure::LogSpectral, "spectrum", "dB"),
        (Measure::LevelError, "level", "%"),
    ];
    judged.into_iter().filter_map(sentence).collect()
}

/// The rows for people; a star marks the best of a column.
pub(super) fn table(rows: &[Row]) -> Vec<String> {
    let line = |name: &str, runs: &str, cells: Vec<String>| {
        let cells: Vec<_> = cells.iter().map(|cell| format!("{cell:>16}")).collect();
        format!("{name:17} {runs:>4}  {}", cells.join("  "))
    };
    let head = SHOWN.map(|(_, name, _)| name.to_owned());
    let row = |row: &Row| {
        let cell = |(measure, _, digits): (Measure, &str, usize)| {
            let is_best = best(rows, measure).is_some_and(|best| best.name == row.name);
            let star = if is_best { "*" } else { "" };
            let [mean, sd] = measure
                .of(&row.measures)
                .map(|number| fixed(number, digits));
            if row.n_runs > 1 {
                format!("{star}{mean} ± {sd}")
            } else {
                format!("{star}{mean}")
            }
        };
        line(row.name, &row.n_runs.to_string(), SHOWN.map(cell).to_vec())
    };
    let head = line("method", "runs", head.to_vec());
    let mut lines: Vec<String> = std::iter::once(head).chain(rows.iter().map(row)).collect();
    lines.extend(winners(rows));
    lines
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row(name: &'static str, db: f64, percent: f64, ratio: f64) -> Row {
        let mut measures = [[1.0, 0.0]; Measure::N];
        measures[Measure::LogSpectral as usize][0] = db;
        measures[Measure::LevelError as usize][0] = percent;
        measures[Measure::DeviationRatio as usize][0] = ratio;
        Row {
            name,
            n_runs: 1,
            measures,
        }
    }

    #[test]
    fn the_best_of_each_column_is_marked_and_named_and_one_that_knows_the_answer_never_wins() {
        let rows = [
            row("Bayes floor", 3.1, 0.8, 1.0),
            row("oracle mean", 14.0, 0.0, 0.0),
            row("class spectrum", 5.3, 6.55, 0.5),
            row("ours", 3.99, 6.66, 1.6),
        ];
        let lines = table(&rows);
        assert!(!lines[1].contains('*') && !lines[2].contains('*'));
        assert!(lines[3].contains("*6.55") && !lines[3].contains("*5.30"));
        // A ratio of deviations of 1.6 is nearer to 1 than one of 0.5.
        assert!(lines[4].contains("*3.99") && lines[4].contains("*1.60"));
        assert_eq!(
            lines[5..],
            [
                "best spectrum: ours, 3.99 dB",
                "best level: class spectrum (is told the family), 6.55 %, 0.11 % before ours",
            ]
        );
        assert!(winners(&[]).is_empty());
    }
}
