//! What can be asked of the engine, and what it has to say: one value for each.
//!
//! Commands are plain values; what they need prepared (buffers, tables, ports) is prepared by
//! [`Engine::send`](super::Engine::send) before they reach the thread.

use super::{ClothDrive, InputSource, PreparedScene, SequenceStep, SoundFeed, Tap};
use selvedge_device::{ArrayProfile, BridgeEvent, Target};
use selvedge_render::stylus::StylusDrive;
use selvedge_render::{PlacedLevel, RenderError};
use selvedge_textile::tactile::Tuning;

/// Something asked of the engine. Every one takes effect at a tick, except the stops.
#[derive(Debug)]
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
    /// The same with gains that the scene gives some textiles, in the same tick: all of it, or
    /// nothing when any of it makes no sense.
    SetGains {
        /// Gains and compression.
        tuning: Tuning,
        /// Places in the scene's list, and gains on top of the manifests', dB.
        textiles_db: Vec<(usize, f64)>,
    },
    /// Which contactors of the first display are felt, by index: the others do nothing anywhere.
    /// Contactors beyond its end are felt, so an empty one feels all. It outlives scenes.
    SetContactorMask(Vec<bool>),
    /// Plays these one after another from the next tick on, in place of what the first display
    /// feels of the whole scene; an empty list ends what is played. Tuning changes textiles and no
    /// vibrations; limits, calibration, soft start, mask and stops are those of every tick. While
    /// everything is off nothing is played.
    PlaySequence(Vec<SequenceStep>),
    /// Lets the first display feel this stylus in place of the array from the next tick on, or the
    /// array again. Sequences go before it. It stays with edits of its scene; where they change
    /// the list of textiles it is silent until the next comes, and another scene ends it.
    SetStylus(Option<Box<StylusDrive>>),
    /// Lets the first two displays feel what is given of a cloth that hangs, from the next tick
    /// on, or the scene again. Sequences go before it; gains of master and bands, limits, mask
    /// and stops are those of every tick. It outlives scenes. A recording's rows say where the
    /// display was: whoever wants what it holds on the scene lets the scene be felt first.
    SetCloth(Option<Box<ClothDrive>>),
    /// Levels of the placed textiles that were not known when the scene was prepared, one for each.
    SetLevels(Vec<PlacedLevel>),
    /// Where positions come from. A replay or stroke begins paused at its first tick.
    SetSource(InputSource),
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
    /// Lets a replay that begins again do so after the second of these ticks, at the first; `None`:
    /// when it ends.
    LoopWithin(Option<[u64; 2]>),
    /// Opens a device; its shape is that of the scene's first display.
    Connect(Target),
    /// Opens a device for the scene's second display, if it has one. It goes with the first: it is
    /// armed with it, and never moves while the first does not.
    ConnectSecond(Target),
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
    /// The same of the second display's.
    DisconnectSecond,
    /// Arms the device, and ends the silence that `StopAll` began.
    Arm,
    /// Ramps the device to silence; the screen goes on.
    Disarm,
    /// Ends the silence that `StopAll` began, on the screen: the device stays disarmed.
    Resume,
    /// Asks a faulted device to clear its faults; it can be armed again when their cause is gone.
    ClearFaults,
    /// Everything off: the device stops at once, the display is silent until armed or resumed, a
    /// replay is held and a recording ended.
    StopAll,
    /// Ends the recording that [`Engine::record`](super::Engine::record) began.
    StopRecording,
    /// Whether somebody takes [samples of ticks](super::Engine::next_tick_sample); nobody does at
    /// first.
    SampleTicks(bool),
    /// The contactor whose amplitudes samples of ticks hold, of the display that is watched; the
    /// first one at first.
    Watch(usize),
    /// The display of the scene that samples of ticks are of, the first one at first.
    WatchDisplay(usize),
    /// Tell other programs what is felt at every tick, or no longer.
    SetTap(Option<Box<Tap>>),
    /// Make sound of what is felt at every tick, or no longer.
    SetSound(Option<Box<SoundFeed>>),
    /// Ends the thread.
    Shutdown,
}

/// What the engine has to say, in the order in which it happened.
#[derive(Debug)]
pub enum Notice {
    /// News of the device.
    Bridge(BridgeEvent),
    /// News of the second display's.
    SecondBridge(BridgeEvent),
    /// Something asked for was refused; the sentence says what and why.
    Refused(&'static str),
    /// An array profile was not taken, since the device may move; the one before holds.
    ArrayWaits,
    /// A tuning, gain or level that makes no sense was ignored.
    GainIgnored(RenderError),
    /// Everything was switched off.
    Stopped,
    /// A display of the scene has another number of contactors: its device was let go.
    DisplayChanged,
    /// A replay, stroke or line stream came to its end.
    SourceEnded,
    /// The recording reached its limit, or nobody collected its blocks: it ended.
    RecordingEnded(&'static str),
}
