//! What stands around a chart's frame: hairlines, labels, units, the legend, the focus.

use eframe::egui::{
    Align2, Color32, Margin, Painter, Pos2, Rangef, Rect, Response, Stroke, StrokeKind, Ui, pos2,
    vec2,
};
use egui_plot::PlotTransform;

use crate::kit::plot::layers::colour;
use crate::kit::theme;
use crate::kit::theme::Palette;
use selvedge_chart::{At, Chart, Ink, Ruler, Scale};

/// From the frame to the letters of its labels, points.
const GAP: f32 = 5.0;
/// A frame with less room on its left has no vertical labels, points.
const LABELS: f32 = 20.0;
/// From one label to the next, points: beside and below one another.
const APART: [f32; 2] = [48.0, 22.0];

/// Paints hairlines across the frame, their labels left of it and below it, and the units.
pub(crate) fn paint_ticks(
    painter: &Painter,
    chart: &Chart,
    transform: &PlotTransform,
    (scales, margin): ([Scale; 2], Margin),
) {
    let palette = Palette::of(painter.ctx().theme());
    let area = *transform.frame();
    let hairline = Stroke::new(1.0, palette.hairline);
    let rulers = rulers(transform, scales);
    let (labels, _) = rulers[0].labels(&chart.x.label);
    // Below the last of several charts with one horizontal axis.
    let mut taken = if chart.is_x_shared {
        f32::INFINITY
    } else {
        f32::NEG_INFINITY
    };
    for (value, label) in labels {
        let place = scales[0].place(value).unwrap_or_default();
        let x = painter.round_to_pixel_center(transform.position_from_point_x(place));
        painter.vline(x, area.y_range(), hairline);
        let text = painter.layout_no_wrap(label, theme::small_number(), palette.dim);
        let half = 0.5 * text.size().x;
        let middle = inwards(x, area.x_range(), half);
        // A label that would touch the one before it is left out.
        if middle - half > taken {
            taken = middle + half + 2.0;
            painter.galley(pos2(middle - half, area.bottom() + 3.0), text, palette.dim);
        }
    }
    if f32::from(margin.left) < LABELS {
        return;
    }
    let (labels, _) = rulers[1].labels(&chart.y.label);
    for (value, label) in labels {
        let place = scales[1].place(value).unwrap_or_default();
        let y = painter.round_to_pixel_center(transform.position_from_point_y(place));
        painter.hline(area.x_range(), y, hairline);
        let text = painter.layout_no_wrap(label, theme::small_number(), palette.dim);
        let size = text.size();
        // Half a letter may stand out above and below: the number stays beside its place.
        let middle = inwards(y, area.y_range().expand(2.0), 0.5 * size.y);
        let corner = pos2(area.left() - GAP - size.x, middle - 0.5 * size.y);
        painter.galley(corner, text, palette.dim);
    }
}

/// Says what the axes measure, over what is drawn, so that it can be read.
pub(crate) fn paint_titles(
    painter: &Painter,
    chart: &Chart,
    transform: &PlotTransform,
    (scales, margin): ([Scale; 2], Margin),
) {
    let area = *transform.frame();
    let [x, y] = rulers(transform, scales);
    let room = 0.5 * area.width();
    if !chart.is_x_shared {
        let (_, title) = x.labels(&chart.x.label);
        let corner = area.right_bottom() + vec2(-4.0, -1.0);
        paint_title(painter, (corner, Align2::RIGHT_BOTTOM), &title, room);
    }
    if f32::from(margin.left) >= LABELS {
        let (_, title) = y.labels(&chart.y.label);
        let corner = area.left_top() + vec2(4.0, 1.0);
        paint_title(painter, (corner, Align2::LEFT_TOP), &title, room);
    }
}

