//! What savings save, drawn: the cost of a tick with all of them and with each alone, as a share of
//! the cost with none, on every scene.

use super::scenes::Case;
use super::{ALL, NONE};
use crate::Row;
use selvedge_chart::{Axis, Plot, Series, Style};
use selvedge_render::array::Method;

/// The plot and the name of its file; scenes stand side by side in their order.
pub(super) fn plot(rows: &[Row], cases: &[Case]) -> (String, Plot) {
    // Tables are tried with every setting on every scene; `banded` with few on the largest.
    let method = Method::Table.name();
    let own: Vec<&Row> = rows.iter().filter(|row| row.method == method).collect();
    let cost_s = |case: &Case, setting: &str| {
        let is_it = |row: &&&Row| row.case == case.name && row.setting == setting;
        Some(own.iter().find(is_it)?.cost?.cpu_s)
    };
    let mut settings: Vec<&str> = Vec::new();
    for row in own.iter().filter(|row| row.cost.is_some()) {
        if row.setting != NONE && !settings.contains(&&row.setting[..]) {
            settings.push(&row.setting);
        }
    }
    let series = settings.into_iter().map(|setting| {
        let share = |(nth, case): (usize, &Case)| {
            let share = cost_s(case, setting)? / cost_s(case, NONE)?;
            Some([nth as f64 + 1.0, share])
        };
        Series {
            name: setting.to_owned(),
            points: cases.iter().enumerate().filter_map(share).collect(),
            style: if setting == ALL {
                Style::LineAndDots
            } else {
                Style::Dots
            },
            ..Series::default()
        }
    });
    let names = cases
        .iter()
        .zip(1..)
        .map(|(case, nth)| format!("{nth} {}", case.name));
    let names: Vec<String> = names.collect();
    let plot = Plot {
        title: format!("What savings save of a tick by {method}"),
        x: Axis::whole("scene").within([0.5, cases.len() as f64 + 0.5]),
        y: Axis::log("CPU time as a share of that with no saving"),
        series: series.collect(),
        footnote: format!("Scenes: {}.", names.join(", ")),
    };
    ("shares".to_owned(), plot)
}
