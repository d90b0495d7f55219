//! The plot of a study: error against CPU time, both by their logarithm, one series a method.

use super::pareto::error_and_cost;
use super::readable;
use super::{Findings, Row, Study, pareto};
use selvedge_chart::{Axis, Chart, Series, Style};

/// More promises than this are not drawn.
const MOST_PROMISES: usize = 4;

/// The plot of error against run time; `None` where no row has both.
pub(super) fn error_against_time(study: &dyn Study, findings: &Findings) -> Option<Chart> {
    let on_front = pareto(&findings.rows);
    let mut series: Vec<Series> = Vec::new();
    let (mut soonest_s, mut latest_s) = (f64::INFINITY, 0.0_f64);
    for (row, is_on_front) in findings.rows.iter().zip(on_front) {
        let Some((error, cost_s)) = error_and_cost(row) else {
            continue;
        };
        (soonest_s, latest_s) = (soonest_s.min(cost_s), latest_s.max(cost_s));
        let known = series.iter().position(|series| series.name == row.method);
        let place = known.unwrap_or_else(|| {
            series.push(Series {
                name: row.method.clone(),
                ..Series::default()
            });
            series.len() - 1
        });
        let series = &mut series[place];
        if is_on_front == Some(true) {
            series.marked.push(series.points.len());
        }
        series.points.push([cost_s, error]);
    }
    if series.is_empty() {
        return None;
    }
    series.extend(promises(
        &findings.rows,
        [soonest_s, latest_s],
        study.error_measure().1,
    ));
    let (measure, unit) = study.error_measure();
    let y_label = if unit.is_empty() {
        measure.to_owned()
    } else {
        format!("{measure}, {unit}")
    };
    Some(Chart {
        title: format!("{}: {measure} against run time", titled(study.name())),
        x: Axis::log(format!("CPU time a {}, s", study.cost_of())),
        y: Axis::log(y_label),
        series,
        footnote: format!(
            "Ringed: on its case nothing else is both cheaper and more exact. An error of \
             exactly 0 has no place. Numbers: {}.csv.",
            study.name()
        ),
        ..Chart::default()
    })
}

/// The promises as dashed lines, unless there are too many different ones.
fn promises(rows: &[Row], [soonest_s, latest_s]: [f64; 2], unit: &str) -> Vec<Series> {
    let mut promised: Vec<f64> = Vec::new();
    let drawn = rows.iter().filter(|row| row.cost.is_some());
    for promise in drawn.filter_map(|row| row.promised) {
        if promise > 0.0 && !promised.contains(&promise) {
            promised.push(promise);
        }
    }
    if promised.len() > MOST_PROMISES {
        return Vec::new();
    }
    let line = |promise: f64| Series {
        name: format!("promised: {} {unit}", readable::number(promise))
            .trim()
            .to_owned(),
        points: vec![[soonest_s, promise], [latest_s, promise]],
        style: Style::Dashed,
        ..Series::default()
    };
    promised.into_iter().map(line).collect()
}

/// A study's name as a heading: `left-out` is `Left out`.
pub(super) fn titled(name: &str) -> String {
    let mut letters = name.chars();
    let first = letters.next().map(|c| c.to_uppercase().to_string());
    format!(
        "{}{}",
        first.unwrap_or_default(),
        letters.as_str().replace('-', " ")
    )
}
