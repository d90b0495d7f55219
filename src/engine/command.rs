//! What can be asked of the engine, and what it has to say: one value for each.
//!
//! Commands are plain values; what they need prepared (buffers, tables, ports) is prepared by
//! [`Engine::send`](super::Engine::send) before they reach the thread.

use std::fmt;
use std::io::BufRead;
use std::sync::Arc;

use super::{PointerInput, PreparedScene, Tap, VibrationStep};
use selvedge_device::{ArrayProfile, BridgeEvent, Target};
use selvedge_render::scene::{ExplorationPath, Stroke};
use selvedge_render::{PlacedLevel, RenderError};
use selvedge_textile::tactile::Tuning;

/// Something asked of the engine. Every one takes effect at a tick, except the stops.
pub enum Command {
    /// Feel this scene from the next tick on. Ends a recording; disconnects the device if the
    /// number of contactors changed.
    SetScene(Box<PreparedScene>),
    /// Feel the same scene after an edit. The source goes on where it is, and so do counters; a
    /// recording goes on if every display has as many contactors as before.
    UpdateScene(Box<PreparedScene>),
    /// Gains and compression from the next tick on. One that makes no sense is ignored with a
    /// notice.
    SetTuning(Tuning),
    /// Scene gain of one placed textile (its place in the scene's list), dB.
    SetTextileGain {
        /// The textile's place in the scene's list.
        textile: usize,
        /// Its gain on top of the manifest's, dB.
        gain_db: f64,
    },
    /// Which contactors of the first display are felt, by index: the others do nothing anywhere.
    /// Contactors beyond its end are felt, so an empty one feels all. It outlives scenes.
    SetContactorMask(Vec<bool>),
    /// Plays these one after another from the next tick on, in place of what the first display
    /// feels of the scene; an empty list ends what is played. Tuning does not change them; limits,
    /// calibration, soft start, mask and stops are those of every tick. While everything is off
    /// nothing is played.
    Vibrate(Vec<VibrationStep>),
    /// Levels of the placed textiles that were not known when the scene was prepared, one for each.
    SetLevels(Vec<PlacedLevel>),
    /// Where positions come from. A replay or stroke begins paused at its first tick.
    SetSource(InputSource),
    /// How velocity is estimated from samples.
    SetVelocityMethod(VelocityMethod),
    /// Turns the display to this angle, degrees counter-clockwise, added to the scene's; a replay
    /// has its own.
    SetAngle(f64),
    /// Turns the display by this much, degrees counter-clockwise.
    TurnBy(f64),
    /// Lets a replay or stroke run.
    Play,
    /// Holds a replay or stroke: silent, the screen keeps what it showed.
    Pause,
    /// Plays one tick of a replay or stroke, then holds.
    Step,
    /// Back to the first tick of a replay or stroke.
    Rewind,
    /// To this tick of a replay, at most its last, or of a stroke. While it is held that tick is
    /// shown and felt like a step; while it plays it goes on from there. One that ended is held.
    Seek(u64),
    /// Whether a replay or stroke begins again when it ends.
    SetLoop(bool),
    /// Opens a device; its shape is that of the scene's first display.
    Connect(Target),
    /// The array that devices drive, from now on; `None`, or one with another number of contactors
    /// than the scene's first display, is the scene's own. While a device may move, only what
    /// lowers is taken; otherwise [`Notice::ArrayWaits`] comes and nothing changes.
    SetArray(Option<Box<ArrayProfile>>),
    /// Whether channels are being identified: an armed device then gets no frames. Beginning and
    /// ending ramp it to silence.
    Identify(bool),
    /// Drives one channel alone, of a device that was armed while channels are identified.
    IdentifyChannel {
        /// Index of the channel.
        channel: u16,
        /// Peak amplitude at 320 Hz, within every limit, µm.
        amplitude_um: f32,
        /// How long, at most 1000 ms.
        duration_ms: u16,
    },
    /// Stops the device and lets go of it.
    Disconnect,
    /// Arms the device, and ends the silence that `StopAll` began.
    Arm,
    /// Ramps the device to silence; the screen goes on.
    Disarm,
    /// Asks a faulted device to clear its faults; it can be armed again when their cause is gone.
    ClearFaults,
    /// Everything off: the device stops at once, the display is silent until armed again, a replay
    /// is held and a recording ended.
    StopAll,
    /// Begins to record the exploration.
    StartRecording,
    /// Ends the recording; [`Engine::take_recording`](super::Engine::take_recording) has it.
    StopRecording,
    /// Whether somebody takes [glimpses](super::Engine::next_glimpse); nobody does at first.
    Glimpses(bool),
    /// The contactor of the first display whose amplitudes glimpses tell, the first one at first.
    Watch(usize),
    /// Tell other programs what is felt at every tick, or no longer.
    SetTap(Option<Box<Tap>>),
    /// Ends the thread.
    Shutdown,
}

