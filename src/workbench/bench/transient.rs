//! What the window knows for the moment: neither saved nor undoable.

use eframe::egui::Rect;

use crate::bench::clips::Clips;
use crate::bench::folders::Folders;
use crate::bench::history::Moment;
use crate::bench::job::Job;
use crate::bench::keep::Keeping;
use crate::bench::mute_solo::MuteSolo;
use crate::bench::notices::Notices;
use crate::bench::opening::Opening;
use crate::bench::query::IntervalMeter;
use crate::bench::recording::Take;
use crate::bench::signals::history::History;
use crate::bench::sources::Sources;
use crate::bench::view::{BridgeView, Hovered, Live};
use crate::tools::accuracy::AccuracyWatch;
use crate::tools::bridge::actuators::PlantPeek;
use crate::tools::bridge::fault_bench::FaultBench;
use crate::tools::bridge::ports::Ports;
use crate::tools::collection::Collection;
use crate::tools::compare::Comparison;
use crate::tools::lab::Lab;
use crate::tools::lab::view::pictures::LabPictures;
use crate::tools::picture::Picturing;
use crate::tools::picture::view::cards::PictureTextures;
use crate::tools::response::curves::Curves;
use crate::tools::spectra::contact::ContactSpectrogram;
use crate::tools::spectra::drive::DriveSpectrogram;
use crate::tools::spectra::spatial::SpatialSpectra;
use crate::tools::spectra::wave::WaveScale;
use crate::tools::timeline::TransportState;
use crate::tools::why::Why;
use crate::tools::workspace::maps::Maps;
use crate::tools::workspace::overlay::lattice::Lattice;
use crate::tools::workspace::trail::Trail;
use selvedge_render::array::ContactorReading;
use selvedge_render::scene::SceneError;

/// What is neither saved nor undoable.
#[derive(Debug, Default)]
pub(crate) struct Transient {
    /// Sentences for the user.
    pub notices: Notices,
    /// The serial ports of this computer.
    pub ports: Ports,
    /// What is typed in the field for a port.
    pub port: String,
    /// What is typed in the field that searches the library.
    pub search: String,
    /// What the link was last opened to.
    pub target: Option<String>,
    /// Folders that the desktop is asked to show.
    pub folders: Folders,
    /// A scene on its way.
    pub opening: Option<Opening>,
    /// A recorded exploration on its way.
    pub reading: Option<Job<Result<Take, SceneError>>>,
    /// A recorded exploration on its way into a file.
    pub saving: Option<Job<Result<Take, SceneError>>>,
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
    /// The spectrum that arrives, as far as it was drawn.
    pub(crate) contact_spectrogram: ContactSpectrogram,
    /// The spectrum that drives, as far as it was drawn.
    pub(crate) drive_spectrogram: DriveSpectrogram,
    /// The axis of the drive waveform.
    pub(crate) wave_scale: WaveScale,
    /// Spatial spectra as they were drawn last.
    pub spatial: SpatialSpectra,
    /// The explanation that is shown, and whether it is held.
    pub why: (Option<Why>, bool),
    /// The library as a whole.
    pub collection: Collection,
    /// What is compared, and what came of it.
    pub comparison: Comparison,
    /// A picture of a cloth on its way to a textile.
    pub(crate) picturing: Picturing,
    /// Its stages as textures.
    pub(crate) picture_textures: PictureTextures,
    /// How accurate rendering was found to be.
    pub accuracy: AccuracyWatch,
    /// Maps of the textiles at the chosen velocity.
    pub maps: Maps,
    /// Pictures of the points 1 mm apart.
    pub lattice: Lattice,
    /// What the contactors read and how they move, while that is drawn.
    pub readings: Vec<ContactorReading>,
    /// A textile's amplitudes over direction and speed.
    pub curves: Curves,
    /// The textile whose curves were shown last.
    pub(crate) asked_textile: Option<usize>,
    /// The textile lab.
    pub lab: Lab,
    /// What the lab pictures, as it was drawn last.
    pub(crate) lab_pictures: LabPictures,
    /// What the pointer rests on.
    pub hovered: Hovered,
    /// What the timeline remembers.
    pub(crate) transport: TransportState,
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
    /// What is to go wrong with the emulator.
    pub faults: FaultBench,
    /// The emulator's contactors.
    pub plant: PlantPeek,
    /// Refusals to arm that are expected, since there is no device.
    pub(crate) n_expected_refusals: u32,
    /// The device's measured interval between frames.
    pub interval: IntervalMeter,
    /// The level that compression leaves alone, dB re 1 µm.
    pub reference_db: Option<f64>,
}
