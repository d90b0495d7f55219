//! Undo and redo by whole snapshots of what is edited: of the scene, of a recipe, of libraries.
//!
//! A step begins with the first edit of a gesture and takes in every further edit of the same
//! target in that gesture, so one drag is one step. A gesture is a press of the pointer, or keys
//! that follow each other closely. Knows nothing of what is edited; can be written down, without
//! the step that is still open.

use serde::{Deserialize, Serialize};

/// Keys or wheel turns that follow each other within this time are one gesture, s.
const GESTURE_S: f64 = 0.6;

/// Steps that are kept.
const MAX_STEPS: usize = 200;

/// When an edit happens: the pointer's press that it belongs to, and the time.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Moment {
    /// Counts presses of the pointer.
    pub press: u64,
    /// Whether the pointer is down now.
    pub is_down: bool,
    /// Time, s.
    pub t_s: f64,
}

/// The names of steps, oldest first, as menus list them.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub(crate) struct StepList {
    /// Steps that are done, then those that were taken back.
    pub names: Vec<String>,
    /// How many of them are done.
    pub n_done: usize,
}

impl StepList {
    /// What undo would take back.
    pub(crate) fn undo(&self) -> Option<&str> {
        let last = self.n_done.checked_sub(1)?;
        self.names.get(last).map(String::as_str)
    }

    /// What redo would bring back.
    pub(crate) fn redo(&self) -> Option<&str> {
        self.names.get(self.n_done).map(String::as_str)
    }
}

/// Snapshots before and after, with names of the steps between.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(bound(serialize = "S: Serialize", deserialize = "S: Deserialize<'de>"))]
pub(crate) struct History<S, K> {
    past: Vec<Step<S>>,
    future: Vec<Step<S>>,
    #[serde(skip)]
    open: Option<Open<K>>,
}

/// A step: the state on its far side, and its name.
#[derive(Debug, Clone, Serialize, Deserialize)]
struct Step<S> {
    state: S,
    name: String,
}

/// The step that further edits may still join.
#[derive(Debug, Clone, Copy)]
struct Open<K> {
    target: K,
    last: Moment,
}

impl<S, K> Default for History<S, K> {
    fn default() -> Self {
        Self {
            past: Vec::new(),
            future: Vec::new(),
            open: None,
        }
    }
}

impl<S: Clone + PartialEq, K: PartialEq + Copy> History<S, K> {
    /// Says that `state` is about to be edited; what could be redone is gone.
    pub(crate) fn begin(&mut self, state: &S, target: K, name: &str, now: Moment) {
        let joins = self.open.as_ref().is_some_and(|open| {
            let same_press = open.last.press == now.press && (open.last.is_down || now.is_down);
            let follows =
                !now.is_down && !open.last.is_down && now.t_s - open.last.t_s <= GESTURE_S;
            open.target == target && (same_press || follows)
        });
        self.open = Some(Open { target, last: now });
        self.future.clear();
        if !joins {
            self.past.truncate(self.n_done(state));
            if self.past.len() == MAX_STEPS {
                self.past.remove(0);
            }
            self.past.push(Step {
                state: state.clone(),
                name: name.to_owned(),
            });
        }
    }

    /// Ends the step: the next edit begins another, whatever it is.
    pub(crate) fn settle(&mut self) {
        self.open = None;
    }

    /// The steps, of which the last done one led to `state`.
    pub(crate) fn steps(&self, state: &S) -> StepList {
        let n_done = self.n_done(state);
        let done = self.past[..n_done].iter();
        let all = done.chain(self.future.iter().rev());
        StepList {
            names: all.map(|step| step.name.clone()).collect(),
            n_done,
        }
    }

    /// A drag that ended where it began left a step without a difference: it does not count.
    fn n_done(&self, state: &S) -> usize {
        let last = self.past.iter().rposition(|step| step.state != *state);
        last.map_or(0, |last| last + 1)
    }

