//! The lab's state: the recipe at hand, what became of it, and how it is looked at.

use std::sync::Arc;

use crate::bench::background::Task;
use crate::bench::keep::NewTextiles;
use crate::bench::latest::{Latest, Standing};
use crate::tools::lab::family::{Family, FamilyFields};
use crate::tools::lab::fields::KeepFields;
use crate::tools::lab::pictures::Pictures;
use crate::tools::lab::preview::{Compared, Preview, PreviewAsked, PreviewFound};
use crate::tools::lab::steps::{Recipe, Steps};
use selvedge_textile::surface::Direction;
use selvedge_textile::tactile::Filters;
use selvedge_textile::{Draft, Fault, Manifest, Parent, Provenance};

/// Which controls are shown.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) enum Page {
    /// The parameters.
    #[default]
    Recipe,
    /// Several recipes that differ in one parameter.
    Family,
    /// How the textile is called that is kept.
    Keep,
}

impl Page {
    /// All three, with their titles.
    pub(crate) const ALL: [(Self, &'static str); 3] = [
        (Self::Recipe, "Recipe"),
        (Self::Family, "Family"),
        (Self::Keep, "Keep"),
    ];
}

/// Which stroke is looked at, and how much of it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Look {
    /// The stroke.
    pub direction: Direction,
    /// Where the view begins, mm.
    pub from_mm: f64,
    /// How much of it is in sight, mm.
    pub span_mm: f64,
}

impl Default for Look {
    fn default() -> Self {
        Self {
            direction: Direction::WarpForward,
            from_mm: 0.0,
            span_mm: 20.0,
        }
    }
}

/// A recipe that begins.
#[derive(Debug)]
pub(crate) struct Begun {
    /// The recipe.
    pub(crate) draft: Draft,
    /// The textile that it is made from.
    pub(crate) parent: Option<(Parent, Compared)>,
}

/// The lab.
#[derive(Default)]
pub(crate) struct Lab {
    /// The recipe; `None` before one has begun.
    pub steps: Option<Steps>,
    /// What it is compared with.
    pub compared: Option<Compared>,
    /// What became of the recipe that was computed last.
    pub(crate) previews: Latest<PreviewAsked, PreviewFound>,
    /// What is pictured of it, as it was drawn last.
    pub(crate) pictures: Pictures,
    /// Which stroke is looked at.
    pub look: Look,
    /// The heights between which profiles are drawn, µm: they stay while the recipe is edited.
    pub(crate) heights_um: Option<[f64; 2]>,
    /// Which controls are shown.
    pub page: Page,
    /// What is chosen where a family is planned.
    pub plan: FamilyFields,
    /// The family that was tried last.
    pub family: Option<Family>,
    /// Why something was not done.
    pub refusal: Option<String>,
    /// What it is felt through.
    pub(crate) filters: Filters,
    pub(crate) beginning: Option<Task<Begun>>,
    pub(crate) comparing: Option<Task<Compared>>,
    pub(crate) trying: Option<Task<Family>>,
    pub(crate) keeping: Option<Task<NewTextiles>>,
    /// Textiles that are listened to, or were, and the draft that they were made of.
    pub(crate) offered: Option<(NewTextiles, Option<Draft>)>,
}

impl Lab {
    /// What a preview is wanted of; `None` while the recipe makes no sense.
    pub(crate) fn asked(&self) -> Option<PreviewAsked> {
        let manifest = self.steps.as_ref()?.read.as_ref().ok()?.clone();
        let filters = self.filters;
        Some(PreviewAsked { manifest, filters })
    }

    /// How the preview stands to the recipe as it is.
    pub(crate) fn standing(&self) -> Standing {
        let asked = self.asked();
        asked.map_or(Standing::Empty, |asked| self.previews.standing(&asked))
    }

    /// What became of a recipe: of the last one that made a surface.
    pub(crate) fn preview(&self) -> Option<&Arc<Preview>> {
        self.previews.value()?.preview.as_ref()
    }

