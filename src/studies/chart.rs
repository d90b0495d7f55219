//! The plots of studies: error against CPU time, both by their logarithm, one series a method; and
//! what plots of any study are made of.

use super::pareto::error_and_cost;
use super::readable;
use super::{Findings, Front, Row, Study, pareto};
use selvedge_chart::{Axis, Chart, Series, Style};

/// More promises than this are not drawn.
const MOST_PROMISES: usize = 4;

/// A chart of series with a footnote.
pub(super) fn chart(
    title: impl Into<String>,
    x: Axis,
    y: Axis,
    series: Vec<Series>,
    footnote: impl Into<String>,
) -> Chart {
    Chart {
        title: title.into(),
        x,
        y,
        series,
        footnote: footnote.into(),
        ..Chart::default()
    }
}

/// Lines and dots, one for every name among rows in the order in which names come: a dot a row that
/// has a point.
pub(super) fn lines_by<'a>(
    rows: impl IntoIterator<Item = &'a Row>,
    name: fn(&Row) -> &str,
    point: impl Fn(&Row) -> Option<[f64; 2]>,
) -> Vec<Series> {
    let mut lines: Vec<Series> = Vec::new();
    for row in rows {
        let index = place(&mut lines, name(row), Style::LineAndDots);
        lines[index].points.extend(point(row));
    }
    lines
}

/// Where the series of a name stands, which is added if there is none.
pub(super) fn place(all: &mut Vec<Series>, name: &str, style: Style) -> usize {
    let known = all.iter().position(|series| series.name == name);
    known.unwrap_or_else(|| {
        all.push(Series::of(name, style, []));
        all.len() - 1
    })
}

/// A row in the plot: what it costs, its error, whether it is on the front.
type Point = ([f64; 2], bool);

/// Rows of a method by case: what is joined by one line.
type Curves<'a> = Vec<((&'a str, Option<f64>), Vec<Point>)>;

/// The plot of error against run time, one curve a method and case; `None` where no row has both.
pub(super) fn error_against_time(study: &Study, findings: &Findings) -> Option<Chart> {
    let on_front = pareto(&findings.rows);
    let mut methods: Vec<(&str, Curves<'_>)> = Vec::new();
    let mut ends_s = [f64::INFINITY, 0.0_f64];
    for (row, is_on_front) in findings.rows.iter().zip(on_front) {
        let Some((error, cost_s)) = error_and_cost(row) else {
            continue;
        };
        ends_s = [ends_s[0].min(cost_s), ends_s[1].max(cost_s)];
        let curves = of_key(&mut methods, row.method.as_str());
        let curve = of_key(curves, (row.case.as_str(), row.size));
        curve.push(([cost_s, error], is_on_front == Some(Front::On)));
    }
    if methods.is_empty() {
        return None;
    }
    let mut series: Vec<Series> = methods.into_iter().map(joined).collect();
    let (measure, unit) = study.error;
    series.extend(promises(&findings.rows, ends_s, unit));
    let y_label = [measure, unit].join(", ");
    Some(chart(
        format!("{}: {measure} against run time", titled(study.name)),
        Axis::log(format!("CPU time a {}, s", study.cost_of)),
        Axis::log(y_label.trim_end_matches(", ")),
        series,
        format!(
            "A line joins the settings of a method on one case. Ringed: on its case nothing else \
             is both surely cheaper and as exact. An error of exactly 0 has no place. Numbers: \
             {}.csv.",
            study.name
        ),
    ))
}

/// What belongs to a key, which is added if it is new.
fn of_key<K: PartialEq, V: Default>(all: &mut Vec<(K, V)>, key: K) -> &mut V {
    let at = all.iter().position(|(known, _)| *known == key);
    let at = at.unwrap_or_else(|| {
        all.push((key, V::default()));
        all.len() - 1
    });
    &mut all[at].1
}

/// The curves of a method as one series, which is broken between cases.
fn joined((method, curves): (&str, Curves<'_>)) -> Series {
    let mut series = Series::of(method, Style::default(), []);
    for (_, mut curve) in curves {
        curve.sort_by(|a, b| a.0[0].total_cmp(&b.0[0]));
        if curve.len() > 1 {
            series.style = Style::LineAndDots;
        }
        if !series.points.is_empty() {
            series.points.push([f64::NAN; 2]);
        }
        for (point, is_on_front) in curve {
            if is_on_front {
                series.marked.push(series.points.len());
            }
            series.points.push(point);
        }
    }
    series
}

/// The promises as dashed lines, unless there are too many different ones.
fn promises(rows: &[Row], ends_s: [f64; 2], unit: &str) -> Vec<Series> {
    let mut promised: Vec<f64> = Vec::new();
    let drawn = rows.iter().filter(|row| row.cost.is_some());
    for promise in drawn.filter_map(|row| row.promised) {
        if promise > 0.0 && promise.is_finite() && !promised.contains(&promise) {
            promised.push(promise);
        }
    }
    if promised.len() > MOST_PROMISES {
        return Vec::new();
    }
    let line = |promise: f64| {
        let name = format!("promised: {} {unit}", readable::number(promise));
        Series::of(name.trim(), Style::Dashed, ends_s.map(|x| [x, promise]))
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
