//! What a chart draws within its frame, as one item of the toolkit's plot.

use eframe::egui::{Align2, Color32, Pos2, Rect, Shape, Stroke, Ui, pos2, vec2};
use egui_plot::{PlotPoint, PlotTransform};

use crate::kit::theme;
use crate::kit::theme::Palette;
use crate::kit::widgets::polyline::corners;
use selvedge_chart::{
    At, Band, Bars, Chart, Extent, Ink, Rule, Scale, Series, Style, Tone, Weight,
};

/// How opaque areas and bars are.
const FILL: f32 = 0.16;
/// How opaque the bars of a histogram are.
const BAR_FILL: f32 = 0.28;
/// A dash and the gap after it, points.
const DASH: [f32; 2] = [5.0, 4.0];

/// The colour of an ink on the screen.
pub(crate) fn colour(ink: Ink, palette: &Palette) -> Color32 {
    match ink {
        Ink::Amber => palette.low,
        Ink::Cyan => palette.high,
        Ink::Own | Ink::Black => palette.text,
        Ink::Grey => palette.line,
        Ink::Violet => palette.others()[0],
        Ink::Rose => palette.others()[1],
    }
}

/// What a chart shows within its frame, in the order in which it is painted.
pub(crate) fn shapes(
    ui: &Ui,
    chart: &Chart,
    transform: &PlotTransform,
    scales: [Scale; 2],
) -> Vec<Shape> {
    let mut shapes = Vec::new();
    let pen = Pen {
        ui,
        palette: Palette::in_ui(ui),
        transform,
        scales,
    };
    for band in &chart.bands {
        shapes.push(pen.band(band));
    }
    for bars in &chart.bars {
        pen.push_bars(bars, &mut shapes);
    }
    for rule in &chart.rules {
        pen.push_rule(rule, &mut shapes);
    }
    for series in &chart.series {
        pen.push_series(series, &mut shapes);
    }
    for words in &chart.words {
        if let Some(at) = pen.at(words.at) {
            let (by, anchor, ink) = match words.tone {
                Tone::Dark => (vec2(0.0, 0.0), Align2::CENTER_CENTER, pen.palette.text),
                Tone::Light => (vec2(0.0, 0.0), Align2::CENTER_CENTER, Color32::WHITE),
                Tone::Aside => (vec2(8.0, 6.0), Align2::LEFT_TOP, pen.palette.dim),
            };
            shapes.push(pen.text(at + by, anchor, &words.text, ink));
        }
    }
    shapes
}

/// What shapes are made with.
struct Pen<'a> {
    ui: &'a Ui,
    palette: &'static Palette,
    transform: &'a PlotTransform,
    scales: [Scale; 2],
}

