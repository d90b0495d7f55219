//! `selvedge picture`: the lattice of a cloth's repeats, and the cell that repeats, from a picture.

use std::ffi::OsStr;
use std::fs;
use std::path::{Path, PathBuf};

use clap::Args;

use super::output::OutFile;
use super::picture_relief::{Origin, ReliefArgs, Seen, describe_none};
use super::terminal::{self, with_meter};
use super::{CliError, output, picture_folder};
use selvedge_foundation::progress::Progress;
use selvedge_foundation::quantity::{fixed, with_unit};
use selvedge_textile::n_threads;
use selvedge_textile::picture::{
    self, About, Analysis, AnalysisOptions, DirectionOptions, EvenLight, Found, Lattice, Picture,
    PictureScale, Place,
};

/// A picture, and what is known about it.
#[derive(Debug, Clone, Args)]
pub(super) struct PictureArgs {
    /// The picture: PNG, JPEG, TIFF or BMP, 8 or 16 bits, up to 64 million pixels; of a folder
    /// every picture in it
    pub(super) image: PathBuf,
    /// Folder for periodicity.json, maxima.csv and pictures of every stage; of several pictures for
    /// a folder each, and pictures.csv
    #[arg(long, value_name = "DIR")]
    pub(super) out: OutFile,
    /// Pixels to a millimetre; without a scale lengths are given in pixels only
    #[arg(long, value_name = "P", value_parser = positive, conflicts_with = "dpi")]
    px_per_mm: Option<f64>,
    /// Pixels to an inch, as scanners say it
    #[arg(long, value_name = "D", value_parser = positive)]
    dpi: Option<f64>,
    /// Threads to a centimetre, warp and weft, or one number if they are alike: the scale by the
    /// thread grid that is found
    #[arg(long, value_name = "WARP,WEFT", value_parser = threads)]
    #[arg(conflicts_with_all = ["dpi", "px_per_mm"])]
    threads_per_cm: Option<Threads>,
    /// The part to look at: its left, its top, its width and height in pixels
    #[arg(long, value_name = "X,Y,W,H", value_parser = region)]
    region: Option<[usize; 4]>,
    /// Corners of what is a rectangle of cloth, in pixels: upper left, upper right, lower right,
    /// lower left; it is drawn as seen from the front
    #[arg(long, value_name = "X,Y,X,Y,X,Y,X,Y", value_parser = corners, conflicts_with = "region")]
    corners: Option<Corners>,
    /// Divide uneven light out: auto (where it matters), off, or the radius in pixels over which it
    /// is smooth
    #[arg(long, value_name = "HOW", value_parser = light, default_value = "auto")]
    even_light: EvenLight,
    /// λ of the mean concentration in 1/px, instead of one from the distances of the maxima
    #[arg(long, value_name = "L", value_parser = positive)]
    lambda: Option<f64>,
    /// Threads that share the work (as many as the machine has); the bytes are the same
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u8).range(1..))]
    threads: Option<u8>,
    #[command(flatten)]
    relief: ReliefArgs,
}

/// Four corners in pixels.
#[derive(Debug, Clone, Copy)]
struct Corners([Place; 4]);

/// Threads to a centimetre, warp and weft.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Threads([f64; 2]);

fn threads(text: &str) -> Result<Threads, String> {
    let both = numbers(text).or_else(|| numbers(text).map(|[both]| [both; 2]));
    both.filter(|both: &[f64; 2]| both.iter().all(|n| (0.5..=1000.0).contains(n)))
        .map(Threads)
        .ok_or_else(|| "give one or two numbers from 0.5 to 1000, such as 24 or 24,20".to_owned())
}

pub(super) fn positive(text: &str) -> Result<f64, String> {
    let number = text
        .parse()
        .ok()
        .filter(|x: &f64| x.is_finite() && *x > 0.0);
    number.ok_or_else(|| "give a number above 0".to_owned())
}

pub(super) fn numbers<T: std::str::FromStr, const N: usize>(text: &str) -> Option<[T; N]> {
    let all: Option<Vec<T>> = text
        .split(',')
        .map(|cell| cell.trim().parse().ok())
        .collect();
    all?.try_into().ok()
}

fn region(text: &str) -> Result<[usize; 4], String> {
    numbers(text).ok_or_else(|| "give four whole numbers, such as 100,80,600,400".to_owned())
}

fn corners(text: &str) -> Result<Corners, String> {
    let all = numbers(text).filter(|all: &[f64; 8]| all.iter().all(|x| x.is_finite()));
    let [a, b, c, d, e, f, g, h] =
        all.ok_or_else(|| "give eight numbers, such as 10,12,590,20,600,400,5,390".to_owned())?;
    Ok(Corners([[a, b], [c, d], [e, f], [g, h]]))
}

