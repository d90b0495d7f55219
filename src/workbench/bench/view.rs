//! What panes draw: plain data, made once a frame from the document and the newest snapshot.
//!
//! A pane that has these needs neither the engine nor the scene's file; a test can write them by
//! hand. Words for people are made here or later, never in the engine.

use std::collections::BTreeSet;
use std::path::PathBuf;
use std::sync::Arc;

pub(crate) use crate::bench::library_entry::{LibraryDot, LibraryEntry};
use crate::bench::on_finger::OnFinger;
use crate::bench::part::Part;
use crate::bench::perceptual_level::PerceptualLevel;
pub(crate) use crate::kit::swatch::ClothPicture;
use selvedge_device::{BridgeState, ClockFit, DeviceUid, Distribution, LimiterState, LinkScale};
use selvedge_engine::InputRate;
use selvedge_foundation::geometry::{Frame, Point};
use selvedge_render::scene::Pose;
use selvedge_render::stylus::StylusState;
use selvedge_textile::tactile::{Filters, Tuning};

/// The scene as it is drawn.
#[derive(Debug, Clone)]
pub(crate) struct SceneView {
    /// What people call it.
    pub name: String,
    /// Where it was opened or saved.
    pub path: Option<PathBuf>,
    /// Whether it differs from its file.
    pub is_edited: bool,
    /// Width and height of the workspace, mm.
    pub size_mm: [f64; 2],
    /// The textiles in order; the last one is on top.
    pub cloths: Vec<Cloth>,
    /// Gains and compression in force.
    pub tuning: Tuning,
    /// What "reset" goes back to.
    pub default_tuning: Tuning,
    /// The level that compression leaves alone, dB re 1 µm; `None` while nothing has a level.
    pub reference_db: Option<f64>,
    /// The filters of the two bands.
    pub filters: Filters,
    /// Rows and columns of the display, if its contactors form a grid.
    pub grid: Option<(usize, usize)>,
    /// The textiles of the library with a level, for the compression curve.
    pub library: Vec<LibraryDot>,
    /// Whether most of those levels are still under the filters before.
    pub(crate) library_is_stale: bool,
    /// What every view marks.
    pub marks: Marks,
    /// The ids of the library's textiles that are selected.
    pub(crate) picked: Arc<BTreeSet<String>>,
}

/// What is chosen, and what the pointer rests on, in whichever view.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) struct Marks {
    /// The chosen textile: its place in the scene's list.
    pub cloth: Option<usize>,
    /// What the pointer rests on.
    pub hovered: Hovered,
}

/// What the pointer rests on.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) struct Hovered {
    /// A textile: its place in the scene's list.
    pub cloth: Option<usize>,
    /// A contactor.
    pub contactor: Option<usize>,
}

impl Hovered {
    /// Takes in what a view says that the pointer rests on.
    pub(crate) fn take(&mut self, part: Part) {
        match part {
            Part::Cloth(index) => self.cloth = Some(index),
            Part::Contactor(index) => self.contactor = Some(index),
            Part::Band(_) => {}
        }
    }
}

impl SceneView {
    /// What the textiles are called, in order.
    pub(crate) fn titles(&self) -> Vec<String> {
        self.cloths.iter().map(Cloth::title).collect()
    }

    /// The first textile in the scene's list that is this one of the library.
    pub(crate) fn placed(&self, id: &str) -> Option<usize> {
        self.cloths.iter().position(|cloth| cloth.id == id)
    }

    /// Whether a textile is chosen, or under the pointer in some view.
    pub(crate) fn is_marked(&self, index: usize) -> bool {
        let Marks { cloth, hovered } = self.marks;
        cloth == Some(index) || hovered.cloth == Some(index)
    }

    /// The same for a textile of the library, wherever it is placed; and whether it is selected.
    pub(crate) fn is_marked_id(&self, id: &str) -> bool {
        self.picked.contains(id) || self.is_placed_and_marked(id)
    }

    /// Whether a textile of the library is chosen or under the pointer where it is placed.
    pub(crate) fn is_placed_and_marked(&self, id: &str) -> bool {
        let marked = [self.marks.cloth, self.marks.hovered.cloth];
        let mut cloths = marked
            .into_iter()
            .flatten()
            .filter_map(|i| self.cloths.get(i));
        cloths.any(|cloth| cloth.id == id)
    }
}

