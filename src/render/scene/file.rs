//! The scene file: which textiles lie where, which displays feel them, how they are tuned.
//!
//! Reads and writes the text; what makes a value wrong is said in `check.rs`. Loads no textile.

use std::collections::BTreeMap;
use std::ops::Range;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use super::arrangement::Arrangement;
use super::check::scene_flaw;
use super::placed::PlacedTextile;
use super::reference::RecordingReference;
use super::slots::TuningSlot;
use super::{ArrayLayout, Geometry, SceneError};
use selvedge_foundation::files::{self, Flaw};
use selvedge_foundation::geometry::{Displacement, Point};
use selvedge_textile::tactile::{Filters, Tuning};
use selvedge_textile::{Library, elsewhere, id_in};

/// A scene: a workspace of textiles, the displays that explore it, filters and tuning.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(try_from = "SceneKeys", into = "SceneKeys")]
pub struct Scene {
    /// What people call it.
    pub name: String,
    /// The library's folder or file of recipes, relative to the scene's file, or the name of one
    /// that is part of the program; `None` is the library shipped in the program.
    pub library: Option<PathBuf>,
    /// Width and height of the workspace, mm.
    pub size_mm: [f64; 2],
    /// The textiles in order; where they overlap the last one is on top.
    pub textiles: Vec<PlacedTextile>,
    /// One display per finger, at least one; the first is the default.
    pub displays: Vec<Display>,
    /// The filters of the two channels.
    pub filters: Filters,
    /// Gains and compression; `None` takes the library's default tuning.
    pub tuning: Option<Tuning>,
    /// Tunings that are kept to be compared, in the order of their letters.
    pub slots: Vec<TuningSlot>,
    /// Recordings that belong to it.
    pub recordings: Vec<RecordingReference>,
    /// What its textiles were when it was saved: the SHA-256 of their content by their ids. One
    /// that is not there may be anything.
    pub contents: BTreeMap<String, String>,
    /// How the window stands that it is shown in; `None` leaves that to the window.
    pub arrangement: Option<Arrangement>,
}

/// A tactile display.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Display {
    /// Where its contactors sit.
    pub geometry: Geometry,
    /// How it is turned on the finger, degrees counter-clockwise; a path's angle is added.
    pub rotation_deg: f64,
}

