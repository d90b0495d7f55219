//! The line on top: the scene and what may be done with it, rendering, armed state, all off.

use eframe::egui::{
    self, Align, Button, Layout, RichText, Stroke, ThemePreference, Ui, WidgetInfo, vec2,
};

use super::Wishes;
use crate::app::command::{Command, FileCommand, PlayCommand, Purpose, ShowCommand};
use crate::app::shortcuts::hint;
use crate::app::theme::{self, ColourMap, Palette, ROW, STEP};
use crate::app::view::{Live, SceneView, Source, Status};
use crate::app::widgets::{button, mark};
use crate::quantity;

/// Shows the header.
pub(crate) fn show(
    ui: &mut Ui,
    scene: &SceneView,
    live: &Live,
    colour_map: ColourMap,
    wishes: &mut Wishes,
) {
    let width = ui.available_width();
    ui.with_layout(Layout::left_to_right(Align::Center), |ui| {
        show_scene(ui, scene, wishes);
        show_stroke(ui, live.source, wishes);
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            show_all_off(ui, wishes);
            show_armed(ui, live);
            ui.add_space(2.0 * STEP);
            show_appearance(ui, colour_map, wishes);
            ui.add_space(2.0 * STEP);
            if width > 1000.0 {
                show_status(ui, &live.status);
            }
        });
    });
}

fn show_scene(ui: &mut Ui, scene: &SceneView, wishes: &mut Wishes) {
    let palette = Palette::in_ui(ui);
    ui.label(
        RichText::new("Selvedge")
            .font(theme::title())
            .color(palette.dim),
    );
    ui.add_space(STEP);
    let name = ui.label(
        RichText::new(&scene.name)
            .font(theme::title())
            .color(palette.text),
    );
    let place = scene.path.as_ref().map(|path| path.display().to_string());
    name.on_hover_text(place.unwrap_or_else(|| "The scene shipped with the program".to_owned()));
    // The mark keeps its place when there is nothing to mark, so that nothing moves.
    let (ink, words) = if scene.is_edited {
        (palette.selection, "edited: not saved yet")
    } else {
        (egui::Color32::TRANSPARENT, "saved")
    };
    mark(ui, ink, words).on_hover_text(words);
    ui.add_space(STEP);
    let ctx = ui.ctx().clone();
    let tip = |what: &str, command: &Command| format!("{what} ({})", hint(&ctx, command));
    let open: Command = FileCommand::Ask(Purpose::OpenScene).into();
    if button(ui, "Open…", &tip("Open a scene", &open), None) {
        wishes.push(open);
    }
    let unedited = (!scene.is_edited && scene.path.is_some()).then_some("Nothing has changed");
    let save: Command = FileCommand::Save.into();
    if button(ui, "Save", &tip("Save the scene", &save), unedited) {
        wishes.push(save);
    }
    let undo = scene
        .undo
        .map(|step| tip(&format!("Undo {step}"), &Command::Undo));
    let nothing = undo.is_none().then_some("Nothing to undo");
    if button(ui, "Undo", &undo.unwrap_or_default(), nothing) {
        wishes.push(Command::Undo);
    }
    let redo = scene
        .redo
        .map(|step| tip(&format!("Redo {step}"), &Command::Redo));
    let nothing = redo.is_none().then_some("Nothing to redo");
    if button(ui, "Redo", &redo.unwrap_or_default(), nothing) {
        wishes.push(Command::Redo);
    }
}

fn show_stroke(ui: &mut Ui, source: Source, wishes: &mut Wishes) {
    let (text, what) = match source {
        Source::Stroke { is_playing: true } => {
            ("Stop stroke", "Give the display back to the pointer")
        }
        _ => (
            "Play stroke",
            "Let the display explore by itself, in a circle",
        ),
    };
    ui.add_space(STEP);
    let toggle: Command = PlayCommand::Toggle.into();
    let tip = format!("{what} ({})", hint(ui.ctx(), &toggle));
    if button(ui, text, &tip, None) {
        wishes.push(toggle);
    }
}

fn show_all_off(ui: &mut Ui, wishes: &mut Wishes) {
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
        wishes.push(Command::AllOff);
    }
}

fn show_armed(ui: &mut Ui, live: &Live) {
    let palette = Palette::in_ui(ui);
    let is_armed = live.is_armed();
    let (word, ink) = match (is_armed, live.is_stopped) {
        (true, _) => ("ARMED", palette.danger),
        (false, true) => ("all off", palette.text),
        (false, false) => ("disarmed", palette.dim),
    };
    // The same width for every word: the rest of the line stands still.
    ui.allocate_ui_with_layout(
        vec2(76.0, ROW),
        Layout::left_to_right(Align::Center),
        |ui| {
            ui.set_min_width(76.0);
            mark(
                ui,
                if is_armed {
                    palette.danger
                } else {
                    palette.line
                },
                word,
            );
            ui.label(RichText::new(word).color(ink));
        },
    )
    .response
    .on_hover_text("Whether the device's high voltage is on");
}

fn show_appearance(ui: &mut Ui, colour_map: ColourMap, wishes: &mut Wishes) {
    let choice =
        |ui: &mut Ui, is_chosen: bool, label: &str| ui.selectable_label(is_chosen, label).clicked();
    ui.menu_button("View", |ui| {
        let theme = ui.ctx().options(|options| options.theme_preference);
        let themes = [
            (ThemePreference::System, "As the system"),
            (ThemePreference::Dark, "Dark"),
            (ThemePreference::Light, "Light"),
        ];
        for (preference, label) in themes {
            if choice(ui, theme == preference, label) {
                wishes.push(ShowCommand::Theme(preference).into());
            }
        }
        ui.separator();
        for map in ColourMap::ALL {
            if choice(
                ui,
                map == colour_map,
                &format!("Numbers in {}", map.label()),
            ) {
                wishes.push(ShowCommand::ColourMap(map).into());
            }
        }
    });
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

/// The status in fixed digits: `table ·   0.2 µs · ≤ 0.050 dB · 0 missed`; without the cost where
/// nobody measures it.
fn status_line(status: &Status) -> String {
    let cost = status.tick_cost_s.map_or_else(String::new, |s| {
        format!(" · {:>5} µs", quantity::fixed(s * 1e6, 1))
    });
    let bound = quantity::fixed(status.bound_db, 3);
    format!(
        "{}{cost} · ≤ {bound} dB · {} missed",
        status.method, status.missed
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_status_keeps_its_width_while_the_cost_changes() {
        let line = |tick_cost_s| {
            status_line(&Status {
                method: "table",
                tick_cost_s,
                ..Status::default()
            })
        };
        assert_eq!(
            line(Some(2.1e-7)),
            "table ·   0.2 µs · ≤ 0.000 dB · 0 missed"
        );
        let width = |cost_s| line(Some(cost_s)).chars().count();
        assert_eq!(width(41.0e-6), width(2.1e-7));
    }
}
