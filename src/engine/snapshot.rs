//! What the engine shows of itself: plain data, copied whole at every tick.
//!
//! A snapshot has room for every contactor of its scene from the start, so that filling it
//! allocates nothing. It holds no text: that is the window's.

use std::time::Duration;

use super::{DurationHistogram, InputRate, Playback, SampleCounters, SourceKind, VelocityMethod};
use selvedge_device::{
    BridgeCounters, BridgeState, Caps, ClockFit, LimiterState, LinkScale, SentFrame, Spread,
    Status, Timings,
};
use selvedge_foundation::geometry::Point;
use selvedge_render::Counters;
use selvedge_render::array::{ArrayRenderer, ErrorBound, Method};
use selvedge_render::scene::Pose;
use selvedge_render::stylus::StylusState;
use selvedge_textile::tactile::Tuning;

/// The engine after a tick.
#[derive(Debug, Clone)]
pub struct Snapshot {
    /// Serial number of the scene that this shows, given by
    /// [`PreparedScene`](super::PreparedScene).
    pub scene_serial: u64,
    /// Changes of gains, levels and the contactor mask so far: a display that stands still may
    /// show other amplitudes after one.
    pub revision: u64,
    /// Ticks since the engine started.
    pub tick: u64,
    /// Where the first display is, how it is turned and how it moves. Its time is that of the
    /// source.
    pub pose: Pose,
    /// The pose that its amplitudes below were rendered at: at rest while everything is off, and in
    /// a scene that was just opened.
    pub rendered: Pose,
    /// The angle that the display was turned to by hand, degrees counter-clockwise, added to the
    /// scene's; a replay has angles of its own instead.
    pub turn_deg: f64,
    /// Every display of the scene in order.
    pub displays: Vec<DisplayView>,
    /// Whether everything was switched off and nothing has been armed since.
    pub is_stopped: bool,
    /// Whether the device plays silence: stopped, or a replay that is held (whose amplitudes the
    /// displays go on to show).
    pub is_silent: bool,
    /// Which step of a sequence is played, from 0; `None` while none is.
    pub sequence_step: Option<u16>,
    /// What the stylus does that is felt in place of the array; `None`: the array is felt.
    pub stylus: Option<StylusState>,
    /// How amplitudes are made.
    pub rendering: RenderingView,
    /// The pointer and its velocity.
    pub pointer: PointerView,
    /// The replay, stroke or live source.
    pub source: SourceKind,
    /// How far a replay or stroke is.
    pub playback: Playback,
    /// The recording.
    pub recording: RecordingView,
    /// Ticks and what they cost.
    pub clock: ClockView,
    /// What was lost or refused.
    pub counters: EngineCounters,
    /// The device; `None` without one.
    pub link: Option<LinkView>,
    /// The second display's.
    pub second_link: Option<LinkView>,
}

/// How the amplitudes of a snapshot are made.
#[derive(Debug, Clone, Copy)]
pub struct RenderingView {
    /// The rendering method chosen; never `auto`.
    pub method: Method,
    /// Whether a cloth that hangs is felt in place of what it makes.
    pub is_cloth: bool,
    /// How far amplitudes may be from the reference, known before the first tick.
    pub bound: ErrorBound,
    /// What the renderer evaluated and what it left out, since the scene was set.
    pub counters: Counters,
    /// The gains that sound.
    pub tuning: Tuning,
    /// Whether compression waits for levels.
    pub compression_is_pending: bool,
    /// The level that compression leaves alone, dB re 1 µm, once it is known.
    pub compression_reference_db: Option<f64>,
}

impl RenderingView {
    /// What a renderer says of itself.
    pub(super) fn of(renderer: &ArrayRenderer) -> Self {
        Self {
            method: renderer.method(),
            is_cloth: false,
            bound: renderer.bound(),
            counters: *renderer.counters(),
            tuning: *renderer.tuning(),
            compression_is_pending: renderer.compression_is_pending(),
            compression_reference_db: renderer.compression_reference_db(),
        }
    }
}

