//! The legend: right of the frame, one line a series that has a name.

use super::look::{INK, Look};
use super::svg::{draw_dot, text};
use super::text::shortened;
use super::{Series, Style};

/// Height of a line of text, px.
pub(super) const LINE_PX: f64 = 18.0;
/// What a character takes, about, px.
const CHARACTER_PX: f64 = 6.4;
/// From the legend's edge to its names, px.
const SAMPLE_PX: f64 = 32.0;
const LONGEST_NAME: usize = 38;

/// What the legend takes of a figure's width, px: nothing without names.
pub(super) fn width_px(series: &[Series]) -> f64 {
    let names = series.iter().map(|series| series.name.chars().count());
    match names.max() {
        None | Some(0) => 0.0,
        Some(n) => SAMPLE_PX + CHARACTER_PX * n.min(LONGEST_NAME) as f64 + 24.0,
    }
}

/// Draws the legend from its upper left corner; tells its height, px.
pub(super) fn draw(
    series: &[Series],
    looks: &[Look],
    [x, y]: [f64; 2],
    body: &mut Vec<String>,
) -> f64 {
    let mut height_px = 0.0;
    for (series, look) in series.iter().zip(looks) {
        if series.name.is_empty() {
            continue;
        }
        let middle_px = y + height_px;
        if series.style != Style::Dots {
            let dashes = match series.style {
                Style::Dashed => " stroke-dasharray=\"6 4\"",
                _ => "",
            };
            let (colour, right_px) = (look.colour, x + 24.0);
            body.push(format!(
                "<path d=\"M{x:.1} {middle_px:.1}L{right_px:.1} {middle_px:.1}\" \
                 stroke=\"{colour}\" stroke-width=\"1.6\"{dashes}/>\n"
            ));
        }
        if matches!(series.style, Style::Dots | Style::LineAndDots) {
            draw_dot(body, [x + 12.0, middle_px], *look);
        }
        let at = [x + SAMPLE_PX, middle_px + 4.0];
        text(
            body,
            at,
            ("start", 12, INK),
            &shortened(&series.name, LONGEST_NAME),
        );
        height_px += LINE_PX;
    }
    height_px
}
