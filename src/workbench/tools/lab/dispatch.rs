//! What is wanted of the textile lab, and the work that follows from it.

use std::sync::Arc;

use eframe::egui;

use crate::bench::Bench;
use crate::bench::command::ShowCommand;
use crate::bench::keep::Keep;
use crate::bench::pane::Pane;
use crate::bench::task::{Task, taken};
use crate::tools::lab;
use crate::tools::lab::command::{Beginning, LabCommand, Plan};
use crate::tools::lab::family::Family;
use crate::tools::lab::preview::{Compared, Preview};
use selvedge_foundation::progress::Progress;
use selvedge_textile::{Manifest, RECIPES};

impl Bench {
    pub(crate) fn dispatch_lab(&mut self, ctx: &egui::Context, command: LabCommand) {
        let lab = &mut self.transient.lab;
        match command {
            LabCommand::Begin(beginning) => {
                if !self.shows(Pane::Lab) {
                    self.commands.push(ShowCommand::Pane(Pane::Lab).into());
                }
                self.begin_lab(ctx, beginning);
            }
            LabCommand::Set(place, value) => {
                let is_held = ctx.input(|input| input.pointer.any_down());
                self.change_recipe(|steps| steps.set(place, value, is_held));
            }
            LabCommand::Undo => lab.undo(),
            LabCommand::Redo => lab.redo(),
            LabCommand::Restart => self.change_recipe(lab::Steps::restart),
            LabCommand::Compare(None) => lab.compared = None,
            LabCommand::Compare(Some(id)) => self.compare_in_lab(ctx, id),
            LabCommand::Look(look) => lab.look = look,
            LabCommand::Show(page) => lab.page = page,
            LabCommand::Stop => self.stop_lab(),
            LabCommand::GoOn => lab.is_stopped = false,
            LabCommand::TryFamily(plan) => self.try_family(ctx, plan),
            LabCommand::Keep { feels } => {
                let recipe = lab.to_keep(self.loaded.library());
                self.keep_recipes(ctx, recipe.map(|one| vec![one]), feels);
            }
            LabCommand::KeepFamily => {
                let recipes = lab.family_to_keep(self.loaded.library());
                self.keep_recipes(ctx, recipes, false);
            }
        }
    }

    fn change_recipe(&mut self, change: impl FnOnce(&mut lab::Steps)) {
        let lab = &mut self.transient.lab;
        if let Some(steps) = &mut lab.steps {
            change(steps);
            lab.has_changed();
        }
    }

    fn begin_lab(&mut self, ctx: &egui::Context, beginning: Beginning) {
        let library = Arc::clone(self.loaded.library());
        let filters = self.document.scene().filters;
        let work =
            move |progress: &mut Progress<'_>| lab::begin(&beginning, &library, &filters, progress);
        self.transient.lab.refusal = None;
        let task = Task::start(("selvedge-lab-begin", ctx), self.is_stepped, work);
        self.transient.lab.beginning = Some(task);
    }

