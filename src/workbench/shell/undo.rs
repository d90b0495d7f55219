//! Undo acts on what is in use: the recipe while the lab is, the scene while it is explored.
//!
//! What is out of sight is never changed: a step that would not be seen is brought in sight first.

use crate::bench::command::ShowCommand;
use crate::bench::history::StepList;
use crate::bench::pane::Pane;
use crate::shell::window::Workbench;

impl Workbench {
    /// The steps that undo and redo act on now.
    pub(crate) fn steps(&self) -> StepList {
        let own = self.pane_with_steps().and_then(|(_, steps)| steps);
        own.unwrap_or_else(|| self.bench.document.steps())
    }

    /// Takes the last step back.
    pub(crate) fn undo(&mut self) {
        if let Some(n_done) = self.steps().n_done.checked_sub(1) {
            self.step_to(n_done);
        }
    }

    /// Takes steps back or brings them again until so many are done.
    pub(crate) fn step_to(&mut self, n_done: usize) {
        if let Some((pane, Some(_))) = self.pane_with_steps() {
            if let Some(tool) = self.tools.showing(pane) {
                tool.step_to(n_done, &mut self.bench);
            }
            return;
        }
        let steps = self.bench.document.steps();
        if n_done == steps.n_done || n_done > steps.names.len() {
            return;
        }
        match self.bench.document.panes_of(n_done) {
            Some([pane, others @ ..])
                if !self.shell.shows(*pane)
                    && !others.iter().any(|pane| self.shell.shows(*pane)) =>
            {
                let is_back = n_done < steps.n_done;
                let step = if is_back { steps.undo() } else { steps.redo() };
                self.bring_in_sight(*pane, step);
            }
            _ => self.bench.step_to(n_done),
        }
    }

    fn bring_in_sight(&mut self, pane: Pane, step: Option<&str>) {
        let words = format!(
            "Nothing has changed yet: “{}” would not have been seen. {} is in sight now: press \
             again",
            step.unwrap_or_default(),
            pane.title()
        );
        self.bench.notices.give(words);
        self.dispatch_show(&ShowCommand::Reveal(pane));
    }

    /// The pane in use, and the steps of its tool if it has its own. Without one that was pressed,
    /// the scene goes before a tool if it is in sight.
    fn pane_with_steps(&self) -> Option<(Pane, Option<StepList>)> {
        let steps_of = |pane: Pane| {
            let mut tools = self.tools.iter();
            let tool = tools.find(|tool| tool.panes().contains(&pane));
            (pane, tool.and_then(|tool| tool.steps(&self.bench)))
        };
        let used = self.bench.pointer.pane_in_use;
        if let Some(pane) = used.filter(|pane| self.shell.shows(*pane)) {
            return Some(steps_of(pane));
        }
        if self.shell.shows(Pane::Workspace) {
            return None;
        }
        let mut shown = Pane::ALL.into_iter();
        let in_sight = shown.by_ref().filter(|pane| self.shell.shows(*pane));
        in_sight.map(steps_of).find(|(_, steps)| steps.is_some())
    }
}

#[cfg(test)]
mod tests {

    use super::*;
    use crate::bench::command::{Command, Edit};
    use crate::bench::history::Moment;
    use crate::bench::perspective::Perspective;
    use crate::shell::headless::Headless;
    use crate::tools::lab::Lab;
    use selvedge_textile::Place;

    fn set_hurst(window: &mut Headless) {
        let place = Place {
            table: "source",
            key: "hurst",
        };
        let lab = window.workbench.tools.get_mut::<Lab>().unwrap();
        lab.set(place, Some(0.3.into()), Moment::default());
    }

    fn brownian() -> Command {
        crate::bench::command::lab::Beginning::Example("brownian").into()
    }

    #[test]
    fn undo_in_the_lab_leaves_the_scene_alone_and_the_other_way_round() {
        let mut window = Headless::drawn();
        let begun_db = window.workbench.bench.document.tuning().gain_db;
        window.dispatch(Edit::MasterGain(-6.0));
        window.dispatch(ShowCommand::Perspective(Perspective::Cloth));
        window.pass(2);
        window.dispatch(brownian());
        window.pass(3);
        set_hurst(&mut window);
        let steps = window.workbench.steps();
        assert_eq!(steps.undo(), Some("Hurst exponent"));
        window.dispatch(Command::Undo);
        let steps = window.workbench.steps();
        assert_eq!(steps.redo(), Some("Hurst exponent"));
        for _ in 0..5 {
            window.dispatch(Command::Undo);
        }
        let bench = &window.workbench.bench;
        assert_eq!(bench.document.tuning().gain_db, -6.0, "it is out of sight");
        window.dispatch(ShowCommand::Perspective(Perspective::Explore));
        window.pass(2);
        window.dispatch(Command::Undo);
        assert_eq!(window.workbench.bench.document.tuning().gain_db, begun_db);
        window.dispatch(Command::Redo);
        assert_eq!(window.workbench.bench.document.tuning().gain_db, -6.0);
    }

    #[test]
    fn a_step_that_would_not_be_seen_is_brought_in_sight_before_it_is_taken_back() {
        let mut window = Headless::drawn();
        window.dispatch(Edit::RemoveCloth(0));
        window.dispatch(ShowCommand::Perspective(Perspective::Cloth));
        window.pass(2);
        window.dispatch(ShowCommand::Reveal(Pane::Collection));
        window.pass(1);
        assert!(!window.workbench.shell.shows(Pane::Workspace));
        let n_cloths = |window: &Headless| window.workbench.bench.document.scene().textiles.len();
        window.dispatch(Command::Undo);
        window.pass(1);
        assert_eq!(n_cloths(&window), 3, "nothing has changed yet");
        assert!(window.workbench.shell.shows(Pane::Workspace));
        let shown = window.workbench.bench.notices.shown();
        assert!(
            shown[0].text.contains("removed textile"),
            "{}",
            shown[0].text
        );
        window.dispatch(Command::Undo);
        assert_eq!(n_cloths(&window), 4);
    }

    #[test]
    fn the_history_goes_to_any_step_at_once() {
        let mut window = Headless::drawn();
        for gain_db in [-1.0, -2.0, -3.0] {
            window.dispatch(Edit::MasterGain(gain_db));
            window.dispatch(Edit::RemoveCloth(0));
        }
        let steps = window.workbench.steps();
        assert_eq!((steps.names.len(), steps.n_done), (6, 6));
        window.dispatch(Command::StepTo(1));
        let scene = |window: &Headless| {
            let document = &window.workbench.bench.document;
            (document.tuning().gain_db, document.scene().textiles.len())
        };
        assert_eq!(scene(&window), (-1.0, 4));
        window.dispatch(Command::StepTo(4));
        assert_eq!(scene(&window), (-2.0, 2));
        window.dispatch(Command::StepTo(99));
        assert_eq!(scene(&window), (-2.0, 2), "there is no such step");
    }
}