fn light(text: &str) -> Result<EvenLight, String> {
    match text {
        "auto" => Ok(EvenLight::Auto),
        "off" => Ok(EvenLight::Off),
        _ => positive(text)
            .map(EvenLight::Radius)
            .map_err(|_wrong| "give auto, off, or a radius in pixels".to_owned()),
    }
}

impl PictureArgs {
    /// Refuses what cannot go together, before anything is reckoned.
    pub(super) fn check(&self) -> Result<(), CliError> {
        self.relief.check(self.scale())
    }

    /// The same of one picture of a folder.
    pub(super) fn of_folder(&self, image: &Path, name: &OsStr) -> Self {
        Self {
            image: image.to_owned(),
            out: self.out.join(name).into_os_string().into(),
            relief: self.relief.of_folder(name),
            ..self.clone()
        }
    }

    fn scale(&self) -> Option<PictureScale> {
        let of_dpi = || self.dpi.map(PictureScale::Dpi);
        let of_threads = || self.threads_per_cm.map(|n| PictureScale::ThreadsPerCm(n.0));
        let stated = self.px_per_mm.map(PictureScale::PxPerMm);
        stated.or_else(of_dpi).or_else(of_threads)
    }

    /// Pixels to a millimetre. Threads that were counted must be found.
    fn px_per_mm(&self, analysis: &Analysis) -> Result<Option<f64>, CliError> {
        let lattice = analysis.found.as_ref().map(|found| &found.lattice);
        let px_per_mm = self.scale().map(|scale| scale.px_per_mm(lattice.ok()));
        px_per_mm.transpose().map_err(|error| {
            let none = lattice.err().map(|reason| format!("{reason}; "));
            let path = self.image.display();
            CliError::Input(format!("{path}: {}{error}", none.unwrap_or_default()))
        })
    }

    fn about(&self, px_per_mm: Option<f64>) -> About {
        let name = self.image.file_name().unwrap_or_default();
        About {
            px_per_mm,
            scale: self.scale(),
            image: name.to_string_lossy().into_owned(),
            region: self.region,
            corners: self.corners.map(|corners| corners.0),
            ..About::default()
        }
    }
}

/// What is told of a picture.
pub(super) struct Told {
    pub(super) size_px: [usize; 2],
    /// The lattice and what its cells explain, or why there is none.
    pub(super) found: Result<(Lattice, f64), String>,
    described: String,
    warnings: Vec<String>,
}

impl Told {
    fn of(analysis: &Analysis, described: String) -> Self {
        let found = analysis.found.as_ref();
        let found = found.map(|found| (found.lattice, found.explained_variance));
        Self {
            size_px: [analysis.luminance.width(), analysis.luminance.height()],
            found: found.map_err(ToString::to_string),
            described,
            warnings: warnings(analysis),
        }
    }

    /// Prints it, and what to mind of this picture.
    pub(super) fn say(&self, image: &Path) -> Result<(), CliError> {
        for line in &self.warnings {
            terminal::notice(&format!("{}: {line}", image.display()));
        }
        output::print(&self.described)
    }
}

/// Analyses the picture, or all of a folder, and writes the files.
pub(super) fn run(args: &PictureArgs) -> Result<(), CliError> {
    if args.image.is_dir() {
        return picture_folder::run(args);
    }
    analysed(args)?.say(&args.image)
}

/// Analyses the picture and writes the files.
pub(super) fn analysed(args: &PictureArgs) -> Result<Told, CliError> {
    args.check()?;
    let bytes = selvedge_textile::read_measurement(&args.image)?;
    let loaded = Picture::load(&bytes, &args.image)?;
    let origin = Origin::of(&args.image, &bytes);
    drop(bytes);
    let chosen = choose(loaded, args)?;
    let n_threads = args.threads.map_or_else(n_threads, usize::from);
    let options = AnalysisOptions {
        light: args.even_light,
        directions: DirectionOptions {
            lambda_per_px: args.lambda,
        },
        n_threads,
    };
    let work = |progress: &mut Progress<'_>| -> Result<_, CliError> {
        let colour = chosen
            .colour
            .clone()
            .filter(|_| args.relief.textile.is_some());
        let analysis = Analysis::of(chosen, &options, progress)?;
        let px_per_mm = args.px_per_mm(&analysis)?;
        let of = (&origin, args.scale().zip(px_per_mm));
        let is_felt = analysis.found.is_ok() || args.relief.is_asked();
        let even = args.even_light;
        let seen = Seen {
            turned: args.relief.laid(&analysis, even, n_threads, progress)?,
            analysis,
            colour,
        };
        let felt = is_felt.then(|| args.relief.felt(&seen, of, n_threads, progress));
        let felt = felt.transpose()?;
        Ok((seen.analysis, px_per_mm, felt))
    };
    let (analysis, px_per_mm, felt) = with_meter("picture", work)??;
    let mut about = args.about(px_per_mm);
    let scale = (px_per_mm, args.threads_per_cm.is_some());
    let mut described = summary(&analysis, scale, &args.out);
    match felt {
        Some(Ok(felt)) => {
            described.push_str(&args.relief.finish(&felt, &args.out)?);
            about.relief = Some((felt.relief, felt.relief_um));
        }
        Some(Err(reason)) => {
            describe_none(&args.image, &reason);
            about.no_relief = Some(reason);
        }
        None => {}
    }
    let told = Told::of(&analysis, described);
    write(analysis, &about, &args.out)?;
    Ok(told)
}

