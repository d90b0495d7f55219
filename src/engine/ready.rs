//! Commands made ready: what crosses to the engine's thread, and what comes back to be dropped.

use triple_buffer::Input;

use super::input::{Control, PointerInput};
use super::recording::Recorder;
use super::sequence::Sequence;
use super::{ClothDrive, PreparedScene, Snapshot, SoundFeed, Tap};
use selvedge_device::{ArrayChange, Bridge, Coder};
use selvedge_render::PlacedLevel;
use selvedge_render::stylus::StylusDrive;
use selvedge_textile::tactile::Tuning;

/// What the engine's thread obeys. Everything in it is already allocated.
pub(super) enum ReadyCommand {
    /// Something that the core does.
    Core(CoreCommand),
    /// A new scene, with a channel for snapshots of its size.
    Scene(NextScene, Input<Snapshot>),
    /// A device that is being opened, or none, for the first or second display.
    Connect(usize, Option<Box<Bridge>>),
    /// Another array profile, made ready for screen and device.
    Array(Box<NextArray>),
    /// Whether channels are being identified.
    Identify(bool),
    /// Drives one channel alone: amplitude in µm, time in ms.
    IdentifyChannel {
        channel: u16,
        how: (f32, u16),
    },
    /// Arm, unless the stop switch was pressed since it had been pressed this often.
    Arm {
        presses: u64,
    },
    Disarm,
    /// The silence of a stop is over.
    Resume,
    /// Clear the device's faults.
    ClearFaults,
    /// Whether somebody takes samples.
    SampleTicks(bool),
    /// The contactor that samples watch.
    Watch(usize),
    /// The display that samples are of.
    WatchDisplay(usize),
    /// Tell other programs what is felt, or no longer.
    Tap(Option<Box<Tap>>),
    /// Make sound of what is felt, or no longer.
    Sound(Option<Box<SoundFeed>>),
    Shutdown,
}

/// An array profile for everybody who follows one; once obeyed, what they followed before.
pub(super) struct NextArray {
    /// For what the screen shows of limits.
    pub(super) coder: Coder,
    /// For the device.
    pub(super) change: ArrayChange,
    /// For the second display's.
    pub(super) second: ArrayChange,
}

/// The scene that is felt next.
pub(super) struct NextScene {
    pub(super) scene: Box<PreparedScene>,
    /// Whether it is the one before after an edit.
    pub(super) is_edited: bool,
}

impl ReadyCommand {
    /// Plays, holds or moves a source.
    pub(super) fn control(control: Control) -> Self {
        Self::Core(CoreCommand::Control(control))
    }
}

impl From<CoreCommand> for ReadyCommand {
    fn from(command: CoreCommand) -> Self {
        Self::Core(command)
    }
}

/// What the core obeys.
pub(super) enum CoreCommand {
    Scene(NextScene),
    Gains {
        tuning: Tuning,
        textiles_db: Vec<(usize, f64)>,
    },
    Levels(Vec<PlacedLevel>),
    /// Which contactors of the first display are felt.
    Mask(Vec<bool>),
    /// What is felt in place of the whole scene.
    PlaySequence(Sequence),
    /// What is felt in place of the array; `None`: the array.
    Stylus(Option<Box<StylusDrive>>),
    /// A cloth that hangs, in place of the scene; `None`: the scene.
    Cloth(Option<Box<ClothDrive>>),
    /// `None`: live samples.
    Source(Option<Box<dyn PointerInput>>),
    Angle(f64),
    Turn(f64),
    Control(Control),
    Record(Box<Recorder>),
    EndRecording,
}

impl CoreCommand {
    /// Tuning and gains of some textiles, in one tick.
    pub(super) fn gains(tuning: Tuning, textiles_db: Vec<(usize, f64)>) -> Self {
        Self::Gains {
            tuning,
            textiles_db,
        }
    }
}

/// What a command replaced. Whoever owns the engine drops it.
#[expect(dead_code, reason = "most are only carried away to be dropped")]
pub(super) enum Retired {
    Scene(Box<PreparedScene>),
    Snapshots(Input<Snapshot>),
    Source(Box<dyn PointerInput>),
    Levels(Vec<PlacedLevel>),
    Gains(Vec<(usize, f64)>),
    Mask(Vec<bool>),
    Sequence(Sequence),
    Stylus(Box<StylusDrive>),
    Cloth(Box<ClothDrive>),
    Bridge(Box<Bridge>),
    Array(Box<NextArray>),
    Tap(Box<Tap>),
    Sound(Box<SoundFeed>),
    Recorder(Box<Recorder>),
}

/// The most that one command, or a stop, retires.
pub(super) const MAX_RETIRED: usize = 5;
