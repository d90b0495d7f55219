//! The frame that values are drawn in: two rulers on a rectangle, its grid, labels and series.

use super::label::Labels;
use super::look::{FILL, Inks, Look};
use super::marks::{draw_dot, hairline, text};
use super::ticks::Ruler;
use super::{Band, Bars, Chart, Series, Style};

/// What a character of a tick's label takes, about, px.
const CHARACTER_PX: f64 = 6.0;

/// A rectangle of a figure with a ruler on either side.
pub(super) struct Frame {
    /// Its horizontal ruler.
    pub(super) x: Ruler,
    /// Its vertical ruler.
    pub(super) y: Ruler,
    /// Its left and upper edge, px.
    pub(super) corner_px: [f64; 2],
    /// Its width and height, px.
    pub(super) size_px: [f64; 2],
    /// Whether the vertical ruler grows downward, as the rows of a table do.
    pub(super) is_downward: bool,
    /// What it is drawn with.
    pub(super) inks: &'static Inks,
}

impl Frame {
    /// Its right edge, px.
    pub(super) fn right_px(&self) -> f64 {
        self.corner_px[0] + self.size_px[0]
    }

    /// Its lower edge, px.
    pub(super) fn bottom_px(&self) -> f64 {
        self.corner_px[1] + self.size_px[1]
    }

    /// Where a value stands from left to right, px; `None` where it has no place.
    pub(super) fn x_px(&self, value: f64) -> Option<f64> {
        let share = self.x.share(value)?;
        Some(self.corner_px[0] + share.clamp(-9.0, 9.0) * self.size_px[0])
    }

    /// Where a value stands from top to bottom, px; `None` where it has no place.
    pub(super) fn y_px(&self, value: f64) -> Option<f64> {
        let share = self.y.share(value)?.clamp(-9.0, 9.0);
        let from_top = if self.is_downward { share } else { 1.0 - share };
        Some(self.corner_px[1] + from_top * self.size_px[1])
    }

    /// Where a point is drawn, px; `None` where it has no place. Far outside is near outside.
    pub(super) fn place(&self, [x, y]: [f64; 2]) -> Option<[f64; 2]> {
        Some([self.x_px(x)?, self.y_px(y)?])
    }

    /// Whether something drawn there is within the frame.
    pub(super) fn has(&self, at_px: [f64; 2]) -> bool {
        (0..2).all(|axis| {
            let (start_px, length_px) = (self.corner_px[axis], self.size_px[axis]);
            (start_px - 0.01..=start_px + length_px + 0.01).contains(&at_px[axis])
        })
    }

    /// The hairlines of both rulers.
    pub(super) fn draw_hairlines(&self, body: &mut Vec<String>) {
        let [left_px, top_px] = self.corner_px;
        let (right_px, bottom_px) = (self.right_px(), self.bottom_px());
        for x_px in self
            .x
            .hairlines
            .iter()
            .filter_map(|value| self.x_px(*value))
        {
            hairline(body, self.inks.grid, [x_px, top_px], [x_px, bottom_px]);
        }
        for y_px in self
            .y
            .hairlines
            .iter()
            .filter_map(|value| self.y_px(*value))
        {
            hairline(body, self.inks.grid, [left_px, y_px], [right_px, y_px]);
        }
    }

    /// Short marks outside the frame where the labels stand, for what covers the frame.
    pub(super) fn draw_marks(&self, body: &mut Vec<String>) {
        let (left_px, bottom_px) = (self.corner_px[0], self.bottom_px());
        for x_px in self.x.labelled.iter().filter_map(|value| self.x_px(*value)) {
            hairline(
                body,
                self.inks.grey,
                [x_px, bottom_px],
                [x_px, bottom_px + 4.0],
            );
        }
        for y_px in self.y.labelled.iter().filter_map(|value| self.y_px(*value)) {
            hairline(body, self.inks.grey, [left_px - 4.0, y_px], [left_px, y_px]);
        }
    }

    /// The line around it.
    pub(super) fn draw_edge(&self, body: &mut Vec<String>) {
        let [left_px, top_px] = self.corner_px;
        let [width_px, height_px] = self.size_px;
        let edge = self.inks.edge;
        body.push(format!(
            "<rect x=\"{left_px}\" y=\"{top_px}\" width=\"{width_px:.1}\" \
             height=\"{height_px}\" fill=\"none\" stroke=\"{edge}\"/>\n"
        ));
    }

    /// The labels of the horizontal ruler below it; gives the title of the axis.
    pub(super) fn draw_x_labels(&self, label: &str, body: &mut Vec<String>) -> String {
        let Labels { title, ticks } = Labels::of(&self.x, label);
        let mut taken_px = f64::NEG_INFINITY;
        for (value, label) in self.x.labelled.iter().zip(&ticks) {
            let x_px = self.x_px(*value).unwrap_or(self.corner_px[0]);
            let half_px = 0.5 * CHARACTER_PX * label.chars().count() as f64;
            // A label that would touch the one before it is left out.
            if x_px - half_px > taken_px {
                let at = [x_px, self.bottom_px() + 18.0];
                text(body, at, ("middle", 11, self.inks.grey), label);
                taken_px = x_px + half_px + 4.0;
            }
        }
        title
    }

