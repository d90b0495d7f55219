//! The display that the panes look at, where a scene has more than one.

use crate::bench::Bench;
use crate::bench::trail::Trail;
use selvedge_engine::Command;

impl Bench {
    /// The display that the panes look at: its place in the scene's list.
    pub(crate) fn display(&self) -> usize {
        let n_displays = self.document.scene().displays.len();
        self.selection.display.min(n_displays.saturating_sub(1))
    }

    /// Lets the panes look at this display; what was felt of another is forgotten.
    pub(crate) fn choose_display(&mut self, display: usize) {
        if display == self.selection.display {
            return;
        }
        self.selection.display = display;
        self.past.look_back = None;
        self.past.trail = Trail::default();
        self.past.history.clear();
        self.send(Command::WatchDisplay(display));
        self.ctx.request_repaint();
    }

    /// The same for the one after it; the first after the last.
    pub(crate) fn choose_next_display(&mut self) {
        let n_displays = self.document.scene().displays.len();
        if n_displays < 2 {
            self.notices.give("This scene has one display");
        } else {
            self.choose_display((self.display() + 1) % n_displays);
        }
    }
}
