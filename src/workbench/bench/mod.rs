//! What the tools share: the document with its undo, commands, the views of scene and engine, the
//! library, recordings, settings, and work in the background.
//!
//! Knows neither the tools nor the window around them.

pub(crate) mod acts;
pub(crate) mod applied_gains;
pub(crate) mod arrays;
pub(crate) mod background;
pub(crate) mod chosen_display;
pub(crate) mod chosen_keys;
pub(crate) mod clips;
pub(crate) mod clock;
pub(crate) mod command;
pub(crate) mod device;
pub(crate) mod document;
pub(crate) mod edit;
pub(crate) mod editing;
pub(crate) mod error;
pub(crate) mod export;
pub(crate) mod felt_log;
pub(crate) mod files;
pub(crate) mod folders;
pub(crate) mod follow_sound;
pub(crate) mod free_places;
pub(crate) mod gain_set;
pub(crate) mod history;
pub(crate) mod keep;
pub(crate) mod keys;
pub(crate) mod latest;
pub(crate) mod library_acts;
pub(crate) mod library_entry;
pub(crate) mod library_levels;
pub(crate) mod library_selection;
pub(crate) mod library_shelf;
pub(crate) mod library_view;
pub(crate) mod library_work;
pub(crate) mod listening;
pub(crate) mod look_back;
pub(crate) mod marking;
pub(crate) mod mute_solo;
pub(crate) mod news;
pub(crate) mod notices;
pub(crate) mod on_finger;
pub(crate) mod opening;
pub(crate) mod overlays;
pub(crate) mod paint_display;
pub(crate) mod pane;
pub(crate) mod part;
pub(crate) mod perceptual_level;
pub(crate) mod perspective;
pub(crate) mod play;
pub(crate) mod preparing;
pub(crate) mod probe;
pub(crate) mod query;
pub(crate) mod recording;
pub(crate) mod recordings;
pub(crate) mod recovery;
pub(crate) mod rendering;
pub(crate) mod scene_views;
pub(crate) mod selection;
pub(crate) mod session;
pub(crate) mod settings;
pub(crate) mod signals;
pub(crate) mod sound;
pub(crate) mod source_change;
pub(crate) mod source_file;
pub(crate) mod sources;
pub(crate) mod stage;
pub(crate) mod state;
pub(crate) mod tool;
pub(crate) mod trail;
pub(crate) mod view;

use crate::bench::applied_gains::AppliedGains;
use crate::bench::arrays::Arrays;
use crate::bench::background::Executor;
use crate::bench::clock::Clock;
use crate::bench::command::Commands;
use crate::bench::document::Document;
use crate::bench::error::AppError;
use crate::bench::library_acts::LibraryActs;
use crate::bench::library_levels::LibraryLevels;
use crate::bench::library_selection::LibrarySelection;
use crate::bench::library_view::LibraryView;
use crate::bench::mute_solo::MuteSolo;
use crate::bench::notices::Notices;
use crate::bench::opening::{Opened, Origin, open};
use crate::bench::pane::Pane;
use crate::bench::preparing::Preparing;
use crate::bench::recording::Recordings;
use crate::bench::recovery::Recovery;
use crate::bench::selection::Selection;
use crate::bench::session::Hung;
use crate::bench::settings::{Settings, own_arrays, own_libraries, own_recordings, own_work};
use crate::bench::state::{
    DeviceState, EngineScene, Exploration, Files, InspectionCache, LibraryState, Past,
    PointerState, SessionState,
};
use crate::bench::trail::Trail;
use crate::bench::view::EngineView;
use crate::kit::theme;
use eframe::egui;
use selvedge_device::LogBound;
use selvedge_engine::{Command, Engine, EngineConfig};
use selvedge_render::scene::LoadedScene;
use std::path::Path;
use std::sync::Arc;
use std::time::{Duration, Instant};

/// The time between two frames while something moves: 30 frames a second.
pub(crate) const FRAME: Duration = Duration::from_nanos(33_333_333);

/// How much the log of links may take: five files of 1 MB.
pub(crate) const LOG_BOUND: LogBound = LogBound {
    bytes: 16_000_000,
    n_older: 4,
};

/// How a workbench is driven.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Drive {
    /// By an engine on a thread of its own, in real time, with the settings of the user.
    Live,
    /// Likewise before the public: settings are read and not kept, and neither work nor recordings
    /// are; a frame is drawn when the face of the stage wants one.
    OnStage,
    /// By the toolkit's clock, on the caller's thread, with the settings of a new user: the same
    /// every time. For tests and pictures.
    Stepped,
}

