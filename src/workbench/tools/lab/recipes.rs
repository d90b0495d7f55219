//! The recipes of a lab, one after the other: a beginning can be taken back like any other step.

use crate::tools::lab::family::FamilyFields;
use crate::tools::lab::fields::KeepFields;
use crate::tools::lab::preview::Compared;
use crate::tools::lab::state::Lab;
use crate::tools::lab::steps::Steps;
use selvedge_textile::Parent;

/// Most recipes that are remembered.
const MOST: usize = 20;

/// A recipe with all that belongs to it.
#[derive(Debug)]
pub(crate) struct Recipe {
    steps: Steps,
    parent: Option<Parent>,
    compared: Option<Compared>,
    fields: KeepFields,
    plan: FamilyFields,
}

/// The recipes before and after the one at hand, the nearest last.
#[derive(Debug, Default)]
pub(crate) struct Recipes {
    before: Vec<Recipe>,
    after: Vec<Recipe>,
}

impl Lab {
    /// Whether there is a step to take back, and one to bring back.
    pub(crate) fn can_step(&self) -> [bool; 2] {
        let [back, forth] = self.steps.as_ref().map_or([false; 2], Steps::can_step);
        let recipes = &self.recipes;
        [
            back || !recipes.before.is_empty(),
            forth || !recipes.after.is_empty(),
        ]
    }

    /// Takes a step back: of the recipe, or to the recipe before.
    pub(crate) fn undo(&mut self) {
        match &mut self.steps {
            Some(steps) if steps.can_step()[0] => steps.undo(),
            _ => {
                if let Some(recipe) = self.recipes.before.pop() {
                    let own = self.exchange(recipe);
                    self.recipes.after.extend(own);
                }
            }
        }
        self.has_changed();
    }

    /// Brings a step back.
    pub(crate) fn redo(&mut self) {
        match &mut self.steps {
            Some(steps) if steps.can_step()[1] => steps.redo(),
            _ => {
                if let Some(recipe) = self.recipes.after.pop() {
                    let own = self.exchange(recipe);
                    self.recipes.before.extend(own);
                }
            }
        }
        self.has_changed();
    }

    /// Puts the recipe at hand aside, since another begins.
    pub(crate) fn set_aside(&mut self) {
        let own = self.take_recipe();
        let recipes = &mut self.recipes;
        recipes.after.clear();
        recipes.before.extend(own);
        if recipes.before.len() > MOST {
            recipes.before.remove(0);
        }
    }

    fn exchange(&mut self, recipe: Recipe) -> Option<Recipe> {
        let own = self.take_recipe();
        self.steps = Some(recipe.steps);
        self.parent = recipe.parent;
        self.compared = recipe.compared;
        self.fields = recipe.fields;
        self.plan = recipe.plan;
        self.family = None;
        own
    }

    fn take_recipe(&mut self) -> Option<Recipe> {
        Some(Recipe {
            steps: self.steps.take()?,
            parent: self.parent.take(),
            compared: self.compared.take(),
            fields: std::mem::take(&mut self.fields),
            plan: std::mem::take(&mut self.plan),
        })
    }
}