/// Writes what an axis measures, its unit alone where there is no room for more.
fn paint_title(painter: &Painter, (at, anchor): (Pos2, Align2), title: &str, room: f32) {
    let palette = Palette::of(painter.ctx().theme());
    let ink = palette.dim;
    let text = |title: &str| painter.layout_no_wrap(title.to_owned(), theme::small(), ink);
    let mut galley = text(title);
    if galley.size().x > room {
        galley = text(title.rsplit_once(", ").map_or("", |(_, unit)| unit));
    }
    let place = anchor.anchor_size(at, galley.size());
    painter.rect_filled(place, 0, palette.panel);
    painter.galley(place.min, galley, ink);
}

/// The rulers of what is shown.
pub(crate) fn rulers(transform: &PlotTransform, scales: [Scale; 2]) -> [Ruler; 2] {
    let (bounds, size) = (transform.bounds(), transform.frame().size());
    [0, 1].map(|axis| {
        let ends = [bounds.min()[axis], bounds.max()[axis]];
        let room = f64::from(size[axis] / APART[axis]);
        Ruler::in_view(scales[axis], ends.map(|end| scales[axis].value(end)), room)
    })
}

/// A place so that what reaches half as far to both sides stays in a range.
fn inwards(place: f32, range: Rangef, half: f32) -> f32 {
    place.clamp(range.min + half, (range.max - half).max(range.min + half))
}

/// Names series above the frame, from the right, in their colours.
pub(crate) fn paint_legend(painter: &Painter, chart: &Chart, area: Rect) {
    let palette = Palette::of(painter.ctx().theme());
    let bars = chart.bars.iter().map(|bars| (&bars.name, bars.ink));
    let series = chart.series.iter().map(|series| (&series.name, series.ink));
    let named = bars.chain(series).filter(|(name, _)| !name.is_empty());
    let mut right = area.right();
    for (name, ink) in named.collect::<Vec<_>>().into_iter().rev() {
        let ink = legend_colour(ink, palette);
        let text = painter.layout_no_wrap(name.clone(), theme::small(), ink);
        let left = right - text.size().x;
        if left < area.left() {
            return;
        }
        painter.galley(pos2(left, area.top() - 3.0 - text.size().y), text, ink);
        right = left - 2.0 * GAP;
    }
}

/// Names the values that are marked on the horizontal axis above the frame: from the right on,
/// names give way to those before them.
pub(crate) fn paint_marks(
    painter: &Painter,
    chart: &Chart,
    transform: &PlotTransform,
    scale: Scale,
) {
    let palette = Palette::of(painter.ctx().theme());
    let area = *transform.frame();
    let named = chart.rules.iter().filter(|rule| !rule.label.is_empty());
    let mut marks: Vec<_> = named
        .filter_map(|rule| match rule.at {
            At::X(value) => Some((transform.position_from_point_x(scale.place(value)?), rule)),
            At::Y(_) => None,
        })
        .filter(|(x, _)| area.x_range().contains(*x))
        .collect();
    marks.sort_by(|a, b| b.0.total_cmp(&a.0));
    let mut most_right = area.right() + 2.0;
    for (x, rule) in marks {
        let ink = legend_colour(rule.ink, palette);
        let text = painter.layout_no_wrap(rule.label.clone(), theme::small(), ink);
        let left = (x - 0.5 * text.size().x).min(most_right - text.size().x);
        painter.galley(pos2(left, area.top() - 1.0 - text.size().y), text, ink);
        most_right = left - GAP;
    }
}

/// The colour of an ink for letters.
fn legend_colour(ink: Ink, palette: &Palette) -> Color32 {
    match ink {
        Ink::Grey => palette.dim,
        ink => colour(ink, palette),
    }
}

/// A line around what has the keyboard.
pub(crate) fn paint_focus(ui: &Ui, response: &Response, area: Rect) {
    if response.has_focus() {
        let edge = Stroke::new(1.0, Palette::in_ui(ui).selection);
        let around = area.expand2(vec2(4.0, 4.0));
        ui.painter()
            .rect_stroke(around, 4, edge, StrokeKind::Inside);
    }
}
