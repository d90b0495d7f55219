//! From pane to pane by keys: a pane that has the focus as a whole is framed, and Tab goes on to
//! what it holds; one pane may stand alone.

use eframe::egui::{Id, Rect, Role, Sense, Stroke, StrokeKind, Ui, WidgetInfo};
use egui_tiles::Tree;

use crate::bench::keys::pane_focus;
use crate::bench::pane::Pane;
use crate::kit::theme::Palette;
use crate::shell::arrangement;
use crate::shell::state::PaneFocus;
use crate::shell::window::Workbench;

/// Panes whose upper edges are no further apart stand in one row, points.
const ROW: f32 = 40.0;

impl PaneFocus {
    /// Gives a pane the focus if it is the one that is to have it. Before anything in it is drawn.
    pub(crate) fn take(&mut self, ui: &Ui, pane: Pane) {
        if self.pane != Some(pane) {
            return;
        }
        let rect = ui.max_rect();
        let response = ui.interact(rect, pane_focus(pane), Sense::focusable_noninteractive());
        response.widget_info(|| WidgetInfo::labeled(Role::Pane, true, pane.title()));
        if std::mem::take(&mut self.is_wanted) {
            response.request_focus();
        } else if !response.has_focus() {
            self.pane = None;
        }
    }

    /// Frames the pane that has the focus. Once all of it is drawn.
    pub(crate) fn frame(self, ui: &Ui, rect: Rect, pane: Pane) {
        if self.pane == Some(pane) {
            frame_pane(ui, rect);
        }
    }
}

/// Frames a pane.
pub(crate) fn frame_pane(ui: &Ui, rect: Rect) {
    let edge = Stroke::new(1.5, Palette::in_ui(ui).selection);
    let inside = rect.shrink(1.0);
    ui.painter()
        .rect_stroke(inside, 2, edge, StrokeKind::Inside);
}

impl Workbench {
    /// Puts the focus on the pane in sight that is so many further in reading order.
    pub(crate) fn walk_panes(&mut self, by: i8) {
        let order = reading_order(&self.shell.tree);
        let from = self.shell.focus.pane.or(self.bench.pointer.pane_in_use);
        let place = from.and_then(|from| order.iter().position(|pane| *pane == from));
        let n = order.len();
        let next = match place {
            Some(place) if by < 0 => place + n - 1,
            Some(place) => place + 1,
            None => 0,
        };
        let Some(pane) = order.get(next % n.max(1)).copied() else {
            return;
        };
        self.shell.focus = PaneFocus {
            pane: Some(pane),
            is_wanted: true,
        };
        self.bench.pointer.pane_in_use = Some(pane);
    }

    /// Shows a pane, or the one in use, alone; all again if one is alone.
    pub(crate) fn maximise(&mut self, pane: Option<Pane>) {
        if self.shell.whole.is_some() {
            return self.shell.restore_panes();
        }
        let in_use = pane.or(self.bench.pointer.pane_in_use);
        let pane = in_use.filter(|pane| self.shell.shows(*pane));
        let pane = pane.unwrap_or(Pane::Workspace);
        if self.shell.shows(pane) {
            let alone = Tree::new_tabs(Id::unique("alone"), vec![pane]);
            self.shell.whole = Some(std::mem::replace(&mut self.shell.tree, alone));
        }
    }
}

/// The panes in sight, row by row from the left.
fn reading_order(tree: &Tree<Pane>) -> Vec<Pane> {
    let place = |pane: Pane| {
        let tile = arrangement::tile_of(tree, pane)?;
        let rect: Rect = tree.tiles.rect(tile)?;
        Some(((rect.top() / ROW).round(), rect.left()))
    };
    let mut shown: Vec<Pane> = Pane::ALL
        .into_iter()
        .filter(|pane| arrangement::is_shown(tree, *pane))
        .collect();
    shown.sort_by(|one, other| {
        let [one, other] = [*one, *other].map(|pane| place(pane).unwrap_or_default());
        one.0.total_cmp(&other.0).then(one.1.total_cmp(&other.1))
    });
    shown
}

#[cfg(test)]
mod tests {
    use eframe::egui::{Key, Memory, Modifiers};

    use super::*;
    use crate::bench::command::ShowCommand;
    use crate::bench::perspective::Perspective;
    use crate::shell::headless::Headless;

    fn focused(window: &Headless) -> Option<Pane> {
        let id = window.ctx.memory(Memory::focused)?;
        Pane::ALL.into_iter().find(|pane| pane_focus(*pane) == id)
    }

    #[test]
    fn f6_walks_all_panes_in_sight_and_back() {
        let mut window = Headless::drawn();
        let n_shown = window.workbench.bench.in_sight.len();
        let mut walked = Vec::new();
        for _ in 0..n_shown {
            window.press(Modifiers::NONE, Key::F6);
            walked.push(focused(&window).unwrap());
        }
        let mut unique = walked.clone();
        unique.sort_unstable();
        unique.dedup();
        assert_eq!(unique.len(), n_shown, "{walked:?}");
        window.press(Modifiers::NONE, Key::F6);
        assert_eq!(focused(&window), Some(walked[0]), "round");
        window.press(Modifiers::SHIFT, Key::F6);
        assert_eq!(focused(&window), walked.last().copied());
        window.press(Modifiers::NONE, Key::Space);
        assert!(
            window.workbench.bench.live.play.is_playing,
            "Space still plays"
        );
        window.press(Modifiers::NONE, Key::Tab);
        assert_eq!(focused(&window), None, "Tab goes into the pane");
        assert!(window.ctx.memory(Memory::focused).is_some());
    }

    #[test]
    fn a_pane_alone_fills_the_window_and_all_come_back_as_they_were() {
        let mut window = Headless::drawn();
        let before = window.workbench.shell.tree.clone();
        window.dispatch(ShowCommand::Maximise(Some(Pane::Tuning)));
        window.pass(2);
        assert_eq!(window.workbench.bench.in_sight, [Pane::Tuning]);
        window.workbench.keep_arrangement();
        window.dispatch(ShowCommand::Maximise(None));
        window.pass(2);
        assert_eq!(window.workbench.shell.tree, before);
        window.dispatch(ShowCommand::Maximise(Some(Pane::Tuning)));
        window.pass(1);
        window.dispatch(ShowCommand::Reveal(Pane::Why));
        window.pass(2);
        let in_sight = &window.workbench.bench.in_sight;
        assert!(in_sight.contains(&Pane::Why) && in_sight.contains(&Pane::Workspace));
        window.dispatch(ShowCommand::Maximise(Some(Pane::Why)));
        window.dispatch(ShowCommand::Perspective(Perspective::Cloth));
        window.pass(2);
        window.dispatch(ShowCommand::Perspective(Perspective::Explore));
        window.pass(2);
        assert!(
            window.workbench.bench.shows(Pane::Workspace),
            "none is lost"
        );
    }
}