/// Where positions come from.
pub enum InputSource {
    /// Live samples through a [`PointerSender`](super::PointerSender): the mouse.
    Pointer,
    /// A recorded exploration, tick for tick as an offline rendering takes it.
    Replay(Arc<ExplorationPath>),
    /// A generated stroke.
    Stroke(Stroke),
    /// Lines of text, `x_mm,y_mm` (stamped on arrival) or `t_s,x_mm,y_mm`, read on a thread of
    /// their own.
    Lines(Box<dyn BufRead + Send>),
    /// Whatever yields positions: a device, a connection.
    Live(Box<dyn PointerInput>),
}

/// How velocity is estimated from samples.
///
/// The lag is that of the estimate under constant acceleration: the true velocity was the estimate
/// that long before the newest sample.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum VelocityMethod {
    /// Difference of the last two samples. Lag: half their distance in time.
    FiniteDifference,
    /// Slope of the least-squares line through the samples of the last `window_s` seconds. Lag: the
    /// newest time less the mean time of those samples, about half the window.
    LineFit {
        /// The window, s.
        window_s: f64,
    },
    /// An alpha–beta filter. Lag at a constant sample distance T: (α/β − ½)·T.
    AlphaBeta {
        /// Share of the position error that corrects the position, 0…1.
        alpha: f64,
        /// Share of the position error that corrects the velocity, 0…1.
        beta: f64,
    },
    /// A Kalman filter for a constant velocity that white acceleration disturbs; each step takes
    /// the time that passed. Lag: carried along from sample to sample and exact under constant
    /// acceleration; at dense samples T apart it settles at `√2 (σ²T/q)^¼`.
    Kalman {
        /// Power density of the acceleration, q: the velocity wanders by √(q t) in t seconds,
        /// mm²/s³.
        acceleration_mm2_per_s3: f64,
        /// Standard deviation of a measured coordinate, σ, mm.
        noise_mm: f64,
    },
    /// The one-euro filter (Casiez, Roussel and Vogel 2012) on the differences of neighbouring
    /// samples: a low pass whose cutoff `f_min + β·speed` rises with the speed. With β = 0 it is
    /// the derivative of low-passed positions. Lag: carried along and exact under constant
    /// acceleration; it settles at 1/(2π·cutoff) and half a sample distance.
    OneEuro {
        /// Cutoff at rest, Hz.
        min_cutoff_hz: f64,
        /// What each mm/s adds to the cutoff, Hz/(mm/s), that is 1/mm.
        beta_per_mm: f64,
        /// Cutoff of the low pass that the speed is judged behind, Hz.
        derivative_cutoff_hz: f64,
    },
}

impl Default for VelocityMethod {
    /// A Kalman filter that takes a coordinate to be 0.05 mm off and the acceleration of a hand
    /// to have a density of 10⁴ mm²/s³. Of what the study `velocity` compares it has the least rms
    /// error (17 mm/s over all strokes and pointers) among those that hold the level of a steady
    /// stroke of 100 mm/s within 1 dB at the 99th percentile. A line through 40 ms is steadier
    /// still (0.3 dB), but 26 ms late where this is 14, and so 27 mm/s off as soon as a hand turns
    /// or stops. Samples that come in bursts disturb it no more than others; the bare difference
    /// and alpha–beta break on them.
    fn default() -> Self {
        Self::Kalman {
            acceleration_mm2_per_s3: 1e4,
            noise_mm: 0.05,
        }
    }
}

