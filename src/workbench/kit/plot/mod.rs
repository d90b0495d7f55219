//! A chart on the screen: the one place where plots are painted, zoomed, pointed at and linked.
//!
//! A pane makes a [`Chart`] in a pure function and calls [`show`]. Ticks come from the chart's own
//! engine, since the toolkit's know no decades; the toolkit (`egui_plot`, named in this folder
//! alone) says where a place of a chart stands.
//!
//! # Navigation
//! The wheel zooms about the pointer, or Ctrl with the wheel where the pane scrolls; dragging
//! pans, with the secondary button where the primary one has another meaning; a double click or
//! Backspace shows everything again; with the focus, arrows pan and + and − zoom. What is zoomed
//! never leaves the ends that the chart has at rest.

pub(crate) mod around;
pub(crate) mod hover;
pub(crate) mod layers;
pub(crate) mod setting;
#[cfg(test)]
mod tests;
pub(crate) mod view;

use eframe::egui::emath::GuiRounding as _;
use eframe::egui::{Id, Pos2, Rect, Response, Role, Sense, Ui, WidgetInfo, pos2};
use egui_plot::{PlotBounds, PlotTransform};

pub(crate) use crate::kit::plot::setting::{Drag, Setting};

use crate::kit::plot::layers::position;
use crate::kit::plot::view::View;
use selvedge_chart::{Chart, Scale};

/// A smaller frame shows nothing that can be read, points.
const SMALLEST: [f32; 2] = [24.0, 16.0];

/// A chart that is shown: where values lie.
#[derive(Debug)]
pub(crate) struct Shown {
    /// What the pointer and the keys do over it.
    pub response: Response,
    transform: PlotTransform,
    scales: [Scale; 2],
}

impl Shown {
    /// Its frame.
    pub(crate) fn area(&self) -> Rect {
        *self.transform.frame()
    }

    /// Where a point lies; far below for what has no place.
    pub(crate) fn at(&self, [x, y]: [f64; 2]) -> Pos2 {
        position(&self.transform, self.scales, [x, y]).unwrap_or_else(|| pos2(-1e6, -1e6))
    }

    /// The values at a place of the screen.
    pub(crate) fn values_at(&self, at: Pos2) -> [f64; 2] {
        let point = self.transform.value_from_position(at);
        [self.scales[0].value(point.x), self.scales[1].value(point.y)]
    }

    /// Where the pointer is within the frame.
    pub(crate) fn pointer(&self) -> Option<Pos2> {
        let at = self.response.hover_pos()?;
        self.area().contains(at).then_some(at)
    }
}

/// Shows a chart in a rectangle; `None` where there is no room.
pub(crate) fn show(ui: &Ui, rect: Rect, chart: &Chart, setting: &Setting<'_>) -> Option<Shown> {
    let id = Id::unique(("chart", setting.name));
    let response = ui.interact(rect, id, Sense::click_and_drag());
    response.widget_info(|| WidgetInfo::labeled(Role::Canvas, true, setting.name));
    let area = rect - setting.margin;
    if area.width() < SMALLEST[0] || area.height() < SMALLEST[1] {
        return None;
    }
    let rulers = chart.rulers();
    let scales = [rulers[0].scale(), rulers[1].scale()];
    let rest = [0, 1].map(|axis| {
        let place = |end| scales[axis].place(end).unwrap_or(0.0);
        rulers[axis].ends().map(place)
    });
    let view = View::load(ui, id, setting.link);
    let moved = view.after(&view::gesture(ui, &response, area, setting), rest);
    if moved != view {
        moved.store(ui, id, setting.link);
    }
    let ends = moved.ends(rest);
    let bounds = PlotBounds::from_min_max([ends[0][0], ends[1][0]], [ends[0][1], ends[1][1]]);
    let transform = PlotTransform::new(area, bounds, false);
    around::paint_ticks(ui.painter(), chart, &transform, (scales, setting.margin));
    let frame = area.round_ui();
    let within = PlotTransform::new(frame, bounds, false);
    let painter = ui.painter().with_clip_rect(frame.intersect(ui.clip_rect()));
    painter.extend(layers::shapes(ui, chart, &within, scales));
    around::paint_titles(ui.painter(), chart, &transform, (scales, setting.margin));
    around::paint_marks(ui.painter(), chart, &transform, scales[0]);
    if setting.has_legend {
        around::paint_legend(ui.painter(), chart, area);
    }
    around::paint_focus(ui, &response, area);
    let shown = Shown {
        response,
        transform,
        scales,
    };
    hover::show(ui, chart, &shown, setting);
    Some(shown)
}

/// The least and the largest of so many parts of a line, which are drawn as all of it would be.
pub(crate) fn thinned(points: &[[f64; 2]], n_parts: usize) -> Vec<[f64; 2]> {
    if points.len() <= 2 * n_parts {
        return points.to_vec();
    }
    let parts = points.chunks(points.len().div_ceil(n_parts));
    let ends = parts.flat_map(|part| {
        let by = |pick: fn(&[f64; 2], &[f64; 2]) -> bool| {
            let indices = 1..part.len();
            indices.fold(
                0,
                |best, i| if pick(&part[i], &part[best]) { i } else { best },
            )
        };
        let (low, high) = (by(|a, b| a[1] < b[1]), by(|a, b| a[1] > b[1]));
        [part[low.min(high)], part[low.max(high)]]
    });
    ends.collect()
}