/// What tools share: a scene, an engine that feels it, and what is shown of both.
pub(crate) struct Bench {
    pub(crate) document: Document,
    /// What is kept per user.
    pub(crate) settings: Settings,
    /// What tools want of each other, of the document and of the device: done by the shell.
    pub(crate) commands: Commands,
    /// Sentences for the user.
    pub(crate) notices: Notices,
    /// The panes in sight.
    pub(crate) in_sight: Vec<Pane>,
    /// What is chosen in all views.
    pub(crate) selection: Selection,
    pub(crate) session: SessionState,
    pub(crate) pointer: PointerState,
    pub(crate) engine: Engine,
    /// The engine as it was seen last.
    pub(crate) live: EngineView,
    pub(crate) past: Past,
    pub(crate) engine_scene: EngineScene,
    pub(crate) inspection: InspectionCache,
    pub(crate) library: LibraryState,
    pub(crate) exploration: Exploration,
    pub(crate) files: Files,
    pub(crate) device: DeviceState,
    /// Where long work is done.
    pub(crate) executor: Executor,
    pub(crate) ctx: egui::Context,
    pub(crate) clock: Clock,
}

impl Bench {
    /// A bench on the scene at `scene` (`None`: the one that the program ships), disarmed and
    /// without a device.
    ///
    /// # Errors
    /// The scene cannot be opened, or the engine cannot start.
    pub(crate) fn new(
        ctx: &egui::Context,
        scene: Option<&Path>,
        drive: Drive,
    ) -> Result<Self, AppError> {
        theme::install(ctx);
        let origin = scene.map_or(Origin::Shipped, |path| Origin::File(path.to_owned()));
        let now = Instant::now();
        let is_stepped = drive == Drive::Stepped;
        let (settings, complaint) = settings_of(drive);
        let opened = open(origin, settings.preferences.rendering)?;
        let scene_serial = opened.prepared.serial();
        let config = EngineConfig {
            scene: opened.prepared,
            on_news: (drive == Drive::Live).then(|| waker(ctx)),
        };
        let engine = match drive {
            Drive::Stepped => {
                let mut engine = Engine::without_thread(config, now)?;
                engine.step_emulators();
                engine
            }
            Drive::Live | Drive::OnStage => Engine::start(config)?,
        };
        let loaded = opened.loaded;
        let library = Arc::clone(loaded.library());
        let mut bench = Self {
            document: document_of(&loaded, opened.path.as_deref()),
            settings,
            commands: Commands::new(),
            notices: Notices::default(),
            in_sight: Vec::new(),
            selection: Selection::default(),
            session: SessionState::default(),
            pointer: PointerState::default(),
            engine,
            live: EngineView::default(),
            past: Past::default(),
            inspection: InspectionCache::on(&loaded, 0, 0),
            engine_scene: EngineScene {
                loaded,
                serial: scene_serial,
                rendering: opened.rendering,
                preparing: Preparing::default(),
                applied_gains: AppliedGains::default(),
            },
            library: LibraryState {
                view: LibraryView::new(library, opened.library_view),
                levels: LibraryLevels::default(),
                selection: LibrarySelection::default(),
                acts: LibraryActs::default(),
            },
            exploration: Exploration::default(),
            files: Files::default(),
            device: DeviceState::default(),
            executor: if is_stepped {
                Executor::InLine
            } else {
                Executor::Threads(ctx.clone())
            },
            ctx: ctx.clone(),
            clock: Clock::new(is_stepped.then_some(now)),
        };
        bench.begin(drive, [complaint, opened.changed]);
        Ok(bench)
    }

    /// Takes up the settings and whatever else a new window begins with.
    fn begin(&mut self, drive: Drive, complaints: [Option<String>; 2]) {
        if drive != Drive::Stepped {
            self.log_links();
            self.read_arrays();
        }
        if drive == Drive::Live {
            self.library.acts.own_folder = own_libraries();
            if let Some(root) = own_recordings() {
                self.exploration.recordings = Recordings::in_folder(root);
            }
            if let Some(root) = own_work() {
                self.files.recovery = Recovery::in_folder(root);
            }
        }
        for complaint in complaints.into_iter().flatten() {
            self.notices.give(complaint);
        }
        let kept = &self.settings.preferences;
        self.ctx.set_zoom_factor(kept.zoom);
        keys::install(&self.ctx, &kept.keys);
        if !self.is_stepped() {
            self.ctx.set_theme(kept.theme);
        }
        self.selection.scale = kept.scales.amplitude;
        self.selection.spectrum = kept.scales.spectrum;
        self.selection.dot_style = kept.dots;
        self.selection.greys_below = kept.greys_below;
        self.selection.contactor = Some(FIRST_CONTACTOR);
        self.send(Command::Watch(FIRST_CONTACTOR));
        self.send(Command::SampleTicks(true));
        self.show_document();
    }