fn write(analysis: Analysis, about: &About, out: &Path) -> Result<(), CliError> {
    output::make_folder(out, "name another with --out")?;
    let mut old = picture::FILE_NAMES.to_vec();
    picture::write_files(analysis, about, |name, bytes| {
        old.retain(|old| *old != name);
        output::write_bytes(&out.join(name), bytes)
    })?;
    // What an earlier picture left there would pass for this one's.
    for name in old {
        drop(fs::remove_file(out.join(name)));
    }
    Ok(())
}

fn choose(loaded: Picture, args: &PictureArgs) -> Result<Picture, CliError> {
    Ok(match (args.region, args.corners) {
        (Some(region), _) => loaded.part(region)?,
        (None, Some(corners)) => loaded.rectified(corners.0)?,
        (None, None) => loaded,
    })
}

/// What a user should know before using the result as a relief.
fn warnings(analysis: &Analysis) -> Vec<String> {
    let Ok(found) = &analysis.found else {
        return Vec::new();
    };
    let mut lines = Vec::new();
    if found.colour.is_printed() {
        let line = "the colour changes with the period: this may be a printed or dyed pattern, and \
                    brightness says nothing of its relief";
        lines.push(line.to_owned());
    }
    if let Some(unwarped) = &found.unwarped {
        lines.push(format!(
            "the cloth is bent: {}; it was laid straight, and the rest is of that",
            unwarped.words()
        ));
    }
    if found.drifts() {
        let (level, explained) = (
            fixed(found.lattice.level, 2),
            fixed(found.explained_variance, 2),
        );
        let tile = found
            .flat_part
            .map_or_else(String::new, |([x, y, w, h], explained)| {
                let explained = fixed(explained, 2);
                let part = format!("{x},{y},{w},{h}");
                format!(
                    ", so the tile is that of the part {part}, of which it explains {explained}"
                )
            });
        lines.push(format!(
            "repeats that are far apart drift: near ones agree with a correlation of {level}, the \
             mean of all cells explains {explained} of the variance{tile}; choose a flatter part \
             with --region"
        ));
    }
    lines
}

fn summary(
    analysis: &Analysis,
    (px_per_mm, is_counted): (Option<f64>, bool),
    out: &Path,
) -> String {
    let out = out.display();
    let Found {
        lattice,
        explained_variance,
        ..
    } = match &analysis.found {
        Ok(found) => found,
        Err(reason) => return format!("{out}: no lattice: {reason}\n"),
    };
    let (scale, unit, decimals) = px_per_mm.map_or((1.0, "px", 2), |per_mm| (per_mm, "mm", 3));
    let vector = |[x, y]: Place| {
        let [x, y] = [x, y].map(|px| fixed(px / scale, decimals));
        format!("({x}, {y}) {unit}")
    };
    let counted = px_per_mm
        .filter(|_| is_counted)
        .map_or_else(String::new, |px| {
            format!("{out}: {} by the threads\n", with_unit(px, 3, "px/mm"))
        });
    format!(
        "{out}: repeats by {} and {}{}, confidence {}, by chance {}, explains {} of the variance\n\
         {counted}",
        vector(lattice.p1_px),
        vector(lattice.p2_px),
        lattice
            .weave_name()
            .map_or_else(String::new, |name| format!(" ({name})")),
        fixed(lattice.confidence, 2),
        with_unit(100.0 * lattice.false_alarm_rate, 2, "%"),
        fixed(*explained_variance, 2),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_in_a_row_are_taken_whole_or_not_at_all() {
        assert_eq!(region("1, 2,3,4"), Ok([1, 2, 3, 4]));
        for text in ["1,2,3", "1,2,3,4,5", "1,2,3,-4", ""] {
            assert!(region(text).is_err(), "{text}");
        }
        assert_eq!(corners("0,0,9,0,9,8,0,8").unwrap().0[2], [9.0, 8.0]);
        assert!(corners("0,0,9,0,9,8,0,NaN").is_err(), "not a number");
        assert_eq!(light("12.5"), Ok(EvenLight::Radius(12.5)));
        assert_eq!(threads("24"), Ok(Threads([24.0; 2])));
        assert_eq!(threads("24, 20.5"), Ok(Threads([24.0, 20.5])));
        for text in ["0", "24,", "1,2,3", "NaN", "1e9"] {
            assert!(threads(text).is_err(), "{text}");
        }
        assert!(
            light("bright").is_err() && positive("-1").is_err() && positive("inf").is_err(),
            ""
        );
    }
}
