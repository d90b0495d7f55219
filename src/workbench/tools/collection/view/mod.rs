//! The whole library at once: a plot of small pieces of cloth with a table beside it, or larger
//! pieces to look through. Both share search, kinds and what is selected.

pub(crate) mod cloths;
pub(crate) mod hand;
pub(crate) mod head;
pub(crate) mod plot;
pub(crate) mod status;
pub(crate) mod table;

use eframe::egui::{self, Ui};

use crate::kit::pane::paint_sentence;
use crate::kit::theme::STEP;
use crate::tools::collection::state::{CollectionView, Mode};
use crate::tools::collection::view::hand::Hand;

/// Below this width, and where it is hardly wider than high, the table stands below the plot,
/// points and width over height.
const SIDE_BY_SIDE: f32 = 620.0;
const WIDE: f32 = 1.15;
/// Width of the table beside the plot, points.
const TABLE: f32 = 416.0;
/// Height of the line at the bottom, points.
const STATUS: f32 = 22.0;

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
