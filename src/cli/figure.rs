//! `selvedge figure`: an exploration of a scene, a recording or sessions of an experiment on one
//! page, with a caption.

use std::path::Path;

use clap::Args;

use super::output::{InFile, OutPage};
use super::terminal::with_meter;
use super::{CliError, output};
use selvedge_experiment::ExperimentError;
use selvedge_experiment::analysis::{self, Options};
use selvedge_foundation::files::read_text;
use selvedge_workbench::{FigureFiles, FigureOf, build_cache, exploration_figure};

/// What is drawn, and where it goes.
#[derive(Debug, Args)]
pub(super) struct FigureArgs {
    /// Scene file, a recording's folder, or the log of a session (or a folder of such logs)
    #[arg(value_name = "SCENE|RECORDING|LOG")]
    what: InFile,
    /// The exploration of a scene: a recording's folder or a path file (the scene's first recording
    /// if none is given)
    #[arg(long, value_name = "PATH")]
    path: Option<InFile>,
    /// The page without its ending: NAME.svg, NAME.png and the caption NAME.txt are written
    #[arg(long, value_name = "NAME")]
    out: OutPage,
    /// The contactor whose spectrum is drawn, from 0 (the one that vibrated most)
    #[arg(long, value_name = "N")]
    contactor: Option<usize>,
}

/// Draws it.
///
/// # Errors
/// Scene, exploration or log cannot be read, there is nothing to draw, the files cannot be written.
pub(super) fn run(args: &FigureArgs) -> Result<(), CliError> {
    let is_recording = args.what.join("recording.toml").exists();
    let is_log = args.what.extension().is_some_and(|ending| ending == "csv");
    let files = if !is_recording && (is_log || args.what.is_dir()) {
        of_sessions(args)?
    } else {
        let place = args.what.place().to_path_buf();
        let of = FigureOf {
            scene: if is_recording {
                None
            } else {
                Some((read_text(&args.what)?, place))
            },
            exploration: if is_recording {
                Some(args.what.to_path_buf())
            } else {
                args.path.as_deref().map(Path::to_path_buf)
            },
            contactor: args.contactor,
        };
        exploration_figure(&of, build_cache().as_ref())?
    };
    let parts = [&*files.svg, &*files.png, files.caption.as_bytes()];
    let paths = args.out.files();
    let name = |path: &Path| {
        path.file_name()
            .and_then(|name| name.to_str())
            .map(str::to_owned)
    };
    let names = paths.each_ref().map(|path| name(path).unwrap_or_default());
    let parent = args.out.parent().filter(|at| !at.as_os_str().is_empty());
    let folder = parent.unwrap_or_else(|| Path::new("."));
    if !folder.is_dir() || names.iter().any(String::is_empty) {
        let place = paths[0].display();
        return Err(CliError::Input(format!(
            "cannot write {place}; check the folder and the name"
        )));
    }
    let named: Vec<(&str, &[u8])> = names.iter().map(String::as_str).zip(parts).collect();
    output::write_folder(folder, &named)
}

/// What a session's answers come to, or those of a folder of sessions.
fn of_sessions(args: &FigureArgs) -> Result<FigureFiles, CliError> {
    let (what, none) = (args.what.display(), (args.path.is_none(), args.contactor));
    if none != (true, None) {
        let mend = "leave --path and --contactor out";
        return Err(CliError::Input(format!("{what} is no scene; {mend}")));
    }
    if !args.what.exists() {
        return Err(CliError::Input(format!(
            "{what} is not there; check the path"
        )));
    }
    let is_folder = args.what.is_dir();
    let parent = args.what.parent().filter(|at| !at.as_os_str().is_empty());
    let beside = parent.unwrap_or_else(|| Path::new("."));
    let folder: &Path = if is_folder { &args.what } else { beside };
    let options = Options {
        cache: build_cache(),
        ..Options::default()
    };
    let analysed = with_meter("analysing", |progress| {
        let (mut found, unread) = analysis::sessions(folder, progress)?;
        if !is_folder {
            found.retain(|session| session.log.file_name() == args.what.file_name());
        }
        let why = unread
            .into_iter()
            .find(|one| one.log.file_name() == args.what.file_name());
        if found.is_empty()
            && let Some(why) = why
        {
            return Err(why.error);
        }
        analysis::Analysis::of(&found, &options, progress)
    })?;
    let analysed = analysed.map_err(|error: ExperimentError| match error {
        ExperimentError::Cancelled(stopped) => CliError::from(stopped),
        other => other.into(),
    })?;
    let page = analysed.one_page(&args.out)?.ok_or_else(|| {
        let mend = "name the log of a session with answers, beside its .json";
        CliError::Input(format!("{what} gives no figure; {mend}"))
    })?;
    Ok(FigureFiles {
        svg: page.svg.into_bytes(),
        png: page.png,
        caption: page.caption,
    })
}
