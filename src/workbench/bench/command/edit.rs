//! Changes of the scene: what can be undone, and which of them join into one step.

use crate::bench::gain_set::GainSet;
use selvedge_foundation::geometry::Point;
use selvedge_render::scene::{RecordingReference, SlotLetter};
use selvedge_textile::tactile::{Band, Filters};

/// A change of the scene: undoable, saved.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Edit {
    /// Gain of everything, dB.
    MasterGain(f64),
    /// Gain of a band, dB.
    BandGain(Band, f64),
    /// Compression κ, 0…1.
    Compression(f64),
    /// Gain of the textile at this place in the scene's list, dB.
    TextileGain(usize, f64),
    /// All gains at once.
    Gains(GainSet),
    /// The level above threshold that a band of the textile at this place is to have, dB.
    TargetLevel(usize, Band, Option<f64>),
    /// Keeps the gains in force in a slot.
    KeepSlot(SlotLetter),
    /// Name and note of a slot.
    SlotWords(SlotLetter, [String; 2]),
    /// Forgets what a slot keeps.
    EmptySlot(SlotLetter),
    /// Kind and width of the filters.
    Filters(Filters),
    /// Moves the textile at this place: its origin, mm.
    MoveCloth(usize, Point),
    /// Turns the textile at this place about its middle to this angle, degrees counter-clockwise.
    TurnCloth(usize, f64),
    /// Extent of the textile at this place along warp and weft, mm.
    ResizeCloth(usize, [f64; 2]),
    /// Places a textile of the library with its middle here.
    AddCloth(String, Point),
    /// Places textiles of the library side by side where there is room.
    AddCloths(Vec<String>),
    /// Takes the textile at this place away.
    RemoveCloth(usize),
    /// Lays the textile at this place on top of the others.
    RaiseCloth(usize),
    /// What the scene calls the textile at this place.
    Label(usize, String),
    /// The scene refers to this recording, or no longer.
    Recording(RecordingReference),
}

/// What an edit turns: edits of the same target in one gesture are one step of undo.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Target {
    /// Gain of everything.
    MasterGain,
    /// Gain of a band.
    BandGain(Band),
    /// Compression.
    Compression,
    /// Gain of the textile at this place.
    TextileGain(usize),
    /// All gains.
    Gains,
    /// What level a textile is to have.
    WantedLevel(usize, Band),
    /// What a slot keeps; never joined.
    Slot(SlotLetter),
    /// What a slot is called.
    SlotWords(SlotLetter),
    /// The filters.
    Filters,
    /// Where a textile lies.
    Place(usize),
    /// How a textile is turned.
    Turn(usize),
    /// How large a textile is.
    Size(usize),
    /// Which textiles there are; such edits are never joined.
    Add,
    /// The same, several at once.
    AddSeveral,
    /// The same.
    Remove,
    /// Which textile is on top.
    Order,
    /// What a textile is called.
    Label(usize),
    /// Which recordings the scene refers to; never joined.
    Recording,
}

impl Edit {
    /// What it turns.
    pub(crate) fn target(&self) -> Target {
        match *self {
            Self::MasterGain(_) => Target::MasterGain,
            Self::BandGain(band, _) => Target::BandGain(band),
            Self::Compression(_) => Target::Compression,
            Self::TextileGain(index, _) => Target::TextileGain(index),
            Self::Gains(_) => Target::Gains,
            Self::TargetLevel(index, band, _) => Target::WantedLevel(index, band),
            Self::KeepSlot(letter) | Self::EmptySlot(letter) => Target::Slot(letter),
            Self::SlotWords(letter, _) => Target::SlotWords(letter),
            Self::Filters(_) => Target::Filters,
            Self::MoveCloth(index, _) => Target::Place(index),
            Self::TurnCloth(index, _) => Target::Turn(index),
            Self::ResizeCloth(index, _) => Target::Size(index),
            Self::AddCloth(..) => Target::Add,
            Self::AddCloths(_) => Target::AddSeveral,
            Self::RemoveCloth(_) => Target::Remove,
            Self::RaiseCloth(_) => Target::Order,
            Self::Label(index, _) => Target::Label(index),
            Self::Recording(_) => Target::Recording,
        }
    }
}

impl Target {
    /// Its name in the undo list.
    pub(crate) fn label(self) -> &'static str {
        match self {
            Self::MasterGain => "master gain",
            Self::BandGain(Band::Low) => "40 Hz gain",
            Self::BandGain(Band::High) => "320 Hz gain",
            Self::Compression => "compression",
            Self::TextileGain(_) => "textile gain",
            Self::Gains => "all gains",
            Self::WantedLevel(..) => "target level",
            Self::Slot(_) => "slot of a tuning",
            Self::SlotWords(_) => "name of a slot",
            Self::Filters => "filters",
            Self::Place(_) => "moved textile",
            Self::Turn(_) => "turned textile",
            Self::Size(_) => "resized textile",
            Self::Add => "added textile",
            Self::AddSeveral => "added textiles",
            Self::Remove => "removed textile",
            Self::Order => "raised textile",
            Self::Label(_) => "label",
            Self::Recording => "recording of the scene",
        }
    }

    /// Whether further edits of the same target may join the step.
    pub(crate) fn joins(self) -> bool {
        !matches!(
            self,
            Self::Add
                | Self::AddSeveral
                | Self::Remove
                | Self::Order
                | Self::Recording
                | Self::Slot(_)
        )
    }
}
