//! Commands made ready: what crosses to the engine's thread, and what comes back to be dropped.

use triple_buffer::Input;

use super::input::{Control, PointerInput};
use super::recording::Recorder;
use super::{PreparedScene, Snapshot, VelocityMethod};
use crate::bridge::Bridge;
use crate::render::PlacedLevel;
use crate::tactile::Tuning;

/// What the engine's thread obeys. Everything in it is already allocated.
pub(super) enum Order {
    /// Something that the core does.
    Core(CoreOrder),
    /// A new scene, with a channel for snapshots of its size.
    Scene(Box<PreparedScene>, Input<Snapshot>),
    /// A device that is being opened.
    Connect(Box<Bridge>),
    Disconnect,
    /// Arm, unless the stop switch was pressed since it had been pressed this often.
    Arm {
        presses: u64,
    },
    Disarm,
    Shutdown,
}

/// What the core obeys.
pub(super) enum CoreOrder {
    Scene(Box<PreparedScene>),
    Tuning(Tuning),
    TextileGain {
        textile: usize,
        gain_db: f64,
    },
    Levels(Vec<PlacedLevel>),
    /// `None`: live samples.
    Source(Option<Box<dyn PointerInput>>),
    Velocity(VelocityMethod),
    Angle(f64),
    Turn(f64),
    Control(Control),
    Record(Box<Recorder>),
    EndRecording,
}

/// What an order replaced. Whoever owns the engine drops it.
#[expect(dead_code, reason = "most are only carried away to be dropped")]
pub(super) enum Retired {
    Scene(Box<PreparedScene>),
    Snapshots(Input<Snapshot>),
    Source(Box<dyn PointerInput>),
    Levels(Vec<PlacedLevel>),
    Bridge(Box<Bridge>),
    Recorder(Box<Recorder>),
}

/// The most that one order, or a stop, retires.
pub(super) const MOST_RETIRED: usize = 4;
