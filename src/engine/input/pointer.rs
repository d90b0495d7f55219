//! What every source of positions is to the engine: one trait, and what a source says and is told.

use std::fmt::Debug;
use std::time::Instant;

use crate::PointerSample;
use selvedge_render::scene::{ExplorationPath, Pose};

/// What moves the display.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SourceKind {
    /// Live samples.
    Pointer,
    /// A recorded exploration.
    Replay,
    /// A generated stroke.
    Stroke,
    /// A stream of lines.
    Lines,
    /// A tablet or touch frame that is read directly.
    Device,
    /// Another program, by a connection.
    Program,
}

/// How far a replay or stroke is. A live source is at 0 of 0, playing.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Playback {
    /// Whether it moves on at the next tick.
    pub is_playing: bool,
    /// Whether it came to its end.
    pub has_ended: bool,
    /// Whether it begins again at its end.
    pub does_loop: bool,
    /// The tick of the path that is shown.
    pub tick: u64,
    /// Ticks in the path.
    pub n_ticks: u64,
}

/// What a source says of one tick.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Reading {
    /// It handed over what samples there were; velocity is to be estimated.
    Samples,
    /// The pose of this tick, velocity included.
    Pose(Pose),
    /// It handed over what samples there were before the finger left the surface: nothing is felt
    /// until it is back.
    Lifted,
    /// It is held: the display stands still where it is.
    Held,
    /// It has come to its end.
    Ended,
}

/// What can be done with a source that can be played.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Control {
    /// Move on at every tick.
    Play,
    /// Stand still.
    Pause,
    /// Move on by one tick, then stand still.
    Step,
    /// Back to the first tick.
    Rewind,
    /// To this tick, at most the last; shown at once if standing still.
    Seek(u64),
    /// Whether to begin again at the end.
    Loop(bool),
    /// Begin again at the first of these ticks after the last of them, if it begins again at all;
    /// `None`: at the first of all after the last of all.
    LoopWithin(Option<[u64; 2]>),
}

/// What a source lost before anybody could look at it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct InputLosses {
    /// Samples that found the ring full.
    pub overflowed: u64,
    /// Lines that were no sample.
    pub bad_lines: u64,
    /// Times that the system dropped reports of a device because nobody had read them yet.
    pub lost_in_system: u64,
}

/// A source of positions in the workspace. [`poll`](Self::poll) neither allocates nor waits.
pub trait PointerInput: Send + Debug {
    /// What kind of source this is.
    fn kind(&self) -> SourceKind;

    /// Called once a tick. Samples that arrived since the last go to `take`, oldest first.
    fn poll(&mut self, now: Instant, take: &mut dyn FnMut(PointerSample)) -> Reading;

    /// Hands over what fingers beside the first did since the last tick, oldest first: the display
    /// that each holds, and where it is, or that it left the surface.
    fn poll_others(&mut self, _take: &mut dyn FnMut(usize, Option<PointerSample>)) {}

    /// Plays, holds or rewinds. A live source does not care.
    fn control(&mut self, _control: Control) {}

    /// How far it is.
    fn playback(&self) -> Playback {
        Playback {
            is_playing: true,
            ..Playback::default()
        }
    }

    /// The pose so many ticks before the last one, of a path that knows it. Allocates nothing.
    fn pose_before(&self, _n_ticks: u64) -> Option<Pose> {
        None
    }

    /// The path that it moves along, where that tells of displays beside the first.
    fn path(&self) -> Option<&ExplorationPath> {
        None
    }

    /// The display's angle where the source tells it, degrees counter-clockwise.
    fn angle_deg(&self) -> Option<f64> {
        None
    }

    /// What was lost on the way.
    fn losses(&self) -> InputLosses {
        InputLosses::default()
    }
}
