//! What is marked in a frame: values of its axes, and words at places.

use super::frame::Frame;
use super::look::{INK, Inks};
use super::marks::{haloed, text};
use super::{At, Chart, Extent, Ink, Rule, Tone, Words};

/// What the name of a dot takes, about, px.
const NAME_PX: [f64; 2] = [96.0, 13.0];

impl Frame {
    /// A value that is marked on an axis.
    pub(super) fn draw_rule(&self, rule: &Rule, body: &mut Vec<String>) {
        let [left_px, top_px] = self.corner_px;
        let (right_px, bottom_px) = (self.right_px(), self.bottom_px());
        let is_edge = rule.extent == Extent::Edge;
        let (start, end, label) = match rule.at {
            At::X(value) => {
                let Some(x) = self.x_px(value) else { return };
                let end_px = if is_edge { top_px - 5.0 } else { bottom_px };
                let is_crowded = x > right_px - 48.0;
                let label = if is_crowded {
                    ([x - 4.0, top_px + 14.0], "end")
                } else {
                    ([x + 4.0, top_px + 14.0], "start")
                };
                ([x, top_px], [x, end_px], label)
            }
            At::Y(value) => {
                let Some(y) = self.y_px(value) else { return };
                let end_px = if is_edge { right_px + 5.0 } else { left_px };
                (
                    [right_px, y],
                    [end_px, y],
                    ([right_px - 6.0, y - 5.0], "end"),
                )
            }
        };
        if !self.has(start) {
            return;
        }
        body.push(line_of(rule, start, end, self.inks));
        let (at, anchor) = label;
        text(
            body,
            at,
            (anchor, 11, rule.ink.letters(self.inks)),
            &rule.label,
        );
    }

    /// The words of a chart at their places; the names of dots below one another where they would
    /// touch.
    pub(super) fn draw_words(&self, chart: &Chart, body: &mut Vec<String>) {
        let mut taken: Vec<[f64; 2]> = Vec::new();
        let inks = self.inks;
        // The colours of a raster do not follow the paper.
        let dark = if chart.raster.is_some() {
            INK
        } else {
            inks.ink
        };
        for Words {
            at,
            text: words,
            tone,
        } in &chart.words
        {
            let Some([x, y]) = self.place(*at) else {
                continue;
            };
            match tone {
                Tone::Dark => text(body, [x, y + 4.0], ("middle", 11, dark), words),
                Tone::Light => text(body, [x, y + 4.0], ("middle", 11, "#ffffff"), words),
                Tone::Aside => {
                    let mut at = [x + 8.0, y + 14.0];
                    let touches = |at: &[f64; 2], [x, y]: &[f64; 2]| {
                        (at[0] - x).abs() < NAME_PX[0] && (at[1] - y).abs() < NAME_PX[1]
                    };
                    while taken.iter().any(|other| touches(&at, other)) {
                        at[1] += NAME_PX[1];
                    }
                    taken.push(at);
                    haloed(body, at, inks, words);
                }
            }
        }
    }
}

fn line_of(rule: &Rule, [x1, y1]: [f64; 2], [x2, y2]: [f64; 2], inks: &Inks) -> String {
    let dashes = match (rule.extent, rule.ink) {
        // Two rules may coincide: each fills the other's gaps.
        (Extent::Dashed, Ink::Cyan) => " stroke-dasharray=\"8 8\" stroke-dashoffset=\"8\"",
        (Extent::Dashed, _) => " stroke-dasharray=\"8 8\"",
        (Extent::Across | Extent::Edge, _) => "",
    };
    let width = if rule.extent == Extent::Edge { 2 } else { 1 };
    let colour = rule.ink.colour(inks).unwrap_or(inks.grey);
    format!(
        "<path d=\"M{x1:.2} {y1:.2}L{x2:.2} {y2:.2}\" stroke=\"{colour}\" \
         stroke-width=\"{width}\"{dashes}/>\n"
    )
}