impl Pen<'_> {
    fn at(&self, point: [f64; 2]) -> Option<Pos2> {
        position(self.transform, self.scales, point)
    }

    fn text(&self, at: Pos2, anchor: Align2, text: &str, ink: Color32) -> Shape {
        let galley = self
            .ui
            .painter()
            .layout_no_wrap(text.to_owned(), theme::small(), ink);
        let corner = anchor.anchor_size(at, galley.size()).min;
        Shape::galley(corner, galley, ink)
    }

    fn band(&self, band: &Band) -> Shape {
        let ink = colour(band.ink, self.palette).gamma_multiply(FILL);
        let mut mesh = eframe::egui::Mesh::default();
        let places = band
            .points
            .iter()
            .filter_map(|[x, low, high]| Some([self.at([*x, *low])?, self.at([*x, *high])?]));
        for pair in places {
            for at in pair {
                mesh.colored_vertex(at, ink);
            }
        }
        let n_vertices = u32::try_from(mesh.vertices.len()).unwrap_or(0);
        for first in (2..n_vertices).step_by(2) {
            mesh.add_triangle(first - 2, first - 1, first);
            mesh.add_triangle(first - 1, first, first + 1);
        }
        Shape::mesh(mesh)
    }

    fn push_bars(&self, bars: &Bars, shapes: &mut Vec<Shape>) {
        let ink = colour(bars.ink, self.palette);
        let is_any = |bin: &[f64; 3]| bin[2] > 0.0;
        let first = bars.bins.iter().position(is_any).unwrap_or(bars.bins.len());
        let end = bars
            .bins
            .iter()
            .rposition(is_any)
            .map_or(0, |last| last + 1);
        let foot = self.transform.frame().bottom();
        let mut outline: Vec<Pos2> = Vec::new();
        for [from, to, height] in bars.bins.get(first..end).unwrap_or_default() {
            let ends = [self.at([*from, *height]), self.at([*to, *height])];
            let [Some(left), Some(right)] = ends else {
                continue;
            };
            if *height > 0.0 {
                // One among a million is still seen.
                let top = left.y.min(foot - 1.0);
                let corner = pos2(right.x.max(left.x + 1.0), foot);
                let bar = Rect::from_min_max(pos2(left.x, top), corner);
                shapes.push(Shape::rect_filled(bar, 0, ink.gamma_multiply(BAR_FILL)));
            }
            outline.extend([left, right]);
        }
        shapes.push(Shape::line(outline, Stroke::new(1.0, ink)));
    }

    fn push_rule(&self, rule: &Rule, shapes: &mut Vec<Shape>) {
        let frame = *self.transform.frame();
        let anywhere = self.transform.bounds();
        let middle = [0, 1].map(|axis| {
            self.scales[axis].value(0.5 * (anywhere.min()[axis] + anywhere.max()[axis]))
        });
        let point = match rule.at {
            At::X(x) => [x, middle[1]],
            At::Y(y) => [middle[0], y],
        };
        let Some(at) = self.at(point).filter(|at| frame.expand(0.5).contains(*at)) else {
            return;
        };
        let at = {
            let painter = self.ui.painter();
            pos2(
                painter.round_to_pixel_center(at.x),
                painter.round_to_pixel_center(at.y),
            )
        };
        let ends = match rule.at {
            At::X(_) => [pos2(at.x, frame.top()), pos2(at.x, frame.bottom())],
            At::Y(_) => [pos2(frame.left(), at.y), pos2(frame.right(), at.y)],
        };
        let ink = colour(rule.ink, self.palette);
        let stroke = Stroke::new(1.0, ink);
        match rule.extent {
            Extent::Across => shapes.push(Shape::line_segment(ends, stroke)),
            Extent::Dashed => {
                // Two rules may coincide: each fills the other's gaps.
                let shift = if rule.ink == Ink::Cyan { 5.0 } else { 0.0 };
                let dashes = Shape::dashed_line_with_offset(&ends, stroke, &[5.0], &[5.0], shift);
                shapes.extend(dashes);
            }
            Extent::Edge => {}
        }
        if matches!(rule.at, At::Y(_)) && !rule.label.is_empty() {
            let corner = pos2(frame.right() - 4.0, at.y - 1.0);
            shapes.push(self.text(corner, Align2::RIGHT_BOTTOM, &rule.label, ink));
        }
    }

    fn push_series(&self, series: &Series, shapes: &mut Vec<Shape>) {
        let ink = colour(series.ink, self.palette).gamma_multiply(1.0 - series.faintness);
        let places: Vec<Option<Pos2>> = series.points.iter().map(|at| self.at(*at)).collect();
        let stroke = Stroke::new(width(series.weight), ink);
        match series.style {
            Style::Line | Style::LineAndDots | Style::Dashed => {
                for run in places.split(Option::is_none).filter(|run| !run.is_empty()) {
                    let run: Vec<Pos2> = run.iter().copied().flatten().collect();
                    push_line(&run, series.style == Style::Dashed, stroke, shapes);
                }
            }
            Style::Stems => {
                let foot = self.transform.frame().bottom();
                let stems = places.iter().flatten().map(|at| [*at, pos2(at.x, foot)]);
                shapes.extend(stems.map(|ends| Shape::line_segment(ends, stroke)));
            }
            Style::Dots => {}
        }
        if matches!(series.style, Style::Dots | Style::LineAndDots) {
            for at in places.iter().flatten() {
                push_dot(*at, (series.ink, ink), self.palette, shapes);
            }
        }
        let marked = series
            .marked
            .iter()
            .filter_map(|index| *places.get(*index)?);
        let ring = Stroke::new(1.5, self.palette.selection);
        shapes.extend(marked.map(|at| Shape::circle_stroke(at, 7.0, ring)));
    }
}

fn width(weight: Weight) -> f32 {
    match weight {
        Weight::Thin => 1.0,
        Weight::Normal => 1.5,
        Weight::Bold => 2.0,
    }
}

fn push_line(run: &[Pos2], is_dashed: bool, stroke: Stroke, shapes: &mut Vec<Shape>) {
    if let [alone] = run {
        shapes.push(Shape::circle_filled(*alone, stroke.width, stroke.color));
    } else if is_dashed {
        shapes.extend(Shape::dashed_line(run, stroke, DASH[0], DASH[1]));
    } else {
        shapes.push(Shape::line(corners(run), stroke));
    }
}

/// A dot on a rim of panel; those in grey stand behind and are hollow.
fn push_dot(at: Pos2, (ink, colour): (Ink, Color32), palette: &Palette, shapes: &mut Vec<Shape>) {
    if ink == Ink::Grey {
        shapes.push(Shape::circle_filled(at, 2.5, palette.panel));
        shapes.push(Shape::circle_stroke(at, 2.5, Stroke::new(1.0, colour)));
    } else {
        shapes.push(Shape::circle_filled(at, 4.5, palette.panel));
        shapes.push(Shape::circle_filled(at, 3.5, colour));
    }
}

/// Where a point of a chart lies on the screen.
pub(crate) fn position(
    transform: &PlotTransform,
    scales: [Scale; 2],
    [x, y]: [f64; 2],
) -> Option<Pos2> {
    let point = PlotPoint::new(scales[0].place(x)?, scales[1].place(y)?);
    let at = transform.position_from_point(&point);
    let near = |at: f32, low: f32, high: f32| at.clamp(low - 1e4, high + 1e4);
    let frame = transform.frame();
    Some(pos2(
        near(at.x, frame.left(), frame.right()),
        near(at.y, frame.top(), frame.bottom()),
    ))
}
