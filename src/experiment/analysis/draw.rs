//! Figures of the kinds that the papers print, from plain numbers.

use super::model::{Drawn, Table, cells, known, percent_interval};
use selvedge_chart::{
    At, Axis, Chart, ColourBar, Extent, Figure, Ink, Row, Rule, Scale, Series, Style, Tone,
    Upright, Words,
};
use selvedge_statistics::{Summary, mean};

/// Height of a figure's frame, px.
const HEIGHT_PX: f64 = 360.0;

/// A value with its name and, where there is one, its interval.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Bar {
    pub(super) name: String,
    /// Which group it belongs to: bars of one group share a colour.
    pub(super) group: String,
    pub(super) value: f64,
    pub(super) interval: Option<[f64; 2]>,
}

impl Bar {
    pub(crate) fn of(name: &str, group: &str, value: f64, interval: Option<[f64; 2]>) -> Self {
        Self {
            name: name.to_owned(),
            group: group.to_owned(),
            value,
            interval,
        }
    }

    /// A mean over subjects, with its 95 % interval by Student's t where they are two or more.
    pub(super) fn mean(name: &str, group: &str, values: &[f64]) -> Option<Self> {
        let interval = Summary::of(values).and_then(|summary| summary.interval(0.95));
        let ends = interval.ok().map(|ends| [ends.low, ends.high]);
        Some(Self::of(name, group, mean(values).ok()?, ends))
    }

    /// A share, %, with Wilson's interval.
    pub(super) fn share(name: &str, hits: u64, n: u64) -> Self {
        let interval = percent_interval(hits, n).ok();
        let interval = interval.map(|interval| [interval.low, interval.high]);
        Self::of(name, "", 100.0 * hits as f64 / n as f64, interval)
    }
}

/// Bars of percentages beside one to compare with.
pub(super) fn share_bars(
    key: &str,
    (title, label): (&str, &str),
    shown: &[Bar],
    rule: (f64, &str),
) -> Drawn {
    let label = format!("{label} (95 % interval)");
    bars(key, title, &label, (shown, Some([0.0, 100.0])), &[rule])
}

/// Bars with error bars, groups side by side, and levels to compare with.
pub(crate) fn bars(
    key: &str,
    title: &str,
    label: &str,
    (bars, range): (&[Bar], Option<[f64; 2]>),
    rules: &[(f64, &str)],
) -> Drawn {
    let mut names: Vec<&str> = Vec::new();
    let mut groups: Vec<&str> = Vec::new();
    for bar in bars {
        if !names.contains(&bar.name.as_str()) {
            names.push(&bar.name);
        }
        if !groups.contains(&bar.group.as_str()) {
            groups.push(&bar.group);
        }
    }
    // Rows from the top, on an axis that rises.
    let n = names.len() as f64;
    let place = |bar: &Bar| {
        let row = names.iter().position(|name| *name == bar.name);
        let group = groups.iter().position(|group| *group == bar.group);
        let within = (group.unwrap_or(0) as f64 + 0.5) / groups.len() as f64 - 0.5;
        n - row.unwrap_or(0) as f64 - 0.6 * within
    };
    let series = bar_series(bars, &groups, &place);
    let ends = range.unwrap_or_else(|| span(bars));
    let panel = Chart {
        x: Axis {
            label: label.to_owned(),
            range: Some(ends),
            ..Axis::default()
        },
        y: rows_axis(n),
        upright: Upright::Shared,
        series,
        rules: rules
            .iter()
            .map(|(at, label)| dashed(At::X(*at), label))
            .collect(),
        width: 1.0,
        ..Chart::default()
    };
    let height_px = (90.0 + 26.0 * n * (1.0 + 0.3 * (groups.len() as f64 - 1.0))).max(160.0);
    Drawn {
        key: key.to_owned(),
        figure: figure(title, vec![list(&names), panel], height_px, None),
        points: bar_table(bars, label),
    }
}

