//! The small pieces that figures are drawn with: dots, hairlines, texts.

use super::look::{Dot, Inks, Look};
use super::text::escaped;

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

/// A text that reads upward, its middle here: the title of a vertical axis.
pub(super) fn upward_text(body: &mut Vec<String>, [x, y]: [f64; 2], colour: &str, what: &str) {
    let what = escaped(what);
    body.push(format!(
        "<text transform=\"translate({x:.1} {y:.1}) rotate(-90)\" text-anchor=\"middle\" \
         font-size=\"12\" fill=\"{colour}\">{what}</text>\n"
    ));
}

/// The name of a dot, on a rim of paper that parts it from lines behind.
pub(super) fn haloed(body: &mut Vec<String>, [x, y]: [f64; 2], inks: &Inks, what: &str) {
    let (what, grey, ground) = (escaped(what), inks.grey, inks.ground);
    body.push(format!(
        "<text x=\"{x:.1}\" y=\"{y:.1}\" font-size=\"11\" fill=\"{grey}\" stroke=\"{ground}\" \
         stroke-width=\"3\" stroke-linejoin=\"round\" paint-order=\"stroke\">{what}</text>\n"
    ));
}

/// A line of one pixel.
pub(super) fn hairline(
    body: &mut Vec<String>,
    colour: &str,
    [x1, y1]: [f64; 2],
    [x2, y2]: [f64; 2],
) {
    body.push(format!(
        "<path d=\"M{x1:.2} {y1:.2}L{x2:.2} {y2:.2}\" stroke=\"{colour}\" stroke-width=\"1\"/>\n"
    ));
}
