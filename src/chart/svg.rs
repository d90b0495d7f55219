//! A chart of its own as SVG text: frame, grid, series, legend, footnote.
//!
//! Nothing but rectangles, paths and text, so that every viewer draws it alike.

use super::Chart;
use super::frame::Frame;
use super::legend::{self, LINE_PX};
use super::look::{Inks, Paper, looks};
use super::marks::text;
use super::text::{escaped, wrapped};

/// Width of every figure, px.
pub(super) const WIDTH_PX: f64 = 860.0;
const LEFT_PX: f64 = 76.0;
const TOP_PX: f64 = 66.0;
const FRAME_HEIGHT_PX: f64 = 360.0;
/// Below the frame: tick labels and the title of the axis.
const BELOW_PX: f64 = 56.0;
/// Around everything, px.
pub(super) const MARGIN_PX: f64 = 20.0;
/// Characters of a footnote that fit in a line.
const FOOTNOTE_CHARACTERS: usize = 130;

impl Chart {
    /// The picture as SVG text, without a raster, which only figures have. The same chart gives
    /// the same bytes.
    pub fn to_svg(&self) -> String {
        let inks = Paper::White.inks();
        let legend_px = legend::width_px(&self.series);
        let [x, y] = self.rulers();
        let frame = Frame {
            x,
            y,
            corner_px: [LEFT_PX, TOP_PX],
            size_px: [WIDTH_PX - LEFT_PX - MARGIN_PX - legend_px, FRAME_HEIGHT_PX],
            is_downward: false,
            inks,
        };
        let looks = looks(&self.series, inks);
        let mut body = Vec::new();
        self.draw_axes(&frame, &mut body);
        frame.draw_areas(self, "frame", &mut body);
        for rule in &self.rules {
            frame.draw_rule(rule, &mut body);
        }
        let mut n_left_out = 0;
        for (series, look) in self.series.iter().zip(&looks) {
            n_left_out += frame.draw_series(series, *look, "frame", &mut body);
        }
        frame.draw_words(self, &mut body);
        let legend_at = [frame.right_px() + MARGIN_PX, TOP_PX + 8.0];
        let legend_height_px = legend::draw(&self.series, (&looks, inks), legend_at, &mut body);
        let below_px = TOP_PX + (FRAME_HEIGHT_PX + BELOW_PX).max(legend_height_px + MARGIN_PX);
        let notes = wrapped(&self.note(n_left_out), FOOTNOTE_CHARACTERS);
        for (line, note) in notes.iter().enumerate() {
            let at = [MARGIN_PX, below_px + 6.0 + line as f64 * LINE_PX];
            text(&mut body, at, ("start", 11, inks.grey), note);
        }
        let height_px = below_px + notes.len() as f64 * LINE_PX + 12.0;
        document(&self.title, height_px, &frame, &body.concat())
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

    fn draw_axes(&self, frame: &Frame, body: &mut Vec<String>) {
        frame.draw_hairlines(body);
        frame.draw_edge(body);
        let x_title = frame.draw_x_labels(&self.x.label, body);
        let y_title = frame.draw_y_labels(&self.y.label, body);
        let below = [LEFT_PX + 0.5 * frame.size_px[0], frame.bottom_px() + 40.0];
        text(body, below, ("middle", 12, frame.inks.ink), &x_title);
        let above = [MARGIN_PX, TOP_PX - 12.0];
        text(body, above, ("start", 12, frame.inks.ink), &y_title);
    }
}

/// The root of a document of this height, its title, and one clip path a frame.
pub(super) fn opening(title: &str, height_px: f64, clips: &[(String, &Frame)]) -> String {
    let clips: String = clips.iter().map(|(id, frame)| clip(id, frame)).collect();
    let name = escaped(title);
    format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{WIDTH_PX}\" height=\"{height_px:.0}\" \
         viewBox=\"0 0 {WIDTH_PX} {height_px:.0}\" font-family=\"sans-serif\" role=\"img\">\n\
         <title>{name}</title>\n{clips}"
    )
}

fn clip(id: &str, frame: &Frame) -> String {
    let ([left_px, top_px], [width_px, height_px]) = (frame.corner_px, frame.size_px);
    format!(
        "<clipPath id=\"{id}\"><rect x=\"{left_px}\" y=\"{top_px}\" width=\"{width_px:.1}\" \
         height=\"{height_px}\"/></clipPath>\n"
    )
}

/// Paper of this height.
pub(super) fn paper(height_px: f64, inks: &Inks) -> String {
    let ground = inks.ground;
    format!("<rect width=\"{WIDTH_PX}\" height=\"{height_px:.0}\" fill=\"{ground}\"/>\n")
}

fn document(title: &str, height_px: f64, frame: &Frame, body: &str) -> String {
    let opening = opening(title, height_px, &[("frame".to_owned(), frame)]);
    let paper = paper(height_px, frame.inks);
    let mut heading = Vec::new();
    text(
        &mut heading,
        [MARGIN_PX, 28.0],
        ("start", 16, frame.inks.ink),
        title,
    );
    let heading = heading.concat();
    format!("{opening}{paper}{heading}{body}</svg>\n")
}
