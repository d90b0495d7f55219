//! The recipe of the lab and the steps that led to it.
//!
//! A step holds everything that the next one may change: the parameters, what the textile is to be
//! called, and what it was made from, so that a beginning is taken back like any other step. What
//! it is compared with and which part is looked at are views, and no steps.

use serde::{Deserialize, Serialize};

use crate::bench::history::{History, Moment, StepList};
use crate::bench::recovery::Unsaved;
use crate::tools::lab::fields::KeepFields;
use selvedge_foundation::files::KeyValue;
use selvedge_textile::{Draft, Fault, Manifest, Parameter, ParameterKind, Parent, Place, groups};

/// A recipe with all that belongs to it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct Recipe {
    pub(crate) draft: Draft,
    /// The draft that it began with.
    pub(crate) first: Draft,
    /// The textile of the library that it is made from.
    pub(crate) parent: Option<Parent>,
    /// What is typed where the textile is named.
    pub(crate) fields: KeepFields,
}

/// What a step changes: changes of the same in one gesture are one step.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Target {
    Parameter(Place),
    Fields,
    All,
}

/// What is written down of a recipe that no library holds.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub(crate) struct Work {
    recipe: Recipe,
    history: History<Recipe, Target>,
}

/// A recipe while it is edited, and how it came to be.
#[derive(Debug, Clone)]
pub(crate) struct Steps {
    /// The draft that was kept last as a textile.
    pub(super) kept: Option<Draft>,
    pub(crate) recipe: Recipe,
    history: History<Recipe, Target>,
    pub(crate) read: Result<Manifest, Fault>,
}

impl Recipe {
    /// One that begins, perhaps as a copy of a textile.
    pub(crate) fn new(draft: Draft, parent: Option<Parent>) -> Self {
        let name = draft
            .read()
            .map_or_else(|_| String::new(), |read| read.name);
        Self {
            fields: KeepFields::of(&name, parent.is_some()),
            first: draft.clone(),
            draft,
            parent,
        }
    }
}

impl Steps {
    /// The first recipe.
    pub(crate) fn new(recipe: Recipe) -> Self {
        Self {
            kept: None,
            read: recipe.draft.read(),
            recipe,
            history: History::default(),
        }
    }

    /// A recipe that was changed and not kept, with every step.
    pub(crate) fn unsaved(&self) -> Option<Unsaved> {
        let draft = &self.recipe.draft;
        if *draft == self.recipe.first || self.kept.as_ref() == Some(draft) {
            return None;
        }
        let last = self.list();
        let name = format!("Recipe “{}” in the textile lab", self.recipe.fields.name);
        let what = format!(
            "{} steps, the last: {}",
            last.n_done,
            last.undo().unwrap_or("none")
        );
        let whole = |history| Work {
            recipe: self.recipe.clone(),
            history,
        };
        Some(Unsaved::with_steps(name, &what, &self.history, whole))
    }

    /// The recipe of such work.
    pub(crate) fn of(work: Work) -> Self {
        Self {
            history: work.history,
            ..Self::new(work.recipe)
        }
    }

    /// What is wrong with the recipe.
    pub(crate) fn fault(&self) -> Option<&Fault> {
        self.read.as_ref().err()
    }

    /// The steps that led here.
    pub(crate) fn list(&self) -> StepList {
        self.history.steps(&self.recipe)
    }

    /// Takes steps back or brings them again until so many are done.
    pub(crate) fn step_to(&mut self, n_done: usize) {
        self.history.step_to(n_done, &mut self.recipe);
        self.read = self.recipe.draft.read();
    }

    /// Begins with another recipe.
    pub(crate) fn begin(&mut self, recipe: Recipe) {
        let name = format!("began {}", recipe.fields.name);
        self.change(recipe, Target::All, &name, Moment::default());
    }

    /// Sets a parameter, or leaves it out.
    pub(crate) fn set(&mut self, place: Place, value: Option<KeyValue>, now: Moment) {
        let mut recipe = self.recipe.clone();
        let stands_in = value.is_some().then(|| excluded(&self.recipe.draft, place));
        recipe.draft.set(place, value);
        if let Some(other) = stands_in.flatten() {
            recipe.draft.set(other, None);
        }
        let own = parameter_at(&self.recipe.draft, place);
        let name = own.map_or(place.key, |parameter| parameter.name);
        self.change(recipe, Target::Parameter(place), name, now);
    }

