//! What the tools share: the document with its undo, commands, the views of scene and engine, the
//! library, recordings, settings, and work in the background.
//!
//! Knows neither the tools nor the window around them.

pub(crate) mod amplitude;
pub(crate) mod applied_gains;
pub(crate) mod arrays;
pub(crate) mod background;
pub(crate) mod clips;
pub(crate) mod command;
pub(crate) mod device;
pub(crate) mod document;
pub(crate) mod edit;
pub(crate) mod editing;
pub(crate) mod error;
pub(crate) mod export;
pub(crate) mod files;
pub(crate) mod folders;
pub(crate) mod follower;
pub(crate) mod free_places;
pub(crate) mod history;
pub(crate) mod job;
pub(crate) mod keep;
pub(crate) mod keys;
pub(crate) mod latest;
pub(crate) mod library_selection;
pub(crate) mod library_view;
pub(crate) mod mute_solo;
pub(crate) mod news;
pub(crate) mod notices;
pub(crate) mod opening;
pub(crate) mod overlays;
pub(crate) mod pane;
pub(crate) mod perceptual_level;
pub(crate) mod perspective;
pub(crate) mod play;
pub(crate) mod preparing;
pub(crate) mod probe;
pub(crate) mod query;
pub(crate) mod recording;
pub(crate) mod rendering;
pub(crate) mod selection;
pub(crate) mod session;
pub(crate) mod settings;
pub(crate) mod signals;
pub(crate) mod source_file;
pub(crate) mod sources;
pub(crate) mod task;
pub(crate) mod tool;
pub(crate) mod trail;
pub(crate) mod transient;
pub(crate) mod view;

use crate::bench::applied_gains::AppliedGains;
use crate::bench::arrays::Arrays;
use crate::bench::background::Executor;
use crate::bench::command::Commands;
use crate::bench::document::Document;
use crate::bench::error::AppError;
use crate::bench::library_view::LibraryView;
use crate::bench::opening::{Opened, Origin, open};
use crate::bench::pane::Pane;
use crate::bench::preparing::Preparing;
use crate::bench::recording::Take;
use crate::bench::rendering::Rendering;
use crate::bench::selection::Selection;
use crate::bench::session::SessionInSight;
use crate::bench::settings::{Settings, own_arrays, own_libraries, session_log};
use crate::bench::trail::Trail;
use crate::bench::transient::Transient;
use crate::bench::view::{LibraryDot, Marks, SceneView};
use crate::kit::theme;
use eframe::egui;
use selvedge_device::{LogBound, SessionLog};
use selvedge_engine::{Command, Engine, EngineConfig, Recording, StopSwitch, TICK};
use selvedge_render::RenderScene;
use selvedge_render::array::ContactInspector;
use selvedge_render::scene::LoadedScene;
use std::path::Path;
use std::sync::Arc;
use std::time::{Duration, Instant};

/// The time between two frames while something moves: 30 frames a second.
pub(crate) const FRAME: Duration = Duration::from_nanos(33_333_333);

/// How much the log of links may take: five files of 1 MB.
const LOG_BOUND: LogBound = LogBound {
    bytes: 1_000_000,
    n_older: 4,
};

/// How a workbench is driven.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Drive {
    /// By an engine on a thread of its own, in real time, with the settings of the user.
    Live,
    /// By the toolkit's clock, on the caller's thread, with the settings of a new user: the same
    /// every time. For tests and pictures.
    Stepped,
}

/// What tools share: a scene, an engine that feels it, and what is shown of both.
pub(crate) struct Bench {
    pub(crate) document: Document,
    /// What is kept per user.
    pub(crate) settings: Settings,
    /// What devices are taken to drive.
    pub(crate) arrays: Arrays,
    /// What tools want of each other, of the document and of the device: done by the shell.
    pub(crate) commands: Commands,
    /// The panes in sight.
    pub(crate) in_sight: Vec<Pane>,
    /// What all views share.
    pub(crate) workspace: Selection,
    pub(crate) transient: Transient,
    pub(crate) engine: Engine,
    pub(crate) switch: StopSwitch,
    pub(crate) is_stepped: bool,
    /// Where long work is done.
    pub(crate) executor: Executor,
    /// The exploration that can be replayed.
    pub(crate) take: Option<Take>,
    /// A recording that has just ended, until a tool takes it or it becomes the one at hand.
    pub(crate) ended_recording: Option<Recording>,
    /// The session of an experiment that is active.
    pub(crate) session: Option<SessionInSight>,
    /// Whether a participant's view has a window of its own.
    pub(crate) has_participants_window: bool,
    /// The scene as the engine has it: with its textiles, and gains as they are felt.
    pub(crate) loaded: LoadedScene,
    /// The serial number of that scene.
    pub(crate) scene_serial: u64,
    /// How that scene is rendered; what the user chose may still be on its way.
    pub(crate) rendering: Rendering,
    pub(crate) preparing: Preparing,
    pub(crate) felt: AppliedGains,
    pub(crate) library_view: LibraryView,
    pub(crate) library: Vec<LibraryDot>,
    pub(crate) inspection: InspectionCache,
    pub(crate) ctx: egui::Context,
    pub(crate) now: Instant,
}

/// What plots look at a contactor with.
pub(crate) struct InspectionCache {
    /// The scene as rendering sees it.
    pub(crate) scene: RenderScene,
    /// What a contactor feels of it.
    pub(crate) inspector: ContactInspector,
    /// Scenes that were opened.
    pub(crate) n_scenes: u64,
    /// Changes of any scene that need another inspector.
    pub(crate) n_edits: u64,
}

