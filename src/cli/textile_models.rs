//! `selvedge textile make fourier|brownian|restoration` and `learn-fourier`: surfaces from a
//! template, an exponent or a measurement, without a recipe written by hand.
//!
//! Options become the recipe that could have been written; from there on everything goes the way of
//! recipes, so the manifest that is written makes the same bytes again.

use std::path::{Path, PathBuf};

use clap::Args;
use serde::Serialize;

use super::output::{InFile, OutFile};
use super::{CliError, output, terminal};
use selvedge_foundation::files::{self, FileError};
use selvedge_textile::surface::Profile;
use selvedge_textile::{FourierTemplate, Readings, Reduced, TextileError};

/// What every made surface takes.
#[derive(Debug, Args)]
pub(super) struct Common {
    /// A recipe: a manifest; without it the options say what is made
    recipe: Option<InFile>,
    /// The textile's folder
    #[arg(long, value_name = "DIR")]
    out: OutFile,
    /// What people call it
    #[arg(long, conflicts_with = "recipe")]
    name: Option<String>,
    /// Chooses what is drawn
    #[arg(long, default_value_t = 1, conflicts_with = "recipe")]
    seed: u32,
    /// Length of the patch, mm
    #[arg(long, conflicts_with = "recipe")]
    length_mm: Option<f64>,
    /// Distance of the samples, mm
    #[arg(long, conflicts_with = "recipe")]
    step_mm: Option<f64>,
}

/// A Brownian surface.
#[derive(Debug, Args)]
pub(super) struct BrownianArgs {
    #[command(flatten)]
    common: Common,
    /// Hurst exponent, 0.01 (jagged) to 0.99 (rolling)
    #[arg(long, value_name = "H", required_unless_present = "recipe")]
    hurst: Option<f64>,
    /// Mean roughness SMD of the strokes, µm
    #[arg(long, conflicts_with = "rise_um")]
    smd_um: Option<f64>,
    /// Instead: expected rms rise between points 1 mm apart, µm
    #[arg(long)]
    rise_um: Option<f64>,
    /// "exact", or "periodic", which repeats
    #[arg(long, value_parser = ["exact", "periodic"])]
    generator: Option<String>,
    /// No waves shorter than this, mm (periodic)
    #[arg(long)]
    shortest_mm: Option<f64>,
    /// Waves longer than this are no stronger than this one, mm (periodic)
    #[arg(long)]
    longest_mm: Option<f64>,
    /// What is drawn over it: a "point", or the tester's "wire"
    #[arg(long, value_parser = ["point", "wire"])]
    tip: Option<String>,
    /// Noise of the tip, µm rms
    #[arg(long)]
    noise_um: Option<f64>,
}

/// A surface from a Fourier template.
#[derive(Debug, Args)]
pub(super) struct FourierArgs {
    #[command(flatten)]
    common: Common,
    /// An example (fine-plain, soft-twill, coarse-plain, uneven-rib, heavy-canvas: invented) or a
    /// file of templates, of which the first is taken
    #[arg(long, value_name = "NAME|FILE", required_unless_present = "recipe")]
    template: Option<String>,
    /// Another one along the weft
    #[arg(long, value_name = "NAME|FILE")]
    weft_template: Option<String>,
    /// A surface of "independent" coefficients, or the "product" of two profiles
    #[arg(long, value_parser = ["independent", "product"])]
    composition: Option<String>,
    /// The sum as "corrected", or as printed ("literal")
    #[arg(long, value_parser = ["corrected", "literal"])]
    reading: Option<String>,
    /// Harmonics below are left out, cycles/m
    #[arg(long)]
    lowest_per_m: Option<f64>,
    /// Harmonics above are left out, cycles/m
    #[arg(long)]
    highest_per_m: Option<f64>,
}

