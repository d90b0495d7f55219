//! What the window around the tools knows for the moment: which pane stands where, what is asked.

use std::path::PathBuf;
use std::sync::atomic::AtomicBool;
use std::sync::{Arc, Mutex};

use eframe::egui::{Pos2, Vec2};
use egui_tiles::Tree;

use crate::bench::background::Task;
use crate::bench::export::write::Kind;
use crate::bench::export::{Exportable, Exported};
use crate::bench::opening::Origin;
use crate::bench::pane::Pane;
use crate::bench::perspective::Perspective;
use crate::bench::recovery::Part;
use crate::bench::tool::Bar;
use crate::shell::arrangement;
use crate::shell::ask::Ask;
use crate::shell::dialogs::Dialogs;
use crate::shell::guide::Reading;
use crate::shell::help::KeyList;
use crate::shell::palette::Palette;
use crate::shell::pointer::PointerTap;
use selvedge_render::scene::Arrangement;

/// Arrangements that are not in sight.
#[derive(Default)]
pub(crate) struct Resting {
    /// Those of the other perspectives, as far as they were shown.
    pub(crate) of_perspectives: [Option<Tree<Pane>>; Perspective::ALL.len()],
    /// That of the scene as it was taken up last.
    pub(crate) of_scene: Option<Arrangement>,
}

/// The window around the tools.
pub(crate) struct Shell {
    /// Which pane stands where.
    pub(crate) tree: Tree<Pane>,
    /// Arrangements that are not in sight.
    pub(crate) resting: Resting,
    /// What stands at the bottom.
    pub(crate) bar: Box<dyn Bar>,
    /// The size of everything between header and timeline, points.
    pub(crate) size: Vec2,
    /// Where the desktop asks for paths.
    pub(crate) dialogs: Dialogs,
    /// A path that is asked for in the window.
    pub(crate) ask: Option<Ask>,
    /// What waits for an answer to "save changes?".
    pub(crate) question: Option<Question>,
    /// What is known of the keyboard.
    pub(crate) keyboard: Keyboard,
    /// Whether the window may close without another question.
    pub(crate) may_close: bool,
    /// Set when the program is told to end, with nobody there to be asked.
    pub(crate) ends: Arc<AtomicBool>,
    /// What lies over the panes to be read or searched.
    pub(crate) cover: Option<Cover>,
    /// All panes, while one of them stands alone.
    pub(crate) whole: Option<Tree<Pane>>,
    /// The pane that has the focus as a whole.
    pub(crate) focus: PaneFocus,
    /// Whether the window was told to fill the screen.
    pub(crate) fills_screen: bool,
    /// What is being exported.
    pub(crate) exports: Exports,
    /// Motion that gives way to the pointer, as long as it does.
    pub(crate) start_motion: Option<StartMotion>,
    /// How far the tour is, while it is taken.
    pub(crate) tour: Option<Tour>,
    /// Scenes that tools have heard of.
    pub(crate) n_scenes: u64,
    /// How often each pane was drawn.
    pub(crate) n_drawn: [u64; Pane::ALL.len()],
    /// Where the pointer's movements go to the engine.
    pub(crate) tap: Arc<Mutex<PointerTap>>,
}

impl Shell {
    /// The window of a new user; `tap` takes the pointer's movements, `bar` stands at the bottom.
    pub(crate) fn new(tap: PointerTap, dialogs: Dialogs, bar: Box<dyn Bar>) -> Self {
        Self {
            tree: arrangement::default_tree(Vec2::ZERO),
            resting: Resting::default(),
            bar,
            size: Vec2::ZERO,
            dialogs,
            ask: None,
            question: None,
            keyboard: Keyboard::default(),
            may_close: false,
            ends: Arc::default(),
            cover: None,
            whole: None,
            focus: PaneFocus::default(),
            fills_screen: false,
            exports: Exports::default(),
            start_motion: None,
            tour: None,
            n_scenes: 0,
            n_drawn: [0; Pane::ALL.len()],
            tap: Arc::new(Mutex::new(tap)),
        }
    }

    /// Whether a pane is in sight.
    pub(crate) fn shows(&self, pane: Pane) -> bool {
        arrangement::is_shown(&self.tree, pane)
    }

    /// Whether something lies over the panes that wants an answer.
    pub(crate) fn is_covered(&self) -> bool {
        self.ask.is_some() || self.question.is_some() || self.cover.is_some()
    }

    /// Puts away what lies over the panes.
    pub(crate) fn uncover(&mut self) {
        self.ask = None;
        self.exports.seen = None;
        self.question = None;
        self.cover = None;
    }

    /// Whether the next key is to be given to an act.
    pub(crate) fn awaits_key(&self) -> bool {
        matches!(&self.cover, Some(Cover::Keys(list)) if list.awaits.is_some())
    }

    /// Gives no key to the act that waits for one; whether one did.
    pub(crate) fn leave_key(&mut self) -> bool {
        let Some(Cover::Keys(list)) = &mut self.cover else {
            return false;
        };
        list.awaits.take().is_some()
    }

    /// Shows all panes again, if one stands alone.
    pub(crate) fn restore_panes(&mut self) {
        if let Some(whole) = self.whole.take() {
            self.tree = whole;
        }
    }
}

/// What lies over the panes to be read or searched.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum Cover {
    /// The list of keys.
    Keys(KeyList),
    /// The field that finds everything by its name.
    Palette(Palette),
    /// The guide.
    Guide(Reading),
}

/// The pane that has the focus as a whole: from it Tab goes to what it holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) struct PaneFocus {
    pub(crate) pane: Option<Pane>,
    /// Whether it is yet to be given the focus.
    pub(crate) is_wanted: bool,
}

/// What is known of the keyboard.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Keyboard {
    /// Whether text was being typed at the end of the last frame.
    pub(crate) was_typing: bool,
    /// Since when none of several windows has had it, s.
    pub(crate) left_since_s: Option<f64>,
}

/// How far the tour is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Tour {
    /// The step, from 0.
    pub(crate) step: usize,
    /// What was so when it began.
    pub(crate) begun: Begun,
    /// Whether a device was armed in it.
    pub(crate) was_armed: bool,
}

/// What was so when a step of the tour began.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Begun {
    /// The contactor that was looked at.
    pub(crate) contactor: Option<usize>,
    /// Steps that were done and not taken back.
    pub(crate) n_done: usize,
}

/// Motion that gives way to the pointer.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct StartMotion {
    /// Where the pointer was first seen.
    pub(crate) seen: Option<Pos2>,
}

/// What is being exported.
#[derive(Debug, Default)]
pub(crate) struct Exports {
    /// What was seen when it was asked for, while its path is.
    pub seen: Option<(Exportable, Exported)>,
    /// Where the last export went, and as what.
    pub last: Option<(PathBuf, Kind)>,
    /// Files on their way, and tables to be copied.
    pub(crate) tasks: Vec<Task<Done>>,
}

/// What an export ends with.
#[derive(Debug)]
pub(crate) enum Done {
    /// A table to be copied.
    Table(String),
    /// A file, and the words for it.
    Written(String),
}

/// What is asked before anything is lost.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Question {
    /// What waits for the answer.
    pub(crate) after: After,
    /// What would be lost.
    pub(crate) parts: Vec<Part>,
}

/// What was asked for when there was something to save first.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum After {
    /// Close the window.
    Close,
    /// Open a scene.
    Open(Origin),
}
