//! What the pane draws, as charts: the array and the stylus over the same second, force over the
//! way, spectra, the tip in its relief, and what can be held.

use std::collections::VecDeque;

use selvedge_chart::{Axis, Chart, Columns, Ink, Series, Style, Weight};
use selvedge_engine::TICKS_PER_S;
use selvedge_foundation::numerics::extent;
use selvedge_foundation::quantity;
use selvedge_render::contact::{Relief, StylusRow};

use super::follow::{FeltRow, WINDOW};
use crate::bench::signals::amplitudes::hann_amplitudes;
use crate::kit::plot::thinned;

/// What a row says.
type Figure = fn(&StylusRow) -> f64;

/// Lines are drawn by the least and the largest of so many parts.
const N_PARTS: usize = 400;
/// The lowest level that is shown of the array, dB re 1 µm.
const LOWEST_DB: f64 = -40.0;
/// Frequencies of the spectra, Hz.
const FREQUENCIES_HZ: [f64; 2] = [5.0, 1000.0];
/// Amplitudes of the spectra that are shown, N.
const AMPLITUDES_N: [f64; 2] = [1e-5, 1.0];
/// Fewer rows have no spectrum.
const FEWEST: usize = 64;
/// Points of a relief.
const N_RELIEF: i32 = 240;

/// The rows of one second, up to a column of the history.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Second<'a> {
    pub(crate) rows: &'a VecDeque<FeltRow>,
    /// The column at its end.
    pub(crate) end: u64,
}

impl Second<'_> {
    /// When a row was, s from the end.
    fn t_s(&self, column: f64) -> f64 {
        (column - self.end as f64) / TICKS_PER_S
    }

    /// A line of what rows say, with a gap between runs.
    fn line(&self, x: &dyn Fn(&FeltRow) -> f64, y: &dyn Fn(&FeltRow) -> f64) -> Vec<[f64; 2]> {
        let (mut line, mut run, mut before_s) = (Vec::new(), Vec::new(), -1.0);
        for row in self.rows {
            if row.felt.t_s <= before_s {
                line.extend(thinned(&run, N_PARTS));
                line.push([f64::NAN; 2]);
                run.clear();
            }
            before_s = row.felt.t_s;
            run.push([x(row), y(row)]);
        }
        line.extend(thinned(&run, N_PARTS));
        line
    }

    /// The rows of the last run, which follow each other without a gap.
    fn last_run(&self) -> Vec<&FeltRow> {
        let mut last: Vec<&FeltRow> = Vec::new();
        for row in self.rows.iter().rev() {
            if last
                .last()
                .is_some_and(|after| after.felt.t_s <= row.felt.t_s)
            {
                break;
            }
            last.push(row);
        }
        last.reverse();
        last
    }

    /// The numbers as `selvedge probe` writes them, with time from the end.
    pub(crate) fn columns(&self) -> Columns {
        let t_s: Vec<f64> = self.rows.iter().map(|row| self.t_s(row.column)).collect();
        let start = Columns::default().with("t_s", t_s);
        let [_, others @ ..] = StylusRow::COLUMNS;
        others.iter().fold(start, |columns, (name, of)| {
            let values: Vec<f64> = self.rows.iter().map(|row| of(&row.felt)).collect();
            columns.with(*name, values)
        })
    }
}

fn series(name: &str, points: Vec<[f64; 2]>, (ink, weight): (Ink, Weight)) -> Series {
    Series {
        ink,
        weight,
        ..Series::of(name, Style::Line, points)
    }
}

fn time() -> Axis {
    let s = WINDOW as f64 / TICKS_PER_S;
    Axis::linear("time before now, s").within([-s, 0.0])
}

