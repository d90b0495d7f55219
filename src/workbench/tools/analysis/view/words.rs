//! Sentences of an analysis, with `**what matters**` and `` `names` `` as its page marks them.

use eframe::egui::text::{LayoutJob, TextFormat};

use crate::kit::theme;
use crate::kit::theme::Palette;

/// Height of a line, points.
const LINE: f32 = 15.0;

/// How a piece of a sentence is said.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Manner {
    Plain,
    Strong,
    Name,
}

/// The pieces of a sentence; a mark without its other half stays as it is.
fn pieces(words: &str) -> Vec<(&str, Manner)> {
    let mut pieces = Vec::new();
    let mut rest = words;
    while let Some(at) = rest.find(['`', '*']) {
        let (mark, manner) = if rest[at..].starts_with("**") {
            ("**", Manner::Strong)
        } else if rest[at..].starts_with('`') {
            ("`", Manner::Name)
        } else {
            // One star alone is a star.
            pieces.push((&rest[..=at], Manner::Plain));
            rest = &rest[at + 1..];
            continue;
        };
        let inside = &rest[at + mark.len()..];
        let Some(end) = inside.find(mark) else {
            break;
        };
        pieces.push((&rest[..at], Manner::Plain));
        pieces.push((&inside[..end], manner));
        rest = &inside[end + mark.len()..];
    }
    pieces.push((rest, Manner::Plain));
    pieces.retain(|(piece, _)| !piece.is_empty());
    pieces
}

/// A sentence as it is read, without marks.
pub(crate) fn plain(words: &str) -> String {
    let pieces = pieces(words).into_iter();
    pieces.map(|(piece, _)| lettered(piece)).collect()
}

/// The window's fonts have no ᵀ: a transpose is written as M′ as well.
fn lettered(piece: &str) -> String {
    piece.replace('ᵀ', "′")
}

/// A sentence as it is drawn.
pub(crate) fn job(words: &str, palette: &Palette) -> LayoutJob {
    let mut job = LayoutJob::default();
    for (piece, manner) in pieces(words) {
        let (font_id, color) = match manner {
            Manner::Plain => (theme::small(), palette.dim),
            Manner::Strong => (theme::small(), palette.text),
            Manner::Name => (theme::small_number(), palette.text),
        };
        let format = TextFormat {
            font_id,
            color,
            line_height: Some(LINE),
            ..TextFormat::default()
        };
        job.append(&lettered(piece), 0.0, format);
    }
    job
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn marks_become_manners_and_a_lone_mark_stays() {
        let words = "Study `a-b`: **left out**, 2 * 3, and `open";
        assert_eq!(
            pieces(words),
            [
                ("Study ", Manner::Plain),
                ("a-b", Manner::Name),
                (": ", Manner::Plain),
                ("left out", Manner::Strong),
                (", 2 *", Manner::Plain),
                (" 3, and `open", Manner::Plain),
            ]
        );
        assert_eq!(plain("**incomplete** (3 of 4)"), "incomplete (3 of 4)");
        assert_eq!(plain("|M − Mᵀ|"), "|M − M′|");
        assert_eq!(plain(""), "");
    }
}
