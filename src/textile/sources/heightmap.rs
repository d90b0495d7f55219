//! The kinds `heightmap` and `x3p`: a file of measured heights, over which the virtual tester is
//! drawn.

use std::path::Path;

use crate::error::TextileError;
use crate::metrology::{HeightOptions, Measured};
use crate::recipe::{Checker, HeightsFile, KeySpec, Recipe, defaults, keys, source};
use crate::surface::{
    Direction, HeightMap, Levelling, Preparation, Probe, Profile, ProfileSet, Representation,
    SurfaceError, WINDOW_LENGTH_MM, despiked,
};
use crate::unit::LengthUnit;
use selvedge_foundation::files::{FileError, sha256_hex};
use selvedge_foundation::numerics::{Random, to_index};

keys! {
    /// Measured heights (`kind = "heightmap"`, or `"x3p"` for a file of that format).
    source Heightmap {
        /// Whether it is felt along four strokes or at every point of its relief.
        #[serde(default, skip_serializing_if = "Representation::is_default")]
        pub(crate) representation: Representation,
        /// The file; beside the manifest unless the four profile files are named and felt.
        pub(crate) file: String,
        /// SHA-256 of the file; another file is refused.
        #[serde(skip_serializing_if = "Option::is_none")]
        pub(crate) sha256: Option<String>,
        /// The unit of heights, where the file does not state it.
        #[serde(skip_serializing_if = "Option::is_none")]
        pub(crate) height_unit: Option<LengthUnit>,
        /// The unit of places, where the file does not state it.
        #[serde(skip_serializing_if = "Option::is_none")]
        pub(crate) length_unit: Option<LengthUnit>,
        #[serde(skip_serializing_if = "Option::is_none")]
        pub(crate) step_mm: Option<f64>
            => "Step" 0.0005 ..= 0.5 "mm"
            "The distance of points, where the file does not state it",
        #[serde(skip_serializing_if = "Option::is_none")]
        pub(crate) range_um: Option<f64>
            => "Range" 1e-6 ..= 1e6 "µm"
            "The height of white above black in a picture without a scale",
        /// The column of a table that holds the heights.
        #[serde(skip_serializing_if = "Option::is_none")]
        pub(crate) column: Option<String>,
        /// Which of several fields of the file, from 1.
        #[serde(skip_serializing_if = "Option::is_none")]
        pub(crate) layer: Option<usize>,
        /// Whether a profile or a map whose points are not even is brought to even steps.
        #[serde(default, skip_serializing_if = "std::ops::Not::not")]
        pub(crate) resample: bool,
        /// The part that is taken: from u, w to u, w, mm from the lower left corner.
        #[serde(skip_serializing_if = "Option::is_none")]
        pub(crate) crop_mm: Option<[f64; 4]>,
        #[serde(skip_serializing_if = "Option::is_none")]
        pub(crate) despike: Option<f64>
            => "Spikes" 2.0 ..= 1000.0 ""
            "Heights so many robust spreads from those around them are missing",
        /// What is taken off; the best plane if not stated, nothing of what repeats.
        #[serde(skip_serializing_if = "Option::is_none")]
        pub(crate) level: Option<Levelling>,
        /// Where the strokes cross, mm from the lower left corner of the part; the middle if not
        /// stated.
        #[serde(skip_serializing_if = "Option::is_none")]
        pub(crate) place_mm: Option<[f64; 2]>,
        /// Whether the map is one repeat of the textile.
        #[serde(default, skip_serializing_if = "std::ops::Not::not")]
        pub(crate) periodic: bool,
        #[serde(default = "default_noise")]
        pub(crate) noise_um: f64
            => "Noise of the probe" 0.0 ..= 10.0 "µm" "Noise of the virtual tester, rms",
        /// Chooses that noise.
        #[serde(default = "default_seed")]
        pub(crate) seed: u32,
    }
}

defaults! {
    default_noise: f64 = Probe::default().noise_um;
    default_seed: u32 = 1;
}

impl Heightmap {
    /// The recipe of a file: the middle, with the tester's usual noise.
    pub(crate) fn new(file: String, asked: &HeightOptions) -> Self {
        source!(Self = "heightmap" {
            representation: Representation::default(),
            file,
            sha256: None,
            height_unit: asked.height_unit,
            length_unit: asked.length_unit,
            step_mm: asked.step_mm,
            range_um: asked.range_um,
            column: asked.column.clone(),
            layer: asked.layer,
            resample: asked.resample,
            crop_mm: None,
            despike: None,
            level: None,
            place_mm: None,
            periodic: false,
            noise_um: default_noise(),
            seed: default_seed(),
        })
    }

    fn asked(&self) -> HeightOptions {
        HeightOptions {
            height_unit: self.height_unit,
            length_unit: self.length_unit,
            step_mm: self.step_mm,
            range_um: self.range_um,
            column: self.column.clone(),
            layer: self.layer,
            resample: self.resample,
        }
    }

    /// Says how heights are prepared.
    pub(crate) fn set_preparation(&mut self, preparation: Preparation) {
        (self.crop_mm, self.despike) = (preparation.crop_mm, preparation.despike);
        self.level = preparation.level;
    }