/// A textile that lies in the workspace.
#[derive(Debug, Clone, Default)]
pub(crate) struct Cloth {
    /// Its textile in the library.
    pub id: String,
    /// The scene's name for it: a number or a letter.
    pub label: String,
    /// The textile's name.
    pub name: String,
    /// Where it lies and how it is turned.
    pub workspace_from_textile: Frame,
    /// Extent along warp and weft, mm.
    pub size_mm: [f64; 2],
    /// How it is turned, degrees counter-clockwise.
    pub rotation_deg: f64,
    /// Whether it is silent because it was muted or another one is felt alone.
    pub(crate) is_muted: bool,
    /// The scene's gain, dB.
    pub gain_db: f64,
    /// What the scene adds to that by band, dB.
    pub(crate) band_gains_db: [f64; 2],
    /// Lower left and upper right corner of what it is felt within; `None` is all of it.
    pub(crate) within_mm: Option<[Point; 2]>,
    /// How it looks; `None` while it has no picture.
    pub picture: Option<ClothPicture>,
}

impl Cloth {
    /// The scene's name for it with the textile's.
    pub(crate) fn title(&self) -> String {
        format!("{} {}", self.label, self.name).trim().to_owned()
    }
}

/// What the engine did last.
#[derive(Debug, Clone, Default)]
pub(crate) struct EngineView {
    /// Ticks since the engine started.
    pub tick: u64,
    /// The middle of the display; `None` before the pointer was ever in the workspace.
    pub centre: Option<Point>,
    /// Where the display is, how it is turned and how it moves.
    pub pose: Pose,
    /// Speed of the display, mm/s.
    pub speed_mm_per_s: f64,
    /// Contactors in index order.
    pub dots: Vec<Dot>,
    /// Displays of the scene that the panes do not look at, in order.
    pub(crate) others: Vec<OtherDisplay>,
    /// What they feel like, by a model.
    pub(crate) perceptual_level: PerceptualLevel,
    /// What the finger gets of the display as a whole.
    pub(crate) on_finger: OnFinger,
    /// Whether everything was switched off and nothing was armed since.
    pub is_stopped: bool,
    /// Whether the device plays silence, stopped or held; the screen keeps what it showed.
    pub is_silent: bool,
    /// What moves the display, and how far it is.
    pub play: PlayView,
    /// The display's turn on top of the scene's, degrees counter-clockwise.
    pub turn_deg: f64,
    /// Rendering: method and cost.
    pub status: Status,
    /// The level that compression leaves alone, dB re 1 µm.
    pub reference_db: Option<f64>,
    /// How steadily positions come.
    pub input: InputView,
    /// The step of a sequence that is played.
    pub(crate) sequence_step: Option<u16>,
    /// What the stylus does that is felt in place of the array; `None`: the array is felt.
    pub(crate) stylus: Option<StylusState>,
    /// Whether a cloth that hangs is felt in place of the scene.
    pub(crate) is_cloth: bool,
    /// The device.
    pub bridge: Option<BridgeView>,
    /// That of the second display.
    pub(crate) second_bridge: Option<BridgeView>,
}

/// A display that the panes do not look at: drawn over the cloth alone.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct OtherDisplay {
    /// Its place in the scene's list.
    pub(crate) display: usize,
    /// Its contactors in index order.
    pub(crate) dots: Vec<Dot>,
}

/// Positions as they come.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct InputView {
    /// Rate, jitter and gaps.
    pub rate: InputRate,
    /// Whether the finger is off the surface.
    pub is_lifted: bool,
    /// Positions and lines that were lost or were none.
    pub n_lost: u64,
}

/// A contactor.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Dot {
    /// Where it is in the workspace.
    pub position: Point,
    /// The textile under it: its place in the scene's list.
    pub cloth: Option<usize>,
    /// Peak amplitudes of both bands after gains, before output limits, µm.
    pub amplitude_um: [f64; 2],
    /// Which output limits bite.
    pub limiter: LimiterState,
    /// What the finger gets of both bands.
    pub(crate) on_finger: [OnFinger; 2],
}

/// What moves the display.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) enum Source {
    /// The pointer.
    #[default]
    Pointer,
    /// The display by itself, along a stroke.
    Stroke,
    /// A recorded exploration.
    Recording,
    /// A stream of lines, of another program for one.
    Lines,
    /// A tablet or touch frame that is read directly.
    Device,
}

/// How far a stroke, a recording or its replay is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) struct PlayView {
    /// What moves the display.
    pub source: Source,
    /// Whether it moves on at the next tick.
    pub is_playing: bool,
    /// Whether a recording begins again at its end.
    pub does_loop: bool,
    /// The tick that is shown of a stroke or a recording.
    pub tick: u64,
    /// Ticks of the recording that is replayed.
    pub n_ticks: u64,
    /// Whether the exploration is being recorded.
    pub is_recording: bool,
    /// Ticks recorded so far.
    pub n_recorded: u64,
}

