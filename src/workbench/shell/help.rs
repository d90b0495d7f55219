//! The list of keys, and of what the pointer does, to be searched; a key that is clicked on is
//! changed.
//!
//! The keys come from the acts that input is read from: what stands here is what happens.

use eframe::egui::{
    self, Align, Context, Key, KeyboardShortcut, Layout, Rect, RichText, ScrollArea, TextEdit, Ui,
    vec2,
};

use crate::bench::acts::{self, Act};
use crate::bench::chosen_keys::{ChosenKeys, Keys};
use crate::bench::command::{Command, Commands};
use crate::bench::keys::{self, all_written};
use crate::kit::theme;
use crate::kit::theme::{Palette, ROW, STEP};
use crate::kit::widgets::card;
use crate::kit::widgets::card::{DROP as CARD_DROP, MARGIN as CARD_MARGIN};
use crate::kit::widgets::text::{button, named, quiet, row, section};

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

/// How a key is changed.
const TO_CHANGE: &str = "A key that is clicked on can be another.";
/// What else can be pressed while a key is awaited.
const WHILE_AWAITED: &str = "Backspace: no key. Delete: as at first. Esc: leave it.";

/// The list as it is read, and the act that is to have another key.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub(crate) struct KeyList {
    /// What is sought in it.
    search: String,
    /// The act that waits for a key, by what it does.
    pub(crate) awaits: Option<&'static str>,
    /// Why the last key was not given, or what became of it.
    said: String,
}

/// A row of the list: what is done, how, and the act whose key it is.
type Row = (String, String, Option<&'static Act>);

/// Rows that belong together, under their title.
type Group = (&'static str, Vec<Row>);

/// The keys by what they concern, in the order of the acts; acts without a key while one of them
/// may be sought, to be given one.
fn keys_of_acts(ctx: &Context, has_all: bool) -> Vec<Group> {
    let mut groups: Vec<Group> = Vec::new();
    for act in acts::all() {
        let title = act.concern.title();
        let row = (act.what.clone(), all_written(ctx, act), Some(act));
        if row.1.is_empty() && !has_all {
            continue;
        }
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
        rows.map(|(what, how)| ((*what).to_owned(), (*how).to_owned(), None))
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
    let holds = |(what, how, _): &Row| {
        let row = format!("{what} {how}").to_lowercase();
        sought.split_whitespace().all(|word| row.contains(word))
    };
    let matching = |(title, rows): Group| (title, rows.into_iter().filter(holds).collect());
    let groups = groups.into_iter().map(matching);
    groups
        .filter(|(_, rows): &Group| !rows.is_empty())
        .collect()
}

/// Shows the list at the upper edge of `over`; keys that are given to acts go to `chosen`.
pub(crate) fn show(
    ui: &Ui,
    over: Rect,
    list: &mut KeyList,
    chosen: &mut ChosenKeys,
    commands: &mut Commands,
) {
    list.take_key(ui.ctx(), chosen);
    card(ui, over, WIDTH, "Keys and pointer", |ui, title| {
        let field = TextEdit::singleline(&mut list.search)
            .desired_width(f32::INFINITY)
            .hint_text("Search, also acts that have no key");
        let field = ui.add(field).labelled_by(title.id);
        if list.awaits.is_some() {
            field.surrender_focus();
        } else if ui.memory(|memory| memory.focused().is_none()) {
            field.request_focus();
        }
        ui.add_space(STEP);
        // Above: the title, the field and the card's edge. Below: what is said, the safety lines
        // and the buttons.
        let room = over.height() - 2.0 * CARD_DROP - 2.0 * CARD_MARGIN - 176.0;
        let area = ScrollArea::vertical().max_height(room.max(4.0 * ROW));
        area.show(ui, |ui| show_lists(ui, list));
        ui.add_space(2.0 * STEP);
        let palette = Palette::in_ui(ui);
        let said = match list.awaits {
            Some(what) => format!("“{what}”: press its key. {WHILE_AWAITED}"),
            None if list.said.is_empty() => TO_CHANGE.to_owned(),
            None => list.said.clone(),
        };
        ui.add(egui::Label::new(quiet(said)).truncate());
        for sentence in SAFETY {
            ui.label(RichText::new(sentence).color(palette.text));
        }
        ui.add_space(STEP);
        let size = vec2(ui.available_width(), ROW);
        ui.allocate_ui_with_layout(size, Layout::right_to_left(Align::Center), |ui| {
            if button(ui, "Close", "", None) {
                commands.push(Command::Dismiss);
            }
            let none = chosen.is_empty().then_some("No key was changed");
            if button(ui, "All keys as at first", "", none) {
                chosen.clear();
                keys::install(ui.ctx(), chosen);
                "All keys are as at first".clone_into(&mut list.said);
            }
        });
    });
}

impl KeyList {
    /// Gives the key that was pressed to the act that waits for one.
    fn take_key(&mut self, ctx: &Context, chosen: &mut ChosenKeys) {
        let act = self
            .awaits
            .and_then(|what| acts::all().iter().find(|act| act.what == what));
        let (Some(act), Some(key)) = (act, act.and_then(|_| keys::captured(ctx))) else {
            return;
        };
        let bare = |sought| key == KeyboardShortcut::new(egui::Modifiers::NONE, sought);
        if bare(Key::Escape) {
            return;
        }
        self.said = if bare(Key::Delete) {
            chosen.remove(&act.what);
            keys::install(ctx, chosen);
            format!("“{}” is as at first", act.what)
        } else if bare(Key::Backspace) {
            chosen.insert(act.what.clone(), Keys::default());
            keys::install(ctx, chosen);
            format!("“{}” has no key", act.what)
        } else if let Some(why) = keys::refusal(ctx, act, key) {
            why
        } else {
            chosen.insert(act.what.clone(), Keys(vec![key]));
            keys::install(ctx, chosen);
            format!("“{}” is on {}", act.what, all_written(ctx, act))
        };
        self.awaits = None;
    }
}

/// Keys on the left, the pointer on the right; below each other where that is too narrow.
fn show_lists(ui: &mut Ui, list: &mut KeyList) {
    let has_all = !list.search.trim().is_empty();
    let lists = [keys_of_acts(ui.ctx(), has_all), pointer()];
    let lists = lists.map(|groups| sought(groups, &list.search));
    let width = ui.available_width();
    if lists.iter().all(Vec::is_empty) {
        ui.label("Nothing that can be done is called so");
    }
    if width < 0.75 * WIDTH {
        for groups in &lists {
            show_groups(ui, groups, list);
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
                show_groups(ui, groups, list);
            });
        }
    });
}

