//! The line on top: the scene and what may be done with it, rendering, armed state, all off.

use eframe::egui::{
    self, Align, Align2, Button, Layout, RichText, Sense, Stroke, Ui, WidgetInfo, vec2,
};

use crate::bench::command::{Command, Commands, ShowCommand};
use crate::bench::history::StepList;
use crate::bench::keys::hint;
use crate::bench::perspective::Perspective;
use crate::bench::view::{EngineView, SceneView, Status};
use crate::kit::theme;
use crate::kit::theme::{Palette, ROW, STEP};
use crate::kit::widgets::text::{button, mark};
use crate::shell::menu::{Appearance, show_edit_menu, show_scene_menu, show_view_menu};
use selvedge_foundation::quantity;

/// A window narrower than this has no room for the status, points.
const ROOM_FOR_STATUS: f32 = 1000.0;
/// Width of the place that says whether the device is armed, points.
const ARMED_TAG: f32 = 84.0;

/// Shows the header.
pub(crate) fn show(
    ui: &mut Ui,
    (scene, steps): (&SceneView, &StepList),
    live: &EngineView,
    appearance: &Appearance,
    commands: &mut Commands,
) {
    let width = ui.available_width();
    ui.with_layout(Layout::left_to_right(Align::Center), |ui| {
        let palette = Palette::in_ui(ui);
        let name = RichText::new("Selvedge").font(theme::title());
        ui.label(name.color(palette.dim));
        ui.add_space(STEP);
        show_scene_menu(ui, scene, appearance, commands);
        show_edit_menu(ui, steps, commands);
        show_view_menu(ui, appearance, commands);
        ui.add_space(STEP);
        show_history(ui, steps, commands);
        ui.add_space(2.0 * STEP);
        show_perspectives(ui, appearance.perspective, commands);
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            show_all_off(ui, commands);
            show_armed(ui, live);
            ui.add_space(2.0 * STEP);
            if width > ROOM_FOR_STATUS {
                show_status(ui, &live.status);
                ui.add_space(2.0 * STEP);
            }
            ui.with_layout(Layout::left_to_right(Align::Center), |ui| {
                show_name(ui, scene);
            });
        });
    });
}

/// What the window is arranged for: quiet tabs.
fn show_perspectives(ui: &mut Ui, shown: Perspective, commands: &mut Commands) {
    let palette = Palette::in_ui(ui);
    for perspective in Perspective::ALL {
        let is_shown = perspective == shown;
        let ink = if is_shown { palette.text } else { palette.dim };
        let text = RichText::new(perspective.title()).color(ink);
        let tab = Button::new(text).frame_when_inactive(false).selected(false);
        let response = ui.add(tab.min_size(vec2(0.0, ROW)));
        response.widget_info(|| {
            let label = format!("{} perspective", perspective.title());
            WidgetInfo::selected(egui::Role::Tab, true, is_shown, label)
        });
        if is_shown {
            let foot = response.rect.bottom() - 1.0;
            let line = Stroke::new(1.5, palette.selection);
            ui.painter()
                .hline(response.rect.x_range().shrink(6.0), foot, line);
        }
        let command: Command = ShowCommand::Perspective(perspective).into();
        let tip = format!("{} ({})", perspective.what(), hint(ui.ctx(), &command));
        if response.on_hover_text(tip).clicked() && !is_shown {
            commands.push(command);
        }
    }
}

/// The scene's name and whether it is saved.
fn show_name(ui: &mut Ui, scene: &SceneView) {
    let palette = Palette::in_ui(ui);
    ui.add_space(STEP);
    // The mark keeps its place when there is nothing to mark, so that nothing moves.
    let (ink, words) = if scene.is_edited {
        (palette.selection, "edited: not saved yet")
    } else {
        (egui::Color32::TRANSPARENT, "saved")
    };
    mark(ui, ink, words).on_hover_text(words);
    let text = RichText::new(&scene.name).font(theme::title());
    let name = ui.add(egui::Label::new(text.color(palette.text)).truncate());
    let place = scene.path.as_ref().map(|path| path.display().to_string());
    name.on_hover_text(place.unwrap_or_else(|| "Not in a file of yours yet".to_owned()));
}

