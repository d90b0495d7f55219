//! `selvedge textile`: what is in a library, and how strong it is.

use std::path::{Path, PathBuf};

use clap::{Args, Subcommand};

use super::output::{Cell, JsonArgs, OutFile, TableOut};
use super::textile_catalogue::{self, CatalogueArgs};
use super::textile_import::{self, ConvertArgs, ImportArgs, RebuildArgs};
use super::textile_kes::{self, ImportKesArgs};
use super::textile_levels::levels;
use super::textile_make::{self, BuildArgs, MakeCommand};
use super::textile_models::{self, LearnArgs};
use super::{CliError, output, usage};

use selvedge_foundation::quantity::fixed;
use selvedge_textile::surface::{BIN_SPACING_PER_MM, Direction, Representation, Surface};
use selvedge_textile::tactile::{Filters, Levels};
use selvedge_textile::{Library, Textile};

/// What to do with textiles.
#[derive(Debug, Subcommand)]
pub(super) enum TextileCommand {
    /// List the textiles: id, construction, fibre, name
    List {
        #[command(flatten)]
        how: JsonArgs,
        #[command(flatten)]
        from: FromLibrary,
    },
    /// Show a textile: what it is, its roughness and its levels
    Show {
        /// The textile's id
        id: String,
        /// Print the recipe of a model instead, to make another from it
        #[arg(long, conflicts_with = "json")]
        recipe: bool,
        #[command(flatten)]
        how: JsonArgs,
        #[command(flatten)]
        from: FromLibrary,
    },
    /// Local spectra of a textile: power by direction, point and wavenumber
    Spectra {
        /// The textile's id
        id: String,
        /// The table (standard output if none is named)
        #[arg(long, value_name = "S.csv")]
        out: Option<OutFile>,
        #[command(flatten)]
        from: FromLibrary,
    },
    /// Mean amplitudes of every textile at 100 mm/s, before and after the default tuning
    Levels {
        /// The table (standard output if none is named)
        #[arg(long, value_name = "L.csv")]
        out: Option<OutFile>,
        #[command(flatten)]
        from: FromLibrary,
    },
    /// Pick the most typical textile of each kind of construction out of a library
    Select {
        #[command(flatten)]
        from: FromLibrary,
    },
    /// Build every textile of a library into a folder
    Build(BuildArgs),
    /// Make a textile from a recipe, or a library from recipes
    #[command(subcommand)]
    Make(MakeCommand),
    /// Learn a Fourier template from several profiles of a material
    LearnFourier(LearnArgs),
    /// Make a textile of measured heights: X3P, SUR, GWY, GSF, NPY, TMD, FRT, PNG, TIFF or text
    Import(ImportArgs),
    /// Make a textile again as its manifest says: from its recipe, or from its file of heights by
    /// the steps that are kept there; the same bytes if nothing was changed
    Rebuild(RebuildArgs),
    /// Write measured heights in another format: .x3p, .gsf, .npy, .png or .tif
    Convert(ConvertArgs),
    /// A textile from files of the Kawabata surface tester (KES-FB4)
    ImportKes(Box<ImportKesArgs>),
    /// A sheet for every textile: picture, profiles, spectra, amplitudes, measured figures
    Catalogue {
        #[command(flatten)]
        args: CatalogueArgs,
        #[command(flatten)]
        from: FromLibrary,
    },
}

/// The library that is meant.
#[derive(Debug, Args)]
pub(super) struct FromLibrary {
    /// Folder of textiles, file of recipes or "seventy-four" (the shipped library of sixteen if
    /// none is named)
    #[arg(long, value_name = "LIBRARY")]
    library: Option<PathBuf>,
}

impl FromLibrary {
    pub(super) fn open(&self) -> Result<Library, CliError> {
        let cache = selvedge_workbench::build_cache();
        Ok(Library::named_or_shipped(
            self.library.as_deref(),
            cache.as_ref(),
        )?)
    }

    /// The same, which holds a textile of this id or none that is like it.
    pub(super) fn of(&self, id: &str) -> Result<Library, CliError> {
        let library = self.open()?;
        usage::check_id(&library, id)?;
        Ok(library)
    }
}

/// Does it.
pub(super) fn run(command: &TextileCommand) -> Result<(), CliError> {
    match command {
        TextileCommand::List { how, from } => list(&from.open()?, how),
        TextileCommand::Show {
            id,
            recipe: true,
            from,
            ..
        } => textile_make::print_recipe(&from.of(id)?, id),
        TextileCommand::Show {
            id,
            recipe: false,
            how,
            from,
        } => show(&from.of(id)?, id, how),
        TextileCommand::Spectra { id, out, from } => spectra(&from.of(id)?, id, out.as_deref()),
        TextileCommand::Levels { out, from } => levels(&from.open()?, out.as_deref()),
        TextileCommand::Select { from } => select(&from.open()?),
        TextileCommand::Build(args) => textile_make::build(args),
        TextileCommand::Make(command) => textile_make::run(command),
        TextileCommand::LearnFourier(args) => textile_models::learn(args),
        TextileCommand::Import(args) => textile_import::import(args),
        TextileCommand::Rebuild(args) => textile_import::rebuild(args),
        TextileCommand::Convert(args) => textile_import::convert(args),
        TextileCommand::ImportKes(args) => textile_kes::run(args),
        TextileCommand::Catalogue { args, from } => textile_catalogue::run(&from.open()?, args),
    }
}

