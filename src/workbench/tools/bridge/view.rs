//! What the pane of the device is drawn from.

use std::path::Path;

use crate::bench::arrays::wizard::Wizard;
use crate::bench::sources::SourcesView;
use crate::bench::view::EngineView;
use selvedge_device::{ArrayProfile, FaultWords};

/// What the pane is drawn from.
pub(crate) struct BridgePane<'a> {
    /// The engine and the device.
    pub live: &'a EngineView,
    /// What the link was opened to.
    pub target: Option<&'a str>,
    /// That of the second display, where the scene has one.
    pub(crate) second: Option<SecondDevice<'a>>,
    /// The array.
    pub array: ArrayView<'a>,
    /// What moves the display, and who hears of it.
    pub sources: &'a SourcesView,
    /// Whether a model says what the contactors do: those of the emulator in this program.
    pub has_actuator_model: bool,
    /// What goes wrong with the emulator that is connected; `None` for other devices.
    pub faults: Option<&'a FaultWords>,
    /// Why the last device was refused, lost or stopped.
    pub(crate) trouble: Option<&'a str>,
    /// Whether faults and the model of the contactors are shown.
    pub(crate) has_developer_tools: bool,
    /// Whether an armed device stops when the window loses the keyboard.
    pub(crate) stops_on_focus_loss: bool,
}

/// The device of the second display.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct SecondDevice<'a> {
    /// What its link was opened to.
    pub(crate) target: Option<&'a str>,
}

/// The array as the pane shows it.
pub(crate) struct ArrayView<'a> {
    /// The profile in force.
    pub profile: &'a ArrayProfile,
    /// Where its contactors are, mm; none where it is too large to be shown.
    pub places_mm: Vec<[f64; 2]>,
    /// Whether it is the user's.
    pub is_own: bool,
    /// The profiles that fit the scene's display, and which are the user's.
    pub choices: Vec<(String, bool)>,
    /// Whether what was changed waits until the device is disarmed.
    pub waits: bool,
    /// The contactor that is looked at closer.
    pub contactor: Option<usize>,
    /// Channels that are being identified.
    pub(crate) wizard: Option<&'a Wizard>,
    /// Where the user's profiles are kept.
    pub folder: Option<&'a Path>,
}
