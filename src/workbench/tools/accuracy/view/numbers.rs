//! Numbers of the pane as people read them, the lines that hold them, and how histograms stand.

use eframe::egui::{Align2, Color32, Label, Margin, Sense, Ui, pos2, vec2};

use crate::kit::plot::{Drag, Setting};
use crate::kit::theme;
use crate::kit::widgets::text::{paint_quiet, quiet};
use selvedge_foundation::quantity;

/// Height of a line, points.
pub(crate) const LINE: f32 = 14.0;

/// How both histograms stand in the pane, which may scroll.
pub(crate) const HISTOGRAM: Setting<'_> = Setting {
    name: "",
    margin: Margin {
        left: 2,
        right: 2,
        top: 14,
        bottom: 16,
    },
    wheel: false,
    drag: Drag::Pans,
    link: None,
    hover: false,
    note: "",
    has_legend: false,
};

/// A level error in six places, dB: `0.0123`, and `5.2e−7` where that would be nothing but zeros.
pub(crate) fn level(db: f64) -> String {
    if db == 0.0 {
        return "0".to_owned();
    }
    if !(1e-3..1e6).contains(&db) && db.is_finite() {
        let text = format!("{db:.1e}");
        let (digit, exponent) = text.split_once('e').unwrap_or((&text, "0"));
        return format!("{digit}e{}", exponent.replace('-', "−"));
    }
    quantity::fixed(db, if db < 10.0 { 4 } else { 1 })
}

/// A line: a dim name on the left, numbers with their inks right-aligned, a unit behind them.
pub(crate) fn line(ui: &mut Ui, name: &str, values: &[(String, Color32)], unit: &str) {
    let (rect, response) = ui.allocate_exact_size(vec2(ui.available_width(), LINE), Sense::hover());
    let spoken: Vec<&str> = values.iter().map(|(value, _)| &**value).collect();
    let spoken = format!("{name} {} {unit}", spoken.join(", "));
    response.widget_info(|| {
        eframe::egui::WidgetInfo::labeled(eframe::egui::Role::Label, true, &spoken)
    });
    let y = rect.center().y;
    let painter = ui.painter();
    paint_quiet(painter, pos2(rect.left(), y), Align2::LEFT_CENTER, name);
    let unit_at = paint_quiet(painter, pos2(rect.right(), y), Align2::RIGHT_CENTER, unit);
    let mut right = rect.right() - unit_at.width().max(14.0) - 4.0;
    for (value, ink) in values.iter().rev() {
        let font = theme::small_number();
        painter.text(pos2(right, y), Align2::RIGHT_CENTER, value, font, *ink);
        right -= 44.0;
    }
}

/// A line of dim words that is cut where there is no room for all.
pub(crate) fn quiet_line(ui: &mut Ui, words: &str, tip: &str) {
    let words = quiet(words);
    let label = ui.add(Label::new(words).truncate());
    if !tip.is_empty() {
        label.on_hover_text(tip);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn level_errors_are_short_however_small() {
        for (db, text) in [
            (0.0, "0"),
            (5.2e-7, "5.2e−7"),
            (0.000_45, "4.5e−4"),
            (0.0123, "0.0123"),
            (6.0206, "6.0206"),
            (42.0, "42.0"),
            (f64::INFINITY, "∞"),
        ] {
            assert_eq!(level(db), text);
        }
    }
}