fn show_groups(ui: &mut Ui, groups: &[Group], list: &mut KeyList) {
    for (title, rows) in groups {
        section(ui, title);
        for row in rows {
            show_row(ui, row, list);
        }
    }
}

fn show_row(ui: &mut Ui, (what, how, act): &Row, list: &mut KeyList) {
    row(ui, what, |ui| {
        let palette = Palette::in_ui(ui);
        let number = |text: &str| RichText::new(text).font(theme::number());
        let Some(act) = act.filter(|act| act.command != Command::Escape) else {
            let how = number(how).color(palette.dim);
            ui.add(egui::Label::new(how).truncate());
            return;
        };
        let is_awaited = list.awaits == Some(act.what.as_str());
        let text = match how.as_str() {
            _ if is_awaited => number("press a key").color(palette.selection),
            "" => number("none").color(palette.line),
            how => number(how).color(palette.dim),
        };
        ui.spacing_mut().interact_size.y = 0.0;
        let key = egui::Button::new(text).frame(false).truncate();
        let key = ui.add(key);
        let shown = if how.is_empty() { "none" } else { how };
        named(&key, format!("{shown}, the key of “{what}”"));
        if key.clicked() {
            list.awaits = (!is_awaited).then_some(act.what.as_str());
        }
    });
}

#[cfg(test)]
mod tests {
    use eframe::egui::Modifiers;

    use super::*;
    use crate::bench::command::ShowCommand;
    use crate::shell::headless::Headless;
    use crate::shell::state::Cover;

