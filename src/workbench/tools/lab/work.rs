//! The work that follows from what is wanted of the lab.

use std::path::Path;
use std::sync::Arc;

use eframe::egui;

use crate::bench::Bench;
use crate::bench::command::lab::Beginning;
use crate::bench::keep::{Keep, NewTextile};
use crate::bench::task::{Task, taken};
use crate::tools::lab::family::{Family, Plan};
use crate::tools::lab::preview::{Compared, Preview};
use crate::tools::lab::state::{Begun, Lab};
use crate::tools::lab::steps::Steps;
use selvedge_foundation::files::KeyValue;
use selvedge_foundation::progress::Progress;
use selvedge_textile::tactile::Filters;
use selvedge_textile::{Draft, Library, Manifest, Parent, Place, RECIPES, TextileError};

/// Begins work on a thread, or does it here and now in a stepped window.
fn start<T: Send + 'static>(
    name: &str,
    bench: &Bench,
    work: impl FnOnce(&mut Progress<'_>) -> Result<T, String> + Send + 'static,
) -> Task<T> {
    Task::start((name, &bench.ctx), bench.is_stepped(), work)
}

impl Lab {
    /// Sets a parameter, or leaves it out.
    pub(crate) fn set(&mut self, ctx: &egui::Context, place: Place, value: Option<KeyValue>) {
        let is_held = ctx.input(|input| input.pointer.any_down());
        self.change(|steps| steps.set(place, value, is_held));
        ctx.request_repaint();
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
        self.beginning = Some(start("selvedge-lab-begin", bench, work));
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
        self.comparing = Some(start("selvedge-lab-compare", bench, work));
    }

    /// Stops what is being computed.
    pub(crate) fn stop(&mut self) {
        self.is_stopped = true;
        if let Some((_, Some(task))) = &self.previewing {
            task.stop();
        }
        if let Some(task) = &self.trying {
            task.stop();
        }
        if let Some((Some(task), _)) = &self.keeping {
            task.stop();
        }
    }

    /// Tries a family.
    pub(crate) fn try_family(&mut self, bench: &Bench, plan: Plan) {
        let Some(steps) = &self.steps else { return };
        let (draft, filters) = (steps.now().clone(), bench.document.scene().filters);
        let work = move |progress: &mut Progress<'_>| Family::of(&draft, &plan, &filters, progress);
        self.refusal = None;
        self.trying = Some(start("selvedge-lab-family", bench, work));
    }

    /// Keeps the recipe as a textile, and lays it under the display if it is to be felt.
    pub(crate) fn keep(&mut self, bench: &mut Bench, feels: bool) {
        let recipe = self.to_keep(bench.engine_scene.loaded.library());
        self.keep_recipes(bench, recipe.map(|one| vec![one]), feels);
    }

    /// Keeps every textile of the family that was tried.
    pub(crate) fn keep_family(&mut self, bench: &mut Bench) {
        let recipes = self.family_to_keep(bench.engine_scene.loaded.library());
        self.keep_recipes(bench, recipes, false);
    }

    fn keep_recipes(
        &mut self,
        bench: &mut Bench,
        recipes: Result<Vec<(String, Manifest)>, String>,
        feels: bool,
    ) {
        match recipes {
            Err(words) => self.refusal = Some(words),
            Ok(recipes) => {
                self.refusal = None;
                let work = move |progress: &mut Progress<'_>| built(&recipes, progress);
                let task = start("selvedge-lab-keep", bench, work);
                self.keeping = Some((Some(task), feels));
                self.poll_keeping(bench);
            }
        }
    }

    /// Takes what was built to be kept, whether the lab is in sight or not.
    pub(crate) fn poll_keeping(&mut self, bench: &mut Bench) {
        let Some((task, feels)) = &mut self.keeping else {
            return;
        };
        let feels = *feels;
        let Some((outcome, was_stopped)) = taken(task) else {
            return;
        };
        self.keeping = None;
        match outcome {
            Ok(textiles) => {
                let textiles = Arc::new(textiles);
                let keep = if feels {
                    Keep::Feel(textiles)
                } else {
                    Keep::Save(textiles)
                };
                bench.commands.push(keep.into());
            }
            Err(_) if was_stopped => {}
            Err(words) => self.refusal = Some(format!("Nothing was kept: {words}")),
        }
    }

    /// Has what the lab shows, or sends for it: called while it is in sight.
    pub(crate) fn follow(&mut self, bench: &Bench) {
        let filters = bench.document.scene().filters;
        self.feel_through(filters);
        if self.steps.is_none() && self.beginning.is_none() && self.refusal.is_none() {
            self.begin_with(bench, Beginning::Example(RECIPES[0].0));
        }
        self.take();
        if let Some((serial, manifest)) = self.due() {
            self.n_computed += 1;
            let work = move |progress: &mut Progress<'_>| Preview::of(manifest, &filters, progress);
            let task = start("selvedge-lab", bench, work);
            self.previewing = Some((serial, Some(task)));
            self.take();
        }
    }

    /// Takes what threads bring.
    fn take(&mut self) {
        if let Some((outcome, _)) = taken(&mut self.beginning) {
            match outcome {
                Ok(begun) => self.begin(begun),
                Err(words) => self.refusal = Some(words),
            }
        }
        if let Some((outcome, _)) = taken(&mut self.comparing) {
            match outcome {
                Ok(compared) => self.compared = Some(compared),
                Err(words) => self.refusal = Some(words),
            }
        }
        if let Some((outcome, was_stopped)) = taken(&mut self.trying) {
            match outcome {
                Ok(family) => self.family = Some(family),
                Err(_) if was_stopped => {}
                Err(words) => self.refusal = Some(words),
            }
        }
        let Some((serial, task)) = &mut self.previewing else {
            return;
        };
        let serial = *serial;
        let Some((outcome, was_stopped)) = taken(task) else {
            return;
        };
        self.previewing = None;
        match outcome {
            Ok(preview) => self.show(serial, preview),
            Err(_) if was_stopped => {}
            Err(words) => self.refuse(serial, words),
        }
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
