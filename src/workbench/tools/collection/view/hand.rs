//! What is changed in the pane, and what pointer and keys do with a textile.

use eframe::egui::{DragAndDrop, Response, Stroke, StrokeKind, Ui};

use crate::bench::Bench;
use crate::bench::command::edit::Edit;
use crate::bench::command::{Commands, Part, ShowCommand};
use crate::bench::library_selection::Joining;
use crate::bench::library_view::LibraryItem;
use crate::bench::pane::Pane;
use crate::kit::theme::Palette;
use crate::tools::collection::state::{Choice, Entry};

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
        self.bench.library.selection.select(ids, joining);
    }
}

/// What every view of a textile does with pointer and keys: hover marks, a click selects, a double
/// click adds, a drag carries it into the workspace.
pub(crate) fn answer(ui: &Ui, response: &Response, entry: &Entry<'_>, hand: &mut Hand<'_>) {
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
pub(crate) fn paint_focus(ui: &Ui, response: &Response) {
    if response.has_focus() {
        let edge = Stroke::new(1.0, Palette::in_ui(ui).selection);
        let rect = response.rect.expand(2.0);
        ui.painter().rect_stroke(rect, 4, edge, StrokeKind::Inside);
    }
}