    #[test]
    fn every_key_is_listed_once_under_a_title_of_its_own_and_escape_first() {
        let groups = keys_of_acts(&Context::default(), false);
        let rows: Vec<&Row> = groups.iter().flat_map(|(_, rows)| rows).collect();
        let n_keys = acts::all().iter().filter(|act| !act.keys.is_empty());
        assert_eq!(rows.len(), n_keys.count());
        assert_eq!(rows[0].1, "Esc");
        let mut titles: Vec<_> = groups.iter().map(|(title, _)| *title).collect();
        let n_titles = titles.len();
        titles.sort_unstable();
        titles.dedup();
        assert_eq!(titles.len(), n_titles);
        let redo = rows.iter().find(|(what, ..)| what == "Redo");
        assert!(
            redo.is_some_and(|(_, keys, _)| keys.contains(" or ")),
            "{redo:?}"
        );
    }

    #[test]
    fn the_list_is_searched_by_what_is_done_and_by_the_key() {
        let all = || keys_of_acts(&Context::default(), true);
        let redo = sought(all(), "ctrl+y");
        assert_eq!((redo.len(), redo[0].1[0].0.as_str()), (1, "Redo"));
        let wheel = sought(pointer(), "turn wheel");
        assert_eq!(wheel[0].1[0].1, "Alt + wheel");
        assert!(sought(all(), "no such thing").is_empty());
        assert_eq!(sought(all(), "arm the device")[0].1[0].1, "", "has no key");
    }

    /// Lets the act wait for a key, presses it, and says what is said then.
    fn give(window: &mut Headless, what: &str, modifiers: Modifiers, key: Key) -> String {
        let act = acts::all().iter().find(|act| act.what == what).unwrap();
        let Some(Cover::Keys(list)) = &mut window.workbench.shell.cover else {
            panic!("the list of keys is not shown")
        };
        list.awaits = Some(act.what.as_str());
        window.press(modifiers, key);
        match &window.workbench.shell.cover {
            Some(Cover::Keys(list)) => list.said.clone(),
            _ => panic!("the list of keys was put away"),
        }
    }

    #[test]
    fn a_key_that_is_given_works_at_once_and_one_that_is_taken_is_refused() {
        let mut window = Headless::shipped();
        window.pass(2);
        window.dispatch(ShowCommand::Help);
        window.pass(2);
        let refused = give(&mut window, "Loop or not", Modifiers::NONE, Key::R);
        assert!(refused.contains("Record"), "{refused}");
        assert!(!window.workbench.is_recording(), "the key did nothing else");
        let given = give(&mut window, "Loop or not", Modifiers::COMMAND, Key::J);
        assert!(
            given.contains("Ctrl+J") || given.contains("Cmd+J"),
            "{given}"
        );
        window.dispatch(Command::Dismiss);
        let loops = |window: &Headless| window.workbench.bench.exploration.does_loop;
        let before = loops(&window);
        window.press(Modifiers::NONE, Key::L);
        assert_eq!(loops(&window), before, "L is free");
        window.press(Modifiers::COMMAND, Key::J);
        assert_ne!(loops(&window), before);
        window.dispatch(ShowCommand::Help);
        window.pass(2);
        give(&mut window, "Loop or not", Modifiers::NONE, Key::Backspace);
        let none = &window.workbench.bench.settings.preferences.keys["Loop or not"];
        assert_eq!(*none, Keys::default());
        give(&mut window, "Loop or not", Modifiers::NONE, Key::Delete);
        assert!(window.workbench.bench.settings.preferences.keys.is_empty());
    }

    #[test]
    fn escape_leaves_a_key_as_it_is_and_the_list_open() {
        let mut window = Headless::shipped();
        window.pass(2);
        window.dispatch(ShowCommand::Help);
        window.pass(2);
        give(&mut window, "Undo", Modifiers::COMMAND, Key::ControlLeft);
        assert!(window.workbench.shell.awaits_key(), "a modifier is no key");
        give(&mut window, "Undo", Modifiers::NONE, Key::Escape);
        assert!(!window.workbench.shell.awaits_key());
        assert!(window.workbench.bench.settings.preferences.keys.is_empty());
        window.press(Modifiers::NONE, Key::Escape);
        assert_eq!(window.workbench.shell.cover, None);
    }
}
