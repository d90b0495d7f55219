//! The textile lab: a recipe is edited and what becomes of it is seen at once.
//!
//! ```text
//! parameter ─▶ LabCommand::Set ─▶ Steps (drafts, read as a file would be) ─▶ Task: Preview
//!          ─▶ LabCommand::Keep ─▶ Task: files of a textile ─▶ Command::Keep
//! ```
//!
//! Nothing is computed for a hidden pane. While one preview is computed the parameters may change:
//! the newest are computed next, and the last preview stays until then.

pub(crate) mod command;
pub(crate) mod dispatch;
pub(crate) mod export;
pub(crate) mod family;
pub(crate) mod fields;
pub(crate) mod preview;
pub(crate) mod recipes;
pub(crate) mod steps;
#[cfg(test)]
mod tests;
pub(crate) mod view;

pub(crate) use crate::tools::lab::command::Beginning;
pub(crate) use crate::tools::lab::command::Look;
pub(crate) use crate::tools::lab::command::Page;
#[cfg(test)]
pub(crate) use crate::tools::lab::command::Plan;
pub(crate) use crate::tools::lab::family::Family;
pub(crate) use crate::tools::lab::family::FamilyFields;
#[cfg(test)]
pub(crate) use crate::tools::lab::family::Member;
pub(crate) use crate::tools::lab::fields::KeepFields;
pub(crate) use crate::tools::lab::preview::Compared;
pub(crate) use crate::tools::lab::preview::Preview;
pub(crate) use crate::tools::lab::steps::Steps;

use std::path::Path;
use std::sync::Arc;

use crate::bench::keep::NewTextile;
use crate::bench::task::Task;
use selvedge_foundation::progress::Progress;
use selvedge_textile::tactile::Filters;
use selvedge_textile::{Draft, Fault, Library, Manifest, Parent, Provenance, TextileError};

/// A recipe that begins.
#[derive(Debug)]
pub(crate) struct Begun {
    draft: Draft,
    /// The textile that it is made from.
    parent: Option<(Parent, Compared)>,
}

/// The lab.
#[derive(Debug, Default)]
pub(crate) struct Lab {
    /// The recipe; `None` before one has begun.
    pub steps: Option<Steps>,
    /// The textile of the library that it is made from.
    pub parent: Option<Parent>,
    /// What it is compared with.
    pub compared: Option<Compared>,
    /// What became of the recipe that was computed last.
    pub(crate) preview: Option<Arc<Preview>>,
    /// Which stroke is looked at.
    pub look: Look,
    /// Which controls are shown.
    pub page: Page,
    /// What is typed where the textile is named.
    pub fields: KeepFields,
    /// What is chosen where a family is planned.
    pub plan: FamilyFields,
    /// The family that was tried last.
    pub family: Option<Family>,
    /// Why something was not done.
    pub refusal: Option<String>,
    /// Whether the preview was stopped: nothing is computed until something changes.
    pub is_stopped: bool,
    /// Previews that were begun.
    pub(crate) n_computed: u64,
    /// Counts changes of the recipe and of what it is felt through.
    serial: u64,
    recipes: recipes::Recipes,
    shown_serial: Option<u64>,
    filters: Option<Filters>,
    pub(crate) beginning: Option<Task<Begun>>,
    pub(crate) comparing: Option<Task<Compared>>,
    pub(crate) previewing: Option<(u64, Option<Task<Preview>>)>,
    pub(crate) trying: Option<Task<Family>>,
    pub(crate) keeping: Option<(Option<Task<Vec<NewTextile>>>, bool)>,
}

impl Lab {
    /// Whether the preview is of the recipe as it is.
    pub(crate) fn is_fresh(&self) -> bool {
        self.shown_serial == Some(self.serial)
    }

    /// What is wrong with the recipe.
    pub(crate) fn fault(&self) -> Option<&Fault> {
        self.steps.as_ref().and_then(Steps::fault)
    }

    /// How far what is computed is, 0…1; `None` while nothing is.
    pub(crate) fn share(&self) -> Option<f32> {
        let preview = self.previewing.as_ref().and_then(|(_, task)| task.as_ref());
        let share = preview.map(Task::share);
        share
            .or_else(|| self.trying.as_ref().map(Task::share))
            .or_else(|| self.beginning.as_ref().map(Task::share))
            .or_else(|| self.comparing.as_ref().map(Task::share))
            .or_else(|| self.keeping.as_ref()?.0.as_ref().map(Task::share))
    }

    /// The recipe has changed.
    pub(crate) fn has_changed(&mut self) {
        self.serial += 1;
        self.is_stopped = false;
        self.refusal = None;
    }

    /// Notices that everything is felt through other filters.
    pub(crate) fn feel_through(&mut self, filters: Filters) {
        if self.filters.replace(filters) != Some(filters) {
            self.serial += 1;
        }
    }

    /// The recipe to compute next; `None` while there is nothing to do.
    pub(crate) fn due(&self) -> Option<(u64, Manifest)> {
        let is_idle = self.previewing.is_none() && !self.is_stopped && !self.is_fresh();
        let manifest = self.steps.as_ref()?.read().as_ref().ok()?;
        is_idle.then(|| (self.serial, manifest.clone()))
    }

