//! The menus of the library: which libraries are shown, and what can be done with a textile.

use eframe::egui::{Button, Ui};

use crate::bench::command::lab::Beginning;
use crate::bench::command::{Command, FileCommand, Purpose};
use crate::bench::library_acts::LibraryCommand;
use crate::bench::library_shelf::{Shelf, plain_id};
use crate::bench::library_work::OF_PROGRAM;
use crate::bench::tool::PaneContext;
use crate::bench::view::LibraryEntry;
use crate::tools::library::list::added;
use crate::tools::library::state::{Library, Shown};
use selvedge_foundation::quantity::rfc3339;
use selvedge_textile::{LibraryFolder, Version};

/// Letters of a date and a time of day: `2026-11-23T09:12`.
const MINUTES: usize = 16;

/// Which libraries are shown.
pub(crate) fn show_chooser(ui: &mut Ui, state: &mut Library, context: &mut PaneContext<'_>) {
    let title = match &state.shown {
        Shown::Near => "Scene and own",
        Shown::All => "All libraries",
        Shown::One(title) => &**title,
    };
    let menu = ui.menu_button(title.to_owned(), |ui| {
        ui.set_min_width(220.0);
        context.bench.open_all_libraries();
        for (shown, words) in [
            (Shown::Near, "Scene and own"),
            (Shown::All, "All libraries"),
        ] {
            choose(ui, state, shown, (words, ""));
        }
        ui.separator();
        for shelf in context.bench.library.view.shelves() {
            let words = format!("{} · {}", shelf.title, shelf.items.len());
            let shown = Shown::One(shelf.title.clone());
            choose(ui, state, shown, (&words, &shelf.place()));
        }
        ui.separator();
        let add = FileCommand::Ask(Purpose::AddLibrary);
        entry(ui, ("Add a folder…", None), add.into(), context);
        show_forget(ui, context);
        show_removed(ui, context);
    });
    let tip = "Which libraries are listed; a search goes through all of them";
    menu.response.on_hover_text(tip);
}

fn choose(ui: &mut Ui, state: &mut Library, shown: Shown, (words, tip): (&str, &str)) {
    let response = ui.selectable_label(state.shown == shown, words);
    let response = if tip.is_empty() {
        response
    } else {
        response.on_hover_text(tip)
    };
    if response.clicked() {
        state.shown = shown;
        ui.close();
    }
}

/// Folders that were added and need not be listed any longer.
fn show_forget(ui: &mut Ui, context: &mut PaneContext<'_>) {
    let folders = context.bench.settings.preferences.folders.libraries.clone();
    for folder in folders {
        let words = format!("No longer list {}", folder.display());
        let command = LibraryCommand::ForgetFolder(folder);
        entry(ui, (&words, None), command.into(), context);
    }
}

/// Textiles that were taken away and can be had back.
fn show_removed(ui: &mut Ui, context: &mut PaneContext<'_>) {
    let shelves = context.bench.library.view.shelves();
    let folders: Vec<LibraryFolder> = shelves.filter_map(Shelf::folder).collect();
    ui.menu_button("Bring back a deleted textile", |ui| {
        let mut is_any = false;
        for folder in &folders {
            for id in folder.removed() {
                is_any = true;
                show_versions(ui, (folder, &id), &folder.versions(&id), context);
            }
        }
        if !is_any {
            ui.weak("None was deleted");
        }
    });
}

/// Versions of a textile, the newest first.
fn show_versions(
    ui: &mut Ui,
    (folder, id): (&LibraryFolder, &str),
    versions: &[Version],
    context: &mut PaneContext<'_>,
) {
    for one in versions {
        let at: String = rfc3339(one.at).chars().take(MINUTES).collect();
        let words = format!("{} · {}", one.name, at.replace('T', " "));
        let version = one.version.clone();
        let command = LibraryCommand::Restore(folder.clone(), id.to_owned(), version);
        entry(ui, (&words, None), command.into(), context);
    }
}

/// What can be done with a textile of a library.
pub(crate) fn show_item_menu(
    ui: &mut Ui,
    item: &LibraryEntry,
    state: &mut Library,
    context: &mut PaneContext<'_>,
) {
    let id = || item.id.clone();
    let add = added(item, context.scene);
    entry(ui, ("Add to the scene", None), add, context);
    let copy = Beginning::Copy(id());
    entry(ui, ("Vary a copy in the lab", None), copy.into(), context);
    let restore = Beginning::Restore(id());
    let words = "Restore in the lab from what repeats";
    entry(ui, (words, None), restore.into(), context);
    ui.separator();
    let folder = context.bench.library.view.shelf_of(&item.id).folder();
    let why = folder.is_none().then_some(OF_PROGRAM);
    let rename = ui.add_enabled(folder.is_some(), Button::new("Rename…"));
    if rename.on_disabled_hover_text(OF_PROGRAM).clicked() {
        state.renaming = Some((id(), item.name.clone()));
        ui.close();
    }
    let duplicate = LibraryCommand::Duplicate(id());
    entry(ui, ("Duplicate", None), duplicate.into(), context);
    let remove = LibraryCommand::Remove(id());
    entry(ui, ("Delete", why), remove.into(), context);
    if let Some(folder) = folder {
        let plain = plain_id(&item.id);
        ui.menu_button("Earlier versions", |ui| {
            let versions = folder.versions(plain);
            if versions.is_empty() {
                ui.weak("It was never changed");
            }
            show_versions(ui, (&folder, plain), &versions, context);
        });
    }
}

/// A line that does something; grey, with the reason, when it does nothing.
fn entry(
    ui: &mut Ui,
    (words, refusal): (&str, Option<&str>),
    command: Command,
    context: &mut PaneContext<'_>,
) {
    let response = ui.add_enabled(refusal.is_none(), Button::new(words));
    let response = response.on_disabled_hover_text(refusal.unwrap_or_default());
    if response.clicked() {
        context.commands.push(command);
        ui.close();
    }
}
