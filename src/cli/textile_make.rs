//! `selvedge textile make`: textiles from recipes, and a library from its recipes.
//!
//! A recipe is a manifest whose source is a model: `selvedge textile show ID --recipe` prints one.

use std::path::{Path, PathBuf};

use clap::{Args, Subcommand};

use super::terminal::Meter;
use super::textile_models::{self, BrownianArgs, FourierArgs, RestorationArgs};
use super::{CliError, output, signals};
use crate::files::{self, FileError};
use crate::progress::{CancelFlag, Progress};
use crate::textile::{self, Library, Manifest};

/// What to make.
#[derive(Debug, Subcommand)]
pub(super) enum MakeCommand {
    /// A woven cloth from a recipe of kind "weave"
    Weave(MakeArgs),
    /// A knitted cloth from a recipe of kind "knit"
    Knit(MakeArgs),
    /// A surface drawn from a template of harmonics
    Fourier(FourierArgs),
    /// A Brownian surface by its Hurst exponent
    Brownian(BrownianArgs),
    /// A surface restored from what repeats in measured profiles
    Restoration(RestorationArgs),
    /// Every textile of a folder anew, and the folder's library.toml
    Library {
        /// Folder with a folder for every textile
        from: PathBuf,
        /// The folder that the library is written to; it may be the same
        #[arg(long, value_name = "DIR")]
        out: PathBuf,
    },
}

/// A recipe, and where the textile goes.
#[derive(Debug, Args)]
pub(super) struct MakeArgs {
    /// The recipe: a manifest; "selvedge textile show ID --recipe" prints one
    recipe: PathBuf,
    /// The textile's folder
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
}

/// Makes it.
pub(super) fn run(command: &MakeCommand) -> Result<(), CliError> {
    match command {
        MakeCommand::Weave(args) => make("weave", &args.recipe, &args.out),
        MakeCommand::Knit(args) => make("knit", &args.recipe, &args.out),
        MakeCommand::Fourier(args) => textile_models::fourier(args),
        MakeCommand::Brownian(args) => textile_models::brownian(args),
        MakeCommand::Restoration(args) => textile_models::restoration(args),
        MakeCommand::Library { from, out } => make_library(from, out),
    }
}

/// Makes the textile of a recipe of this kind.
pub(super) fn make(kind: &str, recipe: &Path, out: &Path) -> Result<(), CliError> {
    let text = files::read_text(recipe)?;
    let manifest = Manifest::from_toml(&text, recipe)?;
    let found = manifest.source.kind();
    if found != kind {
        let line = files::line_of_key(&text, "source", 0, "kind");
        let what = format!("this is a recipe of kind \"{found}\", not \"{kind}\"");
        let mend = format!("use \"selvedge textile make {found}\"");
        return Err(FileError::content(recipe, line, what, mend).into());
    }
    let made = textile::make(&text, recipe, out)?;
    output::print(&format!("{}: {}\n", out.display(), made.name))
}

fn make_library(from: &Path, to: &Path) -> Result<(), CliError> {
    let library = Library::open(from)?;
    let mut tuning = library.default_tuning();
    // The reference level follows from the textiles made.
    tuning.compression_reference_db = None;
    let cancel = CancelFlag::shared(signals::stop_flag()?);
    let mut meter = Meter::new("making");
    let mut report = |share: f64, doing: &str| meter.show(share, doing);
    let mut progress = Progress::new(&mut report, cancel);
    let index = textile::build_library(&library, to, tuning, &mut progress)?;
    let n_made = index.textiles.len();
    output::print(&format!("{}: {n_made} textiles\n", to.display()))
}

/// Prints the recipe of a model.
pub(super) fn print_recipe(library: &Library, id: &str) -> Result<(), CliError> {
    let mut manifest = library.manifest(id)?;
    let recipe = manifest.source.recipe();
    if manifest.source.kind() == "profiles" {
        let what = format!("textile \"{id}\" was measured and has no recipe");
        return Err(CliError::Input(format!("{what}; name a model")));
    }
    manifest.source = recipe;
    manifest.appearance = None;
    manifest.measured.clear();
    output::print(&manifest.to_toml(Path::new(id))?)
}
