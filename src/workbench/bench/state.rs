//! What the bench holds, by subject. Neither saved nor undoable, but for the arrays of devices.

use std::ops::Range;

use eframe::egui::{Pos2, Rect};

use crate::bench::applied_gains::AppliedGains;
use crate::bench::arrays::Arrays;
use crate::bench::background::Task;
use crate::bench::clips::Clips;
use crate::bench::document::Document;
use crate::bench::folders::Folders;
use crate::bench::history::Moment;
use crate::bench::library_acts::LibraryActs;
use crate::bench::library_levels::LibraryLevels;
use crate::bench::library_selection::LibrarySelection;
use crate::bench::library_view::LibraryView;
use crate::bench::look_back::LookBack;
use crate::bench::opening::Opened;
use crate::bench::pane::Pane;
use crate::bench::preparing::Preparing;
use crate::bench::query::IntervalMeter;
use crate::bench::recording::{Recording, Recordings};
use crate::bench::recovery::Recovery;
use crate::bench::rendering::Rendering;
use crate::bench::session::SessionInSight;
use crate::bench::signals::history::History;
use crate::bench::sound::Sound;
use crate::bench::sources::Sources;
use crate::bench::trail::Trail;
use selvedge_device::FaultWords;
use selvedge_render::RenderScene;
use selvedge_render::array::ContactInspector;
use selvedge_render::scene::{LoadedScene, Scene};
use selvedge_textile::Uncertainty;

/// The scene as the engine has it.
pub(crate) struct EngineScene {
    /// With its textiles, and gains as they are felt.
    pub(crate) loaded: LoadedScene,
    /// Its serial number.
    pub(crate) serial: u64,
    /// How it is rendered; what the user chose may still be on its way.
    pub(crate) rendering: Rendering,
    /// An edited scene on its way.
    pub(crate) preparing: Preparing,
    /// The gains that the engine has.
    pub(crate) applied_gains: AppliedGains,
}

impl EngineScene {
    /// How far the levels of a placed textile may be off, where that is said.
    pub(crate) fn uncertainty(&self, index: usize) -> Option<&Uncertainty> {
        let known = self
            .loaded
            .textiles()
            .get(index)?
            .manifest()
            .uncertainty
            .as_ref();
        known.filter(|known| !known.levels.is_empty())
    }
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
    /// For a scene, the so manieth opened, after so many changes.
    pub(crate) fn on(loaded: &LoadedScene, n_scenes: u64, n_edits: u64) -> Self {
        let scene = RenderScene::of(loaded);
        Self {
            inspector: ContactInspector::new(&scene),
            scene,
            n_scenes,
            n_edits,
        }
    }
}

/// The libraries.
pub(crate) struct LibraryState {
    /// Their textiles, and their pictures as far as they were wanted.
    pub(crate) view: LibraryView,
    /// How strong those of the scene's library are.
    pub(crate) levels: LibraryLevels,
    /// Those that are selected.
    pub(crate) selection: LibrarySelection,
    /// What was done with libraries.
    pub(crate) acts: LibraryActs,
}

/// Explorations: where positions come from, and the one that can be replayed.
#[derive(Debug, Default)]
pub(crate) struct Exploration {
    /// Tablets, and other programs that joined.
    pub(crate) sources: Sources,
    /// All recordings.
    pub(crate) recordings: Recordings,
    /// The one that can be replayed.
    pub(crate) at_hand: Option<Recording>,
    /// The ticks of it that are replayed again and again, if not all.
    pub(crate) loop_within: Option<Range<u64>>,
    /// The ticks of it that are selected.
    pub(crate) selected: Option<Range<u64>>,
    /// The marker that is to be named.
    pub(crate) unnamed: Option<u64>,
    /// Whether it is replayed again and again.
    pub(crate) does_loop: bool,
}

/// Files under way.
#[derive(Debug, Default)]
pub(crate) struct Files {
    /// A scene on its way.
    pub(crate) opening: Option<Task<Box<Opened>>>,
    /// Work that no file holds, kept against a crash.
    pub(crate) recovery: Recovery,
    /// The document that becomes the scene once its textiles are there.
    pub(crate) restoring: Option<Document>,
    /// A path on its way into a file.
    pub(crate) saving: Option<Task<String>>,
    /// A file for other programs on its way.
    pub(crate) clips: Clips,
    /// Folders that the desktop is asked to show.
    pub(crate) folders: Folders,
}

/// The device, as far as the engine does not know it.
#[derive(Debug, Default)]
pub(crate) struct DeviceState {
    /// What the link was last opened to.
    pub(crate) target: Option<String>,
    /// What that of the second display was last opened to.
    pub(crate) second: Option<String>,
    /// The share of full scale that no amplitude exceeds whatever a profile allows.
    pub(crate) ceiling: Option<f64>,
    /// What devices are taken to drive.
    pub(crate) arrays: Arrays,
    /// What goes wrong with the emulator that is connected; `None` for other devices.
    pub(crate) faults: Option<FaultWords>,
    /// Why the last device was refused, lost or stopped, in one line; nothing since it was armed.
    pub(crate) trouble: Option<String>,
    /// The device's measured interval between frames.
    pub(crate) interval: IntervalMeter,
    /// What the log of links was told.
    pub(crate) felt_log: FeltLog,
    /// The sound of what is felt.
    pub(crate) sound: Sound,
    /// The stylus that drives it in place of the array, in a line.
    pub(crate) stylus: Option<String>,
    /// The cloth that hangs and is felt in place of the scene, in a line.
    pub(crate) cloth: Option<String>,
}

/// What was felt lately.
#[derive(Debug, Default)]
pub(crate) struct Past {
    /// Where the display was.
    pub(crate) trail: Trail,
    /// Whether a face has a pace of its own at which the trail is drawn.
    pub(crate) is_paced: bool,
    /// The last minutes.
    pub(crate) history: History,
    /// The tick of them that every view shows in place of what is felt now.
    pub(crate) look_back: Option<LookBack>,
}

/// What the pointer does.
#[derive(Debug, Default)]
pub(crate) struct PointerState {
    /// The gesture that edits belong to.
    pub(crate) moment: Moment,
    /// The pane that was pressed or brought to the front last: undo acts on what it shows.
    pub(crate) pane_in_use: Option<Pane>,
    /// The part of the screen where it felt last, points.
    pub(crate) ground: Option<Rect>,
    /// Where fingers were before this frame that feel nothing, because others hold the displays.
    pub(crate) strays: Vec<Pos2>,
}

/// The session of an experiment, as far as others need to know of it.
#[derive(Debug, Default)]
pub(crate) struct SessionState {
    /// The one that is active.
    pub(crate) active: Option<SessionInSight>,
    /// Whether a participant's view has a window of its own.
    pub(crate) has_window: bool,
}

/// What the log of links was told of what is felt.
#[derive(Debug, Default)]
pub(crate) struct FeltLog {
    pub(crate) scene: Option<Scene>,
    /// The hash of a path, being worked out.
    pub(crate) hashing: Option<Task<String>>,
}
