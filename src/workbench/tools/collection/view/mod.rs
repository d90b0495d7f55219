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

use crate::bench::Bench;
use crate::bench::command::edit::Edit;
use crate::bench::command::{Commands, Part, ShowCommand};
use crate::bench::library_view::LibraryItem;
use crate::bench::pane::Pane;
use crate::bench::selection::Joining;
use crate::kit::spectrogram::paint_sentence;
use crate::kit::theme::{Palette, STEP};
use crate::tools::collection::{Choice, CollectionView, Entry, Mode};

/// Below this width, and where it is hardly wider than high, the table stands below the plot,
/// points and width over height.
const SIDE_BY_SIDE: f32 = 620.0;
const WIDE: f32 = 1.15;
/// Width of the table beside the plot, points.
const TABLE: f32 = 416.0;
/// Height of the line at the bottom, points.
const STATUS: f32 = 22.0;

/// What is changed in the pane.
pub(crate) struct Hand<'a> {
    /// What is shown next, and how.
    pub choice: Choice,
    /// What is typed in the field that searches.
    pub search: String,
    /// The textile under the pointer.
    pub pointed: Option<String>,
    /// Whether measuring stops or goes on.
    pub halts: Option<bool>,
    /// What tools share.
    pub(crate) bench: &'a mut Bench,
    /// What the user wants of the scene.
    pub(crate) commands: &'a mut Commands,
}

impl Hand<'_> {
    /// Selects textiles.
    pub(crate) fn select(&mut self, ids: Vec<String>, joining: Joining) {
        self.bench.transient.selection.select(ids, joining);
    }
}

/// Shows the pane.
pub(crate) fn show(ui: &mut Ui, view: &CollectionView<'_>, hand: &mut Hand<'_>) {
    head::show(ui, view, hand);
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
            Mode::Cloths => within(ui, room, |ui| cloths::show(ui, view, hand)),
            Mode::Plot => {
                let is_wide = room.width() >= SIDE_BY_SIDE && room.width() > WIDE * room.height();
                let (plot, table) = if is_wide {
                    room.split_left_right_at_x(room.right() - TABLE)
                } else {
                    let height = (0.62 * room.height()).min(0.9 * room.width());
                    room.split_top_bottom_at_y(room.top() + height.round())
                };
                within(ui, plot, |ui| plot::show(ui, view, hand));
                let table = if is_wide {
                    table.with_min_x(table.left() + 3.0 * STEP)
                } else {
                    table.with_min_y(table.top() + STEP)
                };
                within(ui, table, |ui| table::show(ui, view, hand));
            }
        }
    }
    within(ui, foot, |ui| status::show(ui, view, hand));
}

fn within(ui: &mut Ui, room: egui::Rect, content: impl FnOnce(&mut Ui)) {
    ui.scope_builder(egui::UiBuilder::new().max_rect(room), content);
}

/// What every view of a textile does with pointer and keys: hover marks, a click selects, a double
/// click adds, a drag carries it into the workspace.
fn answer(ui: &Ui, response: &Response, entry: &Entry<'_>, hand: &mut Hand<'_>) {
    let id = &entry.item.id;
    if response.hovered() {
        hand.pointed = Some(id.clone());
        if let Some(index) = entry.placed {
            hand.commands
                .push(ShowCommand::Hover(Part::Cloth(index)).into());
        }
    }
    if entry.item.flaw.is_some() {
        return;
    }
    if response.double_clicked() {
        hand.commands.push(Edit::AddCloths(vec![id.clone()]).into());
    } else if response.clicked() {
        let is_more = ui.input(|input| input.modifiers.command);
        let joining = if is_more {
            Joining::Toggled
        } else {
            Joining::Alone
        };
        hand.select(vec![id.clone()], joining);
        if let Some(index) = entry.placed.filter(|_| !is_more) {
            hand.commands
                .push(ShowCommand::SelectCloth(Some(index)).into());
        }
    }
    if response.drag_started() {
        hand.commands
            .push(ShowCommand::Reveal(Pane::Workspace).into());
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
