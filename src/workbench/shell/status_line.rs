//! The line at the foot of the window: notices, the newest first, or one sentence of what to do;
//! and how well things go, in plain words.
//!
//! Nothing of it ever lies over the cloth: older notices are a list that is opened.

use eframe::egui::{
    self, Align, Button, Label, Layout, Popup, PopupCloseBehavior, RectAlign, Response, RichText,
    ScrollArea, Ui, WidgetInfo, accesskit, vec2,
};

use crate::bench::Bench;
use crate::bench::command::{Command, Commands};
use crate::bench::notices::Notice;
use crate::bench::view::{EngineView, Source, Status};
use crate::kit::foot;
use crate::kit::theme;
use crate::kit::theme::{Palette, STEP};
use crate::kit::widgets::text::{mark, small};
use selvedge_foundation::quantity;

/// Height of what can be pressed, points.
const BUTTON: f32 = 20.0;
/// Width and most height of the list of notices, points.
const LIST: [f32; 2] = [560.0, 320.0];

/// Shows the line.
pub(crate) fn show(ui: &mut Ui, bench: &Bench, commands: &mut Commands) {
    let told = foot::told(ui.ctx());
    ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
        show_status(ui, &bench.live.status);
        ui.add_space(2.0 * STEP);
        ui.with_layout(Layout::left_to_right(Align::Center), |ui| {
            let palette = Palette::in_ui(ui);
            let mut say = |words: &str, ink| {
                let text = small(words, ink);
                ui.add(Label::new(text).truncate());
            };
            match bench.notices.shown() {
                _ if told.is_some() => say(&told.unwrap_or_default(), palette.text),
                [] if bench.has_session() => {}
                [] => say(hint(&bench.live), palette.dim),
                notices => show_notices(ui, notices, commands),
            }
        });
    });
}

/// The newest notice, and how many there are; a click on either opens the list.
fn show_notices(ui: &mut Ui, notices: &[Notice], commands: &mut Commands) {
    let [older @ .., newest] = notices else {
        return;
    };
    let palette = Palette::in_ui(ui);
    mark(ui, palette.selection, "Notice");
    ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
        show_close(ui, newest, commands);
        let opener = (!older.is_empty()).then(|| {
            let words = format!("{} notices", notices.len());
            let text = RichText::new(words).font(theme::small());
            ui.add(Button::new(text).min_size(vec2(0.0, BUTTON)))
        });
        ui.with_layout(Layout::left_to_right(Align::Center), |ui| {
            let text = RichText::new(counted(newest)).font(theme::small());
            let sentence = ui.add(Label::new(text.color(palette.text)).truncate());
            ui.ctx().accesskit_node_builder(sentence.id, |node| {
                node.set_live(accesskit::Live::Polite);
            });
        });
        if let Some(opener) = opener {
            show_list(&opener, notices, commands);
        }
    });
}

/// All notices, newest first.
fn show_list(opener: &Response, notices: &[Notice], commands: &mut Commands) {
    let popup = Popup::menu(opener)
        .align(RectAlign::TOP_END)
        .close_behavior(PopupCloseBehavior::CloseOnClickOutside);
    popup.show(|ui| {
        let [width, height] = LIST;
        ui.set_width(width.min(ui.ctx().content_rect().width() - 64.0));
        ScrollArea::vertical().max_height(height).show(ui, |ui| {
            for notice in notices.iter().rev() {
                ui.with_layout(Layout::right_to_left(Align::Min), |ui| {
                    show_close(ui, notice, commands);
                    ui.with_layout(Layout::left_to_right(Align::Min), |ui| {
                        ui.add(Label::new(counted(notice)).wrap().selectable(true));
                    });
                });
            }
        });
        ui.separator();
        if ui.button("Close all").clicked() {
            commands.push(Command::DismissNotice(None));
        }
    });
}

fn show_close(ui: &mut Ui, notice: &Notice, commands: &mut Commands) {
    let text = RichText::new("Close").font(theme::small());
    let close = ui.add(Button::new(text).min_size(vec2(0.0, BUTTON)));
    close.widget_info(|| WidgetInfo::labeled(egui::Role::Button, true, "Close the notice"));
    if close.clicked() {
        commands.push(Command::DismissNotice(Some(notice.number)));
    }
}

/// A notice with how often it was given.
fn counted(notice: &Notice) -> String {
    match notice.n_times {
        1 => notice.text.clone(),
        n_times => format!("{} ({n_times} times)", notice.text),
    }
}

/// What to do next.
fn hint(live: &EngineView) -> &'static str {
    match live.play.source {
        _ if live.is_stopped => "Everything is off. Go on, or arm the device, to feel again",
        Source::Stroke if live.play.is_playing => {
            "The display moves by itself: move the pointer over a textile to feel with it"
        }
        Source::Stroke | Source::Recording => "Space plays, P lets the pointer feel",
        Source::Pointer => "Move over a textile to feel it. Space: the display moves by itself",
        Source::Lines | Source::Device => "Another input moves the display. P: the pointer feels",
    }
}

/// How well things go; method, cost and ages are told on hover.
fn show_status(ui: &mut Ui, status: &Status) {
    let palette = Palette::in_ui(ui);
    let ink = if status.missed > 0 {
        palette.text
    } else {
        palette.dim
    };
    let words = RichText::new(plain_words(status)).font(theme::small());
    ui.label(words.color(ink)).on_hover_text(details(status));
}

/// `exact to 0.05 dB · nothing missed`.
fn plain_words(status: &Status) -> String {
    let exact = match status.bound_db {
        0.0 => "exact".to_owned(),
        bound_db => {
            let decimals = if bound_db < 0.005 { 4 } else { 2 };
            format!("exact to {} dB", quantity::fixed(bound_db, decimals))
        }
    };
    match status.missed {
        0 => format!("{exact} · nothing missed"),
        1 => format!("{exact} · 1 tick missed"),
        missed => format!("{exact} · {missed} ticks missed"),
    }
}

/// The numbers behind the words.
fn details(status: &Status) -> String {
    let cost = status.tick_cost_s.map(quantity::time_span);
    let lines = [
        Some(format!("Rendered by: {}", status.method)),
        Some(format!(
            "Levels differ from the reference by at most {} dB",
            quantity::fixed(status.bound_db, 4)
        )),
        cost.map(|cost| format!("A tick costs {cost} (median); one is due every 25 ms")),
        Some(format!(
            "Ticks that never were: {}; late ones: {}",
            status.missed, status.late
        )),
        (status.felt_age_s).map(|age_s| {
            let age = quantity::time_span(age_s);
            format!("From the pointer to the middle of the felt tick: {age}")
        }),
    ];
    lines.into_iter().flatten().collect::<Vec<_>>().join("\n")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_status_is_in_plain_words_and_its_numbers_one_level_deeper() {
        let mut status = Status {
            method: "table",
            bound_db: 0.05,
            tick_cost_s: Some(2e-4),
            ..Status::default()
        };
        assert_eq!(plain_words(&status), "exact to 0.05 dB · nothing missed");
        assert!(details(&status).contains("table"), "{}", details(&status));
        status.missed = 12;
        assert!(plain_words(&status).ends_with("12 ticks missed"));
        status.bound_db = 0.0;
        assert!(plain_words(&status).starts_with("exact ·"));
    }
}
