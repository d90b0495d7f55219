//! Every act of the user, as one value.
//!
//! Menus, shortcuts, buttons, sliders and tests all say what they want with a [`Command`];
//! `dispatch.rs` is the one place that does it. Panes never change anything themselves.

use std::path::PathBuf;

use eframe::egui;

use super::theme::ColourMap;
use crate::tactile::Band;

/// Something that the user wants.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Command {
    /// Everything off, at once, from anywhere.
    AllOff,
    /// Arm the device: high voltage on.
    Arm,
    /// End the silence of all off where there is no device to arm.
    GoOn,
    /// Ramp the device to silence.
    Disarm,
    /// Connect to the emulator in this process.
    ConnectEmulator,
    /// Connect to the device at this path.
    ConnectPort(PathBuf),
    /// Let go of the device.
    Disconnect,
    /// Let the display explore by itself, or give it back to the pointer.
    ToggleStroke,
    /// Change the scene.
    Edit(Edit),
    /// Take the last change back.
    Undo,
    /// Bring it back again.
    Redo,
    /// Show the field that asks which scene to open.
    AskOpen,
    /// Show the field that asks where to save.
    AskSaveAs,
    /// Open the scene at this path.
    Open(PathBuf),
    /// Save the scene where it came from, or ask where.
    Save,
    /// Save the scene at this path.
    SaveAs(PathBuf),
    /// Put away what asks.
    Dismiss,
    /// Put away a notice.
    DismissNotice(u64),
    /// Follow the system's theme, or choose one.
    SetTheme(egui::ThemePreference),
    /// Choose the colours that stand for numbers.
    SetColourMap(ColourMap),
}

/// A change of the scene: undoable, saved.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Edit {
    /// Gain of everything, dB.
    MasterGain(f64),
    /// Gain of a band, dB.
    BandGain(Band, f64),
    /// Compression κ, 0…1.
    Compression(f64),
    /// Gain of the textile at this place in the scene's list, dB.
    TextileGain(usize, f64),
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
}

impl Edit {
    /// What it turns.
    pub(crate) fn target(self) -> Target {
        match self {
            Self::MasterGain(_) => Target::MasterGain,
            Self::BandGain(band, _) => Target::BandGain(band),
            Self::Compression(_) => Target::Compression,
            Self::TextileGain(index, _) => Target::TextileGain(index),
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
        }
    }
}