    /// The labels of the vertical ruler left of it; gives the title of the axis.
    pub(super) fn draw_y_labels(&self, label: &str, body: &mut Vec<String>) -> String {
        let Labels { title, ticks } = Labels::of(&self.y, label);
        for (value, label) in self.y.labelled.iter().zip(&ticks) {
            let y_px = self.y_px(*value).unwrap_or_else(|| self.bottom_px());
            let at = [self.corner_px[0] - 8.0, y_px + 4.0];
            text(body, at, ("end", 11, self.inks.grey), label);
        }
        title
    }

    /// Draws the areas and bars of a chart, cut off at the clip path of this name.
    pub(super) fn draw_areas(&self, chart: &Chart, clip: &str, body: &mut Vec<String>) {
        for Band { points, ink, .. } in &chart.bands {
            let edge = |at: usize| {
                let edge = points
                    .iter()
                    .filter(|point| point[1..].iter().all(|y| y.is_finite()));
                let places = edge.filter_map(move |point| self.place([point[0], point[at]]));
                places.collect::<Vec<_>>()
            };
            let upper = edge(2).into_iter().rev();
            let corners: Vec<_> = edge(1).into_iter().chain(upper).collect();
            self.fill(&corners, ink.colour(self.inks), clip, body);
        }
        for Bars { bins, ink, .. } in &chart.bars {
            for &[from, to, height] in bins.iter().filter(|bin| bin[2] > 0.0) {
                let places = [[from, 0.0], [from, height], [to, height], [to, 0.0]];
                let corners: Vec<_> = places.into_iter().filter_map(|at| self.place(at)).collect();
                self.fill(&corners, ink.colour(self.inks), clip, body);
            }
        }
    }

    fn fill(&self, corners: &[[f64; 2]], colour: Option<&str>, clip: &str, body: &mut Vec<String>) {
        let corner = |[x, y]: &[f64; 2]| format!("{x:.2},{y:.2}");
        let corners: Vec<String> = corners.iter().map(corner).collect();
        let (corners, colour) = (corners.join(" "), colour.unwrap_or(self.inks.grey));
        body.push(format!(
            "<polygon points=\"{corners}\" fill=\"{colour}\" fill-opacity=\"{FILL}\" \
             clip-path=\"url(#{clip})\"/>\n"
        ));
    }

    /// Draws a series, cut off at the clip path of this name, and tells how many of its points it
    /// left out.
    pub(super) fn draw_series(
        &self,
        series: &Series,
        look: Look,
        clip: &str,
        body: &mut Vec<String>,
    ) -> usize {
        let places = series.points.iter().map(|point| self.place(*point));
        if series.style == Style::Stems {
            self.draw_stems(&places.clone().collect::<Vec<_>>(), look, clip, body);
        } else if series.style != Style::Dots {
            let places: Vec<_> = places.clone().collect();
            draw_line(&places, series, look, clip, body);
        }
        let has_dots = matches!(series.style, Style::Dots | Style::LineAndDots);
        let mut n_left_out = 0;
        for (index, place) in places.enumerate() {
            let Some(at) = place.filter(|at| !has_dots || self.has(*at)) else {
                // What is no number at all is where a line is broken.
                let is_break = series.points[index].iter().all(|value| value.is_nan());
                n_left_out += usize::from(!is_break);
                continue;
            };
            if has_dots {
                draw_dot(body, at, look);
            }
            if series.marked.contains(&index) && self.has(at) {
                let ([x, y], ink) = (at, self.inks.ink);
                body.push(format!(
                    "<circle cx=\"{x:.2}\" cy=\"{y:.2}\" r=\"8\" fill=\"none\" stroke=\"{ink}\" \
                     stroke-width=\"1.2\"/>\n"
                ));
            }
        }
        n_left_out
    }

    /// A line upright from the lower edge to every place.
    fn draw_stems(
        &self,
        places: &[Option<[f64; 2]>],
        look: Look,
        clip: &str,
        body: &mut Vec<String>,
    ) {
        let bottom_px = self.bottom_px();
        let stem = |[x, y]: [f64; 2]| format!("M{x:.2} {bottom_px:.2}V{y:.2}");
        let path: String = places.iter().copied().flatten().map(stem).collect();
        push_path(body, &path, look, "", clip);
    }
}

/// A line through the places in their order, broken where there is none.
fn draw_line(
    places: &[Option<[f64; 2]>],
    series: &Series,
    look: Look,
    clip: &str,
    body: &mut Vec<String>,
) {
    let mut is_drawing = false;
    let mut step = |place: &Option<[f64; 2]>| {
        let command = if is_drawing { 'L' } else { 'M' };
        is_drawing = place.is_some();
        place.map(|[x, y]| format!("{command}{x:.2} {y:.2}"))
    };
    let path: String = places.iter().filter_map(&mut step).collect();
    let mut manner = String::new();
    if series.style == Style::Dashed {
        manner += " stroke-dasharray=\"6 4\"";
    }
    if series.faintness > 0.0 {
        let opacity = 1.0 - series.faintness;
        manner.extend([" stroke-opacity=\"", &format!("{opacity:.2}"), "\""]);
    }
    push_path(body, &path, look, &manner, clip);
}

fn push_path(body: &mut Vec<String>, path: &str, look: Look, dashes: &str, clip: &str) {
    if path.is_empty() {
        return;
    }
    let (colour, width) = (look.colour, look.weight.width_px());
    body.push(format!(
        "<path d=\"{path}\" fill=\"none\" stroke=\"{colour}\" stroke-width=\"{width}\" \
         stroke-linejoin=\"round\" clip-path=\"url(#{clip})\"{dashes}/>\n"
    ));
}