    /// The heights of the file that are taken, without spikes. `path` names it in errors.
    pub(crate) fn open(&self, bytes: &[u8], path: &Path) -> Result<Measured, TextileError> {
        let found = sha256_hex([bytes]);
        if self
            .sha256
            .as_ref()
            .is_some_and(|sha256| !sha256.eq_ignore_ascii_case(&found))
        {
            let what = "this is not the file whose sha256 the manifest states";
            let mend = "restore that file, or import this one";
            return Err(FileError::whole(path, what, mend).into());
        }
        let mut measured = Measured::open(bytes, path, &self.asked())?;
        self.crop(&mut measured, path)?;
        if let Some(spreads) = self.despike {
            let (left, n) = despiked(&measured.heights_um, spreads);
            measured.heights_um = left;
            let line = format!("{n} points are spikes of more than {spreads} spreads: missing");
            measured.warnings.push(line);
        }
        let (n_missing, n) = (measured.n_missing(), measured.heights_um.values().len());
        if 2 * n_missing > n {
            let what = format!("{n_missing} of {n} points are missing, more than half");
            let mend = "measure again, or take a part that has heights: crop_mm (--crop)";
            return Err(FileError::whole(path, what, mend).into());
        }
        Ok(measured)
    }

    /// Takes the part that is wanted, whole points.
    fn crop(&self, measured: &mut Measured, path: &Path) -> Result<(), FileError> {
        let Some([u0, w0, u1, w1]) = self.crop_mm else {
            return Ok(());
        };
        let n = [measured.heights_um.width(), measured.heights_um.height()];
        let point = |mm: f64, axis: usize| (mm / measured.step_mm[axis]).round();
        let [from_u, to_u] = [u0, u1].map(|mm| point(mm, 0));
        // A profile has one row, wherever it lies.
        let [from_w, to_w] = match n[1] {
            1 => [0.0, 1.0],
            _ => [w0, w1].map(|mm| point(mm, 1)),
        };
        let sides = [from_u, from_w, to_u - from_u, to_w - from_w];
        let is_sound = sides.iter().all(|side| (0.0..=1e9).contains(side));
        let part = measured
            .heights_um
            .part(sides.map(to_index))
            .filter(|_| is_sound);
        let Some(part) = part else {
            let [width, height] = [0, 1].map(|axis| n[axis] as f64 * measured.step_mm[axis]);
            let what = format!("the part {u0},{w0} to {u1},{w1} mm is not on the map");
            let mend = format!("give crop_mm (--crop) from 0,0 to {width:.2},{height:.2} mm");
            return Err(FileError::whole(path, what, mend));
        };
        let (width, height) = (part.width(), part.height());
        let line = format!("the part {u0},{w0} to {u1},{w1} mm: {width} × {height} points");
        measured.warnings.push(line);
        measured.heights_um = part;
        Ok(())
    }

    /// The strokes over measured heights, by [`Direction::index`].
    pub fn strokes(&self, measured: &Measured, path: &Path) -> Result<ProfileSet, TextileError> {
        self.strokes_at(&self.laid(measured, path)?, self.place_mm, path)
    }

    /// Measured heights, level unless they repeat; missing points stay missing.
    pub(crate) fn level(
        &self,
        measured: &Measured,
        path: &Path,
    ) -> Result<HeightMap, TextileError> {
        let map = HeightMap::new(measured.heights_um.clone(), measured.step_mm);
        let map = map.map_err(TextileError::surface(path))?;
        let map = if measured.is_profile() {
            map.filled()
        } else {
            map
        };
        let is_repeat = self.periodic && !measured.is_profile();
        let usual = if is_repeat {
            Levelling::None
        } else {
            Levelling::Plane
        };
        let map = map.levelled(self.level.unwrap_or(usual));
        Ok(if is_repeat { map.periodic() } else { map })
    }

    /// Measured heights ready for strokes, and what was done to get there, one line each.
    pub(crate) fn laid(&self, measured: &Measured, path: &Path) -> Result<Laid, TextileError> {
        let mut notes = measured.warnings.clone();
        let n_missing = measured.n_missing();
        if n_missing > 0 {
            let n = measured.heights_um.values().len();
            notes.push(format!("{n_missing} of {n} points are missing: {FILLED}"));
        }
        let map = self.level(measured, path)?;
        let is_long = [0, 1].map(|axis| self.periodic || n_of(&map)[axis] >= n_window(&map, axis));
        if !is_long[0] {
            return Err(too_short(&map, path).into());
        }
        let is_profile = measured.is_profile();
        if is_profile && self.representation == Representation::Areal {
            let mend = "feel it along its stroke (economical), or give a map";
            return Err(FileError::whole(path, "a profile has no other points", mend).into());
        }
        if is_profile {
            let tilt = match self.level {
                None | Some(Levelling::Plane | Levelling::Rows) => "its tilt removed",
                Some(Levelling::Quadratic) => "its bow removed",
                Some(Levelling::None) => "its tilt left",
            };
            notes.push(format!("a single profile, {tilt}; no tester was drawn"));
        } else if !is_long[1] {
            let height_mm = map.size_mm()[1];
            notes.push(format!(
                "{height_mm:.2} mm across are less than a window: the weft is felt as the warp"
            ));
        }
        Ok(Laid {
            map,
            is_profile,
            has_weft: is_long[1],
            notes,
        })
    }