/// Rendering: method and cost.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct Status {
    /// The rendering method.
    pub method: &'static str,
    /// Cost of a tick, s; `None` where nobody measures.
    pub(crate) tick_cost_s: Option<f64>,
    /// Bound of the method's level error, dB.
    pub bound_db: f64,
    /// Ticks that never were.
    pub missed: u64,
    /// Ticks that came late.
    pub late: u64,
    /// Age of the felt amplitude, s: from the pointer to the middle of the felt tick.
    pub(crate) felt_age_s: Option<f64>,
}

/// The device and the link to it.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct BridgeView {
    /// Where the connection stands, for people.
    pub state: &'static str,
    /// What may be done with it.
    pub phase: BridgePhase,
    /// The device's own number.
    pub uid: Option<DeviceUid>,
    /// What it makes of codes.
    pub scale: Option<LinkScale>,
    /// Whether it can drive one channel alone.
    pub(crate) can_identify: bool,
    /// Ticks from a frame to its effect.
    pub depth: u8,
    /// From the last frame but one to the last, measured on the device's ticks, s.
    pub(crate) frame_interval_s: Option<f64>,
    /// From a pointer event to the end of the write of its frame, 99th percentile, s.
    pub(crate) stamp_to_write_s: Option<f64>,
    /// From the device's STATUS to the frame that answers it, 99th percentile and largest, s.
    pub(crate) status_to_frame_s: Option<[f64; 2]>,
    /// Soft-start gain of the last frame, 0…1.
    pub gain: Option<f64>,
    /// Frames sent.
    pub frames_sent: u64,
    /// What its last STATUS measured.
    pub telemetry: Option<Telemetry>,
    /// Counters that ought to stay at zero, with their names.
    pub troubles: Vec<(&'static str, u64)>,
    /// How long things take.
    pub timing: LinkTiming,
}

/// What a device measures, and how loud our own frames allow it to be.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Telemetry {
    /// High voltage, V.
    pub(crate) high_v: f64,
    /// Supply current, mA.
    pub(crate) current_ma: u16,
    /// Temperature, °C.
    pub(crate) celsius: f64,
    /// Sum of all codes that it puts out.
    pub(crate) codes: u32,
    /// The largest sum that our own frames allow it.
    pub(crate) most_codes: f64,
}

/// How long things take on the link, and where it is written down what happens there.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct LinkTiming {
    /// How long before the tick in which it is felt a frame is made.
    pub lead: Option<std::time::Duration>,
    /// What is known of the device's clock.
    pub clock: Option<ClockFit>,
    /// From a PING to its answer.
    pub round_trip: Distribution,
    /// From frame to frame.
    pub frame_interval: Distribution,
    /// The path of the session log.
    pub log: Option<String>,
    /// Why nothing is written to it.
    pub(crate) log_failure: Option<String>,
}

/// What may be done with a device.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) enum BridgePhase {
    /// On the way to ready.
    #[default]
    Opening,
    /// It may be armed.
    Ready,
    /// High voltage is on, or about to be.
    Armed,
    /// It refused or is gone.
    Broken,
}

impl PlayView {
    /// Whether a stroke or a recording moves the display, or would if it were not held.
    pub(crate) fn moves_by_itself(self) -> bool {
        matches!(self.source, Source::Stroke | Source::Recording)
    }
}

impl EngineView {
    /// Whether one channel can be driven alone now: armed, and nothing played yet.
    pub(crate) fn takes_ident(&self) -> bool {
        let bridge = self.bridge.as_ref();
        bridge.is_some_and(|bridge| bridge.state == BridgeState::Armed.label())
    }

    /// Whether high voltage is on, or about to be.
    pub(crate) fn is_armed(&self) -> bool {
        self.bridge
            .as_ref()
            .is_some_and(|bridge| bridge.phase == BridgePhase::Armed)
    }

    /// The textile under most contactors; of equals the one on top.
    pub(crate) fn cloth_under_display(&self) -> Option<usize> {
        let n_cloths = self.dots.iter().filter_map(|dot| dot.cloth).max()? + 1;
        let count = |cloth| {
            self.dots
                .iter()
                .filter(|dot| dot.cloth == Some(cloth))
                .count()
        };
        (0..n_cloths).max_by_key(|&cloth| count(cloth))
    }
}
