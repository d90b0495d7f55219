//! `selvedge picture`, from the cell that repeats on: heights, and a textile of them.

use std::ffi::OsStr;
use std::path::{Path, PathBuf};

use clap::Args;

use super::picture::{numbers, positive};
use super::textile_words::construction;
use super::usage::one_of;
use super::{CliError, terminal};
use selvedge_foundation::files::sha256_hex;
use selvedge_foundation::numerics::Grid;
use selvedge_foundation::progress::{Cancelled, Progress};
use selvedge_foundation::quantity::{fixed, with_unit};
use selvedge_textile::picture::brightness::Brightness;
use selvedge_textile::picture::shading::{Light, Method, ShadingError, ShadingOptions};
use selvedge_textile::picture::{
    Analysis, EvenLight, PictureScale, Relief, ReliefOf, Turned, TurnedPicture,
};
use selvedge_textile::surface::Representation;
use selvedge_textile::{
    BuiltFile, Construction, Description, Ensemble, HeightScale, Lamp, PictureTextile,
};

/// How heights are found on the cell, and what becomes of them.
#[derive(Debug, Clone, Args)]
pub(super) struct ReliefArgs {
    /// A further picture of the same cloth, turned by any angle in the plane under the same lamp;
    /// can be said three times. Heights, albedo and the light's tilt are then found together
    #[arg(long, value_name = "FILE", conflicts_with_all = ["region", "corners"])]
    turned: Vec<PathBuf>,
    /// Where the light came from: degrees from straight above, and degrees counter-clockwise from
    /// +x (to the right) towards the light, y up; estimated if not said
    #[arg(long, value_name = "SLANT,TILT", value_parser = light_from, allow_hyphen_values = true)]
    light: Option<Light>,
    /// Within how many degrees that is right (10)
    #[arg(long, value_name = "DEG", value_parser = positive, requires = "light")]
    light_within: Option<f64>,
    /// What is felt: the picture as it is, over and over; cloth synthesized of it, without a
    /// visible repetition; or the mean cell, which leaves out what varies from yarn to yarn
    #[arg(long, value_name = "WHAT", value_parser = one_of(GROUNDS), default_value = "picture")]
    relief_of: ReliefOf,
    /// How much cloth is synthesized, mm each way (60)
    #[arg(long, value_name = "MM", value_parser = positive, requires = "textile")]
    extent_mm: Option<f64>,
    /// How heights are found from brightness; if not said, by what the picture speaks for.
    /// tsai-shah and linear are the historical reference
    #[arg(long, value_name = "METHOD", value_parser = one_of(SHADINGS))]
    shading: Option<Method>,
    /// Iterations at most, 1 to 10000 (the method's own number)
    #[arg(long, value_name = "N")]
    iterations: Option<usize>,
    /// From the lowest to the highest point of the cloth, µm
    #[arg(long, value_name = "UM", value_parser = positive, conflicts_with = "smd_um")]
    relief_um: Option<f64>,
    /// The roughness SMD that a Kawabata tester reads on the cloth, µm; needs the scale
    #[arg(long, value_name = "UM", value_parser = positive)]
    smd_um: Option<f64>,
    /// Folder of a textile to make of it; needs the scale, and the relief or the SMD
    #[arg(long, value_name = "DIR")]
    pub(super) textile: Option<PathBuf>,
    /// What people call the textile (the picture's name)
    #[arg(long, default_value = "", requires = "textile")]
    name: String,
    /// How the textile is made
    #[arg(long, value_parser = construction(), default_value = "other", requires = "textile")]
    construction: Construction,
    /// Feel the textile at every point, not along the strokes
    #[arg(long, requires = "textile")]
    areal: bool,
}

const SHADINGS: [(&str, Method); 4] = [
    ("variational", Method::Variational),
    ("dark-is-deep", Method::DarkIsDeep),
    ("linear", Method::Linear),
    ("tsai-shah", Method::TsaiShah),
];

const GROUNDS: [(&str, ReliefOf); 3] = [
    ("picture", ReliefOf::Picture),
    ("synthesized", ReliefOf::Synthesized),
    ("cell", ReliefOf::Cell),
];

fn light_from(text: &str) -> Result<Light, String> {
    let wrong = || "give two numbers in degrees, such as 45,30".to_owned();
    let [slant_deg, tilt_deg] = numbers(text).ok_or_else(wrong)?;
    let light = Light {
        slant_deg,
        tilt_deg,
    };
    light.check().map_err(|error| error.to_string())?;
    Ok(light)
}

/// What was found, and the textile's files.
pub(super) struct Felt {
    pub(super) relief: Relief,
    pub(super) relief_um: Option<f64>,
    files: Option<Vec<BuiltFile>>,
    /// What to do about a wide band.
    advice: Option<String>,
    /// How further pictures lie over the first, in a line each.
    turned: Vec<String>,
}

/// What was seen of the cloth.
pub(super) struct Seen {
    pub(super) analysis: Analysis,
    /// Shares of red and green in the picture.
    pub(super) colour: Option<Grid<[u16; 2]>>,
    /// Further pictures, laid over it, and as its textile names them.
    pub(super) turned: Vec<(Turned, TurnedPicture)>,
}

