//! The list of keys, and of what the pointer does.
//!
//! The keys come from the one table that input is read from: what stands here is what happens.

use eframe::egui::{self, Align, KeyboardShortcut, Layout, Rect, RichText, ScrollArea, Ui, vec2};

use crate::bench::command::{Command, Commands};
use crate::bench::keys::{Shortcut, table};
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

/// Keys of one kind.
#[derive(Debug, Clone, PartialEq, Eq)]
struct Group {
    title: &'static str,
    /// What is done, and the keys that do it.
    rows: Vec<(&'static str, Vec<KeyboardShortcut>)>,
}

/// The keys by kind, in the order of the table; keys that do the same share a row.
fn groups(table: &[Shortcut]) -> Vec<Group> {
    let mut groups: Vec<Group> = Vec::new();
    for shortcut in table {
        let title = kind(&shortcut.command);
        let known = groups.iter().position(|group| group.title == title);
        let group = known.unwrap_or_else(|| {
            groups.push(Group {
                title,
                rows: Vec::new(),
            });
            groups.len() - 1
        });
        let rows = &mut groups[group].rows;
        match rows.iter_mut().find(|(what, _)| *what == shortcut.what) {
            Some((_, keys)) => keys.push(shortcut.key),
            None => rows.push((shortcut.what, vec![shortcut.key])),
        }
    }
    groups
}

fn kind(command: &Command) -> &'static str {
    match command {
        Command::Escape | Command::AllOff => "From anywhere",
        Command::Edit(_)
        | Command::Undo
        | Command::Redo
        | Command::StepTo(_)
        | Command::Chosen(_) => "Scene",
        Command::Device(_) => "Device",
        Command::File(_) | Command::Library(_) => "Files",
        Command::Play(_) | Command::Recording(_) | Command::Source(_) => "Play and record",
        Command::Show(_)
        | Command::Lab(_)
        | Command::Render(_)
        | Command::Dismiss
        | Command::DismissNotice(_) => "View",
    }
}

/// Shows the list at the upper edge of `over`.
pub(crate) fn show(ui: &Ui, over: Rect, commands: &mut Commands) {
    card(ui, over, WIDTH, "Keys and pointer", |ui, _| {
        // Above: the title and the card's edge. Below: the safety lines and the button.
        let room = over.height() - 2.0 * CARD_DROP - 2.0 * CARD_MARGIN - 112.0;
        let list = ScrollArea::vertical().max_height(room.max(4.0 * ROW));
        list.show(ui, show_lists);
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
fn show_lists(ui: &mut Ui) {
    let width = ui.available_width();
    if width < 0.75 * WIDTH {
        show_keys(ui);
        show_pointer(ui);
        return;
    }
    let column = vec2((width - GAP) / 2.0, 0.0);
    ui.horizontal_top(|ui| {
        ui.spacing_mut().item_spacing.x = GAP;
        for show in [show_keys, show_pointer] {
            let down = Layout::top_down(Align::Min);
            ui.allocate_ui_with_layout(column, down, |ui| {
                ui.spacing_mut().item_spacing.x = 2.0 * STEP;
                ui.set_width(column.x);
                show(ui);
            });
        }
    });
}

fn show_keys(ui: &mut Ui) {
    for group in groups(&table()) {
        section(ui, group.title);
        for (what, keys) in group.rows {
            let keys = keys.iter().map(|key| ui.ctx().format_shortcut(key));
            show_row(ui, what, &keys.collect::<Vec<_>>().join(" or "));
        }
    }
}

fn show_pointer(ui: &mut Ui) {
    for (title, acts) in POINTER {
        section(ui, title);
        for (what, act) in acts {
            show_row(ui, what, act);
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
    fn every_key_of_the_table_is_listed_once() {
        let table = table();
        let groups = groups(&table);
        let listed = groups.iter().flat_map(|group| &group.rows);
        let listed: Vec<_> = listed.flat_map(|(_, keys)| keys).collect();
        assert_eq!(listed.len(), table.len());
        for shortcut in &table {
            assert!(listed.contains(&&shortcut.key), "{shortcut:?}");
        }
    }

    #[test]
    fn all_off_stands_first_and_two_keys_that_do_the_same_share_a_row() {
        let groups = groups(&table());
        assert!(groups[0].rows[0].0.starts_with("Everything off"));
        let titles: Vec<_> = groups.iter().map(|group| group.title).collect();
        let mut unique = titles.clone();
        unique.dedup();
        assert_eq!(titles, unique);
        let mut rows = groups.iter().flat_map(|group| &group.rows);
        let redo = rows.find(|(what, _)| *what == "Redo");
        assert_eq!(redo.map(|(_, keys)| keys.len()), Some(2));
    }
}