/// One display in a snapshot.
#[derive(Debug, Clone, Default)]
pub struct DisplayView {
    /// Where it is and how it moves.
    pub pose: Pose,
    /// The pose that its amplitudes were rendered at.
    pub rendered: Pose,
    /// Its contactors in index order.
    pub contactors: Vec<ContactorView>,
}

/// One contactor in a snapshot.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct ContactorView {
    /// Where it is in the workspace.
    pub position: Point,
    /// The textile under it: its place in the scene's list.
    pub textile: Option<u16>,
    /// Peak amplitudes [A40, A320] after gains, before output limits, µm.
    pub amplitude_um: [f32; 2],
    /// The output limits that this amplitude meets at full soft-start gain.
    pub limiter: LimiterState,
}

/// The pointer in a snapshot.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct PointerView {
    /// Whether a sample was ever seen from this source.
    pub is_known: bool,
    /// From the stamp of the sample in use to this tick; `None` when at rest or without a stamp.
    pub age: Option<Duration>,
    /// Age of the felt amplitude: from the sample's stamp to the middle of the tick in which the
    /// device plays it. `None` when at rest or without a stamp.
    pub felt_age: Option<Duration>,
    /// How velocity is estimated.
    pub method: VelocityMethod,
    /// The lag of that estimate at this tick, s; 0 when a path carries its own velocity.
    pub(crate) velocity_lag_s: f64,
    /// Whether the finger is off the surface, for sources that tell.
    pub is_lifted: bool,
    /// How steadily the source reports.
    pub rate: InputRate,
    /// What became of the samples.
    pub samples: SampleCounters,
}

/// The recording in a snapshot.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct RecordingView {
    /// Whether it records.
    pub is_recording: bool,
    /// Ticks recorded.
    pub n_ticks: u64,
}

/// Ticks and what they cost.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct ClockView {
    /// Whether the device paces (otherwise the engine's own clock does).
    pub(crate) is_device_paced: bool,
    /// Ticks that began more than 1 ms after they were due.
    pub late: u64,
    /// Ticks that never were because the engine came a whole tick too late.
    pub missed: u64,
    /// Times that the device fell silent and the own clock took over.
    pub fallbacks: u64,
    /// From when a tick was due to when its frame was handed over.
    pub lateness: Spread,
    /// Median cost of the recent ticks, ns; 0 where nobody measures.
    pub cost_ns: u64,
    /// The cost of every tick since the engine started, wall time; none where nobody measures.
    pub costs: DurationHistogram,
}

/// What was lost or refused since the engine started.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct EngineCounters {
    /// Times that another display moved by itself.
    pub(super) others_moved: u64,
    /// Notices that the full ring had no room for.
    pub(crate) notices_lost: u64,
    /// Tunings, gains and angles that made no sense and were ignored.
    pub ignored: u64,
    /// Samples that the full ring had no room for.
    pub(crate) tick_samples_lost: u64,
    /// Steps of a stylus that was felt; 0 while none ever was.
    pub stylus_steps: u64,
    /// Frames not made because no armed device listened.
    pub frames_unheard: u64,
    /// Commands obeyed before this was shown: all that were sent once it equals
    /// [`Engine::commands_sent`](super::Engine::commands_sent).
    pub commands_obeyed: u64,
}

/// The device in a snapshot.
#[derive(Debug, Clone, Copy)]
pub struct LinkView {
    /// Where the connection stands.
    pub state: BridgeState,
    /// What the device says it is.
    pub caps: Option<Caps>,
    /// What it makes of codes.
    pub scale: Option<LinkScale>,
    /// The largest sum of codes that our own frames allow it now; its STATUS says the real one.
    pub predicted_sum: f64,
    /// Its last STATUS.
    pub status: Option<Status>,
    /// Ticks from a frame to its effect, 1…3.
    pub depth: u8,
    /// From the moment a frame is due to the start of the tick in which it is felt.
    pub lead: Duration,
    /// What is known of the device's clock.
    pub clock: ClockFit,
    /// Counters of device and host.
    pub counters: BridgeCounters,
    /// Due to FRAME, pointer to FRAME; refreshed once a second.
    pub timings: Timings,
    /// The last frame sent.
    pub sent: Option<SentFrame>,
}
