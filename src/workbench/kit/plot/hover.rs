//! What a chart says where the pointer is: every series at once, and one cursor through all charts
//! of a link.

use eframe::egui::{Id, Pos2, Stroke, Ui};

use crate::kit::plot::{Setting, Shown, around};
use crate::kit::theme::Palette;
use selvedge_chart::{Chart, Ruler, Series, Style};

/// The place that is pointed at in one of the charts of a link.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Cursor {
    x: f64,
    by: Id,
}

/// Paints the cursor and names what every series says at the pointer.
pub(crate) fn show(ui: &Ui, chart: &Chart, shown: &Shown, setting: &Setting<'_>) {
    let pointer = shown.pointer();
    if let Some(link) = setting.link {
        let cursor = shared_cursor(ui, link, shown, pointer);
        if let Some(cursor) = cursor {
            let x = shown
                .at([cursor.x, shown.values_at(shown.area().center())[1]])
                .x;
            if shown.area().x_range().contains(x) {
                let ink = Palette::in_ui(ui).dim.gamma_multiply(0.6);
                ui.painter()
                    .vline(x, shown.area().y_range(), Stroke::new(1.0, ink));
            }
        }
    }
    let Some(at) = pointer.filter(|_| setting.hover && !shown.response.dragged()) else {
        return;
    };
    let rulers = around::rulers(&shown.transform, shown.scales);
    if let Some(words) = describe(chart, &rulers, shown.values_at(at)[0]) {
        let words = format!("{words}\n{}", setting.note);
        let response = shown.response.clone();
        response.on_hover_text_at_pointer(words.trim_end());
    }
}

/// The cursor of a link, after this chart's pointer.
fn shared_cursor(ui: &Ui, link: &str, shown: &Shown, pointer: Option<Pos2>) -> Option<Cursor> {
    let (id, by) = (Id::unique((link, "cursor")), shown.response.id);
    let before: Option<Cursor> = ui.data(|data| data.get_temp(id));
    let own = pointer.map(|at| Cursor {
        x: shown.values_at(at)[0],
        by,
    });
    let cursor = own.or_else(|| before.filter(|cursor| cursor.by != by));
    if cursor != before {
        ui.data_mut(|data| match cursor {
            Some(cursor) => {
                data.insert_temp(id, cursor);
            }
            None => data.remove::<Cursor>(id),
        });
        // Those that were already drawn follow at once.
        ui.ctx().request_repaint();
    }
    cursor
}

/// What every line and every row of bars says at a value of the horizontal axis.
fn describe(chart: &Chart, [across, up]: &[Ruler; 2], x: f64) -> Option<String> {
    let (x_axis, y_axis) = (&chart.x.label, &chart.y.label);
    let lines = chart
        .series
        .iter()
        .filter(|series| series.style != Style::Dots);
    let values = lines.filter_map(|series| {
        let at = nearest(series, across, x)?;
        Some((&series.name, at[0], at[1]))
    });
    let bars = chart.bars.iter().filter_map(|bars| {
        let bin = bars.bins.iter().find(|bin| bin[0] <= x && x < bin[1])?;
        Some((&bars.name, x, bin[2]))
    });
    let found: Vec<_> = values.chain(bars).collect();
    let [(_, first, _), ..] = found[..] else {
        return None;
    };
    let mut words = across.reading(x_axis, first);
    for (name, _, y) in found {
        let value = up.reading(y_axis, y);
        words += &format!("\n{name}  {value}").replace("\n  ", "\n");
    }
    Some(words)
}

/// The point of a series that lies nearest along the horizontal axis, if the series reaches there.
fn nearest(series: &Series, across: &Ruler, x: f64) -> Option<[f64; 2]> {
    let place = |value: f64| across.scale().place(value);
    let at = place(x)?;
    let seen = series.points.iter().filter(|point| point[1].is_finite());
    let distances = seen.filter_map(|point| Some(((place(point[0])? - at).abs(), *point)));
    let nearest = distances.min_by(|a, b| a.0.total_cmp(&b.0));
    nearest.map(|(_, point)| point)
}

#[cfg(test)]
mod tests {
    use super::*;
    use selvedge_chart::{Axis, Bars};

    #[test]
    fn every_series_is_named_with_its_value_there() {
        let line = |name: &str, points: &[[f64; 2]]| Series {
            name: name.to_owned(),
            points: points.to_vec(),
            style: Style::Line,
            ..Series::default()
        };
        let mut chart = Chart {
            x: Axis::linear("time, s").within([0.0, 0.05]),
            y: Axis::linear("displacement, µm").within([-2.0, 2.0]),
            series: vec![
                line("40 Hz", &[[0.0, 0.0], [0.01, 1.25], [0.02, f64::NAN]]),
                line("sum", &[[0.0, 1.0], [0.02, -0.5]]),
                Series {
                    name: "dots".to_owned(),
                    points: vec![[0.01, 1.0]],
                    ..Series::default()
                },
            ],
            ..Chart::default()
        };
        let words = describe(&chart, &chart.rulers(), 0.012).unwrap();
        assert_eq!(words, "10.0 ms\n40 Hz  1.25 µm\nsum  −0.50 µm");
        chart.series.clear();
        assert_eq!(describe(&chart, &chart.rulers(), 0.012), None);
        chart.bars = vec![Bars {
            bins: vec![[0.0, 0.01, 3.0], [0.01, 0.02, 7.0]],
            ..Bars::default()
        }];
        let words = describe(&chart, &chart.rulers(), 0.012).unwrap();
        assert!(words.ends_with("\n7.00 µm"), "{words}");
    }
}
