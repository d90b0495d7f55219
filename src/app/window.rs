//! The window's state and its frame: inboxes are emptied, then everything is drawn from views that
//! do not change while they are drawn.

use std::collections::BTreeMap;
use std::fmt;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

use eframe::egui::{self, ColorImage, TextureFilter, TextureHandle, TextureOptions, Vec2};

use super::command::{DeviceCommand, FileCommand, Purpose};
use super::document::Document;
use super::error::AppError;
use super::history::Moment;
use super::opening::{Opened, Opening, open};
use super::panes::{Ask, Levels, Notices};
use super::pointer::PointerTap;
use super::theme::{self, ColourMap};
use super::view::{BridgeView, ClothPicture, LibraryDot, Live, SceneView};
use super::workspace::Trail;
use super::{frame, query, shortcuts};
use crate::engine::{Engine, EngineConfig, Notice, StopSwitch, TICK, TICKS_PER_S};
use crate::scene::LoadedScene;
use crate::tactile::Tuning;

/// The time between two frames while something moves: 30 frames a second.
pub(crate) const FRAME: Duration = Duration::from_nanos(33_333_333);

/// How a workbench is driven.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Drive {
    /// By an engine on a thread of its own, in real time.
    Live,
    /// By the toolkit's clock, on the caller's thread: the same every time. For tests and pictures.
    Stepped,
}

/// The window: a scene, an engine that feels it, and what is shown of both.
pub struct Workbench {
    pub(crate) document: Document,
    pub(crate) layout: Layout,
    pub(crate) transient: Transient,
    pub(crate) engine: Engine,
    pub(crate) switch: StopSwitch,
    pub(crate) is_stepped: bool,
    pub(crate) tap: Arc<Mutex<PointerTap>>,
    loaded: LoadedScene,
    library: Vec<LibraryDot>,
    pictures: BTreeMap<String, (TextureHandle, ClothPicture)>,
    ctx: egui::Context,
    now: Instant,
}

/// What is shown how. Not undoable.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Layout {
    /// The colours that stand for numbers.
    pub(crate) colour_map: ColourMap,
}

/// What is neither saved nor undoable.
#[derive(Debug, Default)]
pub(crate) struct Transient {
    /// Sentences for the user.
    pub(crate) notices: Notices,
    /// A path that is asked for.
    pub(crate) ask: Option<Ask>,
    /// What is typed in the field for a port.
    pub(crate) port: String,
    /// What the link was last opened to.
    pub(crate) target: Option<String>,
    /// A scene on its way.
    pub(crate) opening: Option<Opening>,
    /// The engine as it was seen last.
    pub(crate) live: Live,
    /// Where the display was.
    pub(crate) trail: Trail,
    /// How strong it felt.
    pub(crate) levels: Levels,
    /// The gesture that edits belong to.
    pub(crate) moment: Moment,
    /// A device that is shown though the engine has none: in pictures.
    pub(crate) pictured_bridge: Option<BridgeView>,
    /// Whether the next refusal to arm is expected.
    pub(crate) is_going_on: bool,
    interval: query::IntervalMeter,
    reference_db: Option<f64>,
}

impl Workbench {
    /// A workbench on the scene at `scene` (`None`: the one that the program ships), disarmed and
    /// without a device.
    ///
    /// # Errors
    /// The scene cannot be opened, or the engine cannot start.
    pub fn new(ctx: &egui::Context, scene: Option<&Path>, drive: Drive) -> Result<Self, AppError> {
        theme::install(ctx);
        let Opened {
            path,
            loaded,
            prepared,
            pictures,
            flaws,
        } = open(scene)?;
        let now = Instant::now();
        let is_stepped = drive == Drive::Stepped;
        let mut engine = if is_stepped {
            Engine::without_thread(
                EngineConfig {
                    scene: prepared,
                    on_news: None,
                },
                now,
            )?
        } else {
            let waker = ctx.clone();
            let on_news: Box<dyn Fn() + Send> =
                Box::new(move || waker.request_repaint_after(FRAME));
            Engine::start(EngineConfig {
                scene: prepared,
                on_news: Some(on_news),
            })?
        };
        let document = Document::new(
            loaded.scene().clone(),
            path.clone(),
            default_tuning(&loaded),
        );
        let mut workbench = Self {
            document,
            layout: Layout::default(),
            transient: Transient::default(),
            switch: engine.stop_switch(),
            is_stepped,
            tap: Arc::new(Mutex::new(PointerTap::new(engine.take_pointer()))),
            engine,
            library: Vec::new(),
            pictures: BTreeMap::new(),
            ctx: ctx.clone(),
            now,
            loaded: loaded.clone(),
        };
        for flaw in flaws {
            workbench.transient.notices.give(flaw);
        }
        workbench.show_scene(path, loaded, pictures);
        Ok(workbench)
    }

