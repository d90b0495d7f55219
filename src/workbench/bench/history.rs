//! Undo and redo by whole snapshots of what is edited.
//!
//! A step begins with the first edit of a gesture and takes in every further edit of the same
//! target in that gesture, so one drag is one step. A gesture is a press of the pointer, or keys
//! that follow each other closely. Knows nothing of scenes.

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

/// Snapshots before and after, with names of the steps between.
#[derive(Debug, Clone)]
pub(crate) struct History<S, K> {
    past: Vec<Step<S>>,
    future: Vec<Step<S>>,
    open: Option<Open<K>>,
}

/// A step: the state on its far side, and its name.
#[derive(Debug, Clone)]
struct Step<S> {
    state: S,
    name: &'static str,
}

/// The step that further edits may still join.
#[derive(Debug, Clone, Copy)]
struct Open<K> {
    target: K,
    last: Moment,
}

impl<S: Clone + PartialEq, K: PartialEq + Copy> History<S, K> {
    /// Nothing to undo.
    pub(crate) fn new() -> Self {
        Self {
            past: Vec::new(),
            future: Vec::new(),
            open: None,
        }
    }

    /// Says that `state` is about to be edited; what could be redone is gone.
    pub(crate) fn begin(&mut self, state: &S, target: K, name: &'static str, now: Moment) {
        let joins = self.open.as_ref().is_some_and(|open| {
            let same_press = open.last.press == now.press && (open.last.is_down || now.is_down);
            let follows =
                !now.is_down && !open.last.is_down && now.t_s - open.last.t_s <= GESTURE_S;
            open.target == target && (same_press || follows)
        });
        self.open = Some(Open { target, last: now });
        self.future.clear();
        if !joins {
            if self.past.len() == MAX_STEPS {
                self.past.remove(0);
            }
            self.past.push(Step {
                state: state.clone(),
                name,
            });
        }
    }

    /// Ends the step: the next edit begins another, whatever it is.
    pub(crate) fn settle(&mut self) {
        self.open = None;
    }

    /// Takes the last step back: `state` becomes what it was before. Says which step it was.
    pub(crate) fn undo(&mut self, state: &mut S) -> Option<&'static str> {
        self.open = None;
        // A drag that ended where it began left a step without a difference.
        while self.past.last().is_some_and(|step| step.state == *state) {
            self.past.pop();
        }
        let Step {
            state: before,
            name,
        } = self.past.pop()?;
        let after = std::mem::replace(state, before);
        self.future.push(Step { state: after, name });
        Some(name)
    }

    /// What was undone cannot be brought back any more.
    pub(crate) fn forget_undone(&mut self) {
        self.future.clear();
    }

    /// Brings the last undone step back. Says which step it was.
    pub(crate) fn redo(&mut self, state: &mut S) -> Option<&'static str> {
        self.open = None;
        let Step { state: after, name } = self.future.pop()?;
        let before = std::mem::replace(state, after);
        self.past.push(Step {
            state: before,
            name,
        });
        Some(name)
    }

    /// Changes every state that undo and redo could bring back.
    pub(crate) fn change_all(&mut self, change: impl Fn(&mut S)) {
        let steps = self.past.iter_mut().chain(&mut self.future);
        steps.for_each(|step| change(&mut step.state));
    }

    /// What undo would take back from `state`.
    pub(crate) fn undo_name(&self, state: &S) -> Option<&'static str> {
        self.past
            .iter()
            .rev()
            .find(|step| step.state != *state)
            .map(|step| step.name)
    }

    /// What redo would bring back.
    pub(crate) fn redo_name(&self) -> Option<&'static str> {
        self.future.last().map(|step| step.name)
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

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
        let mut history = History::new();
        let mut gain = 0;
        for i in 1..=30 {
            history.begin(&gain, 'g', "gain", at(1, true, f64::from(i)));
            gain = i;
        }
        history.begin(&gain, 'g', "gain", at(2, true, 31.0));
        gain = 40;
        assert_eq!(history.undo(&mut gain), Some("gain"));
        assert_eq!(gain, 30);
        history.undo(&mut gain);
        assert_eq!(gain, 0);
        assert_eq!(history.undo(&mut gain), None);
    }

    #[test]
    fn keys_in_quick_succession_are_one_step_and_slow_ones_are_not() {
        let mut history = History::new();
        let mut gain = 0;
        for t_s in [0.0, 0.3, 0.6, 5.0] {
            history.begin(&gain, 'g', "gain", at(0, false, t_s));
            gain += 1;
        }
        history.undo(&mut gain);
        assert_eq!(gain, 3);
        history.undo(&mut gain);
        assert_eq!(gain, 0);
    }

    #[test]
    fn another_target_is_another_step() {
        let mut history = History::new();
        let mut gains = [0, 0];
        for (i, target) in ['a', 'b'].into_iter().enumerate() {
            history.begin(&gains, target, "gain", at(1, true, 0.0));
            gains[i] = 1;
        }
        history.undo(&mut gains);
        assert_eq!(gains, [1, 0]);
    }

    #[test]
    fn a_drag_back_to_where_it_began_leaves_nothing_to_undo() {
        let mut history = History::new();
        let mut gain = 5;
        history.begin(&gain, 'g', "gain", at(1, true, 0.0));
        assert_eq!(history.undo_name(&gain), None);
        assert_eq!(history.undo(&mut gain), None);
        assert_eq!(gain, 5);
    }

    proptest! {
        #[test]
        fn undoing_everything_and_redoing_it_is_the_same_again(
            edits in prop::collection::vec((0_u8..3, -9_i32..9, 0_u64..4, any::<bool>()), 0..40)
        ) {
            let mut history = History::new();
            let mut state = [0; 3];
            for (i, (target, value, press, is_down)) in edits.into_iter().enumerate() {
                history.begin(&state, target, "edit", at(press, is_down, i as f64 * 0.4));
                state[usize::from(target)] = value;
            }
            let last = state;
            let mut n_undone = 0;
            while history.undo(&mut state).is_some() { n_undone += 1; }
            prop_assert_eq!(state, [0; 3]);
            for _ in 0..n_undone { prop_assert!(history.redo(&mut state).is_some()); }
            prop_assert_eq!(state, last);
            prop_assert!(history.redo(&mut state).is_none());
        }
    }
}
