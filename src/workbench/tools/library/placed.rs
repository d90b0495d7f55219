//! The textiles of the scene, to mute, choose, label and remove.

use eframe::egui::{
    self, Align, Layout, Rect, RichText, Sense, TextEdit, Ui, UiBuilder, WidgetInfo, pos2, vec2,
};

use crate::bench::command::edit::Edit;
use crate::bench::command::{Commands, Part, ShowCommand};
use crate::bench::mute_solo::MuteSolo;
use crate::bench::tool::PaneContext;
use crate::bench::view::{Cloth, SceneView};
use crate::kit::pane::scroll_area;
use crate::kit::theme;
use crate::kit::theme::{Palette, STEP};
use crate::kit::widgets::text::{named, paint_focus, paint_line, paint_name, row, toggle};
use selvedge_foundation::quantity;

/// Width of a letter of a label, points.
const LETTER: f32 = 8.0;
/// Most letters of a label that the list shows: files may hold longer ones than can be typed.
const MOST_SHOWN: usize = 5;
/// Most letters that can be typed for a label.
const MOST_LETTERS: usize = 3;

/// The textiles of the scene, topmost first as they lie.
pub(crate) fn show(ui: &mut Ui, context: &mut PaneContext<'_>) {
    let (scene, commands) = (context.scene, &mut *context.commands);
    let mute_solo = &context.bench.selection.mute_solo;
    let selected = context.bench.selection.cloth;
    row(ui, "In the scene", |ui| {
        if mute_solo.is_any() && toggle(ui, "feel all", false, "End every mute and solo (H)") {
            commands.push(ShowCommand::HearAll.into());
        }
    });
    if scene.cloths.is_empty() {
        let words = "No textile yet: drag one from the library into the workspace";
        ui.label(RichText::new(words).color(Palette::in_ui(ui).dim));
        return;
    }
    let labels = label_width(scene);
    scroll_area("placed").show_rows(ui, theme::ROW, scene.cloths.len(), |ui, range| {
        for index in range {
            if let Some(cloth) = scene.cloths.get(index) {
                let marks = [selected == Some(index), scene.is_marked(index)];
                show_cloth(ui, (index, cloth), mute_solo, (marks, labels), commands);
            }
        }
    });
}

/// Room for the longest label, points: all names begin at one place.
fn label_width(scene: &SceneView) -> f32 {
    let letters = scene.cloths.iter().map(|cloth| cloth.label.chars().count());
    let most = letters.max().unwrap_or(1).min(MOST_SHOWN);
    (LETTER * most as f32).max(18.0)
}

fn show_cloth(
    ui: &mut Ui,
    (index, cloth): (usize, &Cloth),
    mute_solo: &MuteSolo,
    ([is_selected, is_marked], labels): ([bool; 2], f32),
    commands: &mut Commands,
) {
    let palette = Palette::in_ui(ui);
    let part = Part::Cloth(index);
    let width = ui.available_width();
    ui.allocate_ui_with_layout(
        vec2(width, theme::ROW),
        Layout::right_to_left(Align::Center),
        |ui| {
            ui.spacing_mut().item_spacing.x = STEP;
            let name = format!("{} {}", cloth.label, cloth.name);
            let solo = format!("Feel {name} alone");
            if toggle(ui, "S", mute_solo.is_solo(part), &solo) {
                commands.push(ShowCommand::Solo(part).into());
            }
            let mute = format!("Mute {name}");
            if toggle(ui, "M", mute_solo.is_muted(part), &mute) {
                commands.push(ShowCommand::Mute(part).into());
            }
            let (rect, response) = ui.allocate_exact_size(ui.available_size(), Sense::click());
            response.widget_info(|| {
                WidgetInfo::selected(egui::Role::ListItem, true, is_selected, &name)
            });
            if response.hovered() {
                commands.push(ShowCommand::Hover(part).into());
            }
            if is_selected {
                ui.painter().rect_filled(rect, 4, palette.raised);
            } else if response.hovered() || is_marked {
                ui.painter()
                    .rect_filled(rect, 4, palette.raised.gamma_multiply(0.6));
            }
            paint_focus(ui, &response);
            let ink = if cloth.is_muted {
                palette.dim
            } else {
                palette.text
            };
            let (left, middle) = (rect.left() + 6.0, rect.center().y);
            if is_selected {
                let place = rect.with_max_x(rect.left() + labels + 6.0);
                show_label_field(ui, place, (index, cloth), commands);
            } else {
                let label = RichText::new(&cloth.label).font(theme::number());
                paint_line(ui, pos2(left, middle), labels, label.color(palette.dim));
            }
            let from = labels + 2.0;
            let room = rect.width() - from - 6.0;
            paint_name(ui, pos2(left + from, middle), room, (&cloth.name, ink));
            if response.clicked() {
                let choice = (!is_selected).then_some(index);
                commands.push(ShowCommand::SelectCloth(choice).into());
            }
            let gain = quantity::with_unit(cloth.gain_db, 1, "dB");
            response.on_hover_text(format!("{name}\nscene gain {gain}\nClick to choose it"));
        },
    );
}

/// The label of the chosen textile, to be typed over.
fn show_label_field(
    ui: &mut Ui,
    place: Rect,
    (index, cloth): (usize, &Cloth),
    commands: &mut Commands,
) {
    let mut label = cloth.label.clone();
    let place = place.shrink2(vec2(0.0, 2.0));
    let field = TextEdit::singleline(&mut label)
        .font(theme::number())
        .char_limit(MOST_LETTERS)
        .margin(egui::Margin::symmetric(4, 2));
    // A child of its own: the row is as high as the others.
    let response = ui.new_child(UiBuilder::new().max_rect(place)).add(field);
    let name = format!("Label of {}", cloth.name);
    named(&response, name);
    if response.changed() {
        commands.push(Edit::Label(index, label).into());
    }
    response.on_hover_text("What the scene calls it");
}
