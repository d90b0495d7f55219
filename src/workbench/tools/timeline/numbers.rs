//! Time, tick and speed at the right end of the bar.

use eframe::egui::{self, Align2, FontId, Rect, Sense, Ui, WidgetInfo, pos2};

use crate::kit::theme::{self, Palette};
use crate::kit::widgets::text::paint_quiet;
use crate::tools::timeline::transport::{TICK_MS, TransportView};
use selvedge_foundation::quantity;

/// Time, tick and speed in digits that stand still.
pub(crate) fn show(ui: &Ui, rect: Rect, view: &TransportView<'_>) {
    let palette = Palette::in_ui(ui);
    let (tick, what) = view.counted();
    let time = quantity::clock(tick * TICK_MS);
    let response = ui.interact(
        rect,
        ui.scope_id().with("transport numbers"),
        Sense::hover(),
    );
    response.widget_info(|| {
        let speed = quantity::with_unit(view.speed_mm_per_s, 1, "mm/s");
        let words = format!("Time {time}, tick {tick}, speed {speed}");
        WidgetInfo::labeled(egui::Role::Label, true, words)
    });
    let painter = ui.painter();
    let large = FontId::monospace(theme::title().size);
    let at = pos2(rect.right(), rect.top() + 14.0);
    painter.text(at, Align2::RIGHT_CENTER, time, large, palette.text);
    let rows = [
        ("tick", tick.to_string(), ""),
        ("speed", quantity::fixed(view.speed_mm_per_s, 1), "mm/s"),
    ];
    for ((name, digits, unit), y) in rows.into_iter().zip([38.0, 56.0]) {
        let y = rect.top() + y;
        let dim = |x: f32, anchor: Align2, words: &str| {
            paint_quiet(painter, pos2(x, y), anchor, words);
        };
        dim(rect.left(), Align2::LEFT_CENTER, name);
        dim(rect.right(), Align2::RIGHT_CENTER, unit);
        let right = pos2(rect.right() - if unit.is_empty() { 0.0 } else { 30.0 }, y);
        painter.text(
            right,
            Align2::RIGHT_CENTER,
            digits,
            theme::number(),
            palette.text,
        );
    }
    response.on_hover_text(format!("{what}\nSpeed of the middle of the display"));
}
