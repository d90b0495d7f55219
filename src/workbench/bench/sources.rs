//! What else can move the display, and who else hears of it: tablets that are read directly, and
//! other programs of this machine.
//!
//! Devices are listed and opened on threads of their own. The link to other programs lasts until
//! it is ended here; nothing of this is kept in files or undone.

use std::net::SocketAddr;
use std::path::{Path, PathBuf};

use crate::bench::background::Task;
use selvedge_engine::{InputDevice, InputError, PointerInput, ProgramCounts, ProgramLink};

/// What can be done with sources.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum SourceCommand {
    /// Look anew which devices there are.
    List,
    /// Take positions from this device.
    Device(PathBuf),
    /// Let other programs join.
    Listen,
    /// Let no program join any more.
    EndListening,
    /// Take positions from the program that joined.
    Program,
    /// Where the surface of tablets of this name lies, `X,Y,WIDTH,HEIGHT` in mm of the workspace;
    /// `None`: where it usually does.
    Area(String, Option<String>),
}

/// Where the surface of the tablet that was chosen last lies.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct SurfaceView {
    /// What the tablet calls itself.
    pub name: String,
    /// `[x, y, width, height]`, mm of the workspace.
    pub area_mm: [f64; 4],
    /// Whether the user said so.
    pub is_own: bool,
}

/// What is shown of the sources.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct SourcesView {
    /// Whether devices are being listed or opened now.
    pub(crate) is_busy: bool,
    /// Whether they have ever been listed.
    pub is_known: bool,
    /// Devices to choose from, and what they are.
    pub devices: Vec<(PathBuf, String)>,
    /// The surface of the one that was chosen last.
    pub surface: Option<SurfaceView>,
    /// Why some of them, or all, cannot be chosen.
    pub complaint: Option<String>,
    /// Where programs may join, and how it stands with them.
    pub programs: Option<(SocketAddr, ProgramCounts)>,
}

pub(crate) type Listed = Vec<Result<InputDevice, InputError>>;
pub(crate) type Opened = Box<dyn PointerInput>;

/// The sources that are known, and what is under way with them.
#[derive(Debug, Default)]
pub(crate) struct Sources {
    pub(crate) view: SourcesView,
    /// The devices as they were listed last.
    pub(crate) listed: Vec<InputDevice>,
    pub(crate) listing: Option<Task<Listed>>,
    pub(crate) opening: Option<Task<Opened>>,
    pub(crate) link: Option<ProgramLink>,
    /// What was chosen last.
    pub(crate) chosen: Option<(SourceCommand, String)>,
}

impl Sources {
    /// What is shown.
    pub(crate) fn view(&self) -> SourcesView {
        let link = self.link.as_ref();
        SourcesView {
            is_busy: self.listing.is_some() || self.opening.is_some(),
            programs: link.map(|link| (link.address(), link.counts())),
            ..self.view.clone()
        }
    }

    /// The device at this path, as it was listed last.
    pub(crate) fn listed(&self, path: &Path) -> Option<&InputDevice> {
        self.listed.iter().find(|device| device.path == path)
    }

    /// The device that was chosen last, if it was a device.
    pub(crate) fn chosen_device(&self) -> Option<&InputDevice> {
        match self.chosen()? {
            SourceCommand::Device(path) => self.listed(path),
            _ => None,
        }
    }

    /// What was chosen last, to be chosen again.
    pub(crate) fn chosen(&self) -> Option<&SourceCommand> {
        self.chosen.as_ref().map(|(chosen, _)| chosen)
    }

    /// What people call it.
    pub(crate) fn chosen_name(&self) -> Option<&str> {
        self.chosen.as_ref().map(|(_, name)| name.as_str())
    }

    pub(crate) fn take_listed(&mut self, listed: Result<Listed, String>) {
        self.view.is_known = true;
        let (found, mut complaint) = match listed {
            Ok(found) => (found, None),
            Err(line) => (Vec::new(), Some(line)),
        };
        self.listed.clear();
        for device in found {
            match device {
                Ok(device) => self.listed.push(device),
                Err(error) => complaint = complaint.or_else(|| Some(error.to_string())),
            }
        }
        let devices = self.listed.iter();
        self.view.devices = devices
            .map(|device| (device.path.clone(), described(device)))
            .collect();
        self.view.complaint = complaint;
    }
}

fn described(device: &InputDevice) -> String {
    match device.axes.map(|axis| axis.length_mm()) {
        [Some(width_mm), Some(height_mm)] => {
            format!("{}, {width_mm:.0} × {height_mm:.0} mm", device.name)
        }
        _ => device.name.clone(),
    }
}
