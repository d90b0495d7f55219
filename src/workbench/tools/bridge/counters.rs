//! The counters that tell whether to trust the link.

use eframe::egui::{self, RichText, Ui};

use crate::bench::view::BridgeView;
use crate::kit::theme::Palette;
use crate::kit::widgets::text::{quiet_pair, quiet_pairs, row};
use selvedge_foundation::quantity;

/// What matters of the link while its part is folded away.
pub(crate) fn summary(bridge: Option<&BridgeView>) -> String {
    let troubles = bridge.map_or(&[][..], |bridge| &bridge.troubles);
    let n: u64 = troubles.iter().map(|(_, count)| count).sum();
    match (bridge, n) {
        (None, _) => String::new(),
        (Some(_), 0) => "no losses".to_owned(),
        (Some(_), 1) => "1 loss or error".to_owned(),
        (Some(_), n) => format!("{n} losses and errors"),
    }
}

pub(crate) fn show_counters(ui: &mut Ui, bridge: Option<&BridgeView>, felt_age_s: Option<f64>) {
    let number = |text: Option<String>| text.unwrap_or_else(|| "–".to_owned());
    let ms = |s: f64| quantity::fixed(s * 1e3, 2);
    let of = |pick: fn(&BridgeView) -> Option<f64>| bridge.and_then(pick);
    let interval_s = of(|bridge| bridge.frame_interval_s);
    let gain = of(|bridge| bridge.gain);
    let written = number(of(|bridge| bridge.stamp_to_write_s).map(ms));
    let depth = number(bridge.map(|bridge| bridge.depth.to_string()));
    let sent = number(bridge.map(|bridge| bridge.frames_sent.to_string()));
    let gain = number(gain.map(|gain| quantity::fixed(gain * 100.0, 0)));
    let felt = format!(
        "From the pointer's movement to the middle of the tick in which it is felt\nto the end of \
         the write to the port, 99 of 100: {written} ms"
    );
    let answered = bridge.and_then(|bridge| bridge.status_to_frame_s);
    let answered = answered.map_or_else(String::new, |[p99_s, most_s]| {
        let [p99, most] = [p99_s, most_s].map(quantity::time_span);
        format!("\nFrom when it was due to our frame: 99 of 100 within {p99}, at most {most}")
    });
    let interval = format!("Measured on the device's clock{answered}");
    let rows = [
        [
            (
                "Frame interval",
                number(interval_s.map(ms)),
                "ms",
                interval.as_str(),
            ),
            ("Depth", depth, "ticks", "Ticks from a frame to its effect"),
        ],
        [
            (
                "Pointer to skin",
                number(felt_age_s.map(ms)),
                "ms",
                felt.as_str(),
            ),
            (
                "Soft start",
                gain,
                "%",
                "How far levels have risen since the device was armed",
            ),
        ],
    ];
    for row in rows {
        quiet_pairs(ui, row);
    }
    quiet_pair(ui, "Frames sent", &sent, "");
    show_troubles(ui, bridge.map_or(&[], |bridge| &bridge.troubles));
}

/// Counters that ought to be zero: those that are not, in red, the rest on hover.
fn show_troubles(ui: &mut Ui, troubles: &[(&'static str, u64)]) {
    let palette = Palette::in_ui(ui);
    let counted = troubles.iter().filter(|(_, count)| *count > 0);
    let words: Vec<String> = counted
        .map(|(name, count)| format!("{count} {name}"))
        .collect();
    let (words, ink) = if words.is_empty() {
        ("none".to_owned(), palette.dim)
    } else {
        (words.join(", "), palette.danger)
    };
    let names: Vec<&str> = troubles.iter().map(|(name, _)| *name).collect();
    row(ui, "Losses and errors", |ui| {
        let label = egui::Label::new(RichText::new(words).color(ink)).truncate();
        ui.add(label)
            .on_hover_text(format!("Counted: {}", names.join(", ")));
    });
}
