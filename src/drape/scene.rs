//! The scene file `NAME.drape.toml`: which cloth hangs how, and which fingers are there.

mod hang;

use std::path::{Path, PathBuf};

use serde::Deserialize;

use super::DrapeError;
use super::fabric::Fabric;
use super::integrator::Integrator;
use super::kes::{self, Figures, Plausible};
use super::mesh::{Pins, Vector};
use super::sheet::Losses;
use selvedge_foundation::files::{self, Flaw};
use selvedge_textile::Library;

/// Most fingers.
const MAX_FINGERS: usize = 2;

/// A cloth that hangs, and fingers.
#[derive(Debug, Clone)]
pub struct DrapeScene {
    name: String,
    pub(crate) textile: Option<String>,
    /// The textile of its back, if that is another.
    pub(crate) back: Option<String>,
    /// Where its library is; `None` is that of the program.
    pub(crate) library_folder: Option<PathBuf>,
    size_mm: [f64; 2],
    pub(crate) grid: Option<[usize; 2]>,
    pins: Pins,
    pub(crate) losses: Losses,
    /// How it is stepped if nobody says otherwise.
    integrator: Integrator,
    pub(crate) step_ms: Option<f64>,
    /// What its laws were made from.
    pub(crate) figures: Figures,
    pub(crate) fabric: Fabric,
    /// What is odd about its figures.
    pub(crate) notes: Vec<String>,
    pub(crate) plausible: Plausible,
    pub(crate) fingers: Vec<FingerSpec>,
}

/// A finger of a scene.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct FingerSpec {
    /// +1 in front of the cloth, −1 behind it.
    pub(crate) side: f64,
    pub(crate) rotation_deg: f64,
    pub(crate) start_mm: [f64; 3],
    pub(crate) opening_mm: f64,
    /// It does what the first finger does.
    pub(crate) is_mirrored: bool,
    /// A device of its own leads it, where there is one.
    has_device: bool,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct SceneKeys {
    name: String,
    library: Option<PathBuf>,
    textile: Option<String>,
    back: Option<String>,
    #[serde(default = "usual_size_mm")]
    size_mm: [f64; 2],
    grid: Option<GridKey>,
    pins: Option<String>,
    air: Option<bool>,
    hysteresis: Option<bool>,
    friction: Option<f64>,
    tension: Option<PathBuf>,
    integrator: Option<String>,
    step_ms: Option<f64>,
    #[serde(default)]
    measured: Figures,
    #[serde(default, rename = "finger")]
    fingers: Vec<FingerKeys>,
}

#[derive(Deserialize)]
#[serde(untagged)]
enum GridKey {
    Word(String),
    Vertices([usize; 2]),
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct FingerKeys {
    display: Option<String>,
    side: Option<String>,
    mapping: Option<String>,
    #[serde(default)]
    rotation_deg: f64,
    start_mm: [f64; 3],
    opening_mm: f64,
}

fn usual_size_mm() -> [f64; 2] {
    [200.0; 2]
}

impl DrapeScene {
    /// Reads a scene file.
    ///
    /// # Errors
    /// One line: what is wrong, where, and how to mend it.
    pub fn read(path: &Path) -> Result<Self, DrapeError> {
        Self::from_text(&files::read_text(path)?, path)
    }

    /// The scene that is part of the program.
    ///
    /// # Errors
    /// Its textile is not in the program's library.
    pub fn shipped() -> Result<Self, DrapeError> {
        let text = include_str!("../../assets/scenes/denim.drape.toml");
        Self::from_text(text, Path::new("denim.drape.toml"))
    }

