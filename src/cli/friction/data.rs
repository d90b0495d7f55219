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

#[cfg(test)]
mod tests {
    use super::*;
    use clap::Parser;
    use selvedge_foundation::files::GrayImage;
    use selvedge_friction::Taken;
    use selvedge_scratch::ScratchFolder;

    #[derive(Debug, Parser)]
    struct Asked {
        #[command(flatten)]
        data: DataArgs,
    }

    fn fabrics(folder: &Path, more: &[&str]) -> Result<Vec<Fabric>, CliError> {
        let folder = folder.to_string_lossy();
        let args = ["asked", "--data", &*folder, "--px-per-mm", "10"];
        let asked = Asked::parse_from(args.iter().chain(more));
        assert_eq!(asked.data.name().as_deref(), Some("mine"));
        asked.data.fabrics().map(Option::unwrap)
    }

    /// Puts a fabric of 60 mm x 12 mm with a trace into a folder.
    fn put(folder: &ScratchFolder, trace: &str) {
        let values = (0..600 * 120_u32).map(|i| f64::from(i % 97) / 97.0);
        let picture = GrayImage::of_shares([600, 120], values);
        let png = picture.to_png("velvet.png".as_ref()).unwrap();
        folder.write("velvet.png", png);
        folder.write("velvet.csv", trace);
    }

    #[test]
    fn a_trace_of_places_has_their_scale_and_one_of_numbers_the_one_that_is_given() {
        let folder = ScratchFolder::made("mine");
        let mu = |at: i32| 0.4 + 0.01 * f64::from(at % 5);
        let place = |at| format!("{},{}\n", 3.0 + f64::from(at) / 12.5, mu(at));
        let places = (0..700).map(place).collect::<Vec<_>>().concat();
        put(&folder, &format!("x_mm,mu\n{places}"));
        let found = &fabrics(&folder, &[]).unwrap()[0];
        assert_eq!((found.name.as_str(), found.px_per_mm), ("velvet", 10.0));
        assert_eq!([found.picture.width(), found.picture.height()], [600, 120]);
        assert!((found.samples_per_mm - 12.5).abs() < 1e-9);
        assert_eq!(found.trace, (0..700).map(mu).collect::<Vec<_>>());
        // As HapTex has them: a number a line, blank lines between.
        let numbers: Vec<String> = (0..700).map(|at| format!("{}\n\n", mu(at))).collect();
        put(&folder, &numbers.concat());
        for (more, samples_per_mm) in [
            (&[] as &[&str], 12.9),
            (&["--samples-per-mm", "12.5"], 12.5),
        ] {
            let found = &fabrics(&folder, more).unwrap()[0];
            assert_eq!(found.samples_per_mm, samples_per_mm);
            assert_eq!(found.trace, (0..700).map(mu).collect::<Vec<_>>());
        }
    }

    #[test]
    fn a_trace_that_is_none_is_refused_with_its_file_and_line() {
        let folder = ScratchFolder::made("mine");
        for (trace, said) in [
            ("x_mm,mu\n0,0.3\n0.1,0.3\n0.5,0.3\n", "even steps"),
            ("x_mm,mu\n", "even steps"),
            ("", "this file is empty"),
            ("x_mm,mu\n1,0.3\n0,0.3\n", "even steps"),
            ("0.3\nwool\n", "\"wool\" is no number"),
            ("0.3\nNaN\n", "\"NaN\" is no number"),
        ] {
            put(&folder, trace);
            let refused = fabrics(&folder, &[]).unwrap_err().to_string();
            assert!(refused.contains(said), "{trace:?}: {refused}");
            assert!(refused.contains("velvet.csv"), "{refused}");
        }
        // Numbers that are no friction are refused with the fabric's name when it is learnt from.
        for trace in ["\n", "-0.3\n-0.3\n"] {
            put(&folder, trace);
            let one = fabrics(&folder, &[]).unwrap().swap_remove(0);
            let refused = Taken::of_fabrics(&[one.clone(), one.clone(), one]).unwrap_err();
            let refused = refused.to_string();
            assert!(
                refused.contains("velvet: its friction is none"),
                "{refused}"
            );
        }
    }
}
