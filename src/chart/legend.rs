//! The legend: right of the frame, one line a series that has a name; or above it, in one line.

use super::look::{Inks, Look};
use super::marks::{draw_dot, text};
use super::text::shortened;
use super::{Series, Style};

/// Height of a line of text, px.
pub(super) const LINE_PX: f64 = 18.0;
/// What a character takes, about, px.
const CHARACTER_PX: f64 = 6.4;
/// From the legend's edge to its names, px.
const SAMPLE_PX: f64 = 32.0;
const LONGEST_NAME: usize = 38;
/// From one name to the next where they stand side by side, px.
const BETWEEN_PX: f64 = 14.0;

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
    (looks, inks): (&[Look], &Inks),
    [x, y]: [f64; 2],
    body: &mut Vec<String>,
) -> f64 {
    let mut height_px = 0.0;
    for (series, look) in series.iter().zip(looks) {
        if series.name.is_empty() {
            continue;
        }
        let middle_px = y + height_px;
        draw_sample(series.style, *look, [x, middle_px], body);
        let at = [x + SAMPLE_PX, middle_px + 4.0];
        text(
            body,
            at,
            ("start", 12, inks.ink),
            &shortened(&series.name, LONGEST_NAME),
        );
        height_px += LINE_PX;
    }
    height_px
}

/// Draws the legend in one line above a frame; `right` is its end.
pub(super) fn draw_across(
    series: &[Series],
    (looks, inks): (&[Look], &Inks),
    [right, y]: [f64; 2],
    body: &mut Vec<String>,
) {
    let mut right_px = right;
    for (series, look) in series.iter().zip(looks).rev() {
        if series.name.is_empty() {
            continue;
        }
        let name = shortened(&series.name, LONGEST_NAME);
        let start_px = right_px - CHARACTER_PX * name.chars().count() as f64;
        text(body, [start_px, y + 4.0], ("start", 12, inks.ink), &name);
        draw_sample(series.style, *look, [start_px - SAMPLE_PX, y], body);
        right_px = start_px - SAMPLE_PX - BETWEEN_PX;
    }
}

/// The sample of a series, 24 px wide from its left end.
fn draw_sample(style: Style, look: Look, [x, y]: [f64; 2], body: &mut Vec<String>) {
    if style != Style::Dots {
        let dashes = match style {
            Style::Dashed => " stroke-dasharray=\"6 4\"",
            _ => "",
        };
        let (colour, width, right_px) = (look.colour, look.weight.width_px(), x + 24.0);
        body.push(format!(
            "<path d=\"M{x:.1} {y:.1}L{right_px:.1} {y:.1}\" stroke=\"{colour}\" \
             stroke-width=\"{width}\"{dashes}/>\n"
        ));
    }
    if matches!(style, Style::Dots | Style::LineAndDots) {
        draw_dot(body, [x + 12.0, y], look);
    }
}
