//! The whole library at once: a plot of small pieces of cloth with a table beside it, or larger
//! pieces to look through. Both share search, kinds and what is selected.

pub(crate) mod cloths;
pub(crate) mod head;
pub(crate) mod names;
pub(crate) mod plot;
pub(crate) mod points;
pub(crate) mod status;
pub(crate) mod table;

use eframe::egui::{self, DragAndDrop, Response, Stroke, StrokeKind, Ui};

use crate::bench::command::edit::Edit;
use crate::bench::command::{Commands, Part, ShowCommand};
use crate::bench::library_view::LibraryItem;
use crate::bench::library_view::LibraryView;
use crate::kit::spectrogram::paint_sentence;
use crate::kit::theme::{Palette, STEP};
use crate::tools::collection::{CollectionCommand, CollectionView, Entry, Joining, Mode};

/// Below this width, and where it is hardly wider than high, the table stands below the plot,
/// points and width over height.
const SIDE_BY_SIDE: f32 = 620.0;
const WIDE: f32 = 1.15;
/// Width of the table beside the plot, points.
const TABLE: f32 = 416.0;
/// Height of the line at the bottom, points.
const STATUS: f32 = 22.0;

/// What the pane changes by itself: what is typed, and where the pointer rests.
pub(crate) struct Typed<'a> {
    /// What is typed in the field that searches.
    pub search: &'a mut String,
    /// The textile under the pointer.
    pub pointed: &'a mut Option<String>,
}

/// Shows the pane.
pub(crate) fn show(
    ui: &mut Ui,
    library_view: &mut LibraryView,
    view: &CollectionView<'_>,
    typed: &mut Typed<'_>,
    commands: &mut Commands,
) {
    *typed.pointed = None;
    head::show(ui, view, typed.search, commands);
    let room = ui.available_rect_before_wrap();
    let (room, foot) = room.split_top_bottom_at_y(room.bottom() - STATUS);
    if view.entries.is_empty() {
        let words = if view.items.is_empty() {
            "This library holds no textiles: put some into its folder, then open the scene again"
        } else {
            "Nothing by that name or of that kind: clear the field, or choose all kinds"
        };
        paint_sentence(ui.painter(), room, words);
    } else {
        match view.choice.mode {
            Mode::Cloths => within(ui, room, |ui| {
                cloths::show(ui, library_view, view, typed.pointed, commands);
            }),
            Mode::Plot => {
                let is_wide = room.width() >= SIDE_BY_SIDE && room.width() > WIDE * room.height();
                let (plot, table) = if is_wide {
                    room.split_left_right_at_x(room.right() - TABLE)
                } else {
                    let height = (0.62 * room.height()).min(0.9 * room.width());
                    room.split_top_bottom_at_y(room.top() + height.round())
                };
                within(ui, plot, |ui| {
                    plot::show(ui, library_view, view, typed.pointed, commands);
                });
                let table = if is_wide {
                    table.with_min_x(table.left() + 3.0 * STEP)
                } else {
                    table.with_min_y(table.top() + STEP)
                };
                within(ui, table, |ui| {
                    table::show(ui, view, typed.pointed, commands);
                });
            }
        }
    }
    within(ui, foot, |ui| status::show(ui, view, commands));
}

fn within(ui: &mut Ui, room: egui::Rect, content: impl FnOnce(&mut Ui)) {
    ui.scope_builder(egui::UiBuilder::new().max_rect(room), content);
}

/// What every view of a textile does with pointer and keys: hover marks, a click selects, a double
/// click adds, a drag carries it into the workspace.
fn answer(
    ui: &Ui,
    response: &Response,
    entry: &Entry<'_>,
    pointed: &mut Option<String>,
    commands: &mut Commands,
) {
    let id = &entry.item.id;
    if response.hovered() {
        *pointed = Some(id.clone());
        if let Some(index) = entry.placed {
            commands.push(ShowCommand::Hover(Part::Cloth(index)).into());
        }
    }
    if entry.item.flaw.is_some() {
        return;
    }
    if response.double_clicked() {
        commands.push(Edit::AddCloths(vec![id.clone()]).into());
    } else if response.clicked() {
        let is_more = ui.input(|input| input.modifiers.command);
        let joining = if is_more {
            Joining::Toggled
        } else {
            Joining::Alone
        };
        commands.push(CollectionCommand::Select(vec![id.clone()], joining).into());
        if let Some(index) = entry.placed.filter(|_| !is_more) {
            commands.push(ShowCommand::SelectCloth(Some(index)).into());
        }
    }
    if response.drag_started() {
        commands.push(CollectionCommand::Carry.into());
        DragAndDrop::set_payload(ui.ctx(), LibraryItem { id: id.clone() });
    }
}

/// A line around what has the keyboard.
fn paint_focus(ui: &Ui, response: &Response) {
    if response.has_focus() {
        let edge = Stroke::new(1.0, Palette::in_ui(ui).selection);
        let rect = response.rect.expand(2.0);
        ui.painter().rect_stroke(rect, 4, edge, StrokeKind::Inside);
    }
}
