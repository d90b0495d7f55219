//! What can go wrong with textiles, their files and their libraries: one line each, with what,
//! where, and how to mend it.

use std::path::{Path, PathBuf};

use crate::picture::ShadingError;
use crate::surface::SurfaceError;
use selvedge_chart::FigureError;
use selvedge_foundation::files::FileError;
use selvedge_foundation::progress::Cancelled;

/// What can be wrong with a textile or a library.
#[derive(Debug, thiserror::Error)]
pub enum TextileError {
    /// A file cannot be read or written, or its content is wrong.
    #[error(transparent)]
    File(#[from] FileError),
    /// Heights that are no surface.
    #[error("{}: {source}", path.display())]
    Surface {
        /// The file they come from.
        path: PathBuf,
        /// What is wrong.
        source: SurfaceError,
    },
    /// No such textile.
    #[error("no textile \"{id}\" in {library}; it has {known}")]
    Unknown {
        /// What was asked for.
        id: String,
        /// The library.
        library: String,
        /// What it has.
        known: String,
    },
    /// A textile that is no model has nothing to be built from.
    #[error(
        "{}: a source of kind \"{kind}\" is not a recipe; give kind = {recipes}",
        path.display()
    )]
    NoRecipe {
        /// The manifest.
        path: PathBuf,
        /// The kind it has.
        kind: String,
        /// The kinds that are recipes.
        recipes: String,
    },
    /// Measurements that no model can be made from: what, and how to mend it.
    #[error("{0}")]
    Model(String),
    /// Files of the surface tester that do not say enough.
    #[error("{}:{line}: {what}; {ask}", path.display())]
    Kes {
        /// The file.
        path: PathBuf,
        /// The line, from 1.
        line: usize,
        /// What is wrong.
        what: String,
        /// What must be said.
        ask: KesAsk,
    },
    /// A picture that shows no shape.
    #[error(transparent)]
    Shading(#[from] ShadingError),
    /// A picture that cannot be drawn.
    #[error(transparent)]
    Figure(#[from] FigureError),
    /// Nothing was measured on the textiles of a library.
    #[error(
        "{}: no levels were measured; build it with \"selvedge textile build\", which writes a \
         library.toml",
        library.display()
    )]
    NoIndex {
        /// The library.
        library: PathBuf,
    },
    /// The work was stopped.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

/// What must be said because the files do not.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum KesAsk {
    /// The sensitivity.
    #[error("say --um-per-volt UM, the height in µm that 1 V stands for")]
    UmPerVolt,
    /// The distance of samples.
    #[error("say --step-mm MM, or --speed-mm-per-s V and --rate-hz HZ")]
    Step,
    /// The speed.
    #[error("say --speed-mm-per-s V, the speed of the stroke")]
    Speed,
    /// Which stroke it is.
    #[error(
        "say --direction once a file: warp or weft, or warp-forward, warp-return, \
         weft-forward, weft-return"
    )]
    Direction,
    /// How a return stroke is stored.
    #[error("say --return-order travel (as measured) or mirrored (by place)")]
    ReturnOrder,
    /// The decimal sign.
    #[error("say --decimal point or --decimal comma")]
    Decimal,
    /// The unit of places.
    #[error("say --x-unit mm, cm or um")]
    XUnit,
    /// The unit of heights.
    #[error("say --height-unit um or mm, or --um-per-volt UM for volts")]
    HeightUnit,
    /// What the columns are.
    #[error("say --columns, such as x,forward,return (skip for one that does not matter)")]
    Columns,
    /// The evaluated section.
    #[error("say --section FROM,TO in mm on the cloth (or warp=FROM,TO and weft=FROM,TO)")]
    Section,
}

/// Textiles that are named when one is not found; more would hide what is wrong.
const MAX_NAMED: usize = 20;

impl TextileError {
    /// What is wrong with heights, as an error of where they come from.
    pub(crate) fn surface<P: Into<PathBuf>>(path: P) -> impl FnOnce(SurfaceError) -> Self {
        move |source| Self::Surface {
            path: path.into(),
            source,
        }
    }

    /// There is no textile of that id.
    pub(crate) fn unknown(id: &str, library: &Path, ids: &[String]) -> Self {
        let known = match ids.split_at_checked(MAX_NAMED) {
            _ if ids.is_empty() => "no textiles".to_owned(),
            Some((named, rest)) if !rest.is_empty() => {
                format!("{} and {} more", named.join(", "), rest.len())
            }
            _ => ids.join(", "),
        };
        Self::Unknown {
            id: id.to_owned(),
            library: library.display().to_string(),
            known,
        }
    }
}
