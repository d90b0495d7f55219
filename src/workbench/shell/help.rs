//! The list of keys, and of what the pointer does, to be searched.
//!
//! The keys come from the acts that input is read from: what stands here is what happens.

use eframe::egui::{self, Align, Context, Layout, Rect, RichText, ScrollArea, TextEdit, Ui, vec2};

use crate::bench::acts;
use crate::bench::command::{Command, Commands};
use crate::bench::keys::all_written;
use crate::kit::theme;
use crate::kit::theme::{Palette, ROW, STEP};
use crate::kit::widgets::card;
use crate::kit::widgets::card::{DROP as CARD_DROP, MARGIN as CARD_MARGIN};
use crate::kit::widgets::text::{button, row, section};

/// The card's width, points.
const WIDTH: f32 = 720.0;
/// Between the two columns, points.
const GAP: f32 = 8.0 * STEP;

/// What the pointer does, and where.
const POINTER: [(&str, &[(&str, &str)]); 3] = [
    (
        "Pointer in the workspace",
        &[
            ("Feel the cloth", "move"),
            ("Closer or farther", "wheel"),
            ("Turn the display", "Alt + wheel"),
            ("Move the view", "middle drag"),
            ("See all of it", "double click"),
            ("What can be done here", "right click"),
        ],
    ),
    (
        "Pointer while arranging",
        &[
            ("Move a textile", "drag"),
            ("Without snapping", "Alt + drag"),
            ("Look closer at a contactor", "click"),
        ],
    ),
    (
        "Pointer on a slider",
        &[
            ("Back to its resting value", "double click"),
            ("Finely", "Shift + drag"),
            ("Type a value", "click the number"),
        ],
    ),
];

/// What everybody must know before a finger is on the device.
const SAFETY: [&str; 2] = [
    "While a device is armed, Esc switches everything off at once, whatever is open.",
    "Nothing arms the device again but you.",
];

/// A row of the list: what is done, and how.
type Row = (String, String);

/// Rows that belong together, under their title.
type Group = (&'static str, Vec<Row>);

/// The keys by what they concern, in the order of the acts; those that do the same share a row.
fn keys(ctx: &Context) -> Vec<Group> {
    let mut groups: Vec<Group> = Vec::new();
    for act in acts::all().iter().filter(|act| !act.keys.is_empty()) {
        let title = act.concern.title();
        let row = (act.what.clone(), all_written(ctx, act));
        match groups.iter_mut().find(|(known, _)| *known == title) {
            Some((_, rows)) => rows.push(row),
            None => groups.push((title, vec![row])),
        }
    }
    groups
}

/// What the pointer does.
fn pointer() -> Vec<Group> {
    let rows = |acts: &[(&str, &str)]| {
        let rows = acts.iter();
        rows.map(|(what, how)| ((*what).to_owned(), (*how).to_owned()))
            .collect()
    };
    POINTER
        .iter()
        .map(|(title, acts)| (*title, rows(acts)))
        .collect()
}

/// The rows that hold every word that is sought, in what they do or how.
fn sought(groups: Vec<Group>, sought: &str) -> Vec<Group> {
    let sought = sought.to_lowercase();
    let holds = |(what, how): &Row| {
        let row = format!("{what} {how}").to_lowercase();
        sought.split_whitespace().all(|word| row.contains(word))
    };
    let matching = |(title, rows): Group| (title, rows.into_iter().filter(holds).collect());
    let groups = groups.into_iter().map(matching);
    groups
        .filter(|(_, rows): &Group| !rows.is_empty())
        .collect()
}

/// Shows the list at the upper edge of `over`; `search` is what is sought in it.
pub(crate) fn show(ui: &Ui, over: Rect, search: &mut String, commands: &mut Commands) {
    card(ui, over, WIDTH, "Keys and pointer", |ui, title| {
        let field = TextEdit::singleline(search)
            .desired_width(f32::INFINITY)
            .hint_text("Search");
        let field = ui.add(field).labelled_by(title.id);
        if ui.memory(|memory| memory.focused().is_none()) {
            field.request_focus();
        }
        ui.add_space(STEP);
        // Above: the title, the field and the card's edge. Below: the safety lines and the button.
        let room = over.height() - 2.0 * CARD_DROP - 2.0 * CARD_MARGIN - 152.0;
        let list = ScrollArea::vertical().max_height(room.max(4.0 * ROW));
        list.show(ui, |ui| show_lists(ui, search));
        ui.add_space(2.0 * STEP);
        let palette = Palette::in_ui(ui);
        for sentence in SAFETY {
            ui.label(RichText::new(sentence).color(palette.text));
        }
        ui.add_space(STEP);
        let size = vec2(ui.available_width(), ROW);
        ui.allocate_ui_with_layout(size, Layout::right_to_left(Align::Center), |ui| {
            if button(ui, "Close", "", None) {
                commands.push(Command::Dismiss);
            }
        });
    });
}

/// Keys on the left, the pointer on the right; below each other where that is too narrow.
fn show_lists(ui: &mut Ui, search: &str) {
    let lists = [keys(ui.ctx()), pointer()].map(|groups| sought(groups, search));
    let width = ui.available_width();
    if lists.iter().all(Vec::is_empty) {
        ui.label("No key and nothing that the pointer does is called so");
    }
    if width < 0.75 * WIDTH {
        for groups in &lists {
            show_groups(ui, groups);
        }
        return;
    }
    let column = vec2((width - GAP) / 2.0, 0.0);
    ui.horizontal_top(|ui| {
        ui.spacing_mut().item_spacing.x = GAP;
        for groups in &lists {
            let down = Layout::top_down(Align::Min);
            ui.allocate_ui_with_layout(column, down, |ui| {
                ui.spacing_mut().item_spacing.x = 2.0 * STEP;
                ui.set_width(column.x);
                show_groups(ui, groups);
            });
        }
    });
}

fn show_groups(ui: &mut Ui, groups: &[Group]) {
    for (title, rows) in groups {
        section(ui, title);
        for (what, how) in rows {
            show_row(ui, what, how);
        }
    }
}

fn show_row(ui: &mut Ui, what: &str, how: &str) {
    row(ui, what, |ui| {
        let palette = Palette::in_ui(ui);
        let how = RichText::new(how).font(theme::number()).color(palette.dim);
        ui.add(egui::Label::new(how).truncate());
    });
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_key_is_listed_once_under_a_title_of_its_own_and_escape_first() {
        let groups = keys(&Context::default());
        let rows: Vec<&Row> = groups.iter().flat_map(|(_, rows)| rows).collect();
        let n_keys = acts::all().iter().filter(|act| !act.keys.is_empty());
        assert_eq!(rows.len(), n_keys.count());
        assert_eq!(rows[0].1, "Esc");
        let mut titles: Vec<_> = groups.iter().map(|(title, _)| *title).collect();
        let n_titles = titles.len();
        titles.sort_unstable();
        titles.dedup();
        assert_eq!(titles.len(), n_titles);
        let redo = rows.iter().find(|(what, _)| what == "Redo");
        assert!(
            redo.is_some_and(|(_, keys)| keys.contains(" or ")),
            "{redo:?}"
        );
    }

    #[test]
    fn the_list_is_searched_by_what_is_done_and_by_the_key() {
        let redo = sought(keys(&Context::default()), "ctrl+y");
        assert_eq!((redo.len(), redo[0].1[0].0.as_str()), (1, "Redo"));
        let wheel = sought(pointer(), "turn wheel");
        assert_eq!(wheel[0].1[0].1, "Alt + wheel");
        assert!(sought(keys(&Context::default()), "no such thing").is_empty());
    }
}
