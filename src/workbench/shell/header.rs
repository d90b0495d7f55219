//! The line on top: the scene and what may be done with it, armed state, and what Esc does.

use eframe::egui::{
    self, Align, Align2, Button, Color32, Layout, Pos2, RichText, Sense, Shape, Stroke, StrokeKind,
    Ui, WidgetInfo, vec2,
};

use crate::bench::Bench;
use crate::bench::command::{Command, Commands, DeviceCommand, PlayCommand, ShowCommand};
use crate::bench::history::StepList;
use crate::bench::keys::hint;
use crate::bench::pane::Pane;
use crate::bench::perspective::Perspective;
use crate::bench::view::{EngineView, SceneView};
use crate::kit::theme;
use crate::kit::theme::{Palette, ROW, STEP};
use crate::kit::widgets::text::{button, mark};
use crate::shell::menu::{
    Appearance, show_edit_menu, show_help_menu, show_scene_menu, show_view_menu,
};
use selvedge_engine::SoundState;

/// What also stands in a menu has no room in a narrower window, points: whether the device is armed
/// and what Esc does is always seen.
const ROOM_FOR_STEPS: f32 = 900.0;
const ROOM_FOR_PERSPECTIVES: f32 = 720.0;
/// Width of the place that says whether the device is armed, points.
const ARMED_TAG: f32 = 84.0;