    /// Calls the textile otherwise.
    pub(crate) fn call(&mut self, fields: KeepFields, now: Moment) {
        let recipe = Recipe {
            fields,
            ..self.recipe.clone()
        };
        self.change(recipe, Target::Fields, "name", now);
    }

    /// Back to what it began with: a step of its own, which can be taken back.
    pub(crate) fn restart(&mut self) {
        let recipe = Recipe {
            draft: self.recipe.first.clone(),
            ..self.recipe.clone()
        };
        self.change(recipe, Target::All, "back to the start", Moment::default());
    }

    fn change(&mut self, recipe: Recipe, target: Target, name: &str, now: Moment) {
        if recipe == self.recipe {
            return;
        }
        self.history.begin(&self.recipe, target, name, now);
        if target == Target::All {
            self.history.settle();
        }
        self.recipe = recipe;
        self.read = self.recipe.draft.read();
    }
}

/// The parameter at a place of a draft.
pub(crate) fn parameter_at(draft: &Draft, place: Place) -> Option<Parameter> {
    let mut all = groups(draft.kind())
        .into_iter()
        .flat_map(|group| group.parameters);
    all.find(|parameter| parameter.place == place)
}

/// The parameter that is left out when this one is stated.
fn excluded(draft: &Draft, place: Place) -> Option<Place> {
    match parameter_at(draft, place)?.kind {
        ParameterKind::Optional { instead_of, .. } if !instead_of.is_empty() => Some(Place {
            table: place.table,
            key: instead_of,
        }),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use selvedge_textile::Manifest;

    const HURST: Place = Place {
        table: "source",
        key: "hurst",
    };

    fn steps() -> Steps {
        let draft = Draft::of(&Manifest::example("brownian").unwrap()).unwrap();
        Steps::new(Recipe::new(draft, None))
    }

    /// In one gesture where `press` is the same.
    fn at(press: u64) -> Moment {
        Moment {
            press,
            is_down: true,
            t_s: 0.0,
        }
    }

    #[test]
    fn changes_of_one_gesture_are_one_step_with_the_name_of_the_parameter() {
        let mut steps = steps();
        let before = steps.recipe.draft.clone();
        for hurst in [0.6, 0.7, 0.8] {
            steps.set(HURST, Some(hurst.into()), at(1));
        }
        assert_eq!(steps.recipe.draft.number(HURST), Some(0.8));
        assert_eq!(steps.list().names, ["Hurst exponent"]);
        steps.step_to(0);
        assert_eq!((&steps.recipe.draft, steps.list().n_done), (&before, 0));
        steps.step_to(1);
        assert_eq!(steps.recipe.draft.number(HURST), Some(0.8));
        steps.set(HURST, Some(0.2.into()), at(2));
        steps.restart();
        assert_eq!(steps.recipe.draft, steps.recipe.first);
        assert_eq!(steps.list().undo(), Some("back to the start"));
        steps.step_to(2);
        assert_eq!(steps.recipe.draft.number(HURST), Some(0.2));
    }

    #[test]
    fn what_is_wrong_is_said_of_its_parameter_and_goes_with_the_step() {
        let mut steps = steps();
        steps.set(HURST, Some(7.0.into()), at(1));
        let fault = steps.fault().unwrap();
        assert_eq!(fault.place, Some(HURST));
        assert_eq!(fault.message, "hurst is 7; give a number from 0.01 to 0.99");
        steps.step_to(0);
        assert!(steps.fault().is_none() && steps.read.is_ok());
    }

    #[test]
    fn one_amplitude_stands_in_the_place_of_the_other() {
        let mut steps = steps();
        let place = |key| Place {
            table: "source",
            key,
        };
        steps.set(place("rise_um"), Some(3.0.into()), at(1));
        assert_eq!(steps.recipe.draft.value(place("smd_um")), None);
        assert!(steps.read.is_ok(), "{:?}", steps.fault());
    }

    #[test]
    fn of_very_many_steps_the_start_is_still_known() {
        let mut steps = steps();
        let first = steps.recipe.first.clone();
        for n in 0..300_u32 {
            let hurst = 0.1 + 0.002 * f64::from(n);
            steps.set(HURST, Some(hurst.into()), at(n.into()));
        }
        steps.restart();
        assert_eq!(steps.recipe.draft, first);
    }
}
