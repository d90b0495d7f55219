//! Every act of the user, as one value.
//!
//! Menus, shortcuts, buttons, sliders and tests all say what they want with a [`Command`];
//! `dispatch.rs` is the one place that does it. Panes never change anything themselves.

pub(crate) mod array;
pub(crate) mod device;
pub(crate) mod edit;
#[cfg(feature = "friction")]
pub(crate) mod friction;
pub(crate) mod lab;
pub(crate) mod recording;

pub(crate) use crate::bench::command::array::ArrayCommand;
pub(crate) use crate::bench::command::device::DeviceCommand;
pub(crate) use crate::bench::command::edit::Edit;
pub(crate) use crate::bench::command::recording::RecordingCommand;
pub(crate) use crate::bench::part::{DotStyle, Part};

use std::ops::Range;
use std::path::PathBuf;

use eframe::egui;

use crate::bench::keep::Keep;
use crate::bench::library_acts::LibraryCommand;
use crate::bench::overlays::Overlay;
use crate::bench::pane::{Exportable, Pane};
use crate::bench::perspective::Perspective;
use crate::bench::probe::Probe;
use crate::bench::rendering::Rendering;
use crate::bench::settings::preferences::Loudness;
use crate::bench::sources::SourceCommand;
use crate::kit::theme::colour_map::ColourMap;
use selvedge_engine::ClipKind;
use selvedge_foundation::geometry::Point;

/// What the user wants, in the order in which it was said.
pub(crate) type Commands = Vec<Command>;

/// Something that the user wants.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Command {
    /// What Esc does: everything off while a device is armed or a session is held; otherwise what
    /// lies on top is put away, or motion paused.
    Escape,
    /// Everything off, at once, from anywhere.
    AllOff,
    /// Change the scene.
    Edit(Edit),
    /// Take the last change back.
    Undo,
    /// Bring it back again.
    Redo,
    /// Take steps back or bring them again until so many are done.
    StepTo(usize),
    /// Do something with the device.
    Device(DeviceCommand),
    /// Do something with files.
    File(FileCommand),
    /// Move, record and replay.
    Play(PlayCommand),
    /// Do something with a recording of the list.
    Recording(RecordingCommand),
    /// Choose what else moves the display, or hears of it.
    Source(SourceCommand),
    /// Render scenes so from now on.
    Render(Rendering),
    /// Do something with the textiles of a library.
    Library(LibraryCommand),
    /// Begin a recipe in the textile lab.
    Lab(lab::Beginning),
    /// Show the friction of a picture.
    #[cfg(feature = "friction")]
    Friction(friction::PictureAtHand),
    /// Change what is shown how.
    Show(ShowCommand),
    /// Do something with the chosen textile, if one is.
    Chosen(Chosen),
    /// Put away what asks: a field, a question, the calibration, the help.
    Dismiss,
    /// Put away a notice, or all.
    DismissNotice(Option<u64>),
}

impl From<DeviceCommand> for Command {
    fn from(command: DeviceCommand) -> Self {
        Self::Device(command)
    }
}

impl From<ArrayCommand> for Command {
    fn from(command: ArrayCommand) -> Self {
        Self::Device(DeviceCommand::Array(command))
    }
}

impl From<FileCommand> for Command {
    fn from(command: FileCommand) -> Self {
        Self::File(command)
    }
}

impl From<Keep> for Command {
    fn from(keep: Keep) -> Self {
        Self::Library(LibraryCommand::Keep(keep))
    }
}

impl From<LibraryCommand> for Command {
    fn from(command: LibraryCommand) -> Self {
        Self::Library(command)
    }
}

impl From<PlayCommand> for Command {
    fn from(command: PlayCommand) -> Self {
        Self::Play(command)
    }
}

impl From<SourceCommand> for Command {
    fn from(command: SourceCommand) -> Self {
        Self::Source(command)
    }
}

impl From<ShowCommand> for Command {
    fn from(command: ShowCommand) -> Self {
        Self::Show(command)
    }
}

impl From<lab::Beginning> for Command {
    fn from(beginning: lab::Beginning) -> Self {
        Self::Lab(beginning)
    }
}

#[cfg(feature = "friction")]
impl From<friction::PictureAtHand> for Command {
    fn from(picture: friction::PictureAtHand) -> Self {
        Self::Friction(picture)
    }
}

impl From<Edit> for Command {
    fn from(edit: Edit) -> Self {
        Self::Edit(edit)
    }
}

/// What keys do with the chosen textile.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Chosen {
    /// Take it away.
    Remove,
    /// Mute it, or feel it again.
    Mute,
    /// Feel it alone, or with the others again.
    Solo,
    /// Lay it on top of the others.
    Raise,
}

/// What can be done with files.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum FileCommand {
    /// Ask for a path: by the desktop's dialog, or by a field where there is none.
    Ask(Purpose),
    /// Use this path for this purpose.
    Use(Purpose, PathBuf),
    /// Begin a scene without textiles.
    New,
    /// Open the scene that the program ships.
    OpenShipped,
    /// Save the scene where it came from, or ask where.
    Save,
    /// Copy what a pane shows as a table.
    CopyTable(Exportable),
    /// Close the window; asks first when the scene is not saved.
    Close,
    /// Stop the file for other programs that is written.
    StopClip,
    /// Go on with what was asked for and let the changes go.
    LetGo,
    /// Save the scene, leave drafts to the next start, and go on.
    SaveAll,
    /// Restore, discard or put off what an earlier run left.
    Left(Left),
}

/// What is done with work that an earlier run left.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Left {
    /// It is taken up.
    Restored,
    /// It is deleted.
    Discarded,
    /// It is offered again at the next start.
    PutOff,
}