/// Shows the header.
pub(crate) fn show(
    ui: &mut Ui,
    (scene, steps): (&SceneView, &StepList),
    bench: &Bench,
    appearance: &Appearance,
    commands: &mut Commands,
) {
    ui.with_layout(Layout::left_to_right(Align::Center), |ui| {
        let palette = Palette::in_ui(ui);
        let width = ui.available_width();
        if width > ROOM_FOR_PERSPECTIVES {
            let name = RichText::new("Selvedge").font(theme::title());
            ui.label(name.color(palette.dim));
            ui.add_space(STEP);
        }
        show_scene_menu(ui, scene, appearance, commands);
        show_edit_menu(ui, steps, &bench.document, commands);
        show_view_menu(ui, appearance, commands);
        show_help_menu(ui, commands);
        ui.add_space(STEP);
        if width > ROOM_FOR_STEPS {
            show_history(ui, steps, commands);
            ui.add_space(2.0 * STEP);
        }
        if width > ROOM_FOR_PERSPECTIVES {
            show_perspectives(ui, appearance.perspective, commands);
        }
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            show_escape(ui, bench, commands);
            show_armed(ui, &bench.live);
            show_sound(ui, bench, commands);
            show_in_place(ui, &bench.live, commands);
            ui.add_space(2.0 * STEP);
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
        (Color32::TRANSPARENT, "saved")
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

/// What Esc would do now, as a button: everything off while a device is armed or a session is held,
/// going on after that, else a pause. Red is only what switches off.
fn show_escape(ui: &mut Ui, bench: &Bench, commands: &mut Commands) {
    let live = &bench.live;
    let size = vec2(92.0, ROW);
    if live.is_armed() || bench.has_session() {
        let palette = Palette::in_ui(ui);
        let text = RichText::new("Esc  all off").color(palette.on_danger);
        let red = Button::new(text).fill(palette.danger).min_size(size);
        let response = ui.add(red.stroke(Stroke::NONE));
        response.widget_info(|| WidgetInfo::labeled(egui::Role::Button, true, "All off"));
        let tip = "Every contactor off at once; works from anywhere, also while typing (Esc)";
        if response.on_hover_text(tip).clicked() {
            commands.push(Command::AllOff);
        }
        return;
    }
    let pauses = live.play.moves_by_itself() && live.play.is_playing;
    let (text, is_enabled, tip, command) = if live.is_stopped {
        let tip = "The display moves on the screen again; the device stays disarmed until you arm \
                   it";
        ("Go on", true, tip, DeviceCommand::GoOn.into())
    } else {
        let tip = "Hold what moves by itself; while a device is armed, Esc switches everything off";
        ("Esc  pause", pauses, tip, PlayCommand::Toggle.into())
    };
    let response = ui.add_enabled(is_enabled, Button::new(text).min_size(size));
    let response = response.on_disabled_hover_text("Nothing moves by itself");
    if response.on_hover_text(tip).clicked() {
        commands.push(command);
    }
}

/// That something else is felt in place of the array on the scene, and the way to where that is
/// switched.
fn show_in_place(ui: &mut Ui, live: &EngineView, commands: &mut Commands) {
    let tip = "What is felt is the stylus’ vibration, not the array’s rendering; the Stylus pane \
               switches it off";
    if live.stylus.is_some() && button(ui, "Stylus felt", tip, None) {
        commands.push(ShowCommand::Reveal(Pane::Stylus).into());
    }
    let tip = "What is felt is the cloth that hangs in the Drape pane, not the scene; the pane \
               switches it off, and while it is out of sight nothing is felt";
    if live.is_cloth && button(ui, "Cloth felt", tip, None) {
        commands.push(ShowCommand::Reveal(Pane::Drape).into());
    }
}

/// Whether what is felt is heard; grey, with the reason, where it cannot be.
fn show_sound(ui: &mut Ui, bench: &Bench, commands: &mut Commands) {
    let palette = Palette::in_ui(ui);
    let chosen = bench.settings.preferences.sound;
    let command: Command = ShowCommand::ToggleSound.into();
    let key = hint(ui.ctx(), &command);
    let is_allowed = !bench.has_session();
    let (is_heard, tip) = match bench.device.sound.state() {
        Some(SoundState::Absent(why)) => (false, format!("Not heard: {why}. Off: {key}")),
        _ if !chosen.is_on => (false, format!("Hear what is felt ({key})")),
        state => {
            let what = bench.heard_alone().map_or_else(
                || "What is felt".to_owned(),
                |contactor| format!("Contactor {contactor} alone"),
            );
            let low = if chosen.as_driven {
                "as driven"
            } else {
                "made audible by overtones"
            };
            let later = match state {
                Some(SoundState::Playing {
                    latency: Some(latency),
                    ..
                }) => format!(", {} ms later", latency.as_millis()),
                _ => String::new(),
            };
            let tip = format!(
                "{what} is heard{later}, 40 Hz {low}. Off: {key}. Louder, quieter, as driven: \
                 View, Sound"
            );
            (true, tip)
        }
    };
    let button = Button::new("").min_size(vec2(ROW, ROW));
    let response = ui.add_enabled(is_allowed, button.frame_when_inactive(false));
    let ink = if is_allowed && is_heard == chosen.is_on {
        palette.text
    } else {
        palette.dim
    };
    paint_loudspeaker(ui, response.rect.center(), (is_heard && is_allowed, ink));
    let name = "Sound of what is felt";
    response
        .widget_info(|| WidgetInfo::selected(egui::Role::CheckBox, is_allowed, chosen.is_on, name));
    let why = "No sound while a session is held: it changes what is felt and gives answers away";
    let response = response.on_disabled_hover_text(why).on_hover_text(tip);
    if response.clicked() {
        commands.push(command);
    }
}

/// A loudspeaker, with waves or struck out: the window's letters have none.
fn paint_loudspeaker(ui: &Ui, centre: Pos2, (is_heard, ink): (bool, Color32)) {
    let at = |x: f32, y: f32| centre + vec2(x, y);
    let line = Stroke::new(1.5, ink);
    let painter = ui.painter();
    let cone = [
        (-7.0, -2.5),
        (-4.0, -2.5),
        (0.0, -6.0),
        (0.0, 6.0),
        (-4.0, 2.5),
        (-7.0, 2.5),
    ];
    painter.add(Shape::closed_line(
        cone.map(|(x, y)| at(x, y)).to_vec(),
        line,
    ));
    if is_heard {
        for far in [3.5, 6.5] {
            let wave = [(far - 1.0, -far), (far, 0.0), (far - 1.0, far)];
            painter.line(wave.map(|(x, y)| at(x, 0.8 * y)).to_vec(), line);
        }
    } else {
        painter.line_segment([at(3.0, -3.0), at(7.0, 3.0)], line);
        painter.line_segment([at(3.0, 3.0), at(7.0, -3.0)], line);
    }
}

/// Whether high voltage is on, in red and large when it is, with the frame around the window; and
/// whether everything was switched off since.
fn show_armed(ui: &mut Ui, live: &EngineView) {
    let palette = Palette::in_ui(ui);
    let is_armed = live.is_armed();
    let (word, tip) = match (is_armed, live.is_stopped) {
        (true, _) => ("ARMED", "The device's high voltage is on"),
        (false, true) => (
            "ALL OFF",
            "Everything was switched off: nothing is felt or shown until you go on or arm",
        ),
        (false, false) => ("disarmed", "The device's high voltage is off"),
    };
    // The same place for every word: the rest of the line stands still.
    let (rect, response) = ui.allocate_exact_size(vec2(ARMED_TAG, ROW + 4.0), Sense::hover());
    response.widget_info(|| WidgetInfo::labeled(egui::Role::Label, true, word));
    let painter = ui.painter();
    let (middle, left) = (rect.center(), rect.left_center());
    if is_armed {
        painter.rect_filled(rect, 3, palette.danger);
        let ink = palette.on_danger;
        painter.text(middle, Align2::CENTER_CENTER, word, theme::title(), ink);
    } else if live.is_stopped {
        let edge = Stroke::new(1.5, palette.danger);
        painter.rect_stroke(rect, 3, edge, StrokeKind::Inside);
        painter.text(
            middle,
            Align2::CENTER_CENTER,
            word,
            theme::title(),
            palette.text,
        );
    } else {
        painter.circle_filled(left + vec2(5.0, 0.0), 4.0, palette.line);
        let at = left + vec2(16.0, 0.0);
        painter.text(at, Align2::LEFT_CENTER, word, theme::body(), palette.dim);
    }
    response.on_hover_text(tip);
}