impl InspectionCache {
    fn on(loaded: &LoadedScene, n_scenes: u64, n_edits: u64) -> Self {
        let scene = RenderScene::of(loaded);
        Self {
            inspector: ContactInspector::new(&scene),
            scene,
            n_scenes,
            n_edits,
        }
    }
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
        let (settings, complaint) = if is_stepped {
            (Settings::in_memory(), None)
        } else {
            Settings::of_user()
        };
        let opened = open(origin, settings.preferences.rendering)?;
        let scene_serial = opened.prepared.serial();
        let config = EngineConfig {
            scene: opened.prepared,
            on_news: (!is_stepped).then(|| waker(ctx)),
        };
        let engine = if is_stepped {
            Engine::without_thread(config, now)?
        } else {
            Engine::start(config)?
        };
        let loaded = opened.loaded;
        let mut bench = Self {
            document: document_of(&loaded, opened.path.as_deref()),
            commands: Commands::new(),
            in_sight: Vec::new(),
            arrays: Arrays::default(),
            workspace: Selection::default(),
            transient: Transient::default(),
            switch: engine.stop_switch(),
            is_stepped,
            executor: if is_stepped {
                Executor::InLine
            } else {
                Executor::Threads(ctx.clone())
            },
            engine,
            take: None,
            ended_recording: None,
            session: None,
            has_participants_window: false,
            scene_serial,
            rendering: opened.rendering,
            preparing: Preparing::new(opened.cache, opened.rendering),
            felt: AppliedGains::default(),
            library_view: LibraryView::new(Arc::clone(loaded.library()), opened.library_view),
            library: Vec::new(),
            inspection: InspectionCache::on(&loaded, 0, 0),
            settings,
            ctx: ctx.clone(),
            now,
            loaded,
        };
        bench.begin(complaint);
        Ok(bench)
    }

    /// Takes up the settings and whatever else a new window begins with.
    fn begin(&mut self, complaint: Option<String>) {
        if !self.is_stepped {
            self.transient.keeping.own_folder = own_libraries();
            self.log_links();
            self.read_arrays();
        }
        if let Some(complaint) = complaint {
            self.transient.notices.give(complaint);
        }
        let kept = &self.settings.preferences;
        self.ctx.set_zoom_factor(kept.zoom);
        if !self.is_stepped {
            self.ctx.set_theme(kept.theme);
        }
        self.workspace.scale = kept.amplitude;
        self.workspace.dot_style = kept.dots;
        self.workspace.greys_below = kept.greys_below;
        self.workspace.contactor = Some(FIRST_CONTACTOR);
        self.send(Command::Watch(FIRST_CONTACTOR));
        self.send(Command::SampleTicks(true));
        self.show_document();
    }

    /// Lets every link to a device be logged in the user's own folder.
    fn log_links(&mut self) {
        let Some(path) = session_log() else { return };
        match SessionLog::append(&path, Some(LOG_BOUND)) {
            Ok(log) => self.engine.log_links_to(log),
            Err(error) => self.transient.notices.give(error.to_string()),
        }
    }

    fn read_arrays(&mut self) {
        let Some(folder) = own_arrays() else { return };
        let (arrays, flaws) = Arrays::in_folder(&folder);
        self.arrays = arrays;
        for flaw in flaws {
            self.transient.notices.give(flaw);
        }
    }

    /// Shows another scene, and lets it be felt.
    pub(crate) fn show_scene(&mut self, opened: Opened) {
        self.scene_serial = opened.prepared.serial();
        self.rendering = opened.rendering;
        self.send(Command::SetScene(Box::new(opened.prepared)));
        self.document = document_of(&opened.loaded, opened.path.as_deref());
        self.library_view =
            LibraryView::new(Arc::clone(opened.loaded.library()), opened.library_view);
        self.preparing = Preparing::new(opened.cache, opened.rendering);
        self.loaded = opened.loaded;
        self.transient.mute_solo = mute_solo::MuteSolo::default();
        self.transient.trail = Trail::default();
        self.transient.history.clear();
        self.transient.library_selection = library_selection::LibrarySelection::default();
        self.workspace.cloth = None;
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
        self.felt = mask_alone.after_scene(self.loaded.scene());
        self.send(Command::SetContactorMask(Vec::new()));
        self.scene_has_changed();
        self.tell_gains();
    }

    /// What depends on the textiles and where they lie is made anew.
    pub(crate) fn scene_has_changed(&mut self) {
        self.library = query::library_dots(&self.loaded, &self.library_view);
        let (n_scenes, n_edits) = (self.inspection.n_scenes, self.inspection.n_edits);
        self.inspection = InspectionCache::on(&self.loaded, n_scenes, n_edits + 1);
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

    /// The stamp of an event that arrives now.
    pub(crate) fn stamp(&self) -> Instant {
        if self.is_stepped {
            self.now + TICK / 2
        } else {
            Instant::now()
        }
    }

    /// The scene as panes draw it; textiles in it want their pictures.
    pub(crate) fn scene_view(&mut self) -> SceneView {
        let placed = &self.document.scene().textiles;
        for cloth in placed {
            self.library_view.want(&cloth.id);
        }
        for flaw in self.library_view.work(&self.ctx, self.is_stepped) {
            self.transient.notices.give(flaw);
        }
        let mut view = query::scene_view(
            &self.document,
            &self.library_view,
            &self.library,
            &self.transient.mute_solo,
            self.transient.reference_db,
        );
        view.picked = Arc::clone(&self.transient.library_selection.0);
        view.marks = Marks {
            cloth: self.workspace.cloth,
            hovered: self.transient.hovered,
        };
        view
    }
}

/// The contactor that is looked at closer until another is chosen: in the middle.
const FIRST_CONTACTOR: usize = 9;

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
