//! Sentences of an analysis, with `**what matters**` and `` `names` `` as its page marks them.

use eframe::egui::text::{LayoutJob, TextFormat};

use crate::app::theme::{self, Palette};

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
pub(super) fn plain(words: &str) -> String {
    pieces(words).into_iter().map(|(piece, _)| piece).collect()
}

/// A sentence as it is drawn.
pub(super) fn job(words: &str, palette: &Palette) -> LayoutJob {
    let mut job = LayoutJob::default();
    for (piece, manner) in pieces(words) {
        let (font_id, color) = match manner {
            Manner::Plain => (theme::body(), palette.dim),
            Manner::Strong => (theme::body(), palette.text),
            Manner::Name => (theme::number(), palette.text),
        };
        let format = TextFormat {
            font_id,
            color,
            line_height: Some(19.0),
            ..TextFormat::default()
        };
        job.append(piece, 0.0, format);
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
        assert_eq!(plain(""), "");
    }
}