    /// Why something was not done, or why there is no preview of the recipe as it is.
    pub(crate) fn refusal(&self) -> Option<&str> {
        let found = self.previews.value();
        let found = found.filter(|_| self.standing() == Standing::Fresh);
        let refused = || found?.refusal.as_deref();
        self.refusal.as_deref().or_else(refused)
    }

    /// What is wrong with the recipe.
    pub(crate) fn fault(&self) -> Option<&Fault> {
        self.steps.as_ref().and_then(Steps::fault)
    }

    /// How far what is computed is, 0…1; `None` while nothing is.
    pub(crate) fn share(&self) -> Option<f32> {
        let preview = match self.standing() {
            Standing::Working(share) => Some(share),
            _ => None,
        };
        preview
            .or_else(|| self.trying.as_ref().map(Task::share))
            .or_else(|| self.beginning.as_ref().map(Task::share))
            .or_else(|| self.comparing.as_ref().map(Task::share))
            .or_else(|| self.keeping.as_ref().map(Task::share))
    }

    /// The recipe has changed.
    pub(crate) fn has_changed(&mut self) {
        self.previews.go_on();
        self.refusal = None;
    }

    /// Begins a recipe: a step that can be taken back.
    pub(crate) fn begin(&mut self, begun: Begun) {
        let (parent, compared) = begun.parent.unzip();
        let recipe = Recipe::new(begun.draft, parent);
        match &mut self.steps {
            Some(steps) => steps.begin(recipe),
            None => self.steps = Some(Steps::new(recipe)),
        }
        self.family = None;
        self.plan = FamilyFields::default();
        self.compared = compared;
        self.heights_um = None;
        self.has_changed();
    }

    /// Takes steps back or brings them again until so many are done.
    pub(crate) fn go_to(&mut self, n_done: usize) {
        let Some(steps) = &mut self.steps else { return };
        let first = steps.recipe.first.clone();
        steps.step_to(n_done);
        if steps.recipe.first != first {
            self.heights_um = None;
            self.family = None;
            self.plan = FamilyFields::default();
        }
        self.has_changed();
    }

    /// What is typed where the textile is named, and what it is made from.
    pub(crate) fn recipe(&self) -> Result<&Recipe, String> {
        let steps = self.steps.as_ref().ok_or("there is no recipe yet")?;
        Ok(&steps.recipe)
    }

    /// The recipe as it would be kept.
    ///
    /// # Errors
    /// What is wrong with the recipe or with how it is called, in one line.
    pub(crate) fn to_keep(&self) -> Result<(String, Manifest), String> {
        let steps = self.steps.as_ref().ok_or("there is no recipe yet")?;
        let manifest = steps.read.as_ref().map_err(|fault| fault.message.clone())?;
        let fields = &steps.recipe.fields;
        if let Some(words) = fields.refusal() {
            return Err(words);
        }
        let kept = named(&steps.recipe, manifest, fields.name.trim());
        Ok((fields.id.trim().to_owned(), kept))
    }

    /// Every member of the family as it would be kept.
    ///
    /// # Errors
    /// The same, for any of them.
    pub(crate) fn family_to_keep(&self) -> Result<Vec<(String, Manifest)>, String> {
        let recipe = self.recipe()?;
        let fields = &recipe.fields;
        let none = || "there is no family yet: press “Try” first".to_owned();
        let family = self.family.as_ref().ok_or_else(none)?;
        let mut all = Vec::with_capacity(family.members.len());
        for (nth, member) in (1..).zip(&family.members) {
            let numbered = KeepFields {
                id: format!("{}-{nth}", fields.id.trim()),
                ..fields.clone()
            };
            if let Some(words) = numbered.refusal() {
                return Err(words);
            }
            let name = format!("{}, {}", fields.name.trim(), member.label);
            all.push((numbered.id.clone(), named(recipe, &member.manifest, &name)));
        }
        Ok(all)
    }
}

/// A manifest under a name, with where it comes from.
fn named(recipe: &Recipe, manifest: &Manifest, name: &str) -> Manifest {
    Manifest {
        name: name.to_owned(),
        notes: recipe.fields.notes.trim().replace('\n', " "),
        provenance: Some(Provenance::of(recipe.parent.iter().cloned().collect())),
        ..manifest.clone()
    }
}