/// The picture as its textile names it.
pub(super) struct Origin<'a> {
    pub(super) path: &'a Path,
    pub(super) sha256: String,
}

impl<'a> Origin<'a> {
    pub(super) fn of(path: &'a Path, bytes: &[u8]) -> Self {
        let sha256 = sha256_hex([bytes]);
        Self { path, sha256 }
    }
}

impl ReliefArgs {
    /// The same of one picture of a folder: its textile has a folder and a name of its own.
    pub(super) fn of_folder(&self, name: &OsStr) -> Self {
        Self {
            textile: self.textile.as_ref().map(|folder| folder.join(name)),
            name: name.to_string_lossy().into_owned(),
            ..self.clone()
        }
    }

    /// Refuses what cannot go together, before anything is reckoned.
    pub(super) fn check(&self, scale: Option<PictureScale>) -> Result<(), CliError> {
        let refuse = |line: &str| Err(CliError::Input(line.to_owned()));
        let has_height = self.relief_um.is_some() || self.smd_um.is_some();
        let mend = "give --px-per-mm, --dpi or --threads-per-cm";
        if self.textile.is_some() && scale.is_none() {
            return refuse(&format!("--textile needs the picture's scale; {mend}"));
        }
        if self.textile.is_some() && !has_height {
            return refuse("--textile needs the height of the cloth; give --relief-um or --smd-um");
        }
        if self.smd_um.is_some() && scale.is_none() {
            return refuse(&format!("--smd-um needs the picture's scale; {mend}"));
        }
        let options = self.options();
        if self.turned.len() > Turned::MAX {
            return refuse("--turned takes up to three further pictures; leave some out");
        }
        let is_several = !self.turned.is_empty();
        if is_several && self.relief_of == ReliefOf::Cell {
            return refuse("--turned goes with --relief-of picture or synthesized");
        }
        if is_several && self.shading == Some(Method::TsaiShah) {
            return refuse("--shading tsai-shah takes one picture; leave --turned out");
        }
        if self.extent_mm.is_some() && self.relief_of != ReliefOf::Synthesized {
            return refuse("--extent-mm goes with --relief-of synthesized");
        }
        let is_linear = options.method == Method::Linear && self.iterations.is_some();
        if is_linear {
            return refuse("--shading linear has no iterations; leave --iterations out");
        }
        Ok(())
    }

    /// Whether heights were asked for in any way, so that none are an error.
    pub(super) fn is_asked(&self) -> bool {
        let words = [
            !self.turned.is_empty(),
            self.light.is_some(),
            self.shading.is_some(),
            self.iterations.is_some(),
            self.relief_um.is_some(),
            self.smd_um.is_some(),
            self.textile.is_some(),
        ];
        words.contains(&true)
    }

    fn options(&self) -> ShadingOptions {
        // Of a textile whose method is not chosen another relief is kept than the first.
        let is_first_alone = self.textile.is_some() && self.shading.is_none();
        ShadingOptions {
            method: self.shading.unwrap_or_default(),
            iterations: self.iterations.or_else(|| is_first_alone.then_some(1)),
            ..ShadingOptions::default()
        }
    }

    fn about(&self, origin: &Origin<'_>, scaled: Option<(PictureScale, f64)>) -> PictureTextile {
        let name = origin.path.file_name().unwrap_or_default();
        let stem = origin.path.file_stem().unwrap_or_default();
        let scale = match (self.relief_um, self.smd_um) {
            (Some(um), _) => HeightScale::ReliefUm(um),
            (None, Some(um)) => HeightScale::SmdUm(um),
            (None, None) => HeightScale::Unscaled,
        };
        let called = if self.name.trim().is_empty() {
            stem.to_string_lossy().into_owned()
        } else {
            self.name.clone()
        };
        PictureTextile {
            name: Description::of(&called).name,
            construction: self.construction,
            px_per_mm: scaled.map_or(0.0, |(_, px_per_mm)| px_per_mm),
            px_scale: scaled.map(|(scale, _)| scale),
            scale,
            picture: Some([name.to_string_lossy().into_owned(), origin.sha256.clone()]),
            extent_mm: (self.relief_of == ReliefOf::Synthesized)
                .then(|| self.extent_mm.unwrap_or(PictureTextile::EXTENT_MM)),
            light_is_estimated: self.light.is_none(),
            representation: if self.areal {
                Representation::Areal
            } else {
                Representation::Economical
            },
            ..PictureTextile::default()
        }
    }

    /// Reads the further pictures and lays them over the first.
    pub(super) fn laid(
        &self,
        analysis: &Analysis,
        even: EvenLight,
        n_threads: usize,
        progress: &mut Progress<'_>,
    ) -> Result<Vec<(Turned, TurnedPicture)>, CliError> {
        let mut all = Vec::new();
        for path in &self.turned {
            let bytes = selvedge_textile::read_measurement(path)?;
            let other = (bytes.as_slice(), path.as_path());
            all.push(Turned::read(
                &analysis.luminance,
                other,
                even,
                n_threads,
                progress,
            )?);
        }
        Ok(all)
    }