    /// Begins a recipe; the one at hand can be had back.
    pub(crate) fn begin(&mut self, begun: Begun) {
        self.set_aside();
        let manifest = begun.draft.read().ok();
        let name = manifest.map_or_else(String::new, |manifest| manifest.name);
        let is_copy = begun.parent.is_some();
        self.fields = KeepFields::of(&name, is_copy);
        self.steps = Some(Steps::new(begun.draft));
        self.family = None;
        self.plan = FamilyFields::default();
        self.parent = begun.parent.as_ref().map(|(parent, _)| parent.clone());
        self.compared = begun.parent.map(|(_, compared)| compared);
        self.has_changed();
    }

    /// Takes in a preview of this serial number.
    pub(crate) fn show(&mut self, serial: u64, preview: Preview) {
        self.preview = Some(Arc::new(preview));
        self.shown_serial = Some(serial);
    }

    /// Says that there is no preview of this serial number, and why.
    pub(crate) fn refuse(&mut self, serial: u64, words: String) {
        self.shown_serial = Some(serial);
        self.refusal = Some(words);
    }

    /// The recipe as it would be kept.
    ///
    /// # Errors
    /// What is wrong with the recipe or with how it is called, in one line.
    pub(crate) fn to_keep(&self, library: &Library) -> Result<(String, Manifest), String> {
        let steps = self.steps.as_ref().ok_or("there is no recipe yet")?;
        let manifest = steps
            .read()
            .as_ref()
            .map_err(|fault| fault.message.clone())?;
        let id = self.fields.id.trim();
        if let Some(words) = self.fields.refusal(library.ids()) {
            return Err(words);
        }
        Ok((id.to_owned(), self.named(manifest, self.fields.name.trim())))
    }

    /// A recipe under a name, with where it comes from.
    fn named(&self, manifest: &Manifest, name: &str) -> Manifest {
        Manifest {
            name: name.to_owned(),
            notes: self.fields.notes.trim().replace('\n', " "),
            provenance: Some(Provenance::of(self.parent.iter().cloned().collect())),
            ..manifest.clone()
        }
    }

    /// Every member of the family as it would be kept.
    ///
    /// # Errors
    /// The same, for any of them.
    pub(crate) fn family_to_keep(
        &self,
        library: &Library,
    ) -> Result<Vec<(String, Manifest)>, String> {
        let none = || "there is no family yet: press “Try” first".to_owned();
        let family = self.family.as_ref().ok_or_else(none)?;
        let mut all = Vec::with_capacity(family.members.len());
        for (nth, member) in (1..).zip(&family.members) {
            let numbered = KeepFields {
                id: format!("{}-{nth}", self.fields.id.trim()),
                ..self.fields.clone()
            };
            if let Some(words) = numbered.refusal(library.ids()) {
                return Err(words);
            }
            let name = format!("{}, {}", self.fields.name.trim(), member.label);
            all.push((numbered.id.clone(), self.named(&member.manifest, &name)));
        }
        Ok(all)
    }
}

/// Finds what a recipe begins with.
pub(crate) fn begin(
    from: &Beginning,
    library: &Library,
    filters: &Filters,
    progress: &mut Progress<'_>,
) -> Result<Begun, String> {
    let words = |error: TextileError| error.to_string();
    let (id, is_copy) = match from {
        Beginning::Example(kind) => {
            let manifest = selvedge_textile::example(kind).map_err(words)?;
            let draft = Draft::of(&manifest).map_err(words)?;
            return Ok(Begun {
                draft,
                parent: None,
            });
        }
        Beginning::Copy(id) => (id, true),
        Beginning::Restore(id) => (id, false),
    };
    progress.step(0.1, id).map_err(|stop| stop.to_string())?;
    let loaded = library.load(id).map_err(words)?;
    let hash = loaded.content_hash().map_err(words)?;
    let draft = if is_copy {
        Draft::of(loaded.manifest())
    } else {
        selvedge_textile::restored(&loaded).and_then(|manifest| Draft::of(&manifest))
    };
    let compared = Compared::of(&loaded, filters, progress).map_err(|stop| stop.to_string())?;
    let parent = Parent {
        id: id.clone(),
        hash,
    };
    Ok(Begun {
        draft: draft.map_err(words)?,
        parent: Some((parent, compared)),
    })
}

/// Builds the files of textiles that are to be kept.
pub(crate) fn built(
    recipes: &[(String, Manifest)],
    progress: &mut Progress<'_>,
) -> Result<Vec<NewTextile>, String> {
    let n = recipes.len().max(1) as f64;
    let mut all = Vec::with_capacity(recipes.len());
    for (done, (id, manifest)) in recipes.iter().enumerate() {
        let step = progress.step(done as f64 / n, id);
        step.map_err(|stop| stop.to_string())?;
        let files =
            selvedge_textile::build(manifest, Path::new(id)).map_err(|error| error.to_string())?;
        all.push(NewTextile {
            id: id.clone(),
            name: manifest.name.clone(),
            files,
        });
    }
    Ok(all)
}