    /// What the state was or will be after so many steps, other than as it is.
    pub(crate) fn state_after<'a>(&'a self, n_done: usize, state: &S) -> Option<&'a S> {
        let now = self.n_done(state);
        let step = match n_done.checked_sub(now + 1) {
            None => self.past[..now].get(n_done),
            Some(nth) => self.future.iter().rev().nth(nth),
        };
        step.map(|step| &step.state)
    }

    /// Takes steps back or brings them again until so many are done: `state` becomes what it was
    /// then.
    pub(crate) fn step_to(&mut self, n_done: usize, state: &mut S) {
        self.open = None;
        self.past.truncate(self.n_done(state));
        while self.past.len() > n_done {
            let Some(Step {
                state: before,
                name,
            }) = self.past.pop()
            else {
                return;
            };
            let after = std::mem::replace(state, before);
            self.future.push(Step { state: after, name });
        }
        while self.past.len() < n_done {
            let Some(Step { state: after, name }) = self.future.pop() else {
                return;
            };
            let before = std::mem::replace(state, after);
            self.past.push(Step {
                state: before,
                name,
            });
        }
    }

    /// What was undone cannot be brought back any more.
    pub(crate) fn forget_undone(&mut self) {
        self.future.clear();
    }

    /// The same with no more than so many steps back, and on.
    pub(crate) fn newest(&self, n_steps: usize) -> Self {
        let newest = |steps: &[Step<S>]| steps[steps.len().saturating_sub(n_steps)..].to_vec();
        Self {
            past: newest(&self.past),
            future: newest(&self.future),
            open: self.open,
        }
    }

    /// How many steps there are, back or on.
    pub(crate) fn len(&self) -> usize {
        self.past.len().max(self.future.len())
    }

    /// Changes every state that undo and redo could bring back.
    pub(crate) fn change_all(&mut self, change: impl Fn(&mut S)) {
        let steps = self.past.iter_mut().chain(&mut self.future);
        steps.for_each(|step| change(&mut step.state));
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use proptest::prelude::*;
    use selvedge_foundation::files::{keys_from_str, keys_to_string};

    use super::*;

    fn at(press: u64, is_down: bool, t_s: f64) -> Moment {
        Moment {
            press,
            is_down,
            t_s,
        }
    }

    #[test]
    fn one_drag_is_one_step() {
        let mut history = History::default();
        let mut gain = 0;
        for i in 1..=30 {
            history.begin(&gain, 'g', "gain", at(1, true, f64::from(i)));
            gain = i;
        }
        history.begin(&gain, 'g', "gain", at(2, true, 31.0));
        gain = 40;
        let steps = history.steps(&gain);
        assert_eq!((steps.undo(), steps.n_done), (Some("gain"), 2));
        history.step_to(1, &mut gain);
        assert_eq!(gain, 30);
        history.step_to(0, &mut gain);
        assert_eq!(gain, 0);
        assert_eq!(history.steps(&gain).undo(), None);
        history.step_to(2, &mut gain);
        assert_eq!(gain, 40, "both at once");
    }

    #[test]
    fn keys_in_quick_succession_are_one_step_and_slow_ones_are_not() {
        let mut history = History::default();
        let mut gain = 0;
        for t_s in [0.0, 0.3, 0.6, 5.0] {
            history.begin(&gain, 'g', "gain", at(0, false, t_s));
            gain += 1;
        }
        history.step_to(1, &mut gain);
        assert_eq!(gain, 3);
        history.step_to(0, &mut gain);
        assert_eq!(gain, 0);
    }

    #[test]
    fn another_target_is_another_step() {
        let mut history = History::default();
        let mut gains = [0, 0];
        for (i, target) in ['a', 'b'].into_iter().enumerate() {
            history.begin(&gains, target, "gain", at(1, true, 0.0));
            gains[i] = 1;
        }
        history.step_to(1, &mut gains);
        assert_eq!(gains, [1, 0]);
    }

    #[test]
    fn a_drag_back_to_where_it_began_leaves_nothing_to_undo() {
        let mut history = History::default();
        let mut gain = 5;
        history.begin(&gain, 'g', "gain", at(1, true, 0.0));
        assert_eq!(history.steps(&gain), StepList::default());
        history.step_to(0, &mut gain);
        assert_eq!(gain, 5);
    }

    proptest! {
        #[test]
        fn undoing_everything_and_redoing_it_is_the_same_again(
            edits in prop::collection::vec((0_u8..3, -9_i32..9, 0_u64..4, any::<bool>()), 0..40)
        ) {
            let mut history = History::default();
            let mut state = [0; 3];
            for (i, (target, value, press, is_down)) in edits.into_iter().enumerate() {
                history.begin(&state, target, "edit", at(press, is_down, i as f64 * 0.4));
                state[usize::from(target)] = value;
            }
            let last = state;
            let written = keys_to_string(&history, Path::new("steps")).unwrap();
            let n_done = history.steps(&state).n_done;
            let mut history: History<[i32; 3], u8> =
                keys_from_str(&written, Path::new("steps")).unwrap();
            history.step_to(0, &mut state);
            prop_assert_eq!(state, [0; 3]);
            history.step_to(n_done, &mut state);
            prop_assert_eq!(state, last);
            prop_assert!(history.steps(&state).redo().is_none());
        }
    }
}