impl VelocityMethod {
    /// Whether its numbers make sense: a window of up to a second, shares of 0…1, cutoffs of
    /// 0.01…1000 Hz that rise by at most 100 Hz for each mm/s, noise of 10⁻⁶…100 mm and an
    /// acceleration density of 10⁻³…10¹² mm²/s³.
    pub fn is_sound(self) -> bool {
        let is_share = |share: f64| share > 0.0 && share <= 1.0;
        match self {
            Self::FiniteDifference => true,
            Self::LineFit { window_s } => is_share(window_s),
            Self::AlphaBeta { alpha, beta } => is_share(alpha) && is_share(beta),
            Self::Kalman {
                acceleration_mm2_per_s3,
                noise_mm,
            } => {
                (1e-3..=1e12).contains(&acceleration_mm2_per_s3)
                    && (1e-6..=100.0).contains(&noise_mm)
            }
            Self::OneEuro {
                min_cutoff_hz,
                beta_per_mm,
                derivative_cutoff_hz,
            } => {
                let is_cutoff = |hz: f64| (0.01..=1000.0).contains(&hz);
                is_cutoff(min_cutoff_hz)
                    && is_cutoff(derivative_cutoff_hz)
                    && (0.0..=100.0).contains(&beta_per_mm)
            }
        }
    }

    /// Its name for people.
    pub fn label(self) -> &'static str {
        match self {
            Self::FiniteDifference => "finite difference",
            Self::LineFit { .. } => "line fit",
            Self::AlphaBeta { .. } => "alpha–beta",
            Self::Kalman { .. } => "Kalman",
            Self::OneEuro { .. } => "one-euro",
        }
    }
}

/// What the engine has to say, in the order in which it happened.
#[derive(Debug)]
pub enum Notice {
    /// News of the device.
    Bridge(BridgeEvent),
    /// Something asked for was refused; the sentence says what and why.
    Refused(&'static str),
    /// An array profile was not taken, since the device may move; the one before holds.
    ArrayWaits,
    /// A tuning, gain or level that makes no sense was ignored.
    GainIgnored(RenderError),
    /// Everything was switched off.
    Stopped,
    /// The scene's first display has another number of contactors: the device was let go.
    DisplayChanged,
    /// A replay, stroke or line stream came to its end.
    SourceEnded,
    /// The recording reached its limit, or nobody collected its blocks: it ended.
    RecordingEnded(&'static str),
}

impl fmt::Debug for Command {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::SetScene(_) => "SetScene",
            Self::UpdateScene(_) => "UpdateScene",
            Self::SetTuning(_) => "SetTuning",
            Self::SetTextileGain { .. } => "SetTextileGain",
            Self::SetContactorMask(_) => "SetContactorMask",
            Self::Vibrate(_) => "Vibrate",
            Self::SetLevels(_) => "SetLevels",
            Self::SetSource(_) => "SetSource",
            Self::SetVelocityMethod(_) => "SetVelocityMethod",
            Self::SetAngle(_) => "SetAngle",
            Self::TurnBy(_) => "TurnBy",
            Self::Play => "Play",
            Self::Pause => "Pause",
            Self::Step => "Step",
            Self::Rewind => "Rewind",
            Self::Seek(_) => "Seek",
            Self::SetLoop(_) => "SetLoop",
            Self::Connect(_) => "Connect",
            Self::SetArray(_) => "SetArray",
            Self::Identify(_) => "Identify",
            Self::IdentifyChannel { .. } => "IdentifyChannel",
            Self::Disconnect => "Disconnect",
            Self::Arm => "Arm",
            Self::Disarm => "Disarm",
            Self::ClearFaults => "ClearFaults",
            Self::StopAll => "StopAll",
            Self::StartRecording => "StartRecording",
            Self::StopRecording => "StopRecording",
            Self::Glimpses(_) => "Glimpses",
            Self::Watch(_) => "Watch",
            Self::SetTap(_) => "SetTap",
            Self::Shutdown => "Shutdown",
        })
    }
}

impl fmt::Debug for InputSource {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Pointer => "Pointer",
            Self::Replay(_) => "Replay",
            Self::Stroke(_) => "Stroke",
            Self::Lines(_) => "Lines",
            Self::Live(_) => "Live",
        })
    }
}