    /// Shows another scene; its pictures go to the graphics card once, here.
    pub(crate) fn show_scene(
        &mut self,
        path: Option<PathBuf>,
        loaded: LoadedScene,
        pictures: BTreeMap<String, (Arc<ColorImage>, Vec2)>,
    ) {
        let options = TextureOptions {
            mipmap_mode: Some(TextureFilter::Linear),
            ..TextureOptions::LINEAR_REPEAT
        };
        let upload = |(id, (image, tile_mm)): (String, (Arc<ColorImage>, Vec2))| {
            let handle = self
                .ctx
                .load_texture(format!("textile {id}"), image, options);
            let picture = ClothPicture {
                texture: handle.id(),
                tile_mm,
            };
            (id, (handle, picture))
        };
        let title = format!("{} – Selvedge", loaded.scene().name);
        self.ctx
            .send_viewport_cmd(egui::ViewportCommand::Title(title));
        self.pictures = pictures.into_iter().map(upload).collect();
        self.library = query::library_dots(&loaded);
        self.document = Document::new(loaded.scene().clone(), path, default_tuning(&loaded));
        self.loaded = loaded;
        self.transient.trail = Trail::default();
        self.transient.levels = Levels::default();
    }

    /// Empties the inboxes.
    fn take_news(&mut self, ctx: &egui::Context) {
        if self.is_stepped {
            self.step_engine(ctx);
        }
        if let Some(outcome) = self.transient.opening.as_ref().and_then(Opening::poll) {
            self.transient.opening = None;
            self.take_opened(outcome);
        }
        // At most as many notices as a frame can tell anybody about.
        for _ in 0..64 {
            let Some(notice) = self.engine.next_notice() else {
                break;
            };
            if matches!(notice, Notice::Refused(_))
                && std::mem::take(&mut self.transient.is_going_on)
            {
                continue;
            }
            let device = self.transient.target.as_deref().unwrap_or("The device");
            if let Some(sentence) = query::words(&notice, device) {
                self.transient.notices.give(sentence);
            }
        }
        let snapshot = self.engine.snapshot();
        let transient = &mut self.transient;
        let status = snapshot.link.and_then(|link| link.status);
        let interval_s = transient.interval.take(status.map(|s| (s.tick, s.dev_us)));
        let mut live = query::live_view(snapshot, interval_s);
        if live.bridge.is_none() {
            live.bridge.clone_from(&transient.pictured_bridge);
        }
        transient.reference_db = snapshot.compression_reference_db;
        let trail_moves = transient.trail.take(live.tick, live.centre);
        let levels_move = transient.levels.take(live.tick, &live.dots);
        transient.live = live;
        if trail_moves || levels_move {
            ctx.request_repaint_after(FRAME);
        }
        if !self.engine.is_running() {
            let words = "The engine has stopped and the device with it: save the scene and start \
                         the program again";
            self.transient.notices.give(words);
        }
    }

    /// Lets a stepped engine do the ticks that are due by the toolkit's clock.
    fn step_engine(&mut self, ctx: &egui::Context) {
        let due = ctx.input(|input| input.time) * TICKS_PER_S;
        while (self.transient.live.tick as f64) + 1.0 <= due {
            let Some(now) = self.engine.advance_ticks(1) else {
                return;
            };
            self.now = now;
            let tick = self.engine.snapshot().tick;
            if tick <= self.transient.live.tick {
                return;
            }
            self.transient.live.tick = tick;
        }
    }