    /// The scene of a file's text; `path` is what messages call it and what libraries lie beside.
    ///
    /// # Errors
    /// As [`Self::read`].
    pub fn from_text(text: &str, path: &Path) -> Result<Self, DrapeError> {
        let keys: SceneKeys = files::keys_from_str(text, path)?;
        let wrong = |flaw: Flaw| DrapeError::from(flaw.in_file(text, path));
        if let Some(key) = keys.measured.keys().find(|key| !kes::is_known(key)) {
            let line = files::line_of_key(text, "measured", 0, key);
            let what = format!("unknown figure \"{key}\"");
            let mend = "name one of the Kawabata testers with its unit, such as emt_percent";
            return Err(files::FileError::content(path, line, what, mend).into());
        }
        let beside = path.parent().unwrap_or_else(|| Path::new(""));
        let library = keys.library.as_ref();
        let library = library.map(|name| Library::place(name, beside));
        let (figures, plausible) = match &keys.textile {
            Some(id) => kes::of_textile(id, library.as_deref())
                .map_err(|error| wrong(placed(("", 0, "textile"), &error)))?,
            None => (Figures::new(), Plausible::default()),
        };
        let curves = keys.tension.as_ref();
        let curves = curves
            .map(|name| kes::tension_curves(&beside.join(name)))
            .transpose()?;
        let (tension, of_curves) = curves.unzip();
        let stated = of_curves.unwrap_or_default().into_iter();
        let stated: Figures = stated.chain(keys.measured.clone()).collect();
        let plausible = plausible.without(&stated);
        let figures = figures.into_iter().chain(stated).collect();
        let (mut fabric, notes) = Fabric::of_figures(&figures)
            .map_err(|error| wrong(placed(("measured", 0, ""), &error)))?;
        fabric.tension = tension.unwrap_or(fabric.tension);
        if let Some(friction) = keys.friction {
            DrapeError::within(("friction", friction, ""), [0.0, 10.0])
                .map_err(|error| wrong(placed(("", 0, "friction"), &error)))?;
            fabric.friction = friction;
        }
        let mut scene = Self::from_keys(keys, &fabric).map_err(wrong)?;
        scene.figures = figures;
        (scene.notes, scene.plausible) = (notes, plausible);
        scene.library_folder = library;
        // What makes no grid is told where it stands.
        scene
            .mesh()
            .map_err(|error| wrong(placed(("", 0, "size_mm"), &error)))?;
        Ok(scene)
    }

    /// A scene of a textile of the library alone: 200 × 200 mm, pinned at its top.
    ///
    /// # Errors
    /// A textile that is unknown, or whose figures are.
    pub fn of_textile(id: &str) -> Result<Self, DrapeError> {
        let (figures, plausible) = kes::of_textile(id, None)?;
        let (fabric, notes) = Fabric::of_figures(&figures)?;
        Ok(Self {
            textile: Some(id.to_owned()),
            figures,
            notes,
            plausible,
            ..Self::plain(id.to_owned(), &fabric)
        })
    }

    /// A scene of a cloth about which nothing is said.
    fn plain(name: String, fabric: &Fabric) -> Self {
        Self {
            name,
            textile: None,
            back: None,
            library_folder: None,
            size_mm: usual_size_mm(),
            grid: None,
            pins: Pins::Top,
            losses: Losses::default(),
            integrator: Integrator::default(),
            step_ms: None,
            figures: Figures::new(),
            fabric: *fabric,
            notes: Vec::new(),
            plausible: Plausible::default(),
            fingers: Vec::new(),
        }
    }

    fn from_keys(keys: SceneKeys, fabric: &Fabric) -> Result<Self, Flaw> {
        let plain = Self::plain(keys.name, fabric);
        let grid = match keys.grid {
            None => None,
            Some(GridKey::Word(word)) if word == "auto" => None,
            Some(GridKey::Word(word)) => {
                let mend = "give \"auto\", or vertices along warp and weft such as [26, 26]";
                return Err(Flaw::new(
                    ("", 0, "grid"),
                    format!("the grid is \"{word}\""),
                    mend,
                ));
            }
            Some(GridKey::Vertices(vertices)) => Some(vertices),
        };
        let pins = Pins::named(keys.pins.as_deref())?;
        let named = keys
            .integrator
            .as_deref()
            .map_or(Ok(plain.integrator), str::parse);
        let integrator = named.map_err(|mend: String| {
            Flaw::new(("", 0, "integrator"), "this is no integrator", mend)
        })?;
        if keys.step_ms.is_some_and(|ms| !(1e-3..=1e3).contains(&ms)) {
            let mend = "give 0.001 to 1000 ms";
            return Err(Flaw::new(("", 0, "step_ms"), "this is no step", mend));
        }
        if keys.fingers.len() > MAX_FINGERS {
            let what = format!("there are {} fingers", keys.fingers.len());
            return Err(Flaw::new(
                ("finger", MAX_FINGERS, ""),
                what,
                "give two at most",
            ));
        }
        let fingers = keys.fingers.into_iter().enumerate();
        let fingers = fingers.map(|(nth, keys)| FingerSpec::from_keys(keys, nth));
        Ok(Self {
            textile: keys.textile,
            back: keys.back,
            size_mm: keys.size_mm,
            grid,
            pins,
            losses: Losses {
                has_air: keys.air.unwrap_or(plain.losses.has_air),
                has_hysteresis: keys.hysteresis.unwrap_or(plain.losses.has_hysteresis),
                ..plain.losses
            },
            integrator,
            step_ms: keys.step_ms,
            fingers: fingers.collect::<Result<_, _>>()?,
            ..plain
        })
    }

