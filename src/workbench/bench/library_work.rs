//! What is wanted of libraries is done, and the scene follows.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use crate::bench::Bench;
use crate::bench::background::finished;
use crate::bench::command::ShowCommand;
use crate::bench::command::edit::Edit;
use crate::bench::keep::{Keep, Taken, WhenTaken, free_name};
use crate::bench::library_acts::{Aim, Deed, LibraryCommand, Work, Worked};
use crate::bench::library_shelf::{OWN, SHIPPED, Shelf, plain_id};
use crate::bench::notices::Until;
use crate::bench::pane::Pane;
use selvedge_textile::{LibraryFolder, called, elsewhere};

/// Why a textile of the program stays as it is.
pub(crate) const OF_PROGRAM: &str = "It is part of the program: duplicate it, then change the copy";

impl Bench {
    /// Opens the user's own library, and those in which the scene finds textiles.
    pub(crate) fn open_own_library(&mut self) {
        if let Some(own) = self.library.acts.own() {
            self.library.view.open(OWN, &own, &self.executor);
        }
        let mut placed = self.document.scene().textiles.iter();
        if placed.any(|cloth| elsewhere(&cloth.id).is_some()) {
            self.open_all_libraries();
        }
    }

    /// Opens every library that the user knows.
    pub(crate) fn open_all_libraries(&mut self) {
        for (title, name) in SHIPPED {
            let view = &mut self.library.view;
            view.open(title, Path::new(name), &self.executor);
        }
        for folder in &self.settings.preferences.folders.libraries {
            let title = folder.file_name().unwrap_or(folder.as_os_str());
            let view = &mut self.library.view;
            view.open(&title.to_string_lossy(), folder, &self.executor);
        }
    }

    /// Does what is wanted of libraries, or lets it wait for what is being done.
    pub(crate) fn dispatch_library(&mut self, command: LibraryCommand) {
        if self.library.acts.task.is_some() {
            return self.library.acts.next.push_back(command);
        }
        let asked = match command {
            LibraryCommand::Listen(textiles, from) => {
                self.listen_to(textiles, from);
                Ok(None)
            }
            LibraryCommand::Feel(nth) => {
                self.listen_otherwise(|listening| listening.felt = nth);
                Ok(None)
            }
            LibraryCommand::CompareWith(nth, id) => {
                self.listen_otherwise(|listening| {
                    listening.references[nth] = Some(id);
                    listening.felt = nth + 1;
                });
                Ok(None)
            }
            LibraryCommand::Keep(keep) => {
                self.stop_listening();
                self.work_of_keep(keep)
            }
            LibraryCommand::ForgetKeep => {
                self.library.acts.taken = None;
                self.stop_listening();
                Ok(None)
            }
            LibraryCommand::Rename(key, name) => self.work_of_rename(&key, &name).map(Some),
            LibraryCommand::Duplicate(key) => self.work_of_duplicate(&key).map(Some),
            LibraryCommand::Remove(key) => self.work_of_removal(&key).map(Some),
            LibraryCommand::Restore(folder, id, version) => {
                let deed = Deed::Set(id.clone(), Some(version));
                Ok(Some(step(format!("restored {id}"), vec![(folder, deed)])))
            }
            LibraryCommand::AddFolder(folder) => self.add_folder(folder).map(|()| None),
            LibraryCommand::ForgetFolder(folder) => {
                let folders = &mut self.settings.preferences.folders.libraries;
                folders.retain(|known| *known != folder);
                self.library.view.close(&folder);
                Ok(None)
            }
        };
        match asked {
            Ok(Some(work)) => self.begin_work(work),
            Ok(None) => {}
            Err(line) => self.notices.give(line),
        }
    }

