//! The library, to take textiles from, and the textiles of the scene, to mute, choose and remove.

use eframe::egui::{
    self, Align, DragAndDrop, Layout, Rect, Response, RichText, ScrollArea, Sense, Stroke,
    TextEdit, Ui, UiBuilder, WidgetInfo, pos2, vec2,
};

use crate::bench::command::edit::Edit;
use crate::bench::command::lab::Beginning;
use crate::bench::command::{Command, Commands, Part, ShowCommand};
use crate::bench::library_selection::Joining;
use crate::bench::library_view::LibraryItem;
use crate::bench::mute_solo::MuteSolo;
use crate::bench::pane::Pane;
use crate::bench::tool::{PaneContext, Tool};
use crate::bench::view::{Cloth, ClothPicture, LibraryEntry, SceneView};
use crate::kit::pane::framed;
use crate::kit::theme::{Palette, STEP};
use crate::kit::widgets::text::{paint_line, row, toggle};
use crate::kit::{swatch, theme};
use selvedge_foundation::geometry::Point;
use selvedge_foundation::quantity;

/// Height of a row, points.
const ROW: f32 = 36.0;
/// Side of the piece of cloth that a row shows, points.
const SWATCH: f32 = 28.0;
/// How much cloth that piece shows, mm.
const SWATCH_MM: f32 = 14.0;
/// Width of a letter of a label, points.
const LETTER: f32 = 8.0;
/// Most letters of a label that the list shows: files may hold longer ones than can be typed.
const MOST_SHOWN: usize = 5;
/// Most letters that can be typed for a label.
const MOST_LETTERS: usize = 3;
/// Most rows of the scene that are in sight at once.
const SCENE_ROWS: usize = 6;

/// The library, to take textiles from.
#[derive(Debug, Default)]
pub(crate) struct Library {
    /// What is typed in the field that searches it.
    search: String,
}

impl Tool for Library {
    fn panes(&self) -> &'static [Pane] {
        &[Pane::Library]
    }

    fn ui(&mut self, _pane: Pane, ui: &mut Ui, context: &mut PaneContext<'_>) {
        framed(ui, 10, |ui| show(ui, &mut self.search, context));
    }
}

/// Shows the pane. `search` is what is typed in its field.
fn show(ui: &mut Ui, search: &mut String, context: &mut PaneContext<'_>) {
    let n_rows = context.scene.cloths.len().clamp(2, SCENE_ROWS);
    let lower = n_rows as f32 * (theme::ROW + STEP) + 28.0;
    let whole = ui.max_rect();
    let edge = (whole.bottom() - lower)
        .max(whole.top() + 3.0 * ROW)
        .round();
    let (above, below) = whole.split_top_bottom_at_y(edge);
    ui.scope_builder(UiBuilder::new().max_rect(above), |ui| {
        show_library(ui, search, context);
    });
    let line = Stroke::new(1.0, Palette::in_ui(ui).hairline);
    ui.painter().hline(whole.x_range(), edge + 1.0, line);
    let below = below.with_min_y(edge + STEP);
    ui.scope_builder(UiBuilder::new().max_rect(below), |ui| {
        show_placed(ui, context);
    });
}

/// The library, as much of it as matches the search.
fn show_library(ui: &mut Ui, search: &mut String, context: &mut PaneContext<'_>) {
    show_search(ui, search);
    let items = context.bench.library.view.shared_items();
    let matching: Vec<&LibraryEntry> = items.iter().filter(|item| item.matches(search)).collect();
    if matching.is_empty() {
        let words = if items.is_empty() {
            "This library holds no textiles: put some into its folder, then open the scene again"
        } else {
            "Nothing by that name: clear the field to see all"
        };
        ui.label(RichText::new(words).color(Palette::in_ui(ui).dim));
    }
    let rows = ScrollArea::vertical().id_salt("shelf").auto_shrink(false);
    rows.show_rows(
        ui,
        ROW - ui.spacing().item_spacing.y,
        matching.len(),
        |ui, range| {
            for item in &matching[range] {
                let library_view = &mut context.bench.library.view;
                library_view.want(&item.id);
                let picture = library_view.picture(&item.id);
                show_item(ui, item, picture, context);
            }
        },
    );
}

fn show_search(ui: &mut Ui, search: &mut String) {
    let field = TextEdit::singleline(search)
        .desired_width(f32::INFINITY)
        .margin(egui::Margin::symmetric(6, 4))
        .hint_text("Search");
    let response = ui.add(field);
    ui.ctx()
        .accesskit_node_builder(response.id, |node| node.set_label("Search the library"));
}