    /// What people call it.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The textile that it is of, if it is one of a library.
    pub fn textile(&self) -> Option<&str> {
        self.textile.as_deref()
    }

    /// The textiles that are felt on it: its face, then its back if that is another.
    pub fn surfaces(&self) -> impl Iterator<Item = &str> {
        self.textile().into_iter().chain(self.back.as_deref())
    }

    /// Width and height at rest, mm.
    pub fn size_mm(&self) -> [f64; 2] {
        self.size_mm
    }

    /// What is odd about its figures: a line each.
    pub fn notes(&self) -> impl Iterator<Item = &str> {
        self.notes.iter().map(String::as_str)
    }

    /// How many of its figures nobody measured, in words; `None` where all are stated.
    pub fn plausible(&self) -> Option<String> {
        self.plausible.line()
    }

    /// The keys of those.
    pub fn plausible_figures(&self) -> &[String] {
        &self.plausible.keys
    }

    /// Whether its second finger is led by a device of its own, where there is one.
    pub fn has_second_device(&self) -> bool {
        self.fingers.iter().any(|finger| finger.has_device)
    }

    /// Whether anything holds it, so that it comes to rest.
    pub(crate) fn is_hung(&self) -> bool {
        self.pins != Pins::None
    }

    /// Its mechanical laws.
    pub(crate) fn fabric(&self) -> &Fabric {
        &self.fabric
    }

    pub(crate) fn fingers(&self) -> &[FingerSpec] {
        &self.fingers
    }
}

impl FingerSpec {
    fn from_keys(keys: FingerKeys, nth: usize) -> Result<Self, Flaw> {
        let flaw = |key, what: String, mend: &str| Err(Flaw::new(("finger", nth, key), what, mend));
        if let Some(display) = keys.display.filter(|display| display != "exeter-24") {
            let what = format!("the display is \"{display}\"");
            return flaw(
                "display",
                what,
                "give \"exeter-24\": a pad has its 24 contactors",
            );
        }
        let side = match keys.side.as_deref() {
            None => [1.0, -1.0][nth.min(1)],
            Some("front") => 1.0,
            Some("back") => -1.0,
            Some(side) => {
                let what = format!("the side is \"{side}\"");
                return flaw("side", what, "give \"front\" or \"back\"");
            }
        };
        let [is_mirrored, has_device] = match keys.mapping.as_deref() {
            None | Some("path") => [false; 2],
            Some("mirrored") if nth > 0 => [true, false],
            Some("device") if nth > 0 => [false, true],
            Some(mapping) => {
                let what = format!("the mapping is \"{mapping}\"");
                return flaw(
                    "mapping",
                    what,
                    "give \"path\"; a second finger may be \"mirrored\" or \"device\"",
                );
            }
        };
        let numbers = [keys.rotation_deg, keys.opening_mm]
            .into_iter()
            .chain(keys.start_mm);
        if numbers.into_iter().any(|x| x.is_nan() || x.abs() > 1e4) {
            return flaw(
                "start_mm",
                "this is no place".to_owned(),
                "give numbers up to 10000",
            );
        }
        Ok(Self {
            side,
            rotation_deg: keys.rotation_deg,
            start_mm: keys.start_mm,
            opening_mm: keys.opening_mm,
            is_mirrored,
            has_device,
        })
    }

    /// Where the lowest point of its pad is wanted, m: half the opening from the centre of a grasp.
    pub(crate) fn target(&self, centre_mm: [f64; 3], opening_mm: f64) -> Vector {
        let [x_mm, y_mm, z_mm] = centre_mm;
        Vector::new(x_mm, y_mm, z_mm + self.side * 0.5 * opening_mm) * 1e-3
    }
}

/// An error of a value as one of the place where it stands.
fn placed(place: files::Place, error: &DrapeError) -> Flaw {
    Flaw::described(place, &error.to_string(), "correct it")
}