    fn compare_in_lab(&mut self, ctx: &egui::Context, id: String) {
        let library = Arc::clone(self.loaded.library());
        let filters = self.document.scene().filters;
        let work = move |progress: &mut Progress<'_>| {
            progress.step(0.1, &id).map_err(|stop| stop.to_string())?;
            let textile = library.load(&id).map_err(|error| error.to_string())?;
            Compared::of(&textile, &filters, progress).map_err(|stop| stop.to_string())
        };
        let task = Task::start(("selvedge-lab-compare", ctx), self.is_stepped, work);
        self.transient.lab.comparing = Some(task);
    }

    fn stop_lab(&mut self) {
        let lab = &mut self.transient.lab;
        lab.is_stopped = true;
        if let Some((_, Some(task))) = &lab.previewing {
            task.stop();
        }
        if let Some(task) = &lab.trying {
            task.stop();
        }
        if let Some((Some(task), _)) = &lab.keeping {
            task.stop();
        }
    }

    fn try_family(&mut self, ctx: &egui::Context, plan: Plan) {
        let lab = &mut self.transient.lab;
        let Some(steps) = &lab.steps else { return };
        let (draft, filters) = (steps.now().clone(), self.document.scene().filters);
        let work = move |progress: &mut Progress<'_>| Family::of(&draft, &plan, &filters, progress);
        lab.refusal = None;
        let task = Task::start(("selvedge-lab-family", ctx), self.is_stepped, work);
        lab.trying = Some(task);
    }

    fn keep_recipes(
        &mut self,
        ctx: &egui::Context,
        recipes: Result<Vec<(String, Manifest)>, String>,
        feels: bool,
    ) {
        let lab = &mut self.transient.lab;
        match recipes {
            Err(words) => lab.refusal = Some(words),
            Ok(recipes) => {
                lab.refusal = None;
                let work = move |progress: &mut Progress<'_>| lab::built(&recipes, progress);
                let task = Task::start(("selvedge-lab-keep", ctx), self.is_stepped, work);
                lab.keeping = Some((Some(task), feels));
                self.poll_lab();
            }
        }
    }

    /// Takes what was built to be kept, whether the lab is in sight or not.
    pub(crate) fn poll_lab(&mut self) {
        let lab = &mut self.transient.lab;
        let Some((task, feels)) = &mut lab.keeping else {
            return;
        };
        let feels = *feels;
        let Some((outcome, was_stopped)) = taken(task) else {
            return;
        };
        lab.keeping = None;
        match outcome {
            Ok(textiles) => {
                let textiles = Arc::new(textiles);
                let keep = if feels {
                    Keep::Feel(textiles)
                } else {
                    Keep::Save(textiles)
                };
                self.commands.push(keep.into());
            }
            Err(_) if was_stopped => {}
            Err(words) => lab.refusal = Some(format!("Nothing was kept: {words}")),
        }
    }

    /// Has what the lab shows, or sends for it: called while it is in sight.
    pub(crate) fn follow_lab(&mut self, ctx: &egui::Context) {
        let filters = self.document.scene().filters;
        self.transient.lab.feel_through(filters);
        let lab = &self.transient.lab;
        if lab.steps.is_none() && lab.beginning.is_none() && lab.refusal.is_none() {
            self.begin_lab(ctx, Beginning::Example(RECIPES[0].0));
        }
        self.take_lab();
        let lab = &mut self.transient.lab;
        if let Some((serial, manifest)) = lab.due() {
            lab.n_computed += 1;
            let work = move |progress: &mut Progress<'_>| Preview::of(manifest, &filters, progress);
            let task = Task::start(("selvedge-lab", ctx), self.is_stepped, work);
            lab.previewing = Some((serial, Some(task)));
            self.take_lab();
        }
    }

    /// Takes what threads bring.
    fn take_lab(&mut self) {
        let lab = &mut self.transient.lab;
        if let Some((outcome, _)) = taken(&mut lab.beginning) {
            match outcome {
                Ok(begun) => lab.begin(begun),
                Err(words) => lab.refusal = Some(words),
            }
        }
        if let Some((outcome, _)) = taken(&mut lab.comparing) {
            match outcome {
                Ok(compared) => lab.compared = Some(compared),
                Err(words) => lab.refusal = Some(words),
            }
        }
        if let Some((outcome, was_stopped)) = taken(&mut lab.trying) {
            match outcome {
                Ok(family) => lab.family = Some(family),
                Err(_) if was_stopped => {}
                Err(words) => lab.refusal = Some(words),
            }
        }
        let Some((serial, task)) = &mut lab.previewing else {
            return;
        };
        let serial = *serial;
        let Some((outcome, was_stopped)) = taken(task) else {
            return;
        };
        lab.previewing = None;
        match outcome {
            Ok(preview) => lab.show(serial, preview),
            Err(_) if was_stopped => {}
            Err(words) => lab.refuse(serial, words),
        }
    }
}