/// A surface restored from measured profiles.
#[derive(Debug, Args)]
pub(super) struct RestorationArgs {
    #[command(flatten)]
    common: Common,
    /// Measured profile along the warp: a CSV of heights
    #[arg(long, value_name = "W.csv", required_unless_present = "recipe")]
    warp: Option<PathBuf>,
    /// Along the weft (the warp's, if none is named)
    #[arg(long, value_name = "F.csv")]
    weft: Option<PathBuf>,
    /// Harmonics that are kept, at most
    #[arg(long, default_value_t = 12)]
    harmonics: usize,
    /// Two profiles become a surface by "additive", "product", "max" or "gated"
    #[arg(long, value_parser = ["additive", "product", "max", "gated"])]
    composition: Option<String>,
    /// The harmonics alone, without noise like the residual
    #[arg(long)]
    no_residual: bool,
}

/// Profiles of one material.
#[derive(Debug, Args)]
pub(super) struct LearnArgs {
    /// Profiles of different places, alike in length and step
    profiles: Vec<InFile>,
    /// What probe and tracker read over time of one stroke; may be given several times
    #[arg(long, num_args = 2, value_names = ["PROBE.csv", "TRACKER.csv"])]
    readings: Vec<PathBuf>,
    /// Harmonics that are learnt, at most
    #[arg(long, default_value_t = 50)]
    harmonics: usize,
    /// What the material is called
    #[arg(long, default_value = "material")]
    name: String,
    /// The file of the template
    #[arg(long, value_name = "T.toml")]
    out: OutFile,
}

/// Makes a Brownian surface.
pub(super) fn brownian(args: &BrownianArgs) -> Result<(), CliError> {
    // Without any amplitude: as rough as a worsted.
    let smd_um = args
        .smd_um
        .or_else(|| args.rise_um.is_none().then_some(5.0));
    let keys = [
        ("hurst", args.hurst.map(number)),
        ("smd_um", smd_um.map(number)),
        ("rise_um", args.rise_um.map(number)),
        ("generator", args.generator.as_deref().map(text)),
        ("shortest_mm", args.shortest_mm.map(number)),
        ("longest_mm", args.longest_mm.map(number)),
        ("tip", args.tip.as_deref().map(text)),
        ("noise_um", args.noise_um.map(number)),
    ];
    let notes = "Model: a Brownian surface, no cloth.";
    make(&args.common, "brownian", notes, &keys, || Ok(String::new()))
}

/// Makes a surface from a template.
pub(super) fn fourier(args: &FourierArgs) -> Result<(), CliError> {
    #[derive(Serialize)]
    struct Tables {
        template: Option<FourierTemplate>,
        #[serde(skip_serializing_if = "Option::is_none")]
        weft_template: Option<FourierTemplate>,
    }
    let keys = [
        ("composition", args.composition.as_deref().map(text)),
        ("reading", args.reading.as_deref().map(text)),
        ("lowest_per_m", args.lowest_per_m.map(number)),
        ("highest_per_m", args.highest_per_m.map(number)),
    ];
    let notes = "Model: drawn from a template of harmonics.";
    make(&args.common, "fourier", notes, &keys, || {
        tables(&Tables {
            template: args.template.as_deref().map(template).transpose()?,
            weft_template: args.weft_template.as_deref().map(template).transpose()?,
        })
    })
}

/// Makes a restored surface.
pub(super) fn restoration(args: &RestorationArgs) -> Result<(), CliError> {
    #[derive(Serialize)]
    struct Tables {
        warp: Option<Reduced>,
        #[serde(skip_serializing_if = "Option::is_none")]
        weft: Option<Reduced>,
    }
    let keys = [
        ("composition", args.composition.as_deref().map(text)),
        ("residual", args.no_residual.then(|| "false".to_owned())),
    ];
    let reduced = |path: &PathBuf| -> Result<Reduced, CliError> {
        Ok(Reduced::of(&profile(path)?, args.harmonics)?)
    };
    let notes = "Model: restored from what repeats in measured profiles, and their noise.";
    make(&args.common, "restoration", notes, &keys, || {
        tables(&Tables {
            warp: args.warp.as_ref().map(reduced).transpose()?,
            weft: args.weft.as_ref().map(reduced).transpose()?,
        })
    })
}

