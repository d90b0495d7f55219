//! What the window knows for the moment: neither saved nor undoable.

use eframe::egui::Rect;

use crate::bench::background::Task;
use crate::bench::clips::Clips;
use crate::bench::folders::Folders;
use crate::bench::history::Moment;
use crate::bench::keep::Keeping;
use crate::bench::library_selection::LibrarySelection;
use crate::bench::mute_solo::MuteSolo;
use crate::bench::notices::Notices;
use crate::bench::opening::Opened;
use crate::bench::query::IntervalMeter;
use crate::bench::recording::Take;
use crate::bench::signals::history::History;
use crate::bench::sources::Sources;
use crate::bench::trail::Trail;
use crate::bench::view::{BridgeView, Hovered, Live};
use selvedge_device::FaultWords;

/// What is neither saved nor undoable.
#[derive(Debug, Default)]
pub(crate) struct Transient {
    /// Sentences for the user.
    pub notices: Notices,
    /// What the link was last opened to.
    pub target: Option<String>,
    /// Folders that the desktop is asked to show.
    pub folders: Folders,
    /// A scene on its way.
    pub opening: Option<Task<Box<Opened>>>,
    /// A recorded exploration on its way.
    pub reading: Option<Task<Take>>,
    /// A recorded exploration on its way into a file.
    pub saving: Option<Task<Take>>,
    /// New textiles on their way into the library.
    pub keeping: Keeping,
    /// A file for other programs on its way.
    pub clips: Clips,
    /// Tablets, and other programs that joined.
    pub sources: Sources,
    /// The engine as it was seen last.
    pub live: Live,
    /// Where the display was.
    pub(crate) trail: Trail,
    /// The last seconds.
    pub(crate) history: History,
    /// The textiles of the library that are selected.
    pub(crate) library_selection: LibrarySelection,
    /// What the pointer rests on.
    pub hovered: Hovered,
    /// What is muted and what is felt alone.
    pub(crate) mute_solo: MuteSolo,
    /// Whether recordings are replayed again and again.
    pub does_loop: bool,
    /// The gesture that edits belong to.
    pub moment: Moment,
    /// The part of the screen that showed the workspace last, points.
    pub ground: Option<Rect>,
    /// A device that is shown though the engine has none: in pictures.
    pub(crate) pictured_bridge: Option<BridgeView>,
    /// What goes wrong with the emulator that is connected; `None` for other devices.
    pub faults: Option<FaultWords>,
    /// Refusals to arm that are expected, since there is no device.
    pub(crate) n_expected_refusals: u32,
    /// The device's measured interval between frames.
    pub interval: IntervalMeter,
    /// The level that compression leaves alone, dB re 1 µm.
    pub reference_db: Option<f64>,
}