/// What a path is asked for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) enum Purpose {
    /// Open a scene.
    OpenScene,
    /// Save the scene.
    SaveScene,
    /// Open a path file to replay.
    OpenRecording,
    /// Export the path of the recording at hand.
    SaveRecording,
    /// Save what a pane shows as a picture or a table.
    Export(Exportable),
    /// Save the recording for other programs.
    Clip(ClipKind),
    /// Take files of measurements to those that are imported.
    ImportFiles,
    /// Open a picture of cloth in this pane.
    OpenPicture(Pane),
    /// Add a picture of the cloth turned to the one that is open.
    AddTurned,
    /// Hang the cloth of a scene of its own.
    OpenDrape,
    /// Open a path of hands on the hanging cloth.
    OpenHands,
    /// Save the path of hands that was recorded.
    SaveHands,
    /// Look at the textiles of a folder too.
    AddLibrary,
    /// Run an experiment by this design.
    OpenDesign,
    /// Save the design of an experiment.
    SaveDesign,
    /// Analyse the logs in a folder.
    OpenLogs,
    /// Write the report of an analysis into a folder.
    WriteReport,
}

/// What moves the display, and how that is recorded.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum PlayCommand {
    /// Play what can be played, or hold it; with the pointer as the source, explore by itself.
    Toggle,
    /// Take positions from here.
    Source(PlaySource),
    /// Play one tick, then hold.
    Step,
    /// Back to the first tick.
    Rewind,
    /// To this tick of the recording.
    Seek(u64),
    /// Show this tick of the recording at hand, whatever moved the display before.
    ReplayAt(u64),
    /// Let every view show what was felt at this column of the last minutes, or what is felt now.
    LookBack(Option<u64>),
    /// Replay these ticks of the recording again and again, or no longer.
    LoopWithin(Option<Range<u64>>),
    /// Put a marker where the recording is.
    Mark,
    /// Whether a recording begins again at its end.
    Loop(bool),
    /// Begin again at its end if it did not, and the other way round.
    ToggleLoop,
    /// Begin or end a recording.
    ToggleRecording,
    /// Turn the display by this much, degrees counter-clockwise.
    Turn(f64),
    /// Turn the display back to the scene's own angle.
    TurnBack,
}

/// What moves the display.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum PlaySource {
    /// The pointer.
    Pointer,
    /// The display by itself, along a stroke.
    Stroke,
    /// The recording at hand.
    Recording,
    /// The tablet or program that was chosen last.
    Input,
}

/// What is shown how. Never undoable.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum ShowCommand {
    /// Follow the system's theme, or choose one.
    Theme(egui::ThemePreference),
    /// Choose the colours that stand for numbers.
    ColourMap(ColourMap),
    /// Size of everything: 1 is 100 %.
    Zoom(f32),
    /// Decide what a drag in the workspace does.
    Tool(Tool),
    /// Look at another part of the workspace.
    Look(Look),
    /// Show or hide a pane; a pane behind others comes to the front.
    Pane(Pane),
    /// Bring a pane to the front if it is not in sight.
    Reveal(Pane),
    /// Arrange the window for this.
    Perspective(Perspective),
    /// Put every pane back in its place.
    DefaultArrangement,
    /// The scene keeps how its window stands, or no longer.
    ToggleSceneArrangement,
    /// Look at this display of the scene.
    SelectDisplay(usize),
    /// Look at the one after it.
    NextDisplay,
    /// Look closer at this contactor.
    SelectContactor(usize),
    /// Choose the textile at this place in the scene's list, or none.
    SelectCloth(Option<usize>),
    /// Do not feel this.
    Mute(Part),
    /// Feel only what is solo.
    Solo(Part),
    /// Feel everything again.
    HearAll,
    /// Write numbers into the heatmaps, or no longer.
    ToggleNumbers,
    /// Grey what is too weak to be felt by the model, or no longer.
    ToggleThreshold,
    /// What the contactors' dots show by what.
    DotStyle(DotStyle),
    /// Let what is felt be heard, or no longer.
    ToggleSound,
    /// How loud that is.
    Loudness(Loudness),
    /// Let 40 Hz itself sound in place of its overtones, or the other way round.
    ToggleAsDriven,
    /// Draw this over the cloth, or no longer.
    Overlay(Overlay),
    /// Ask what textiles would give at this velocity.
    Probe(Probe),
    /// The pointer rests on this: every view marks it. Said with every frame, and done without a
    /// dispatch, so that nothing is drawn anew while the pointer stays.
    Hover(Part),
    /// Begin to calibrate the screen to true size.
    Calibrate,
    /// Show or hide the list of keys.
    Help,
    /// Show or hide the field that finds everything by its name.
    Palette,
    /// Show a page of the guide, by its name and perhaps a heading after `#`; hide the guide if it
    /// is shown and no page is named.
    Guide(Option<String>),
    /// Explain the pane in use.
    About,
    /// Begin the tour.
    Tour,
    /// Put the focus on the pane so many further in reading order.
    WalkPanes(i8),
    /// Show this pane alone, or the one in use; all again if one is alone.
    Maximise(Option<Pane>),
    /// Fill the screen, or no longer.
    FullScreen,
}

/// What a drag in the workspace does.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) enum Tool {
    /// It feels.
    #[default]
    Feel,
    /// It moves textiles.
    Arrange,
}

/// Which part of the workspace is shown.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Look {
    /// All of it.
    Fit,
    /// One millimetre is one millimetre on the screen.
    TrueSize,
    /// Closer by this factor, with this place of the workspace held where it is on the screen.
    Zoom(f64, Point),
    /// Closer by this factor around the middle.
    ZoomBy(f64),
    /// This place in the middle.
    Centre(Point),
}
