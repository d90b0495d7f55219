//! What a tool is: state, work in the background and panes of its own around the bench that all
//! tools share.
//!
//! ```text
//! logic ─▶ results of work ─┐                      ┌▶ bench: document, selection, engine
//! ui ─▶ own state ──────────┴─▶ bench.commands ─▶ shell ─▶ every tool's `command`
//! ```
//!
//! A tool changes its own state where it stands. Only what can be undone, what reaches a device and
//! what one tool wants of another is a command.

use std::any::Any;
use std::path::PathBuf;

use eframe::egui::{Context, RawInput, Rect, Ui};

use crate::bench::Bench;
use crate::bench::command::{Command, Commands, Purpose};
use crate::bench::export::Exported;
use crate::bench::history::StepList;
use crate::bench::pane::Pane;
use crate::bench::recovery::Unsaved;
use crate::bench::settings::preferences::Preferences;
use crate::bench::stage::StagePicture;
use crate::bench::view::SceneView;
use crate::kit::view_transform::PointerGround;

/// What a tool is drawn with.
pub(crate) struct PaneContext<'a> {
    /// What tools share.
    pub(crate) bench: &'a mut Bench,
    /// The scene as every pane draws it in this frame.
    pub(crate) scene: &'a SceneView,
    /// What the user wants: done after the frame.
    pub(crate) commands: &'a mut Commands,
    /// Where the pointer feels, if a pane showed such a place.
    pub(crate) ground: &'a mut Option<PointerGround>,
    /// The tool that another one shows within its own view, if one is to be.
    pub(crate) guest: &'a mut Guest,
}

/// A tool that was taken out of the list, and its place there.
pub(crate) type Guest = Option<(usize, Box<dyn Tool>)>;

/// A tool of the window.
pub(crate) trait Tool: Any {
    /// The panes that it shows.
    fn panes(&self) -> &'static [Pane];

    /// Takes up what is kept per user. Once, before the first frame.
    fn begin(&mut self, _bench: &mut Bench) {}

    /// Takes the results of its work in the background, whether it is in sight or not. Once a
    /// frame, before anything is drawn.
    fn logic(&mut self, _bench: &mut Bench) {}

    /// Draws one of its panes.
    fn ui(&mut self, pane: Pane, ui: &mut Ui, context: &mut PaneContext<'_>);

    /// Draws what stands at the right end of the row of tabs while a pane of its is in front.
    fn corner(&mut self, _pane: Pane, _ui: &mut Ui, _context: &mut PaneContext<'_>) {}

    /// Shows windows of its own. Once a frame, after all panes.
    fn windows(&mut self, _ctx: &Context, _context: &mut PaneContext<'_>) {}

    /// Does its part of what the user wants; every tool hears every command.
    fn command(&mut self, _command: &Command, _bench: &mut Bench) {}

    /// Whether something of it lies over the panes that [`Command::Dismiss`] puts away.
    fn is_open(&self, _bench: &Bench) -> bool {
        false
    }

    /// Its own steps: undo acts on them while a pane of its is in use. `None`: on the scene's.
    fn steps(&self, _bench: &Bench) -> Option<StepList> {
        None
    }

    /// Takes steps back or brings them again until so many are done.
    fn step_to(&mut self, _n_done: usize, _bench: &mut Bench) {}

    /// What a pane shows now, as a table and a figure.
    ///
    /// # Errors
    /// There is nothing to export, and what to do about it.
    fn export(&mut self, _pane: Pane, _bench: &mut Bench) -> Result<Exported, &'static str> {
        Err("This pane shows no numbers to export")
    }

    /// What an export of it is called, without an ending, where its title will not do.
    fn export_name(&self) -> Option<String> {
        None
    }

    /// The path that a question for one begins with.
    fn known_path(&self, _purpose: Purpose) -> Option<PathBuf> {
        None
    }

    /// Forgets what belonged to the scene that was left for another.
    fn leave_scene(&mut self, _bench: &mut Bench) {}

    /// Work of its own that no file holds.
    fn unsaved(&self) -> Option<Unsaved> {
        None
    }

    /// Takes up such work, as [`Self::unsaved`] wrote it down.
    ///
    /// # Errors
    /// Why it cannot, in one line.
    fn restore(&mut self, _unsaved: &Unsaved, _bench: &mut Bench) -> Result<(), String> {
        Ok(())
    }

    /// Writes down what is kept per user.
    fn keep_preferences(&self, _preferences: &mut Preferences) {}
}

/// The bar at the bottom of the window, which stands in no tile.
pub(crate) trait Bar {
    /// Draws it in the width that there is.
    fn ui(&mut self, ui: &mut Ui, context: &mut PaneContext<'_>);

    /// What it shows now, as a table and a figure.
    ///
    /// # Errors
    /// There is nothing to export, and what to do about it.
    fn export(&mut self, bench: &mut Bench) -> Result<Exported, &'static str>;
}

/// What fills a window before the public, in place of header, panes and bar.
pub(crate) trait PublicFace: Any {
    /// Takes out of the input what the public may not do.
    fn filter(&self, input: &mut RawInput);

    /// Lets time pass. Once a frame, before anything is drawn.
    fn logic(&mut self, bench: &mut Bench);

    /// Draws it.
    fn ui(&mut self, ui: &mut Ui, context: &mut PaneContext<'_>);

    /// Where a press switches everything off without waiting for a frame, points.
    fn stop_area(&self) -> Option<Rect>;

    /// Somebody wants the window closed. Whether it may be.
    fn is_closed_by(&mut self, asks: bool, bench: &mut Bench) -> bool;

    /// The program ends: what is known of the visit is written.
    fn end(&mut self);

    /// Goes to a state, for a picture of it.
    fn go_to(&mut self, picture: StagePicture);
}

/// All tools of a window.
pub(crate) struct Tools(Vec<Box<dyn Tool>>);

impl Tools {
    /// These tools.
    pub(crate) fn new(tools: Vec<Box<dyn Tool>>) -> Self {
        Self(tools)
    }

    /// Every tool, in the order of the list.
    pub(crate) fn iter_mut(&mut self) -> impl Iterator<Item = &mut (dyn Tool + 'static)> {
        self.0.iter_mut().map(|tool| &mut **tool)
    }

    /// Every tool, in the order of the list.
    pub(crate) fn iter(&self) -> impl Iterator<Item = &(dyn Tool + 'static)> {
        self.0.iter().map(|tool| &**tool)
    }

    /// The tool that shows a pane.
    pub(crate) fn showing(&mut self, pane: Pane) -> Option<&mut (dyn Tool + 'static)> {
        self.iter_mut().find(|tool| tool.panes().contains(&pane))
    }

    /// Takes out the tool that shows a pane.
    pub(crate) fn take_out(&mut self, pane: Pane) -> Guest {
        let at = self.iter().position(|tool| tool.panes().contains(&pane))?;
        Some((at, self.0.remove(at)))
    }

    /// Puts a tool back that was taken out.
    pub(crate) fn put_back(&mut self, guest: Guest) {
        if let Some((at, tool)) = guest {
            self.0.insert(at, tool);
        }
    }

    /// The tool of this type.
    pub(crate) fn get<T: Tool>(&self) -> Option<&T> {
        self.iter()
            .find_map(|tool| (tool as &dyn Any).downcast_ref())
    }

    /// The tool of this type.
    #[cfg(test)]
    pub(crate) fn get_mut<T: Tool>(&mut self) -> Option<&mut T> {
        self.iter_mut()
            .find_map(|tool| (tool as &mut dyn Any).downcast_mut())
    }
}
