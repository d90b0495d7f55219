//! `selvedge figure`: a whole exploration on one page, with a caption.

use std::path::PathBuf;

use clap::Args;

use super::{CliError, output};
use selvedge_workbench::{FigureOf, build_cache, exploration_figure};

/// What is drawn, and where it goes.
#[derive(Debug, Args)]
pub(super) struct FigureArgs {
    /// Scene file
    scene: PathBuf,
    /// The exploration: a recording's folder or a path file (the scene's first recording if none is
    /// given)
    #[arg(long, value_name = "PATH")]
    path: Option<PathBuf>,
    /// The page without its ending: NAME.svg, NAME.png and the caption NAME.txt are written
    #[arg(long, value_name = "NAME")]
    out: PathBuf,
    /// The contactor whose spectrum is drawn, from 0 (the one that vibrated most)
    #[arg(long, value_name = "N")]
    contactor: Option<usize>,
}

/// Draws it.
///
/// # Errors
/// Scene or exploration cannot be read, the files cannot be written.
pub(super) fn run(args: &FigureArgs) -> Result<(), CliError> {
    let of = FigureOf {
        scene: args.scene.clone(),
        exploration: args.path.clone(),
        contactor: args.contactor,
    };
    let files = exploration_figure(&of, build_cache().as_ref())?;
    let parts = [
        ("svg", files.svg.as_slice()),
        ("png", files.png.as_slice()),
        ("txt", files.caption.as_bytes()),
    ];
    for (ending, bytes) in parts {
        let mut name = args.out.clone().into_os_string();
        name.push(".");
        name.push(ending);
        output::write_bytes(&PathBuf::from(name), bytes)?;
    }
    Ok(())
}