fn show_history(ui: &mut Ui, steps: &StepList, commands: &mut Commands) {
    let steps = [
        ("Undo", steps.undo(), Command::Undo),
        ("Redo", steps.redo(), Command::Redo),
    ];
    for (label, step, command) in steps {
        let key = hint(ui.ctx(), &command);
        let tip = step.map(|step| format!("{label}: {step} ({key})"));
        let nothing = format!("Nothing to {}", label.to_lowercase());
        let refusal = tip.is_none().then_some(nothing.as_str());
        if button(ui, label, &tip.clone().unwrap_or_default(), refusal) {
            commands.push(command);
        }
    }
}

fn show_all_off(ui: &mut Ui, commands: &mut Commands) {
    let palette = Palette::in_ui(ui);
    let text = RichText::new("Esc  all off").color(palette.on_danger);
    let red = Button::new(text)
        .fill(palette.danger)
        .min_size(vec2(92.0, ROW))
        .stroke(Stroke::NONE);
    let response = ui.add(red);
    response.widget_info(|| WidgetInfo::labeled(egui::Role::Button, true, "All off"));
    let tip = "Every contactor off at once; works from anywhere, also while typing (Esc)";
    if response.on_hover_text(tip).clicked() {
        commands.push(Command::AllOff);
    }
}

/// Whether high voltage is on: in red and large when it is, with the frame around the window.
fn show_armed(ui: &mut Ui, live: &EngineView) {
    let palette = Palette::in_ui(ui);
    let is_armed = live.is_armed();
    let (word, ink) = match (is_armed, live.is_stopped) {
        (true, _) => ("ARMED", palette.on_danger),
        (false, true) => ("all off", palette.text),
        (false, false) => ("disarmed", palette.dim),
    };
    // The same place for every word: the rest of the line stands still.
    let (rect, response) = ui.allocate_exact_size(vec2(ARMED_TAG, ROW + 4.0), Sense::hover());
    response.widget_info(|| WidgetInfo::labeled(egui::Role::Label, true, word));
    let painter = ui.painter();
    let (middle, left) = (rect.center(), rect.left_center());
    if is_armed {
        painter.rect_filled(rect, 3, palette.danger);
        painter.text(middle, Align2::CENTER_CENTER, word, theme::title(), ink);
    } else {
        painter.circle_filled(left + vec2(5.0, 0.0), 4.0, palette.line);
        let at = left + vec2(16.0, 0.0);
        painter.text(at, Align2::LEFT_CENTER, word, theme::body(), ink);
    }
    response.on_hover_text("Whether the device's high voltage is on");
}

fn show_status(ui: &mut Ui, status: &Status) {
    let palette = Palette::in_ui(ui);
    let ink = if status.missed > 0 {
        palette.text
    } else {
        palette.dim
    };
    let response = ui.label(
        RichText::new(status_line(status))
            .font(theme::number())
            .color(ink),
    );
    let felt = status.felt_age_s.map_or_else(String::new, |age_s| {
        format!(
            "\nPointer to the middle of the felt tick {}",
            quantity::time_span(age_s)
        )
    });
    response.on_hover_text(format!(
        "Rendering method · median cost of a tick · bound of its level error · ticks that never \
         were\n{} late ticks{felt}",
        status.late
    ));
}

/// The status in fixed digits: `table ·   0.2 µs · ≤ 0.050 dB ·    0 missed`; without the cost
/// where nobody measures it. Its width is that of the numbers of any day, not of the moment.
fn status_line(status: &Status) -> String {
    let cost = status.tick_cost_s.map_or_else(String::new, |s| {
        let us = s * 1e6;
        let decimals = usize::from(us < 999.95);
        format!(" · {:>5} µs", quantity::fixed(us, decimals))
    });
    let bound = quantity::fixed(status.bound_db, 3);
    format!(
        "{}{cost} · ≤ {bound} dB · {:>4} missed",
        status.method, status.missed
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_status_keeps_its_width_while_its_numbers_change() {
        let line = |cost_s, missed| {
            status_line(&Status {
                method: "table",
                tick_cost_s: Some(cost_s),
                missed,
                ..Status::default()
            })
        };
        assert_eq!(
            line(2.1e-7, 0),
            "table ·   0.2 µs · ≤ 0.000 dB ·    0 missed"
        );
        let width = |cost_s, missed| line(cost_s, missed).chars().count();
        for (cost_s, missed) in [(41.0e-6, 12), (999.96e-6, 345), (0.025, 9999)] {
            assert_eq!(width(cost_s, missed), width(2.1e-7, 0), "{cost_s} {missed}");
        }
    }
}
