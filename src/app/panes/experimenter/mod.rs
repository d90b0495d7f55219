//! A session as who holds it sees it: how far it is, the device, what to lay on the table, notes.
//! Never what is right.

mod begin;
mod session;

use eframe::egui::{RichText, Ui};

use super::Wishes;
use crate::app::experiment::{ExperimenterView, Form};
use crate::app::theme::{Palette, STEP};

/// What is typed in the pane.
pub(crate) struct ExperimenterHands<'a> {
    /// The form of the next session.
    pub(crate) form: &'a mut Form,
    /// The note on the trial under way.
    pub(crate) note: Option<&'a mut String>,
}

/// Shows the pane.
pub(crate) fn show(
    ui: &mut Ui,
    view: &ExperimenterView,
    hands: &mut ExperimenterHands<'_>,
    wishes: &mut Wishes,
) {
    ui.spacing_mut().item_spacing.y = STEP;
    match view {
        ExperimenterView::Nobody { share } => begin::show(ui, hands.form, *share, wishes),
        ExperimenterView::Held(held) => {
            session::show(ui, held, hands.note.as_deref_mut(), wishes);
        }
    }
}

/// What stands in the place of a pane that would tell too much.
pub(crate) fn show_veil(ui: &mut Ui) {
    let words = "Hidden while a session is held: what lies under the finger is not to be seen.";
    let ink = Palette::in_ui(ui).dim;
    ui.add_space(2.0 * STEP);
    ui.add(eframe::egui::Label::new(RichText::new(words).color(ink)).wrap());
}