    /// Finds the heights of a picture; why there are none where nobody asked.
    pub(super) fn felt(
        &self,
        seen: &Seen,
        (origin, scaled): (&Origin<'_>, Option<(PictureScale, f64)>),
        n_threads: usize,
        progress: &mut Progress<'_>,
    ) -> Result<Result<Felt, String>, CliError> {
        let px_per_mm = scaled.map(|(_, px_per_mm)| px_per_mm);
        let path = origin.path.display();
        let found = seen.analysis.found.as_ref().ok();
        let (turned, kept): (Vec<_>, Vec<_>) = seen.turned.iter().cloned().unzip();
        let ground = (self.relief_of, &seen.analysis.luminance);
        let brightness = if turned.is_empty() {
            Brightness::ground(ground, found, px_per_mm, n_threads)
        } else {
            Some(Brightness::of_turned(ground.1, &turned, found)?)
        };
        let Some(brightness) = brightness else {
            let what = "there is no lattice and so no cell";
            let mend = "leave --relief-of cell out";
            return Err(CliError::Input(format!("{path}: {what}; {mend}")));
        };
        let mut relief = match Relief::of(brightness, self.light, &self.options(), progress) {
            Ok(relief) => relief,
            Err(ShadingError::Cancelled(_)) => return Err(Cancelled.into()),
            Err(error) if self.is_asked() => {
                return Err(CliError::Input(format!("{path}: {error}")));
            }
            Err(error) => return Ok(Err(error.to_string())),
        };
        let mut about = self.about(origin, scaled);
        about.size_px = Some(relief.brightness.size_px);
        about.turned = kept;
        let advice = match &self.textile {
            Some(_) => {
                let shares = (seen.colour.as_ref(), turned.as_slice());
                let colours = relief.brightness.colours(shares, (self.relief_of, found));
                about.colours = Some(colours);
                let own = (&mut relief, self.shading.is_some());
                Ensemble::believe(own, &mut about, self.lamp(), n_threads, progress)?
            }
            None => None,
        };
        let wants = self.textile.as_ref();
        let made = wants.map(|_| {
            let tile = found.map(|found| &found.tile);
            PictureTextile::files_of(&relief.shape, &relief.brightness, tile, &about)
        });
        let made = made.transpose()?;
        let relief_um = match (about.scale, px_per_mm, &made) {
            (_, _, Some(made)) => Some(made.relief_um),
            (HeightScale::Unscaled, ..) => None,
            (HeightScale::ReliefUm(um), None, _) => Some(um),
            _ => Some(PictureTextile::relief_um_of(&relief.shape, &about)?),
        };
        Ok(Ok(Felt {
            relief,
            relief_um,
            turned: seen
                .turned
                .iter()
                .map(|(one, kept)| one.words(&kept.picture))
                .collect(),
            files: made.map(|made| made.files),
            advice,
        }))
    }

    /// The lamp, as far as it is said where it stood.
    fn lamp(&self) -> Lamp {
        self.light.map_or(Lamp::Unknown, |light| Lamp::Known {
            light,
            within_deg: self.light_within.unwrap_or(Lamp::WITHIN_DEG),
        })
    }

    /// Writes the textile, if one is wanted, and tells in lines what was found.
    pub(super) fn finish(&self, felt: &Felt, out: &Path) -> Result<String, CliError> {
        let light = felt.relief.light;
        let by = felt.relief.shape.method.label();
        let (slant, tilt) = (fixed(light.slant_deg, 1), fixed(light.tilt_deg, 1));
        let estimate = felt.relief.estimate.as_ref();
        let estimated = estimate.map_or_else(String::new, |e| format!(", estimated: {}", e.words));
        let height = match felt.relief_um {
            Some(um) => with_unit(um, 1, "µm"),
            None => format!("{}, unscaled", with_unit(felt.relief.relief_px(), 2, "px")),
        };
        let (out, words) = (out.display(), &felt.relief.shape.reliability);
        let laid: Vec<String> = felt
            .turned
            .iter()
            .map(|one| format!("{out}: {one}\n"))
            .collect();
        let laid = laid.concat();
        let first = format!("{out}: heights by {by} under light of slant {slant}°, tilt {tilt}°");
        let mut described =
            format!("{laid}{first}{estimated}\n{out}: {height} from lowest to highest. {words}\n");
        if let (Some(folder), Some(files)) = (&self.textile, &felt.files) {
            selvedge_textile::write(files, folder)?;
            let line = format!("{}: the textile\n", folder.display());
            described.push_str(&line);
        }
        if let Some(advice) = &felt.advice {
            let line = format!("{out}: {advice}\n");
            described.push_str(&line);
        }
        Ok(described)
    }
}

/// Tells why there are no heights.
pub(super) fn describe_none(path: &Path, reason: &str) {
    terminal::notice(&format!("{}: no heights: {reason}", path.display()));
}
