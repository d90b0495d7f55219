//! A plot as SVG text: frame, grid, series, legend, footnote.
//!
//! Nothing but rectangles, paths and text, so that every viewer draws it alike.

use super::label::Labels;
use super::legend::{self, LINE_PX};
use super::look::{Dot, GREY, GRID, INK, Look, looks};
use super::text::{escaped, wrapped};
use super::ticks::Ruler;
use super::{Plot, Series, Style};

/// Width of every figure, px.
pub(super) const WIDTH_PX: f64 = 860.0;
const LEFT_PX: f64 = 76.0;
const TOP_PX: f64 = 66.0;
const FRAME_HEIGHT_PX: f64 = 360.0;
/// Below the frame: tick labels and the title of the axis.
const BELOW_PX: f64 = 56.0;
const MARGIN_PX: f64 = 20.0;
/// Characters of a footnote that fit in a line.
const FOOTNOTE_CHARACTERS: usize = 130;

/// The frame that values are drawn in, with its two rulers.
struct Canvas {
    x: Ruler,
    y: Ruler,
    width_px: f64,
}

impl Plot {
    /// The picture as SVG text. The same plot gives the same bytes.
    pub fn to_svg(&self) -> String {
        let legend_px = legend::width_px(&self.series);
        let values = |axis: usize| {
            let points = self.series.iter().flat_map(|series| &series.points);
            points.map(move |point| point[axis])
        };
        let canvas = Canvas {
            x: Ruler::of(&self.x, values(0)),
            y: Ruler::of(&self.y, values(1)),
            width_px: WIDTH_PX - LEFT_PX - MARGIN_PX - legend_px,
        };
        let looks = looks(&self.series);
        let mut body = Vec::new();
        canvas.draw_grid(self, &mut body);
        let mut n_left_out = 0;
        for (series, look) in self.series.iter().zip(&looks) {
            n_left_out += canvas.draw_series(series, *look, &mut body);
        }
        let legend_at = [LEFT_PX + canvas.width_px + MARGIN_PX, TOP_PX + 8.0];
        let legend_height_px = legend::draw(&self.series, &looks, legend_at, &mut body);
        let below_px = TOP_PX + (FRAME_HEIGHT_PX + BELOW_PX).max(legend_height_px + MARGIN_PX);
        let notes = wrapped(&self.note(n_left_out), FOOTNOTE_CHARACTERS);
        for (line, note) in notes.iter().enumerate() {
            let at = [MARGIN_PX, below_px + 6.0 + line as f64 * LINE_PX];
            text(&mut body, at, ("start", 11, GREY), note);
        }
        let height_px = below_px + notes.len() as f64 * LINE_PX + 12.0;
        document(&self.title, height_px, &canvas, &body.concat())
    }

    /// The footnote, with what has no place in the picture.
    fn note(&self, n_left_out: usize) -> String {
        let left_out = match n_left_out {
            0 => String::new(),
            1 => "1 point has no place on these axes and is left out.".to_owned(),
            n => format!("{n} points have no place on these axes and are left out."),
        };
        let parts = [self.footnote.trim(), &left_out];
        parts.map(str::to_owned).join(" ").trim().to_owned()
    }
}

impl Canvas {
    /// Where a value is drawn, px; `None` where it has no place. Far outside is near outside.
    fn place(&self, [x, y]: [f64; 2]) -> Option<[f64; 2]> {
        let (x, y) = (
            self.x.share(x)?.clamp(-9.0, 9.0),
            self.y.share(y)?.clamp(-9.0, 9.0),
        );
        Some([
            LEFT_PX + x * self.width_px,
            TOP_PX + (1.0 - y) * FRAME_HEIGHT_PX,
        ])
    }

    /// Whether something drawn there is within the frame.
    fn has(&self, [x_px, y_px]: [f64; 2]) -> bool {
        let is_within = |px: f64, start_px: f64, length_px: f64| {
            (start_px - 0.01..=start_px + length_px + 0.01).contains(&px)
        };
        is_within(x_px, LEFT_PX, self.width_px) && is_within(y_px, TOP_PX, FRAME_HEIGHT_PX)
    }

    fn draw_grid(&self, plot: &Plot, body: &mut Vec<String>) {
        let (bottom_px, right_px) = (TOP_PX + FRAME_HEIGHT_PX, LEFT_PX + self.width_px);
        let x_of = |value: f64| {
            self.x
                .share(value)
                .map(|share| LEFT_PX + share * self.width_px)
        };
        let y_of = |value: f64| self.y.share(value).map(|s| bottom_px - s * FRAME_HEIGHT_PX);
        for x_px in self.x.hairlines.iter().filter_map(|value| x_of(*value)) {
            hairline(body, [x_px, TOP_PX], [x_px, bottom_px]);
        }
        for y_px in self.y.hairlines.iter().filter_map(|value| y_of(*value)) {
            hairline(body, [LEFT_PX, y_px], [right_px, y_px]);
        }
        let width_px = self.width_px;
        body.push(format!(
            "<rect x=\"{LEFT_PX}\" y=\"{TOP_PX}\" width=\"{width_px:.1}\" \
             height=\"{FRAME_HEIGHT_PX}\" fill=\"none\" stroke=\"#9a9a9a\"/>\n"
        ));
        let (x, y) = (
            Labels::of(&self.x, &plot.x.label),
            Labels::of(&self.y, &plot.y.label),
        );
        for (value, label) in self.x.labelled.iter().zip(&x.ticks) {
            let at = [x_of(*value).unwrap_or(LEFT_PX), bottom_px + 18.0];
            text(body, at, ("middle", 11, GREY), label);
        }
        for (value, label) in self.y.labelled.iter().zip(&y.ticks) {
            let at = [LEFT_PX - 8.0, y_of(*value).unwrap_or(bottom_px) + 4.0];
            text(body, at, ("end", 11, GREY), label);
        }
        let middle_px = LEFT_PX + 0.5 * self.width_px;
        text(
            body,
            [middle_px, bottom_px + 40.0],
            ("middle", 12, INK),
            &x.title,
        );
        text(
            body,
            [MARGIN_PX, TOP_PX - 12.0],
            ("start", 12, INK),
            &y.title,
        );
    }