    /// Takes acts back or brings them again until so many are done.
    pub(crate) fn step_library_to(&mut self, n_done: usize) {
        let Some(work) = self.library.acts.work_to(n_done) else {
            return;
        };
        if self.library.acts.task.is_some() {
            let words = "A library is being changed: press again";
            return self.notices.give_until(Until::Read, words);
        }
        let gone = work.deeds.iter().find_map(|(folder, deed)| match deed {
            Deed::Set(id, None) => self.lies_in_scene(folder, id),
            _ => None,
        });
        match gone {
            Some(name) => self.notices.give(in_scene(&name)),
            None => self.begin_work(work),
        }
    }

    fn begin_work(&mut self, work: Work) {
        let task = self
            .executor
            .start("selvedge-library-act", move |_| work.done());
        self.library.acts.task = Some(task);
        self.poll_library();
    }

    /// Takes what was done, and lets the next act begin.
    pub(crate) fn poll_library(&mut self) {
        let Some(outcome) = finished(&mut self.library.acts.task) else {
            return;
        };
        match outcome {
            Ok(worked) => self.take_worked(&worked),
            Err(line) => self.notices.give(line),
        }
        if let Some(next) = self.library.acts.next.pop_front() {
            self.dispatch_library(next);
        }
    }

    fn take_worked(&mut self, worked: &Worked) {
        self.library.acts.note(worked);
        let changed: Vec<String> = (worked.changes.iter())
            .flat_map(|(folder, change)| self.keys_of(folder, &change.id))
            .collect();
        for library in &worked.libraries {
            if self.engine_scene.loaded.library().root() == library.root() {
                self.engine_scene.loaded.use_library(library);
            }
            self.library.view.renew(library, &changed);
        }
        self.render_anew(&changed);
        self.scene_has_changed();
        self.say_what_was_done(worked);
        if let Aim::Step { is_felt: true, .. } = worked.aim
            && let Some(key) = changed.into_iter().next()
        {
            self.commands.push(Edit::AddCloths(vec![key]).into());
            self.commands
                .push(ShowCommand::Reveal(Pane::Workspace).into());
        }
    }

    fn say_what_was_done(&mut self, worked: &Worked) {
        let Aim::Step { is_kept: true, .. } = worked.aim else {
            return;
        };
        let ids = worked.changes.iter().map(|(_, change)| change.id.as_str());
        let ids: Vec<&str> = ids.collect();
        let first = worked.changes.first();
        let folder = first.map_or_else(String::new, |(folder, _)| {
            folder.path().display().to_string()
        });
        let words = format!("Kept {} in {folder}", ids.join(", "));
        self.notices.give(words);
    }

    /// New textiles on their way into the library that takes them; asks where one is in the way.
    fn work_of_keep(&mut self, keep: Keep) -> Result<Option<Work>, String> {
        let shelf = self.keeping_shelf()?;
        let folder = shelf.folder().ok_or(OF_PROGRAM)?;
        let there = keep.taken(&shelf.items);
        if !there.is_empty() && keep.when_taken.is_none() {
            let home = Arc::clone(&shelf.title);
            self.library.acts.taken = Some(Taken { keep, there, home });
            return Ok(None);
        }
        let mut deeds = Vec::with_capacity(keep.textiles.len());
        let mut names = Vec::with_capacity(keep.textiles.len());
        for (new, place) in keep.textiles.iter().zip(keep.places(&shelf.items)) {
            let files = if place.name == new.name {
                new.files.clone()
            } else {
                called(&new.files, &place.name).map_err(|error| error.to_string())?
            };
            deeds.push((folder.clone(), Deed::Put(place.id, files, place.replaces)));
            names.push(place.name);
        }
        let verb = match keep.when_taken {
            Some(WhenTaken::Replace) => "replaced",
            _ => "kept",
        };
        self.library.acts.taken = None;
        Ok(Some(Work {
            deeds,
            aim: Aim::Step {
                name: format!("{verb} {}", names.join(", ")),
                is_kept: true,
                is_felt: keep.is_felt,
            },
        }))
    }