/// Learns a template.
pub(super) fn learn(args: &LearnArgs) -> Result<(), CliError> {
    let mut profiles = Vec::new();
    for path in &args.profiles {
        profiles.push(profile(path)?);
    }
    for pair in args.readings.chunks_exact(2) {
        let read = |path: &Path, column: &str| -> Result<Readings, CliError> {
            Ok(Readings::from_csv(&files::read_text(path)?, path, column)?)
        };
        let (probe, tracker) = (read(&pair[0], "height_um")?, read(&pair[1], "x_mm")?);
        let imported = selvedge_textile::import(&probe, &tracker)?;
        terminal::notice(&format!(
            "{}: the worst sampling step is {:.3} mm; {} readings without progress",
            pair[1].display(),
            imported.worst_step_mm,
            imported.n_not_rising
        ));
        profiles.push(imported.profile);
    }
    let learnt = FourierTemplate::learn(&args.name, &profiles, args.harmonics)?;
    let n_harmonics = learnt.mean_cos_um.len();
    let text = FourierTemplate::list_to_toml(&[learnt], &args.out)?;
    files::write_atomic(&args.out, text.as_bytes())?;
    let out = args.out.display();
    let n = profiles.len();
    output::print(&format!("{out}: {n_harmonics} harmonics of {n} profiles\n"))
}

fn profile(path: &Path) -> Result<Profile, CliError> {
    Ok(Profile::read(&files::read_text(path)?, path)?)
}

/// An example by its name, or the first template of a file.
fn template(which: &str) -> Result<FourierTemplate, CliError> {
    let examples = FourierTemplate::examples()?;
    let path = Path::new(which);
    if let Some(found) = examples.iter().find(|template| template.name == which) {
        return Ok(found.clone());
    }
    if !path.exists() {
        let names: Vec<&str> = examples
            .iter()
            .map(|template| template.name.as_str())
            .collect();
        let known = names.join(", ");
        let what = format!("no file and no example template is called \"{which}\"");
        return Err(CliError::Input(format!("{what}; the examples are {known}")));
    }
    let found = FourierTemplate::list_from_toml(&files::read_text(path)?, path)?;
    let none = || FileError::content(path, 1, "no template", "add [[template]]");
    Ok(found.into_iter().next().ok_or_else(none)?)
}

/// Makes the textile of a recipe file, or of what the options say.
fn make(
    common: &Common,
    kind: &str,
    notes: &str,
    keys: &[(&str, Option<String>)],
    tables: impl FnOnce() -> Result<String, CliError>,
) -> Result<(), CliError> {
    if let Some(path) = &common.recipe {
        return super::textile_make::make(kind, path, &common.out);
    }
    let folder = common.out.file_name().unwrap_or_default();
    let name = common.name.clone();
    let name = name.unwrap_or_else(|| folder.to_string_lossy().into_owned());
    let mut lines = vec![
        format!("name = {}", text(&name)),
        "construction = \"other\"\nfibre = \"none\"\nlicence = \"\"".to_owned(),
        format!("notes = {}", text(notes)),
        format!("[source]\nkind = \"{kind}\"\nseed = {}", common.seed),
    ];
    let lengths = [
        ("length_mm", common.length_mm.map(number)),
        ("step_mm", common.step_mm.map(number)),
    ];
    for (key, value) in keys.iter().chain(&lengths) {
        lines.extend(value.as_ref().map(|value| format!("{key} = {value}")));
    }
    lines.push(tables()?);
    let recipe = lines.join("\n");
    let made = selvedge_textile::make(&recipe, Path::new("options"), &common.out);
    let made = made.map_err(without_line)?;
    output::print(&format!("{}: {}\n", common.out.display(), made.name))
}

/// Options have no lines.
fn without_line(error: TextileError) -> CliError {
    match error {
        TextileError::File(FileError::Content {
            path, what, mend, ..
        }) if path == Path::new("options") => CliError::Input(format!("{what}; {mend}")),
        error => error.into(),
    }
}

/// Tables of a recipe's source.
fn tables<T: Serialize>(source: &T) -> Result<String, CliError> {
    #[derive(Serialize)]
    struct File<'a, T> {
        source: &'a T,
    }
    Ok(files::keys_to_string(
        &File { source },
        Path::new("options"),
    )?)
}

/// A number as recipes spell it; what is none too, to be refused with its key.
fn number(value: f64) -> String {
    format!("{value:?}").to_lowercase()
}

/// Text as recipes spell it.
fn text(value: &str) -> String {
    format!("{value:?}")
}
