//! The drafts of a recipe, one for every step: taken back, brought back, or all undone.

use selvedge_foundation::files::KeyValue;
use selvedge_textile::{Draft, Fault, Manifest, ParameterKind, Place, groups};

/// Most steps that can be taken back.
const MOST: usize = 200;

/// A recipe while it is edited, and how it came to be.
#[derive(Debug, Clone)]
pub(crate) struct Steps {
    drafts: Vec<Draft>,
    at: usize,
    /// The parameter that is being dragged: its changes are one step.
    held: Option<Place>,
    read: Result<Manifest, Fault>,
}

impl Steps {
    /// The first step.
    pub(crate) fn new(draft: Draft) -> Self {
        Self {
            read: draft.read(),
            drafts: vec![draft],
            at: 0,
            held: None,
        }
    }

    /// The draft as it is.
    pub(crate) fn now(&self) -> &Draft {
        &self.drafts[self.at]
    }

    /// The draft that it began with.
    pub(crate) fn first(&self) -> &Draft {
        &self.drafts[0]
    }

    /// The recipe, or what is wrong with it.
    pub(crate) fn read(&self) -> &Result<Manifest, Fault> {
        &self.read
    }

    /// What is wrong with the recipe.
    pub(crate) fn fault(&self) -> Option<&Fault> {
        self.read.as_ref().err()
    }

    /// Whether there is a step to take back, and one to bring back.
    pub(crate) fn can_step(&self) -> [bool; 2] {
        [self.at > 0, self.at + 1 < self.drafts.len()]
    }

    /// Sets a parameter. While `is_held` the pointer has hold of it, and all its changes are one
    /// step.
    pub(crate) fn set(&mut self, place: Place, value: Option<KeyValue>, is_held: bool) {
        let mut draft = self.now().clone();
        let stands_in = value.is_some().then(|| excluded(&draft, place)).flatten();
        draft.set(place, value);
        if let Some(other) = stands_in {
            draft.set(other, None);
        }
        let goes_on = is_held && self.held == Some(place) && self.at > 0;
        self.held = is_held.then_some(place);
        if goes_on {
            self.drafts.truncate(self.at + 1);
            self.drafts[self.at] = draft;
        } else if draft != *self.now() {
            self.push(draft);
        }
        self.read = self.now().read();
    }

    /// Back to what it began with: a step of its own, which can be taken back.
    pub(crate) fn restart(&mut self) {
        let first = self.first().clone();
        if first != *self.now() {
            self.push(first);
            self.read = self.now().read();
        }
    }

    fn push(&mut self, draft: Draft) {
        self.drafts.truncate(self.at + 1);
        self.drafts.push(draft);
        if self.drafts.len() > MOST {
            // The first one stays: it is what "back to the start" goes to.
            self.drafts.remove(1);
        }
        self.at = self.drafts.len() - 1;
    }

    /// Takes a step back.
    pub(crate) fn undo(&mut self) {
        self.go(self.at.saturating_sub(1));
    }

    /// Brings a step back.
    pub(crate) fn redo(&mut self) {
        self.go((self.at + 1).min(self.drafts.len() - 1));
    }

    fn go(&mut self, at: usize) {
        self.at = at;
        self.held = None;
        self.read = self.now().read();
    }
}

/// The parameter that is left out when this one is stated.
fn excluded(draft: &Draft, place: Place) -> Option<Place> {
    let groups = groups(draft.kind());
    let mut all = groups.iter().flat_map(|group| &group.parameters);
    let own = all.find(|parameter| parameter.place == place)?;
    match own.kind {
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
    use selvedge_textile::example;

    const HURST: Place = Place {
        table: "source",
        key: "hurst",
    };

    fn steps() -> Steps {
        Steps::new(Draft::of(&example("brownian").unwrap()).unwrap())
    }

    #[test]
    fn changes_of_one_gesture_are_one_step() {
        let mut steps = steps();
        let before = steps.now().clone();
        for hurst in [0.6, 0.7, 0.8] {
            steps.set(HURST, Some(hurst.into()), true);
        }
        assert_eq!(steps.now().number(HURST), Some(0.8));
        steps.undo();
        assert_eq!((steps.now(), steps.can_step()), (&before, [false, true]));
        steps.redo();
        assert_eq!(steps.now().number(HURST), Some(0.8));
        steps.set(HURST, Some(0.2.into()), false);
        steps.restart();
        assert_eq!(steps.now(), steps.first());
        steps.undo();
        assert_eq!(steps.now().number(HURST), Some(0.2));
    }

    #[test]
    fn what_is_wrong_is_said_of_its_parameter_and_goes_with_the_step() {
        let mut steps = steps();
        steps.set(HURST, Some(7.0.into()), false);
        let fault = steps.fault().unwrap();
        assert_eq!(fault.place, Some(HURST));
        assert_eq!(fault.message, "hurst is 7; give a number from 0.01 to 0.99");
        steps.undo();
        assert!(steps.fault().is_none() && steps.read().is_ok());
    }

    #[test]
    fn one_amplitude_stands_in_the_place_of_the_other() {
        let mut steps = steps();
        let at = |key| Place {
            table: "source",
            key,
        };
        steps.set(at("rise_um"), Some(3.0.into()), false);
        assert_eq!(steps.now().value(at("smd_um")), None);
        assert!(steps.read().is_ok(), "{:?}", steps.fault());
    }

    #[test]
    fn of_very_many_steps_the_first_one_stays() {
        let mut steps = steps();
        let first = steps.first().clone();
        for n in 0..300_u32 {
            steps.set(HURST, Some((0.1 + 0.002 * f64::from(n)).into()), false);
        }
        assert_eq!(steps.first(), &first);
        for _ in 0..300 {
            steps.undo();
        }
        assert_eq!(steps.now(), &first);
    }
}