/// Intervals as lines, then the values of each group as dots.
fn bar_series(bars: &[Bar], groups: &[&str], place: &dyn Fn(&Bar) -> f64) -> Vec<Series> {
    let mut series = Vec::new();
    for bar in bars {
        if let Some([low, high]) = bar.interval {
            let at = place(bar);
            series.push(Series {
                ink: Ink::Grey,
                ..Series::of("", Style::Line, [[low, at], [high, at]])
            });
        }
    }
    for group in groups {
        let own = bars.iter().filter(|bar| bar.group == *group);
        let name = if groups.len() > 1 { group } else { "" };
        let points = own.map(|bar| [bar.value, place(bar)]);
        series.push(Series::of(name, Style::default(), points));
    }
    series
}

/// A panel with names one under the other, beside a panel with their rows.
pub(super) fn list(names: &[&str]) -> Chart {
    let n = names.len() as f64;
    let longest = names
        .iter()
        .map(|name| name.chars().count())
        .max()
        .unwrap_or(0);
    let words = names.iter().enumerate().map(|(at, name)| Words {
        at: [0.1, n - at as f64 + 0.28],
        text: (*name).to_owned(),
        tone: Tone::Aside,
    });
    Chart {
        // No whole number lies between, so that nothing stands below it.
        x: Axis {
            range: Some([0.1, 0.9]),
            scale: Scale::Whole,
            ..Axis::default()
        },
        y: rows_axis(n),
        upright: Upright::Shared,
        words: words.collect(),
        width: (0.06 + 0.012 * longest as f64).clamp(0.1, 0.5),
        ..Chart::default()
    }
}

fn rows_axis(n: f64) -> Axis {
    Axis {
        scale: Scale::Whole,
        range: Some([0.4, n + 0.6]),
        ..Axis::default()
    }
}

fn span(bars: &[Bar]) -> [f64; 2] {
    let values = bars.iter().flat_map(|bar| {
        let ends = bar.interval.unwrap_or([bar.value; 2]);
        [bar.value, ends[0], ends[1]]
    });
    let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| {
        (low.min(v), high.max(v))
    });
    let margin = if high > low { 0.08 * (high - low) } else { 1.0 };
    if low.is_finite() {
        [low - margin, high + margin]
    } else {
        [0.0, 1.0]
    }
}

fn bar_table(bars: &[Bar], label: &str) -> Table {
    let mut table = Table::new("points", "", "name: ; group; value; low: from; high: to");
    label.clone_into(&mut table.columns[2].heading);
    for bar in bars {
        let ends = [0, 1].map(|end| known(bar.interval.map(|ends| ends[end]), "no interval"));
        table.push(cells![&bar.name, &bar.group, bar.value, ends]);
    }
    table
}

fn dashed(at: At, label: &str) -> Rule {
    Rule {
        at,
        label: label.to_owned(),
        ink: Ink::Grey,
        extent: Extent::Dashed,
    }
}

/// Panels side by side under a title.
pub(super) fn figure(
    title: &str,
    panels: Vec<Chart>,
    height_px: f64,
    bar: Option<ColourBar>,
) -> Figure {
    Figure {
        title: title.to_owned(),
        rows: vec![Row {
            panels,
            height_px,
            bar,
        }],
        ..Figure::default()
    }
}

/// Dots and lines by name over two axes.
pub(crate) fn scatter(key: &str, title: &str, axes: [Axis; 2], series: Vec<Series>) -> Drawn {
    let mut points = Table::new("points", "", "series; x; y");
    for (column, axis) in points.columns[1..].iter_mut().zip(&axes) {
        column.heading.clone_from(&axis.label);
    }
    for one in &series {
        for [x, y] in &one.points {
            points.push(cells![&one.name, *x, *y]);
        }
    }
    let [x, y] = axes;
    let panel = Chart {
        x,
        y,
        series,
        ..Chart::default()
    };
    Drawn {
        key: key.to_owned(),
        figure: figure(title, vec![panel], HEIGHT_PX, None),
        points,
    }
}
