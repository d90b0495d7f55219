//! What wider networks and longer training gain on cloths that were held back, and what they cost:
//! from the runs that are shipped, since each takes minutes.

use crate::chart::{chart, lines_by};
use crate::{Bench, Findings, ReportError, Row, Study};
use selvedge_chart::{Axis, Chart};
use selvedge_foundation::quantity::fixed;
use selvedge_friction::{KeptRun, Measure, Method, Split};

/// The study.
pub(crate) const STUDY: Study = Study {
    name: "friction-training",
    chapter: "friction",
    question: "What do wider networks and longer training gain on cloths that were held back?",
    reference: "Procedural cloths that were held back, and the friction that was felt on them.",
    error: ("distance of spectra, mean", "dB"),
    cost_of: "training",
    run: training,
};

/// Channels and rounds of what is shipped.
const USUAL: [f64; 2] = [16.0, 8.0];
/// What is changed: the width, or the rounds.
const CHANGED: [&str; 2] = ["8 rounds, by width", "16 channels, by rounds"];

fn training(bench: &mut Bench<'_>) -> Result<Findings, ReportError> {
    bench.step(0.0, "reading the runs that are shipped")?;
    let shipped = KeptRun::shipped()?;
    let of_seed = |run: &&KeptRun| {
        let is_ours = run.model == Method::Ours.word() && run.split == Split::Cloths.letter();
        is_ours && run.lesson[0] == Some(1.0)
    };
    let mut rows = Vec::new();
    for (nth, method) in CHANGED.into_iter().enumerate() {
        let mut found: Vec<(f64, Row)> = shipped
            .iter()
            .filter(of_seed)
            .filter_map(|run| row(run, nth, method))
            .collect();
        found.sort_by(|a, b| a.0.total_cmp(&b.0));
        rows.extend(found.into_iter().map(|(_, row)| row));
    }
    let plots = [("width", "channels", 0), ("rounds", "rounds", 1)];
    let mut plots: Vec<(String, Chart)> = plots
        .into_iter()
        .map(|(name, axis, nth)| {
            let of_method = rows.iter().filter(|row| row.method == CHANGED[nth]);
            (name.to_owned(), drawn(of_method, axis, |row| row.size))
        })
        .collect();
    let cpu_s = |row: &Row| row.more[1].1.parse().ok();
    plots.push((
        "time".to_owned(),
        drawn(&rows, "CPU time of training, s", cpu_s),
    ));
    let notes = [
        "Ours, split A, one seed: another moves the distance by about 0.02 dB.",
        "The runs of assets/friction/runs.csv, made by selvedge friction train with --width and \
         --rounds on a machine that did other work beside: processor time, not time that passed.",
    ];
    Ok(Findings::new(rows, plots, notes))
}

/// A run in which nothing but width (0) or rounds (1) is changed.
fn row(run: &KeptRun, changed: usize, method: &'static str) -> Option<(f64, Row)> {
    let [_, width, rounds] = run.lesson;
    let size = [width?, rounds?];
    let same = 1 - changed;
    if size[same].total_cmp(&USUAL[same]).is_ne() {
        return None;
    }
    let level = fixed(Measure::LevelError.of(&run.measures), 2);
    let cpu_s = run.cpu_s.map(|s| fixed(s, 0)).unwrap_or_default();
    let row = Row {
        error: Some(Measure::LogSpectral.of(&run.measures)),
        size: Some(size[changed]),
        more: vec![
            ("level error, %", level),
            ("CPU time of training, s", cpu_s),
        ],
        ..Row::of(
            method,
            format!("{} channels, {} rounds", size[0], size[1]),
            "split A, seed 1",
        )
    };
    Some((size[changed], row))
}

fn drawn<'a>(
    rows: impl IntoIterator<Item = &'a Row>,
    axis: &str,
    place: impl Fn(&Row) -> Option<f64>,
) -> Chart {
    let lines = lines_by(
        rows,
        |row| &row.method,
        |row| Some([place(row)?, row.error?]),
    );
    chart(
        "Held-back error of training",
        Axis::log(axis),
        Axis::linear("distance of spectra, mean, dB"),
        lines,
        "Split A: cloths that were never seen.",
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tests::quick;

    #[test]
    fn longer_training_and_wider_networks_miss_less_and_cost_more() {
        let findings = quick(&STUDY, 1);
        for method in CHANGED {
            let of = |row: &&Row| row.method == method;
            let rows: Vec<&Row> = findings.rows.iter().filter(of).collect();
            assert!(rows.len() >= 2, "{method}: {rows:?}");
            let ends = [rows[0], rows[rows.len() - 1]];
            let [little, much] = ends.map(|row| row.error.unwrap());
            assert!(much < little, "{method}: {little} dB, then {much} dB");
            let [little, much] = ends.map(|row| row.more[1].1.parse::<f64>().unwrap());
            assert!(much > little, "{method}: {little} s, then {much} s");
        }
        let [width, rounds, time] = &*findings.plots else {
            panic!("{} plots", findings.plots.len());
        };
        assert_eq!((width.1.series.len(), rounds.1.series.len()), (1, 1));
        let n_points = |chart: &Chart| chart.series.iter().map(|s| s.points.len()).sum::<usize>();
        assert_eq!(n_points(&time.1), findings.rows.len());
    }
}