    fn take_keys(&mut self, ctx: &egui::Context) {
        let moment = &mut self.transient.moment;
        ctx.input(|input| {
            moment.press += u64::from(input.pointer.any_pressed());
            moment.is_down = input.pointer.any_down();
            moment.t_s = input.time;
        });
        for command in shortcuts::pressed(ctx) {
            self.dispatch(ctx, command);
        }
    }

    /// The stamp of an event that arrives now.
    pub(crate) fn stamp(&self) -> Instant {
        if self.is_stepped {
            self.now + TICK / 2
        } else {
            Instant::now()
        }
    }

    /// The scene as panes draw it.
    pub(crate) fn scene_view(&self) -> SceneView {
        let pictures = self
            .pictures
            .iter()
            .map(|(id, (_, picture))| (id.clone(), *picture));
        query::scene_view(
            &self.document,
            &self.loaded,
            &self.library,
            &pictures.collect(),
            self.transient.reference_db,
        )
    }
}

/// What a test or another program may want to know of a workbench.
impl Workbench {
    /// Peak amplitudes [A40, A320] of every contactor after gains, before output limits, µm.
    pub fn amplitudes_um(&self) -> Vec<[f64; 2]> {
        self.transient
            .live
            .dots
            .iter()
            .map(|dot| dot.amplitude_um)
            .collect()
    }

    /// Gains and compression in force.
    pub fn tuning(&self) -> Tuning {
        self.document.tuning()
    }

    /// The scene's name.
    pub fn scene_name(&self) -> &str {
        &self.document.scene().name
    }

    /// Whether the scene differs from its file.
    pub fn is_edited(&self) -> bool {
        self.document.is_edited()
    }

    /// Whether high voltage is on, or about to be.
    pub fn is_armed(&self) -> bool {
        self.transient.live.is_armed()
    }

    /// Whether the device is ready to be armed.
    pub fn is_ready(&self) -> bool {
        let bridge = self.transient.live.bridge.as_ref();
        bridge.is_some_and(|bridge| bridge.phase == super::view::BridgePhase::Ready)
    }

    /// Whether everything was switched off and nothing was armed since.
    pub fn is_stopped(&self) -> bool {
        self.transient.live.is_stopped
    }

    /// The sentences that are shown.
    pub fn notices(&self) -> Vec<String> {
        self.transient
            .notices
            .shown()
            .iter()
            .map(|notice| notice.text.clone())
            .collect()
    }

    /// Connects to the emulator in this process, as the window does when it starts.
    pub fn connect_emulator(&mut self) {
        let ctx = self.ctx.clone();
        self.dispatch(&ctx, DeviceCommand::ConnectEmulator.into());
    }

    /// Opens the scene at this path, as the field does that asks for one.
    pub fn open_scene(&mut self, path: PathBuf) {
        let ctx = self.ctx.clone();
        self.dispatch(&ctx, FileCommand::Use(Purpose::OpenScene, path).into());
    }
}

impl eframe::App for Workbench {
    fn logic(&mut self, ctx: &egui::Context, _frame: &mut eframe::Frame) {
        self.take_keys(ctx);
        self.take_news(ctx);
    }

    fn ui(&mut self, ui: &mut egui::Ui, _frame: &mut eframe::Frame) {
        let wishes = frame::show(self, ui);
        if !wishes.is_empty() {
            // What was wished for shows in the next frame.
            ui.ctx().request_repaint();
        }
        let ctx = ui.ctx().clone();
        for command in wishes {
            self.dispatch(&ctx, command);
        }
    }

    fn on_exit(&mut self, _gl: Option<&eframe::glow::Context>) {
        self.switch.press();
    }

    fn clear_color(&self, visuals: &egui::Visuals) -> [f32; 4] {
        visuals.extreme_bg_color.to_normalized_gamma_f32()
    }
}

impl fmt::Debug for Workbench {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Workbench")
            .field("scene", &self.scene_name())
            .finish_non_exhaustive()
    }
}

fn default_tuning(loaded: &LoadedScene) -> Tuning {
    loaded.library().default_tuning()
}