    /// The strokes that cross at a place, mm; in the middle if none is said.
    pub(crate) fn strokes_at(
        &self,
        laid: &Laid,
        place_mm: Option<[f64; 2]>,
        path: &Path,
    ) -> Result<ProfileSet, TextileError> {
        let size_mm = laid.map.size_mm();
        if laid.is_profile {
            return profile(&laid.map).map_err(TextileError::surface(path));
        }
        let place_mm = place_mm.unwrap_or_else(|| size_mm.map(|mm| 0.5 * mm));
        check_place(place_mm, size_mm, path)?;
        let probe = Probe {
            noise_um: self.noise_um,
            ..Probe::default()
        };
        let random = Random::new(u64::from(self.seed)).branch("probe");
        let strokes = laid.map.strokes(&probe, place_mm, &random);
        let mut profiles = strokes.map_err(|(_, error)| TextileError::surface(path)(error))?;
        if !laid.has_weft {
            for direction in [Direction::WeftForward, Direction::WeftReverse] {
                profiles[direction.index()] = None;
            }
        }
        Ok(profiles)
    }
}

impl HeightsFile for Heightmap {
    fn name(&self) -> &str {
        &self.file
    }

    fn height_map(&self, bytes: &[u8], path: &Path) -> Result<HeightMap, TextileError> {
        self.level(&self.open(bytes, path)?, path)
    }

    fn profiles(&self, bytes: &[u8], path: &Path) -> Result<ProfileSet, TextileError> {
        self.strokes(&self.open(bytes, path)?, path)
    }
}

impl Recipe for Heightmap {
    fn check(&self, checker: &Checker<'_>) -> Result<(), TextileError> {
        KeySpec::check(Self::KEYS, self, (checker, "source"))?;
        for place in self.place_mm.into_iter().flatten() {
            checker.within("source", "place_mm", place, 0.0..=10_000.0)?;
        }
        for end in self.crop_mm.into_iter().flatten() {
            checker.within("source", "crop_mm", end, 0.0..=100_000.0)?;
        }
        checker.file_name("source", "file", Some(&self.file))
    }

    fn representation(&self) -> Representation {
        self.representation
    }

    fn heights_file(&self) -> Option<Box<dyn HeightsFile>> {
        Some(Box::new(self.clone()))
    }
}

/// Measured heights as the tester goes over them.
#[derive(Debug, Clone)]
pub(crate) struct Laid {
    /// The heights, level unless they repeat; what is missing is still missing.
    pub(crate) map: HeightMap,
    is_profile: bool,
    /// Whether the weft is as long as a window.
    has_weft: bool,
    /// What is odd about them and what was done, one line each.
    pub(crate) notes: Vec<String>,
}

/// How missing points are filled for the strokes; the file keeps them missing.
const FILLED: &str = "filled along row and column between the nearest heights, mean of both";

fn n_of(map: &HeightMap) -> [usize; 2] {
    [map.heights_um().width(), map.heights_um().height()]
}

/// Samples of one window along an axis.
fn n_window(map: &HeightMap, axis: usize) -> usize {
    to_index(WINDOW_LENGTH_MM / map.step_mm()[axis] + 0.5)
}

fn too_short(map: &HeightMap, path: &Path) -> FileError {
    let [width_mm, height_mm] = map.size_mm();
    let what = format!(
        "{width_mm:.2} mm × {height_mm:.2} mm of surface where one window takes 4.35 mm along"
    );
    let mend = "measure a longer piece, turn the map, or state it as one repeat of the cloth \
                (periodic, --periodic)";
    FileError::whole(path, what, mend)
}

fn check_place(place_mm: [f64; 2], size_mm: [f64; 2], path: &Path) -> Result<(), FileError> {
    let is_inside = |axis: usize| (0.0..=size_mm[axis]).contains(&place_mm[axis]);
    if is_inside(0) && is_inside(1) {
        return Ok(());
    }
    let what = format!(
        "the place {:.2}, {:.2} mm is not on the map",
        place_mm[0], place_mm[1]
    );
    let mend = format!(
        "give one from 0, 0 to {:.2}, {:.2} mm",
        size_mm[0], size_mm[1]
    );
    Err(FileError::whole(path, what, mend))
}

/// A profile that was measured as one, level: forward along the warp.
fn profile(map: &HeightMap) -> Result<ProfileSet, SurfaceError> {
    let mut profiles = ProfileSet::default();
    let heights_um = map.heights_um().row(0).to_vec();
    let forward = Direction::WarpForward.index();
    profiles[forward] = Some(Profile::new(map.step_mm()[0], heights_um)?);
    Ok(profiles)
}
