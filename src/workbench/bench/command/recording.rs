//! What can be done with recordings.

use crate::bench::command::Command;
use crate::bench::recording::{Marker, Place};
use std::ops::Range;

/// What can be done with a recording of the list.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum RecordingCommand {
    /// It becomes the one at hand: it moves the display, and waits at its first tick.
    Choose(Place),
    /// Calls it otherwise.
    Rename(Place, String),
    /// Moves it aside.
    Delete(Place),
    /// Brings the one back that was deleted last.
    BringBack,
    /// Exports its path.
    Export(Place),
    /// The scene refers to it, or no longer.
    Refer(Place),
    /// Puts a marker into the one at hand, or names the one that stands there.
    Mark(Marker),
    /// Takes the marker at this tick of the one at hand away.
    Unmark(u64),
    /// Makes these ticks of the one at hand a recording of their own.
    Excerpt(Range<u64>),
    /// Makes these columns of what was felt last a recording.
    Keep(Range<u64>),
    /// Sets two against each other.
    Compare(Box<[Place; 2]>),
}

impl From<RecordingCommand> for Command {
    fn from(command: RecordingCommand) -> Self {
        Self::Recording(command)
    }
}