/// The mean level of the array's contactors, ticks of [A40, A320] in µm.
pub(crate) fn array(second: Second<'_>, ticks: &[(u64, [f64; 2])]) -> Chart {
    let line = |band: usize| -> Vec<[f64; 2]> {
        let mut line = Vec::new();
        for (nth, (column, um)) in ticks.iter().enumerate() {
            if nth > 0 && ticks[nth - 1].0 + 1 < *column {
                line.push([f64::NAN; 2]);
            }
            let db = quantity::level_db(um[band]).max(LOWEST_DB);
            line.push([second.t_s(*column as f64), db]);
        }
        line
    };
    Chart {
        title: "Array, mean of its contactors".to_owned(),
        x: time(),
        y: Axis::linear("level, dB re 1 µm").within([LOWEST_DB, 40.0]),
        series: vec![
            series("A40", line(0), (Ink::Amber, Weight::Normal)),
            series("A320", line(1), (Ink::Cyan, Weight::Normal)),
        ],
        ..Chart::default()
    }
}

/// A line over time: its name, what it says of a row, and how it is drawn.
type Line = (&'static str, fn(&FeltRow) -> f64, (Ink, Weight));

/// Charts of the stylus over the second, each with its title, what it measures, and its lines.
const OVER_TIME: [(&str, &str, &[Line]); 3] = [
    (
        "Stylus, contact force",
        "force, N",
        &[
            ("contact", |row| row.felt.force_n, THIN),
            ("below 10 Hz", |row| slow_n(&row.felt), STRONG),
            ("friction", |row| row.felt.tangential_n, ROSE),
        ],
    ),
    (
        "Stylus, vibration",
        "drive, N",
        &[("above 10 Hz", |row| row.felt.vibration_n, THIN)],
    ),
    (
        "Energy",
        "energy, mJ",
        &[
            ("tip and contact", |row| 1e3 * row.felt.energy_j, GREY),
            ("taken less given", |row| 1e3 * row.observed_j, STRONG),
        ],
    ),
];
const THIN: (Ink, Weight) = (Ink::Violet, Weight::Thin);
const STRONG: (Ink, Weight) = (Ink::Black, Weight::Normal);
const ROSE: (Ink, Weight) = (Ink::Rose, Weight::Thin);
const GREY: (Ink, Weight) = (Ink::Grey, Weight::Normal);

/// What a device can give.
fn slow_n(row: &StylusRow) -> f64 {
    row.force_n - row.vibration_n
}

/// Force, what a vibrating tip is left with, and energy.
pub(crate) fn over_time(second: Second<'_>) -> [Chart; 3] {
    OVER_TIME.map(|(title, y, lines)| Chart {
        title: title.to_owned(),
        x: time(),
        y: Axis::linear(y),
        series: (lines.iter())
            .map(|(name, of, pen)| {
                let line = second.line(&|row| second.t_s(row.column), of);
                series(name, line, *pen)
            })
            .collect(),
        ..Chart::default()
    })
}

/// Force over the way along the surface, of the run under way.
pub(crate) fn over_way(second: Second<'_>) -> Chart {
    let run = second.last_run();
    let end_mm = run.last().map_or(0.0, |row| row.way_mm);
    let points: Vec<[f64; 2]> = run
        .iter()
        .map(|row| [row.way_mm - end_mm, row.felt.force_n])
        .collect();
    Chart {
        title: "Contact force along the way".to_owned(),
        x: Axis::linear("way before here, mm"),
        y: Axis::linear("force, N"),
        series: vec![series("", thinned(&points, N_PARTS), THIN)],
        ..Chart::default()
    }
}

/// Peak amplitudes of what a device gives and of what is left to vibration, under a Hann window
/// (periodic) whose gain is compensated.
pub(crate) fn spectra(second: Second<'_>) -> Chart {
    let run = second.last_run();
    let rows = &run[run.len() % 2..];
    let parts: [Figure; 2] = [slow_n, |row| row.vibration_n];
    let lines = parts.map(|part| amplitudes(rows, part));
    let [low, high] = lines.map(|line| thinned(&line, N_PARTS));
    let [least, most] = AMPLITUDES_N;
    let largest = low.iter().chain(&high).map(|point| point[1]);
    let [_, largest] = extent(largest.chain([most]));
    Chart {
        title: "Spectra of the same second".to_owned(),
        x: Axis::log("frequency, Hz").within(FREQUENCIES_HZ),
        y: Axis::log("amplitude, N").within([least, largest]),
        series: vec![
            series("force", low, STRONG),
            series("vibration", high, THIN),
        ],
        ..Chart::default()
    }
}

fn amplitudes(rows: &[&FeltRow], part: Figure) -> Vec<[f64; 2]> {
    let (Some(first), Some(last)) = (rows.first(), rows.last()) else {
        return Vec::new();
    };
    let n = rows.len();
    let span_s = (last.felt.t_s - first.felt.t_s) * n as f64 / (n as f64 - 1.0);
    if n < FEWEST || span_s <= 0.0 {
        return Vec::new();
    }
    let values: Vec<f64> = rows.iter().map(|row| part(&row.felt)).collect();
    let bins = hann_amplitudes(&values, span_s).into_iter();
    let bins = bins.map(|[hz, amplitude]| [hz, amplitude.max(AMPLITUDES_N[0])]);
    let [low, high] = FREQUENCIES_HZ;
    bins.filter(|[hz, _]| (low..=high).contains(hz)).collect()
}

/// The tip in its relief, along the way that it moves, and where it would rest without force, on
/// the relief under the whole tip; `aspect` is the frame's height over its
/// width, by which heights are drawn larger than lengths, and said so.
pub(crate) fn section(
    second: Second<'_>,
    [relief, under_tip]: [&Relief; 2],
    radius_mm: f64,
    aspect: f64,
) -> Option<Chart> {
    let run = second.last_run();
    let tip = run.last()?.felt;
    let [u, w, z_mm] = tip.place_mm;
    let moved = run.iter().rev().find_map(|row| {
        let way = [u - row.felt.place_mm[0], w - row.felt.place_mm[1]];
        let length = way[0].hypot(way[1]);
        (length > 1e-3).then(|| way.map(|mm| mm / length))
    });
    let along = moved.unwrap_or([1.0, 0.0]);
    let half_mm = (3.0 * radius_mm).max(1.0);
    let at = |share: f64| share * half_mm;
    let heights: Vec<[f64; 2]> = (-N_RELIEF..=N_RELIEF)
        .map(|i| {
            let s_mm = at(f64::from(i) / f64::from(N_RELIEF));
            let place = [u + s_mm * along[0], w + s_mm * along[1]];
            [s_mm, 1e3 * relief.height_mm(place)]
        })
        .collect();
    let rest_mm = under_tip.height_mm([u, w]);
    let [low, high] = extent(heights.iter().map(|point| point[1]).chain([1e3 * z_mm]));
    let span_um = (1.6 * (high - low)).max(20.0);
    let ends = [low - 0.1 * span_um, low + span_um];
    let ball = |bottom_mm: f64| -> Vec<[f64; 2]> {
        let places = (-N_RELIEF..=N_RELIEF).map(|i| f64::from(i) / f64::from(N_RELIEF));
        let underside = places.map(|share| {
            let rise_mm = radius_mm * (1.0 - (1.0 - share * share).max(0.0).sqrt());
            [share * radius_mm, 1e3 * (bottom_mm + rise_mm)]
        });
        underside.filter(|[_, um]| *um <= ends[1]).collect()
    };
    let resting = Series {
        style: Style::Dashed,
        ..series("without force", ball(rest_mm), GREY)
    };
    let times = 2.0 * half_mm * aspect / (1e-3 * (ends[1] - ends[0]));
    Some(Chart {
        title: "Tip and relief".to_owned(),
        x: Axis::linear("along the way, mm").within([-half_mm, half_mm]),
        y: Axis::linear(format!(
            "height, drawn {} times, µm",
            quantity::fixed(times, 1)
        ))
        .within(ends),
        series: vec![
            series("relief", heights, STRONG),
            resting,
            series("tip", ball(z_mm), (Ink::Violet, Weight::Bold)),
        ],
        ..Chart::default()
    })
}
