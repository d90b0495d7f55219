//! Curves of the pane: directions over angle, and the four strokes.

use eframe::egui::{Margin, Rect, Ui};
use selvedge_foundation::numerics::extent;

use crate::kit::plot;
use crate::kit::plot::Setting;
use crate::tools::picture::export::direction_chart;
use crate::tools::picture::found::Made;
use selvedge_chart::{Axis, Chart, Ink, Series, Style, Weight};
use selvedge_textile::picture::Directions;

/// Length of a stroke that is shown, mm.
const SHOWN_MM: f64 = 10.0;
/// Room around the curves for numbers and names, points.
const MARGIN: Margin = Margin {
    left: 30,
    right: 2,
    top: 14,
    bottom: 16,
};

/// Both measures over half a turn.
pub(crate) fn directions(ui: &Ui, rect: Rect, directions: &Directions) {
    let setting = Setting {
        name: "Directions of the threads",
        margin: MARGIN,
        ..Setting::default()
    };
    plot::show(ui, rect, &direction_chart(directions), &setting);
}

/// The four strokes, on one scale, each on its own line.
pub(crate) fn strokes(ui: &Ui, rect: Rect, made: &Made) {
    let all = made.profiles.iter().flat_map(|(_, heights, _)| heights);
    let ends = extent(all.copied());
    let n = made.profiles.len();
    let foot = f32::from(MARGIN.bottom);
    let height = (rect.height() - foot) / n.max(1) as f32;
    for (nth, (direction, heights, step_mm)) in made.profiles.iter().enumerate() {
        let points = heights.iter().enumerate();
        let points = points.map(|(i, z)| [i as f64 * step_mm, *z]);
        let is_last = nth + 1 == n;
        let chart = Chart {
            x: Axis::linear("place, mm").within([0.0, SHOWN_MM]),
            y: Axis::linear("height, µm").within(ends),
            series: vec![Series {
                name: direction.label().to_owned(),
                points: points.take_while(|[mm, _]| *mm <= SHOWN_MM).collect(),
                style: Style::Line,
                ink: Ink::Black,
                weight: Weight::Thin,
                ..Series::default()
            }],
            is_x_shared: !is_last,
            ..Chart::default()
        };
        let setting = Setting {
            name: &format!("Heights {}", direction.label()),
            // All on one scale, whose heights stand beside the relief: no numbers between them.
            margin: Margin {
                left: 4,
                bottom: if is_last { MARGIN.bottom } else { 0 },
                ..MARGIN
            },
            link: Some("places of strokes of a picture"),
            ..Setting::default()
        };
        let top = rect.top() + nth as f32 * height;
        let lane = Rect::from_x_y_ranges(rect.x_range(), top..=top + height);
        let lane = lane.with_max_y(if is_last {
            lane.bottom() + foot
        } else {
            lane.bottom()
        });
        plot::show(ui, lane, &chart, &setting);
    }
}