fn list(library: &Library, how: &JsonArgs) -> Result<(), CliError> {
    let mut rows = Vec::new();
    for id in library.ids() {
        let manifest = library.manifest(id)?;
        let construction = manifest.construction.word().to_owned();
        let row = [id.clone(), construction, manifest.fibre, manifest.name];
        rows.push(row.map(Cell::text));
    }
    let widths = [0, 1, 2].map(|column| {
        let width = |row: &[Cell; 4]| row[column].to_string().chars().count();
        rows.iter().map(width).max().unwrap_or(0)
    });
    let columns = ["id", "construction", "fibre", "name"];
    let line = |[id, construction, fibre, name]: &[Cell; 4]| {
        let [a, b, c] = widths;
        format!("{id:a$}  {construction:b$}  {fibre:c$}  {name}\n")
    };
    output::print_rows(how, columns, &rows, || rows.iter().map(line).collect())
}

fn select(library: &Library) -> Result<(), CliError> {
    let chosen = library.most_typical()?;
    let width = chosen.iter().map(|(_, id)| id.chars().count()).max();
    let width = width.unwrap_or(0);
    let lines: Vec<String> = chosen
        .iter()
        .map(|(kind, id)| format!("{id:width$}  {kind}\n"))
        .collect();
    output::print(&lines.concat())
}

fn show(library: &Library, id: &str, how: &JsonArgs) -> Result<(), CliError> {
    let textile = library.load(id)?;
    let own = described(&textile, id)?.into_iter().map(|(key, value)| {
        let line = format!("{key:14}{value}\n");
        ([key, &value].map(Cell::text), line)
    });
    let all = own.chain(textile_kes::figures(&textile.manifest().measured));
    let (rows, lines): (Vec<_>, Vec<String>) = all.unzip();
    output::print_rows(how, ["what", "value"], &rows, || lines.concat())
}

/// What there is to say of a textile: what, and its value.
fn described(textile: &Textile, id: &str) -> Result<Vec<(&'static str, String)>, CliError> {
    let manifest = textile.manifest();
    let levels = Levels::of(textile.surface(), &Filters::default());
    let n_points = Direction::ALL.map(|d| shape(textile.surface().spectra(d).shape()));
    let level = levels
        .level_db()
        .map_or_else(|| "none".to_owned(), |db| fixed(db, 2));
    let both = |values: [f64; 2], digits| values.map(|value| fixed(value, digits)).join(" / ");
    let mut rows = vec![
        ("id", id.to_owned()),
        ("name", manifest.name.clone()),
        ("construction", manifest.construction.word().to_owned()),
        ("fibre", manifest.fibre.clone()),
        ("source", manifest.source.kind().to_owned()),
        ("felt", felt(textile.surface()).to_owned()),
        ("notes", manifest.notes.clone()),
        ("licence", manifest.licence.clone()),
        ("gain", format!("{} dB", fixed(manifest.gain_db, 1))),
        (
            "roughness SMD",
            format!("{} µm", fixed(textile.surface().smd_um(), 2)),
        ),
        ("points", n_points.join(", ")),
        (
            "A40 / A320",
            format!("{} µm at 100 mm/s", both(levels.mean_um, 2)),
        ),
        ("variation", format!("{} of the mean", both(levels.cv, 2))),
        (
            "anisotropy",
            format!("{} dB", both(levels.anisotropy_db, 1)),
        ),
        ("level", format!("{level} dB re 1 µm")),
    ];
    rows.extend(manifest.source.assumed().map(|words| ("assumed", words)));
    if let Some(band) = &manifest.uncertainty {
        rows.extend(
            band.words()
                .map(|words| ("known to", format!("{words} (heights from a picture)"))),
        );
    }
    if let Some(friction) = textile.friction()? {
        let [miu, mmd] = [friction.miu(), friction.mmd()].map(|figure| fixed(figure, 4));
        let within = manifest.uncertainty.as_ref().and_then(|u| u.friction_level);
        let within = within.map_or_else(String::new, |level| format!(" ± {}", fixed(level, 4)));
        rows.push(("friction", format!("MIU {miu}{within}, MMD {mmd}")));
    }
    rows.extend(
        textile
            .fall_backs()
            .into_iter()
            .map(|note| ("fall-back", note)),
    );
    rows.retain(|(_, value)| !value.is_empty());
    Ok(rows)
}

/// Where a surface's spectra come from.
fn felt(surface: &Surface) -> &'static str {
    match surface.representation() {
        Representation::Economical => "along one profile a direction",
        Representation::Areal => "at every point of its area",
    }
}

/// How many points there are along a direction, and across it where they differ.
fn shape([n_along, n_across]: [usize; 2]) -> String {
    if n_across == 1 {
        n_along.to_string()
    } else {
        format!("{n_along} × {n_across}")
    }
}

fn spectra(library: &Library, id: &str, out: Option<&Path>) -> Result<(), CliError> {
    let textile = library.load(id)?;
    let header = ["direction", "point", "wavenumber_per_mm", "power_um2"];
    let mut table = TableOut::new(out, &header)?;
    for direction in Direction::ALL {
        let spectra = textile.surface().spectra(direction);
        for point in 0..spectra.n_points() {
            for (index, power_um2) in spectra.powers_um2(point).iter().enumerate() {
                let wavenumber_per_mm = BIN_SPACING_PER_MM * (index + 1) as f64;
                let row = table.rows();
                row.text(direction.key()).number(point);
                row.number(wavenumber_per_mm).number(power_um2).end_row()?;
            }
        }
    }
    table.finish()
}
