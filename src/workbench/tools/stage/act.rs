//! What a visitor does, and what it changes of what is felt, seen and heard.

use crate::bench::settings::preferences::Loudness;

/// What the visitor does.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Act {
    /// Something came down on what is felt.
    Touch,
    /// Let this cloth stroke itself.
    Tour(usize),
    /// Begin to guess.
    Guess,
    /// Choose the picture at this place.
    Choose(usize),
    /// Choose a face, or a word.
    Face(usize),
    Word(usize),
    /// Replace what was typed.
    Comment(String),
    /// Leave the last question.
    Done,
    /// Make all cloths equally strong, or no longer.
    SameStrength,
    /// Louder, and from loud to mute.
    Sound,
    /// Larger letters, or no longer.
    Large,
    /// Hold the button that begins anew, or let it go.
    HoldRestart(bool),
    /// Hold the button that arms, or let it go.
    HoldFeel(bool),
    /// Everything off.
    Stop,
}

/// What the hand does in a frame.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Hand {
    /// Whether something is down on what is felt.
    pub(crate) is_down: bool,
    /// How far it moved since the last frame, mm.
    pub(crate) moved_mm: f64,
    /// The cloth under it.
    pub(crate) cloth: Option<usize>,
}

/// What moves the display.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Motion {
    /// The ghost, over all cloths.
    Ghost,
    /// The visitor.
    Finger,
    /// A cloth strokes itself.
    Tour(usize),
}

/// What a visitor chose of how it is shown and heard; gone with the visit.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Choices {
    pub(crate) same_strength: bool,
    pub(crate) is_large: bool,
    /// `None`: mute.
    pub(crate) loudness: Option<Loudness>,
}

impl Default for Choices {
    fn default() -> Self {
        Self {
            same_strength: false,
            is_large: false,
            loudness: Some(Loudness::Middle),
        }
    }
}
