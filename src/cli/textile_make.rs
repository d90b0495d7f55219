//! `selvedge textile make`: textiles from recipes, and a library from its recipes.
//!
//! A recipe is a manifest whose source is a model: `selvedge textile show ID --recipe` prints one.

use std::path::{Path, PathBuf};
use std::time::Instant;

use clap::{Args, Subcommand};

use super::output::{InFile, OutFile};
use super::terminal::with_meter;
use super::textile::FromLibrary;
use super::textile_models::{self, BrownianArgs, FourierArgs, RestorationArgs};
use super::{CliError, output};
use selvedge_foundation::files::{self, FileError};
use selvedge_foundation::progress::Progress;
use selvedge_foundation::quantity::fixed;
use selvedge_textile::{Library, Manifest};

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
        out: OutFile,
    },
}

/// A library of recipes, and where its textiles go.
#[derive(Debug, Args)]
pub(super) struct BuildArgs {
    #[command(flatten)]
    from: FromLibrary,
    /// The folder that the textiles are written to, with a library.toml
    #[arg(long, value_name = "DIR")]
    out: OutFile,
    /// Threads that share the work (as many as the machine has); the bytes are the same
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u8).range(1..))]
    threads: Option<u8>,
}

/// A recipe, and where the textile goes.
#[derive(Debug, Args)]
pub(super) struct MakeArgs {
    /// The recipe: a manifest; "selvedge textile show ID --recipe" prints one
    recipe: InFile,
    /// The textile's folder
    #[arg(long, value_name = "DIR")]
    out: OutFile,
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
    let made = selvedge_textile::make(&text, recipe, out)?;
    output::print(&format!("{}: {}\n", out.display(), made.name))
}

fn make_library(from: &Path, to: &Path) -> Result<(), CliError> {
    build_into(&Library::open(from)?, to, None)
}

/// Builds every textile of a library anew, whatever is kept from before.
pub(super) fn build(args: &BuildArgs) -> Result<(), CliError> {
    build_into(&args.from.open()?, &args.out, args.threads)
}

fn build_into(library: &Library, to: &Path, n_threads: Option<u8>) -> Result<(), CliError> {
    if library.ids().is_empty() {
        let mend = "name a folder with a folder for every textile, or a file of recipes";
        return Err(FileError::whole(&library.root(), "this holds no textile", mend).into());
    }
    let started = Instant::now();
    let mut tuning = library.default_tuning();
    // The reference level follows from the textiles made.
    tuning.compression_reference_db = None;
    let n_threads = n_threads.map_or_else(selvedge_textile::n_threads, usize::from);
    let build = |progress: &mut Progress<'_>| {
        selvedge_textile::Index::build(library, to, tuning, n_threads, progress)
    };
    let index = with_meter("making", build)??;
    let n_made = index.textiles.len();
    let seconds = fixed(started.elapsed().as_secs_f64(), 1);
    output::print(&format!(
        "{}: {n_made} textiles in {seconds} s, {n_threads} threads\n",
        to.display()
    ))
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