    /// Draws a series and tells how many of its points it left out.
    fn draw_series(&self, series: &Series, look: Look, body: &mut Vec<String>) -> usize {
        let places = series.points.iter().map(|point| self.place(*point));
        let has_line = series.style != Style::Dots;
        let has_dots = matches!(series.style, Style::Dots | Style::LineAndDots);
        if has_line {
            let is_dashed = series.style == Style::Dashed;
            draw_line(&places.clone().collect::<Vec<_>>(), is_dashed, look, body);
        }
        let mut n_left_out = 0;
        for (index, place) in places.enumerate() {
            let Some(at) = place.filter(|at| !has_dots || self.has(*at)) else {
                n_left_out += 1;
                continue;
            };
            if has_dots {
                draw_dot(body, at, look);
            }
            if series.marked.contains(&index) && self.has(at) {
                let [x, y] = at;
                body.push(format!(
                    "<circle cx=\"{x:.2}\" cy=\"{y:.2}\" r=\"8\" fill=\"none\" stroke=\"{INK}\" \
                     stroke-width=\"1.2\"/>\n"
                ));
            }
        }
        n_left_out
    }
}

/// A line through the places in their order, broken where there is none.
fn draw_line(places: &[Option<[f64; 2]>], is_dashed: bool, look: Look, body: &mut Vec<String>) {
    let mut is_drawing = false;
    let mut step = |place: &Option<[f64; 2]>| {
        let command = if is_drawing { 'L' } else { 'M' };
        is_drawing = place.is_some();
        place.map(|[x, y]| format!("{command}{x:.2} {y:.2}"))
    };
    let path: String = places.iter().filter_map(&mut step).collect();
    if path.is_empty() {
        return;
    }
    let dashes = if is_dashed {
        " stroke-dasharray=\"6 4\""
    } else {
        ""
    };
    let colour = look.colour;
    body.push(format!(
        "<path d=\"{path}\" fill=\"none\" stroke=\"{colour}\" stroke-width=\"1.6\" \
         stroke-linejoin=\"round\" clip-path=\"url(#frame)\"{dashes}/>\n"
    ));
}

/// A dot of a series; the legend draws the same.
pub(super) fn draw_dot(body: &mut Vec<String>, [x, y]: [f64; 2], look: Look) {
    let colour = look.colour;
    let corners = |corners: &[[f64; 2]]| {
        let points: Vec<String> = corners
            .iter()
            .map(|[dx, dy]| format!("{:.2},{:.2}", x + dx, y + dy))
            .collect();
        let points = points.join(" ");
        format!("<polygon points=\"{points}\" fill=\"{colour}\"/>\n")
    };
    body.push(match look.dot {
        Dot::Disc => format!("<circle cx=\"{x:.2}\" cy=\"{y:.2}\" r=\"4\" fill=\"{colour}\"/>\n"),
        Dot::Square => corners(&[[-3.6, -3.6], [3.6, -3.6], [3.6, 3.6], [-3.6, 3.6]]),
        Dot::Triangle => corners(&[[0.0, -4.8], [4.4, 3.2], [-4.4, 3.2]]),
        Dot::Diamond => corners(&[[0.0, -5.0], [5.0, 0.0], [0.0, 5.0], [-5.0, 0.0]]),
    });
}

/// A text: where, how (anchor, size in px, colour), what.
pub(super) fn text(
    body: &mut Vec<String>,
    [x, y]: [f64; 2],
    (anchor, size_px, colour): (&str, u8, &str),
    what: &str,
) {
    let what = escaped(what);
    body.push(format!(
        "<text x=\"{x:.1}\" y=\"{y:.1}\" text-anchor=\"{anchor}\" font-size=\"{size_px}\" \
         fill=\"{colour}\">{what}</text>\n"
    ));
}

fn hairline(body: &mut Vec<String>, [x1, y1]: [f64; 2], [x2, y2]: [f64; 2]) {
    body.push(format!(
        "<path d=\"M{x1:.2} {y1:.2}L{x2:.2} {y2:.2}\" stroke=\"{GRID}\" stroke-width=\"1\"/>\n"
    ));
}

fn document(title: &str, height_px: f64, canvas: &Canvas, body: &str) -> String {
    let width_px = canvas.width_px;
    let name = escaped(title);
    let mut heading = Vec::new();
    text(&mut heading, [MARGIN_PX, 28.0], ("start", 16, INK), title);
    let heading = heading.concat();
    format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{WIDTH_PX}\" height=\"{height_px:.0}\" \
         viewBox=\"0 0 {WIDTH_PX} {height_px:.0}\" font-family=\"sans-serif\" role=\"img\">\n\
         <title>{name}</title>\n\
         <clipPath id=\"frame\"><rect x=\"{LEFT_PX}\" y=\"{TOP_PX}\" width=\"{width_px:.1}\" \
         height=\"{FRAME_HEIGHT_PX}\"/></clipPath>\n\
         <rect width=\"{WIDTH_PX}\" height=\"{height_px:.0}\" fill=\"#ffffff\"/>\n\
         {heading}{body}</svg>\n"
    )
}
