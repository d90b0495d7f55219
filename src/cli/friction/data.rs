//! A folder of fabrics: pictures, and the friction that was felt on each.

use std::fs;
use std::path::{Path, PathBuf};

use clap::Args;

use crate::CliError;
use crate::picture::positive;
use crate::terminal;
use selvedge_foundation::files::{FileError, PICTURE_ENDINGS, Table, read_text};
use selvedge_foundation::numerics::{Grid, to_single};
use selvedge_foundation::quantity::fixed;
use selvedge_friction::Fabric;

/// The table of means, where a folder has no traces.
const MEANS: &str = "friction.csv";

/// Fabrics of one's own, instead of procedural cloth.
#[derive(Debug, Args)]
pub(super) struct DataArgs {
    /// Folder of fabrics: NAME.png (JPEG, TIFF, BMP) with NAME.csv of `x_mm,mu` or a number a line,
    /// felt from the picture's left edge along its middle; or with friction.csv of `name,mu`
    #[arg(long, value_name = "DIR", requires = "px_per_mm")]
    data: Option<PathBuf>,
    /// Pixels to a millimetre of its pictures (11.81 at 300 dots to an inch)
    #[arg(long, value_name = "P", value_parser = positive)]
    px_per_mm: Option<f64>,
    /// Samples to a millimetre of traces without `x_mm`
    #[arg(long, value_name = "S", value_parser = positive, default_value_t = 12.9)]
    samples_per_mm: f64,
}

impl DataArgs {
    /// What the folder is called, if one is named.
    pub(super) fn name(&self) -> Option<String> {
        let name = self.data.as_deref()?.file_name()?;
        Some(name.to_string_lossy().into_owned())
    }

    /// The fabrics by name, with a notice of those whose friction is unlike all others'; `None`
    /// where no folder is named.
    pub(super) fn fabrics(&self) -> Result<Option<Vec<Fabric>>, CliError> {
        let (Some(folder), Some(px_per_mm)) = (&self.data, self.px_per_mm) else {
            return Ok(None);
        };
        let means = Means::of(folder)?;
        let mut fabrics = Vec::new();
        for path in pictures(folder)? {
            let name = path
                .file_stem()
                .map_or_else(String::new, |s| s.to_string_lossy().into_owned());
            let of_trace = path.with_extension("csv");
            let (trace, samples_per_mm) = if of_trace.exists() {
                self.trace(&of_trace)?
            } else if let Some(mean) = means.of_fabric(&name) {
                (vec![mean], self.samples_per_mm)
            } else {
                let what = format!("{}: no friction", path.display());
                return Err(CliError::Input(format!(
                    "{what}; put {name}.csv beside it, or {MEANS} of name,mu"
                )));
            };
            fabrics.push(Fabric {
                picture: brightness(&path)?,
                name,
                px_per_mm,
                trace,
                samples_per_mm,
            });
        }
        for (nth, ratio) in Fabric::unlike(&fabrics) {
            terminal::notice(&format!(
                "{}: its friction is {} times as far from the others as theirs from each other; \
                 look at its trace and its picture, or leave it out",
                fabrics[nth].name,
                fixed(ratio, 1)
            ));
        }
        Ok(Some(fabrics))
    }

    /// A trace and its samples a millimetre.
    fn trace(&self, path: &Path) -> Result<(Vec<f64>, f64), CliError> {
        let text = read_text(path)?;
        let first = text.lines().next().unwrap_or_default();
        if first.contains("x_mm") {
            let table = Table::read(&text, path, &["x_mm", "mu"], &[])?;
            let [x_mm, mu] = ["x_mm", "mu"].map(|column| table.required_numbers(column));
            let (x_mm, mu) = (x_mm?, mu?);
            let span_mm = x_mm.last().unwrap_or(&0.0) - x_mm.first().unwrap_or(&0.0);
            let per_mm = x_mm.len().saturating_sub(1) as f64 / span_mm;
            let is_even = per_mm.is_finite() && per_mm > 0.0 && {
                let place = |at: usize| x_mm[0] + at as f64 / per_mm;
                x_mm.iter()
                    .enumerate()
                    .all(|(at, x)| (x - place(at)).abs() < 0.1 / per_mm)
            };
            if is_even {
                return Ok((mu, per_mm));
            }
            let what = "x_mm does not rise in even steps";
            return Err(FileError::content(path, 2, what, "resample it").into());
        }
        let number = |(line, text): (usize, &str)| {
            text.trim()
                .parse::<f64>()
                .ok()
                .filter(|mu| mu.is_finite())
                .ok_or_else(|| {
                    FileError::content(
                        path,
                        line + 1,
                        format!("\"{text}\" is no number"),
                        "give x_mm,mu or a number a line",
                    )
                })
        };
        let told = text
            .lines()
            .enumerate()
            .filter(|(_, line)| !line.trim().is_empty());
        let mu: Result<Vec<f64>, FileError> = told.map(number).collect();
        Ok((mu?, self.samples_per_mm))
    }
}

/// Means of friction by name.
struct Means(Vec<(String, f64)>);

impl Means {
    fn of(folder: &Path) -> Result<Self, CliError> {
        let path = folder.join(MEANS);
        if !path.exists() {
            return Ok(Self(Vec::new()));
        }
        let table = Table::read(&read_text(&path)?, &path, &["name", "mu"], &[])?;
        let names = table.text("name").unwrap_or_default();
        let names = names.into_iter().map(ToOwned::to_owned);
        Ok(Self(names.zip(table.required_numbers("mu")?).collect()))
    }

    fn of_fabric(&self, name: &str) -> Option<f64> {
        self.0
            .iter()
            .find(|(known, _)| known == name)
            .map(|(_, mu)| *mu)
    }
}

/// The pictures of a folder, by name.
fn pictures(folder: &Path) -> Result<Vec<PathBuf>, CliError> {
    let entries = fs::read_dir(folder).map_err(FileError::read(folder))?;
    let is_picture = |path: &PathBuf| {
        let ending = path
            .extension()
            .map(|ending| ending.to_string_lossy().to_lowercase());
        ending.is_some_and(|ending| PICTURE_ENDINGS.contains(&ending.as_str()))
    };
    let mut paths: Vec<PathBuf> = entries
        .flatten()
        .map(|entry| entry.path())
        .filter(is_picture)
        .collect();
    paths.sort();
    Ok(paths)
}

/// A picture's brightness, 0 to 1.
pub(super) fn brightness(image: &Path) -> Result<Grid<f32>, CliError> {
    let bytes = selvedge_textile::read_measurement(image)?;
    let picture = selvedge_textile::picture::Picture::load(&bytes, image)?;
    Ok(picture.luminance.map(to_single))
}