    fn work_of_rename(&self, key: &str, name: &str) -> Result<Work, String> {
        let name = name.trim();
        if name.is_empty() {
            return Err("The name is empty: nothing was renamed".to_owned());
        }
        let folder = self.library.view.shelf_of(key).folder().ok_or(OF_PROGRAM)?;
        let deed = Deed::Rename(plain_id(key).to_owned(), name.to_owned());
        Ok(step(format!("renamed {name}"), vec![(folder, deed)]))
    }

    fn work_of_duplicate(&self, key: &str) -> Result<Work, String> {
        let shelf = self.library.view.shelf_of(key);
        let to = match shelf.folder() {
            Some(_) => shelf,
            None => self.keeping_shelf()?,
        };
        let item = self.library.view.item(key);
        let name = item.map_or(key, |item| item.name.as_str());
        let name = free_name(&format!("{name}, copy"), &to.items);
        let id = plain_id(key).to_owned();
        let deed = Deed::Copy(Arc::clone(&shelf.library), id, name.clone());
        let folder = to.folder().ok_or(OF_PROGRAM)?;
        Ok(step(format!("duplicated {name}"), vec![(folder, deed)]))
    }

    fn work_of_removal(&self, key: &str) -> Result<Work, String> {
        let folder = self.library.view.shelf_of(key).folder().ok_or(OF_PROGRAM)?;
        let id = plain_id(key);
        if let Some(name) = self.lies_in_scene(&folder, id) {
            return Err(in_scene(&name));
        }
        let item = self.library.view.item(key);
        let name = item.map_or(id, |item| item.name.as_str());
        let deed = Deed::Set(id.to_owned(), None);
        Ok(step(format!("deleted {name}"), vec![(folder, deed)]))
    }

    /// The library that takes new textiles: the scene's, if it is a folder, else the user's own.
    pub(crate) fn keeping_shelf(&self) -> Result<&Shelf, String> {
        let view = &self.library.view;
        let mut shelves = view.shelves();
        let own = shelves.find(|shelf| &*shelf.title == OWN);
        let scene = view.shelves().find(|shelf| shelf.name().is_none());
        let scene = scene.filter(|shelf| shelf.folder().is_some());
        scene.or(own).ok_or_else(|| {
            if view.is_opening() {
                return "Your own library is being opened: press again".to_owned();
            }
            "This system has no folder for a user’s files; save the scene with a library folder \
             of its own, then keep the textile"
                .to_owned()
        })
    }

    fn add_folder(&mut self, folder: PathBuf) -> Result<(), String> {
        let folder = std::path::absolute(&folder).unwrap_or(folder);
        if !folder.is_dir() || folder.to_str().is_none() {
            let folder = folder.display();
            return Err(format!(
                "{folder} is no folder; choose a folder of textiles"
            ));
        }
        let folders = &mut self.settings.preferences.folders.libraries;
        if !folders.contains(&folder) {
            folders.push(folder);
        }
        self.open_all_libraries();
        Ok(())
    }

    /// The ids by which the scene finds a textile of a folder.
    fn keys_of(&self, folder: &LibraryFolder, id: &str) -> Vec<String> {
        let shelves = self.library.view.shelves();
        let own = shelves.filter(|shelf| shelf.library.root() == folder.path());
        own.map(|shelf| shelf.key_of(id)).collect()
    }

    /// The name of a textile of a folder, if it lies in the scene.
    fn lies_in_scene(&self, folder: &LibraryFolder, id: &str) -> Option<String> {
        let keys = self.keys_of(folder, id);
        let mut placed = self.document.scene().textiles.iter();
        let cloth = placed.find(|cloth| keys.contains(&cloth.id))?;
        let item = self.library.view.item(&cloth.id);
        Some(item.map_or_else(|| id.to_owned(), |item| item.name.clone()))
    }
}

fn step(name: String, deeds: Vec<(LibraryFolder, Deed)>) -> Work {
    Work {
        deeds,
        aim: Aim::Step {
            name,
            is_kept: false,
            is_felt: false,
        },
    }
}

fn in_scene(name: &str) -> String {
    format!("“{name}” lies in the scene: take it away there first")
}

#[cfg(test)]
mod tests;