/// The scene as its file spells it.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct SceneKeys {
    name: String,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    library: Option<PathBuf>,
    size_mm: [f64; 2],
    #[serde(default, rename = "textile", skip_serializing_if = "Vec::is_empty")]
    textiles: Vec<PlacedTextile>,
    #[serde(default, rename = "display")]
    displays: Vec<DisplayKeys>,
    #[serde(default)]
    filters: Option<FilterKeys>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    tuning: Option<Tuning>,
    #[serde(default, rename = "slot", skip_serializing_if = "Vec::is_empty")]
    slots: Vec<TuningSlot>,
    #[serde(default, rename = "recording", skip_serializing_if = "Vec::is_empty")]
    recordings: Vec<RecordingReference>,
    #[serde(
        default,
        rename = "content",
        skip_serializing_if = "BTreeMap::is_empty"
    )]
    contents: BTreeMap<String, String>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    arrangement: Option<Arrangement>,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct DisplayKeys {
    #[serde(default, skip_serializing_if = "Option::is_none")]
    geometry: Option<String>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    contactors_mm: Option<Vec<Displacement>>,
    #[serde(default)]
    rotation_deg: f64,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct FilterKeys {
    kind: String,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    octaves: Option<f64>,
}

/// Whether a library is named by where it lies, and not one of the program.
fn is_path(library: &Path) -> bool {
    library.to_string_lossy().contains(['/', '\\'])
}

impl Scene {
    /// Reads a scene file.
    pub fn read(path: &Path) -> Result<Self, SceneError> {
        Self::from_toml(&files::read_text(path)?, path)
    }

    /// Reads the text of a scene file. `path` only names it in errors.
    pub fn from_toml(text: &str, path: &Path) -> Result<Self, SceneError> {
        let keys: SceneKeys = files::keys_from_str(text, path)?;
        let mut scene = Self::from_keys(keys).map_err(|flaw| flaw.in_file(text, path))?;
        scene.name_folders(|folder| {
            let folder = path
                .parent()
                .map_or_else(PathBuf::new, |at| at.join(folder));
            std::path::absolute(&folder).ok()
        });
        match scene_flaw(&scene) {
            Some(flaw) => Err(flaw.in_file(text, path).into()),
            None => Ok(scene),
        }
    }

    /// The text of its file. Reading it gives the same scene again.
    pub fn to_toml(&self) -> Result<String, SceneError> {
        self.check()?;
        Ok(files::keys_to_string(&self.keys(), Path::new("scene"))?)
    }

    /// Whether every value is one that a file may hold.
    pub fn check(&self) -> Result<(), SceneError> {
        scene_flaw(self).map_or(Ok(()), |flaw| Err(flaw.into()))
    }

    /// Writes a scene file; a crash leaves the old one or the new one. Folders of textiles beside
    /// it are named from there.
    pub fn write(&self, path: &Path) -> Result<(), SceneError> {
        let mut scene = self.clone();
        let beside = std::path::absolute(path).ok();
        let beside = beside.as_deref().and_then(Path::parent);
        scene.name_folders(|folder| {
            let folder = folder.strip_prefix(beside?).ok()?;
            Some(Path::new(".").join(folder))
        });
        Ok(files::write_atomic(path, scene.to_toml()?.as_bytes())?)
    }

    /// Names the folders of textiles of other libraries otherwise; `None` leaves one as it is.
    fn name_folders(&mut self, otherwise: impl Fn(&Path) -> Option<PathBuf>) {
        let named = |id: &str| {
            let (folder, id) = elsewhere(id).filter(|(library, _)| is_path(library))?;
            Some(id_in(&otherwise(folder)?, id))
        };
        for textile in &mut self.textiles {
            if let Some(named) = named(&textile.id) {
                textile.id = named;
            }
        }
        self.contents = (std::mem::take(&mut self.contents).into_iter())
            .map(|(id, content)| (named(&id).unwrap_or(id), content))
            .collect();
    }

    /// The topmost textile under a point of the workspace: its place in the list.
    pub fn textile_at(&self, point: Point) -> Option<usize> {
        self.textiles
            .iter()
            .rposition(|t| t.contains(t.workspace_from_textile().into_point(point)))
    }

    /// The contactors of a display among those of all displays one after the other.
    pub fn contactors_of(&self, display: usize) -> Range<usize> {
        let mut n_of_each = (self.displays.iter()).map(|placed| placed.geometry.n_contactors());
        let first = n_of_each.by_ref().take(display).sum();
        first..first + n_of_each.next().unwrap_or(0)
    }

    /// The library's folder as seen from where the program runs, for a scene file at `path`. A
    /// library of the program keeps its name.
    pub fn library_folder(&self, path: &Path) -> Option<PathBuf> {
        let folder = path.parent().unwrap_or_else(|| Path::new(""));
        let name = self.library.as_ref()?;
        Some(Library::place(name, folder))
    }

    fn from_keys(keys: SceneKeys) -> Result<Self, Flaw> {
        let mut displays = Vec::with_capacity(keys.displays.len().max(1));
        for (index, display) in keys.displays.into_iter().enumerate() {
            displays.push(Display::from_keys(display, index)?);
        }
        if displays.is_empty() {
            displays.push(Display::default());
        }
        Ok(Self {
            name: keys.name,
            library: keys.library,
            size_mm: keys.size_mm,
            textiles: keys.textiles,
            displays,
            filters: (keys.filters.as_ref())
                .map_or_else(|| Ok(Filters::default()), filters_from_keys)?,
            tuning: keys.tuning,
            slots: keys.slots,
            recordings: keys.recordings,
            contents: keys.contents,
            arrangement: keys.arrangement,
        })
    }

    fn keys(&self) -> SceneKeys {
        SceneKeys {
            name: self.name.clone(),
            library: self.library.clone(),
            size_mm: self.size_mm,
            textiles: self.textiles.clone(),
            displays: self.displays.iter().map(Display::keys).collect(),
            filters: Some(filter_keys(self.filters)),
            tuning: self.tuning,
            slots: self.slots.clone(),
            recordings: self.recordings.clone(),
            contents: self.contents.clone(),
            arrangement: self.arrangement.clone(),
        }
    }
}

impl Display {
    fn from_keys(keys: DisplayKeys, index: usize) -> Result<Self, Flaw> {
        let geometry = match (keys.geometry, keys.contactors_mm) {
            (Some(name), None) => {
                ArrayLayout::named(&name)
                    .map(Geometry::Array)
                    .ok_or_else(|| {
                        let what = format!("unknown geometry \"{name}\"");
                        Flaw::new(("display", index, "geometry"), what, geometry_choices())
                    })?
            }
            (None, Some(offsets)) => Geometry::Contactors(offsets),
            (Some(_), Some(_)) => {
                let what = "geometry and contactors_mm are both given";
                return Err(Flaw::new(
                    ("display", index, "contactors_mm"),
                    what,
                    "keep one",
                ));
            }
            (None, None) => {
                let what = "the display has no geometry";
                return Err(Flaw::new(("display", index, ""), what, geometry_choices()));
            }
        };
        Ok(Self {
            geometry,
            rotation_deg: keys.rotation_deg,
        })
    }

    fn keys(&self) -> DisplayKeys {
        let (geometry, contactors_mm) = match &self.geometry {
            Geometry::Array(layout) => (Some(layout.name().to_owned()), None),
            Geometry::Contactors(offsets) => (None, Some(offsets.clone())),
        };
        DisplayKeys {
            geometry,
            contactors_mm,
            rotation_deg: self.rotation_deg,
        }
    }
}

fn filters_from_keys(keys: &FilterKeys) -> Result<Filters, Flaw> {
    match (keys.kind.as_str(), keys.octaves) {
        ("log-gaussian", octaves) => {
            Ok(octaves.map_or_else(Filters::default, |octaves| Filters::LogGaussian { octaves }))
        }
        ("receptor", None) => Ok(Filters::Receptor),
        ("receptor", Some(_)) => {
            let what = "receptor filters have no octaves";
            Err(Flaw::new(("filters", 0, "octaves"), what, "remove the key"))
        }
        (kind, _) => {
            let what = format!("unknown filters \"{kind}\"");
            let mend = "give kind = \"log-gaussian\" or \"receptor\"";
            Err(Flaw::new(("filters", 0, "kind"), what, mend))
        }
    }
}

fn filter_keys(filters: Filters) -> FilterKeys {
    match filters {
        Filters::LogGaussian { octaves } => FilterKeys {
            kind: "log-gaussian".to_owned(),
            octaves: Some(octaves),
        },
        Filters::Receptor => FilterKeys {
            kind: "receptor".to_owned(),
            octaves: None,
        },
    }
}

fn geometry_choices() -> String {
    let names = ArrayLayout::ALL
        .map(|layout| format!("\"{}\"", layout.name()))
        .join(", ");
    format!("give geometry = {names}, or contactors_mm = [[x, y], …]")
}

impl From<Scene> for SceneKeys {
    fn from(scene: Scene) -> Self {
        scene.keys()
    }
}

impl TryFrom<SceneKeys> for Scene {
    type Error = SceneError;

    fn try_from(keys: SceneKeys) -> Result<Self, SceneError> {
        let scene = Self::from_keys(keys)?;
        scene.check().map(|()| scene)
    }
}

impl From<Flaw> for SceneError {
    fn from(flaw: Flaw) -> Self {
        Self::Value {
            what: flaw.what,
            mend: flaw.mend,
        }
    }
}
