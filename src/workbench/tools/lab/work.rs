//! The work that follows from what is wanted of the lab.

use std::path::Path;
use std::sync::Arc;

use eframe::egui;

use crate::bench::Bench;
use crate::bench::background::{Executor, Task, finished};
use crate::bench::command::lab::Beginning;
use crate::bench::history::Moment;
use crate::bench::keep::{Keep, NewTextile, NewTextiles};
use crate::bench::library_acts::LibraryCommand;
use crate::bench::pane::Pane;
use crate::tools::lab::family::{Family, Plan};
use crate::tools::lab::fields::KeepFields;
use crate::tools::lab::preview::Compared;
use crate::tools::lab::state::{Begun, Lab};
use crate::tools::lab::steps::Steps;
use selvedge_foundation::files::KeyValue;
use selvedge_foundation::progress::Progress;
use selvedge_textile::tactile::Filters;
use selvedge_textile::{Draft, Library, Manifest, Parent, Place, RECIPES, TextileError};

impl Lab {
    /// Sets a parameter, or leaves it out.
    pub(crate) fn set(&mut self, place: Place, value: Option<KeyValue>, now: Moment) {
        self.change(|steps| steps.set(place, value, now));
    }

    /// Calls the textile otherwise that would be kept.
    pub(crate) fn call(&mut self, fields: KeepFields, now: Moment) {
        self.change(|steps| steps.call(fields, now));
    }

    /// Back to what it began with.
    pub(crate) fn restart(&mut self) {
        self.change(Steps::restart);
    }

    fn change(&mut self, change: impl FnOnce(&mut Steps)) {
        if let Some(steps) = &mut self.steps {
            change(steps);
            self.has_changed();
        }
    }

    /// Begins with this recipe.
    pub(crate) fn begin_with(&mut self, bench: &Bench, beginning: Beginning) {
        let library = Arc::clone(bench.engine_scene.loaded.library());
        let filters = bench.document.scene().filters;
        let work =
            move |progress: &mut Progress<'_>| begin(&beginning, &library, &filters, progress);
        self.refusal = None;
        self.beginning = Some(bench.executor.start("selvedge-lab-begin", work));
    }

    /// Compares with this textile of the library.
    pub(crate) fn compare_with(&mut self, bench: &Bench, id: String) {
        let library = Arc::clone(bench.engine_scene.loaded.library());
        let filters = bench.document.scene().filters;
        let work = move |progress: &mut Progress<'_>| {
            progress.step(0.1, &id).map_err(|stop| stop.to_string())?;
            let textile = library.load(&id).map_err(|error| error.to_string())?;
            Compared::of(&textile, &filters, progress).map_err(|stop| stop.to_string())
        };
        self.comparing = Some(bench.executor.start("selvedge-lab-compare", work));
    }

    /// Stops what is being computed.
    pub(crate) fn stop(&mut self) {
        self.previews.stop();
        if let Some(task) = &self.trying {
            task.stop();
        }
        if let Some(task) = &self.keeping {
            task.stop();
        }
    }

    /// Tries a family.
    pub(crate) fn try_family(&mut self, bench: &Bench, plan: Plan) {
        let Some(steps) = &self.steps else { return };
        let (draft, filters) = (steps.recipe.draft.clone(), bench.document.scene().filters);
        let work = move |progress: &mut Progress<'_>| Family::of(&draft, &plan, &filters, progress);
        self.refusal = None;
        self.trying = Some(bench.executor.start("selvedge-lab-family", work));
    }

    /// Lets the recipe be listened to as a textile, to keep it then.
    pub(crate) fn keep(&mut self, bench: &mut Bench) {
        let recipe = self.to_keep();
        self.keep_recipes(bench, recipe.map(|one| vec![one]));
    }

    /// The same of every textile of the family that was tried.
    pub(crate) fn keep_family(&mut self, bench: &mut Bench) {
        let recipes = self.family_to_keep();
        self.keep_recipes(bench, recipes);
    }

    fn keep_recipes(
        &mut self,
        bench: &mut Bench,
        recipes: Result<Vec<(String, Manifest)>, String>,
    ) {
        match recipes {
            Err(words) => self.refusal = Some(words),
            Ok(recipes) => {
                self.refusal = None;
                let work =
                    move |progress: &mut Progress<'_>| Ok(Arc::new(built(&recipes, progress)?));
                self.keeping = Some(bench.executor.start("selvedge-lab-keep", work));
                self.poll_keeping(bench);
            }
        }
    }

    /// Takes what was built to be kept, whether the lab is in sight or not.
    pub(crate) fn poll_keeping(&mut self, bench: &mut Bench) {
        match finished(&mut self.keeping) {
            Some(Ok(made)) => {
                let draft = self.steps.as_ref().map(|steps| steps.recipe.draft.clone());
                self.offered = Some((Arc::clone(&made), draft));
                bench
                    .commands
                    .push(LibraryCommand::Listen(made, Pane::Lab).into());
            }
            Some(Err(words)) => self.refusal = Some(format!("Nothing was kept: {words}")),
            None => {}
        }
    }

    /// Notes that textiles are kept, if they are those that were offered last.
    pub(super) fn note_kept(&mut self, keep: &Keep) {
        let is_offered = |(made, _): &mut (NewTextiles, _)| Arc::ptr_eq(made, &keep.textiles);
        let offered = self.offered.take_if(is_offered);
        if let (Some((_, draft)), Some(steps)) = (offered, &mut self.steps) {
            steps.kept = draft;
        }
    }

    /// Has what the lab shows, or sends for it: called while it is in sight.
    pub(crate) fn follow(&mut self, bench: &Bench) {
        self.filters = bench.document.scene().filters;
        if self.steps.is_none() && self.beginning.is_none() && self.refusal.is_none() {
            self.begin_with(bench, Beginning::Example(RECIPES[0].0));
        }
        self.take();
        self.follow_recipe(&bench.ctx, &bench.executor);
    }

    /// Lets the preview follow the recipe.
    pub(crate) fn follow_recipe(&mut self, ctx: &egui::Context, executor: &Executor) {
        self.previews.poll();
        if let Some(asked) = self.asked() {
            self.previews.follow(ctx, executor, &asked);
        }
    }

    /// Takes what threads bring.
    fn take(&mut self) {
        if let Some(begun) = taken(&mut self.beginning, &mut self.refusal) {
            self.begin(begun);
        }
        if let Some(compared) = taken(&mut self.comparing, &mut self.refusal) {
            self.compared = Some(compared);
        }
        if let Some(family) = taken(&mut self.trying, &mut self.refusal) {
            self.family = Some(family);
        }
    }
}

/// What came of work that is over; why nothing came of it is a refusal.
fn taken<T>(task: &mut Option<Task<T>>, refusal: &mut Option<String>) -> Option<T> {
    let outcome = finished(task)?;
    outcome.map_err(|words| *refusal = Some(words)).ok()
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
            let manifest = Manifest::example(kind).map_err(words)?;
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
        Manifest::restored(&loaded).and_then(|manifest| Draft::of(&manifest))
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
