//! The mark of an output limit that bites: one look and one meaning in every view.
//!
//! What carries it is played weaker than it is shown. Its words say why.

use eframe::egui::{Painter, Pos2, Rect, Shape, Stroke, pos2, vec2};

use crate::kit::theme::Palette;
use selvedge_device::LimiterState;

/// Width and height of the mark, points.
pub(crate) const LIMIT_MARK: f32 = 6.0;

/// Paints the mark around `centre`: an arrow that meets a ceiling.
pub(crate) fn paint_limit_mark(painter: &Painter, centre: Pos2) {
    let palette = Palette::of(painter.ctx().theme());
    let rect = Rect::from_center_size(centre, vec2(LIMIT_MARK, LIMIT_MARK));
    // Told apart from cloth and colours of any brightness, in both themes.
    painter.rect_filled(rect.expand(1.0), 1, palette.tag);
    let ceiling = [rect.left_top(), rect.right_top()].map(|at| at + vec2(0.0, 0.75));
    painter.line_segment(ceiling, Stroke::new(1.5, palette.selection));
    let corners = vec![
        pos2(rect.center().x, rect.top() + 2.5),
        rect.right_bottom() + vec2(-0.25, 0.0),
        rect.left_bottom() + vec2(0.25, 0.0),
    ];
    painter.add(Shape::convex_polygon(
        corners,
        palette.selection,
        Stroke::NONE,
    ));
}

/// What bites a contactor, in words behind the mark; `None` when nothing does.
pub(crate) fn limit_words(limiter: LimiterState) -> Option<String> {
    let whose = |band: usize| {
        if limiter.by_device[band] {
            "the device's own limit"
        } else {
            "the array's limit"
        }
    };
    let capped = match limiter.limited {
        [true, true] if limiter.by_device[0] == limiter.by_device[1] => {
            Some(format!("both bands are capped at {}", whose(0)))
        }
        [true, true] => Some(format!(
            "40 Hz is capped at {}, 320 Hz at {}",
            whose(0),
            whose(1)
        )),
        [true, false] => Some(format!("40 Hz is capped at {}", whose(0))),
        [false, true] => Some(format!("320 Hz is capped at {}", whose(1))),
        [false, false] => None,
    };
    let shared = limiter
        .guarded
        .then_some("both bands are scaled down to share full drive");
    let off = limiter.off.then_some("switched off in the array profile");
    let none = limiter.non_finite.then_some("not a number, so silent");
    let words = [capped.as_deref(), shared, off, none].into_iter();
    let words: Vec<&str> = words.flatten().collect();
    (!words.is_empty()).then(|| format!("Played weaker than shown: {}", words.join("; ")))
}

/// Whether what bites concerns a band.
pub(crate) fn limits_band(limiter: LimiterState, band: usize) -> bool {
    limiter.guarded || limiter.off || limiter.non_finite || limiter.limited.get(band) == Some(&true)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_limit_that_bites_has_its_words_and_its_bands() {
        assert_eq!(limit_words(LimiterState::default()), None);
        let held = LimiterState {
            limited: [false, true],
            ..LimiterState::default()
        };
        let words = limit_words(held).unwrap();
        assert_eq!(
            words,
            "Played weaker than shown: 320 Hz is capped at the array's limit"
        );
        let by_device = LimiterState {
            limited: [true, true],
            by_device: [true, false],
            ..held
        };
        assert_eq!(
            limit_words(by_device).unwrap(),
            "Played weaker than shown: 40 Hz is capped at the device's own limit, 320 Hz at the \
             array's limit"
        );
        assert_eq!([0, 1].map(|band| limits_band(held, band)), [false, true]);
        let off = LimiterState {
            off: true,
            guarded: true,
            ..held
        };
        let words = limit_words(off).unwrap();
        assert!(words.contains("share full drive; switched off"), "{words}");
        assert_eq!([0, 1].map(|band| limits_band(off, band)), [true, true]);
    }
}