    fn read_arrays(&mut self) {
        let Some(folder) = own_arrays() else { return };
        let (arrays, flaws) = Arrays::in_folder(&folder);
        self.device.arrays = arrays;
        for flaw in flaws {
            self.notices.give(flaw);
        }
    }

    /// Shows another scene, and lets it be felt.
    pub(crate) fn show_scene(&mut self, opened: Opened) {
        self.engine_scene.serial = opened.prepared.serial();
        self.engine_scene.rendering = opened.rendering;
        if let Some(changed) = opened.changed {
            self.notices.give(changed);
        }
        self.send(Command::SetScene(Box::new(opened.prepared)));
        self.document = document_of(&opened.loaded, opened.path.as_deref());
        self.library.view =
            LibraryView::new(Arc::clone(opened.loaded.library()), opened.library_view);
        self.library.acts.listening = None;
        self.engine_scene.preparing = Preparing::default();
        self.engine_scene.loaded = opened.loaded;
        self.selection.mute_solo = MuteSolo::default();
        self.choose_display(0);
        self.past.trail = Trail::default();
        self.past.history.clear();
        self.library.selection = LibrarySelection::default();
        self.selection.cloth = None;
        self.inspection.n_scenes += 1;
        self.show_document();
        self.render_as_chosen();
    }

    /// What a scene that is new to the window needs.
    pub(crate) fn show_document(&mut self) {
        let title = format!("{} – Selvedge", self.document.scene().name);
        self.ctx
            .send_viewport_cmd(egui::ViewportCommand::Title(title));
        // A contactor mask outlasts a scene.
        let mask_alone = AppliedGains::default();
        self.engine_scene.applied_gains = mask_alone.after_scene(self.engine_scene.loaded.scene());
        self.send(Command::SetContactorMask(Vec::new()));
        self.scene_has_changed();
        self.send_gains();
        self.open_own_library();
    }

    /// What depends on the textiles and where they lie is made anew.
    pub(crate) fn scene_has_changed(&mut self) {
        let (loaded, view) = (&self.engine_scene.loaded, &self.library.view);
        self.library.levels.renew(loaded, view);
        let (n_scenes, n_edits) = (self.inspection.n_scenes, self.inspection.n_edits);
        self.inspection = InspectionCache::on(&self.engine_scene.loaded, n_scenes, n_edits + 1);
    }

    /// Whether the toolkit's clock drives the engine.
    pub(crate) fn is_stepped(&self) -> bool {
        self.clock.stepped_at.is_some()
    }

    /// Whether a session of an experiment is under way.
    pub(crate) fn has_session(&self) -> bool {
        self.session.active.is_some()
    }

    /// What the session that is under way hangs.
    pub(crate) fn hung(&self) -> Option<&Hung> {
        self.session.active.as_ref()?.hung.as_ref()
    }

    /// Whether a pane would tell what a session must not.
    pub(crate) fn is_veiled(&self, pane: Pane) -> bool {
        // The analysis has a cover of its own.
        let is_open = matches!(
            pane,
            Pane::Participant | Pane::Experimenter | Pane::Bridge | Pane::Analysis
        );
        self.has_session() && !is_open
    }

    /// Whether a pane is in sight.
    pub(crate) fn shows(&self, pane: Pane) -> bool {
        self.in_sight.contains(&pane)
    }

    /// Contactors of the first display.
    pub(crate) fn n_contactors(&self) -> usize {
        let first = self.document.scene().displays.first();
        first.map_or(0, |display| display.geometry.n_contactors())
    }
}

/// The contactor that is looked at closer until another is chosen: in the middle.
const FIRST_CONTACTOR: usize = 9;

/// The settings of a window that is driven so, and a sentence when they could not be read.
fn settings_of(drive: Drive) -> (Settings, Option<String>) {
    match drive {
        Drive::Stepped => (Settings::in_memory(), None),
        Drive::Live => Settings::of_user(),
        Drive::OnStage => {
            let (settings, complaint) = Settings::of_user();
            (settings.unwritten(), complaint)
        }
    }
}

/// Wakes the window when there is news, at most 30 times a second.
fn waker(ctx: &egui::Context) -> Box<dyn Fn() + Send> {
    let ctx = ctx.clone();
    Box::new(move || ctx.request_repaint_after(FRAME))
}

fn document_of(loaded: &LoadedScene, path: Option<&Path>) -> Document {
    let default_tuning = loaded.library().default_tuning();
    let path = path.map(Path::to_owned);
    Document::new(loaded.scene().clone(), path, default_tuning)
}