/// One textile of the library: dragged into the workspace, or added by a double click.
fn show_item(
    ui: &mut Ui,
    item: &LibraryEntry,
    picture: Option<ClothPicture>,
    context: &mut PaneContext<'_>,
) {
    let scene = context.scene;
    let palette = Palette::in_ui(ui);
    let size = vec2(ui.available_width(), ROW - ui.spacing().item_spacing.y);
    let (rect, response) = ui.allocate_exact_size(size, Sense::click_and_drag());
    let is_usable = item.flaw.is_none();
    response.widget_info(|| {
        WidgetInfo::labeled(
            egui::Role::ListItem,
            is_usable,
            format!("Add {}", item.name),
        )
    });
    if let Some(index) = scene.placed(&item.id).filter(|_| response.hovered()) {
        let hover = ShowCommand::Hover(Part::Cloth(index));
        context.commands.push(hover.into());
    }
    let is_lit = response.hovered() || response.has_focus() || scene.is_marked_id(&item.id);
    if is_usable && is_lit {
        ui.painter().rect_filled(rect, 4, palette.raised);
    }
    paint_focus(ui, &response);
    let side = SWATCH.min(rect.height());
    let square = Rect::from_min_size(
        pos2(rect.left() + 2.0, rect.center().y - 0.5 * side),
        vec2(side, side),
    );
    swatch::paint(ui.painter(), square, SWATCH_MM, picture);
    let ink = if is_usable { palette.text } else { palette.dim };
    let left = square.right() + 8.0;
    let room = rect.right() - left;
    let name = RichText::new(&item.name).font(theme::body()).color(ink);
    paint_line(ui, pos2(left, rect.center().y - 7.0), room, name);
    let second = if is_usable {
        item.kind.as_str()
    } else {
        "cannot be read"
    };
    let second = RichText::new(second)
        .font(theme::small())
        .color(palette.dim);
    paint_line(ui, pos2(left, rect.center().y + 8.0), room, second);
    answer_item(ui, response, item, context);
}

fn answer_item(ui: &Ui, response: Response, item: &LibraryEntry, context: &mut PaneContext<'_>) {
    let scene = context.scene;
    if let Some(flaw) = &item.flaw {
        response.on_hover_text(flaw);
        return;
    }
    let is_entered = response.has_focus() && ui.input(|i| i.key_pressed(egui::Key::Enter));
    if response.double_clicked() || is_entered {
        context.commands.push(added(item, scene));
    } else if response.clicked() {
        let joining = if ui.input(|input| input.modifiers.command) {
            Joining::Toggled
        } else {
            Joining::Alone
        };
        let selection = &mut context.bench.library.selection;
        selection.select(vec![item.id.clone()], joining);
        ui.ctx().request_repaint();
    }
    response.context_menu(|ui| show_item_menu(ui, item, scene, context.commands));
    if response.drag_started() {
        let id = item.id.clone();
        DragAndDrop::set_payload(ui.ctx(), LibraryItem { id });
    }
    let level = item.level_db.map_or_else(String::new, |level_db| {
        format!(
            "\nlevel {}, mean of both bands at 100 mm/s, re 1 µm",
            quantity::with_unit(level_db, 1, "dB")
        )
    });
    response
        .on_hover_cursor(egui::CursorIcon::Grab)
        .on_hover_text(format!(
            "{}\n{}{level}\nDrag it into the workspace, or double click; more with the right \
             button",
            item.name, item.kind
        ));
}

/// The act that adds a textile in the middle of the workspace.
fn added(item: &LibraryEntry, scene: &SceneView) -> Command {
    let [width_mm, height_mm] = scene.size_mm;
    let middle = Point::new(width_mm / 2.0, height_mm / 2.0);
    Edit::AddCloth(item.id.clone(), middle).into()
}

/// What can be done with a textile of the library.
fn show_item_menu(ui: &mut Ui, item: &LibraryEntry, scene: &SceneView, commands: &mut Commands) {
    let id = || item.id.clone();
    let acts = [
        ("Add to the scene", added(item, scene)),
        ("Vary a copy in the lab", Beginning::Copy(id()).into()),
        (
            "Restore in the lab from what repeats",
            Beginning::Restore(id()).into(),
        ),
    ];
    for (words, act) in acts {
        if ui.button(words).clicked() {
            commands.push(act);
            ui.close();
        }
    }
}

/// A line around the row that has the keyboard.
fn paint_focus(ui: &Ui, response: &Response) {
    if response.has_focus() {
        let edge = Stroke::new(1.0, Palette::in_ui(ui).selection);
        let inside = egui::StrokeKind::Inside;
        ui.painter().rect_stroke(response.rect, 4, edge, inside);
    }
}

/// The textiles of the scene, topmost first as they lie.
fn show_placed(ui: &mut Ui, context: &mut PaneContext<'_>) {
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
    let rows = ScrollArea::vertical().id_salt("placed").auto_shrink(false);
    rows.show_rows(ui, theme::ROW, scene.cloths.len(), |ui, range| {
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
            let text = RichText::new(&cloth.name).font(theme::body()).color(ink);
            let from = labels + 2.0;
            paint_line(
                ui,
                pos2(left + from, middle),
                rect.width() - from - 6.0,
                text,
            );
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
    ui.ctx()
        .accesskit_node_builder(response.id, |node| node.set_label(name));
    if response.changed() {
        commands.push(Edit::Label(index, label).into());
    }
    response.on_hover_text("What the scene calls it");
}
