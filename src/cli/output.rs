//! Where results go: standard output, or a file that appears only when it is whole; and text that
//! comes from a file or from standard input.

use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::path::Path;

use super::CliError;
use selvedge_foundation::files::{self, FileError, Staged, TableWriter};

/// What standard output is called in errors.
const STDOUT: &str = "standard output";
/// Where systems other than Windows have standard input among their files.
const STDIN: &str = "/dev/stdin";

/// Creates what a staged file is written to.
///
/// # Errors
/// The place is wrong: its folder is missing or closed to us. That is wrong input.
fn created(staged: &Staged) -> Result<BufWriter<File>, CliError> {
    let path = staged.path().display();
    if staged.path().is_dir() {
        let what = format!("{path} is a folder; name a file in it");
        return Err(CliError::Input(what));
    }
    let wrong = |error: io::Error| {
        CliError::Input(format!("cannot write {path}: {error}; check the folder"))
    };
    staged.create().map_err(wrong)
}

/// Where rows go.
pub(super) enum Out {
    /// Standard output.
    Stdout(BufWriter<io::Stdout>),
    /// A file.
    File(BufWriter<File>),
}

impl Write for Out {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        match self {
            Self::Stdout(out) => out.write(bytes),
            Self::File(out) => out.write(bytes),
        }
    }

    fn flush(&mut self) -> io::Result<()> {
        match self {
            Self::Stdout(out) => out.flush(),
            Self::File(out) => out.flush(),
        }
    }
}

/// A table on its way to a file, or to standard output when no file or `-` is named.
pub(super) struct TableOut {
    table: TableWriter<Out>,
    staged: Option<Staged>,
}

impl TableOut {
    /// A table with this header.
    pub(super) fn new(path: Option<&Path>, header: &[&str]) -> Result<Self, CliError> {
        let (out, staged, name) = match named_file(path) {
            None => {
                let out = Out::Stdout(BufWriter::new(io::stdout()));
                (out, None, Path::new(STDOUT))
            }
            Some(path) => {
                let staged = Staged::new(path);
                (Out::File(created(&staged)?), Some(staged), path)
            }
        };
        Ok(Self {
            table: TableWriter::new(out, name, header)?,
            staged,
        })
    }

    /// The table, to add cells and end rows.
    pub(super) fn rows(&mut self) -> &mut TableWriter<Out> {
        &mut self.table
    }

    /// Writes what is buffered and puts the file in its place.
    pub(super) fn finish(self) -> Result<(), CliError> {
        match (self.table.finish()?, self.staged) {
            (Out::File(out), Some(staged)) => Ok(staged.finish(out)?),
            _ => Ok(()),
        }
    }
}

/// The text of a file, or of standard input when `-` is named, and what messages call it.
pub(super) fn read_text(path: &Path) -> Result<(String, &Path), CliError> {
    match named_file(Some(path)) {
        Some(path) => Ok((files::read_text(path)?, path)),
        None => Ok((files::read_text(Path::new(STDIN))?, Path::new(STDIN))),
    }
}

/// A file named on the command line; `-` is standard output, or standard input.
pub(super) fn named_file(path: Option<&Path>) -> Option<&Path> {
    path.filter(|path| *path != Path::new("-"))
}

/// Writes text to standard output.
pub(super) fn print(text: &str) -> Result<(), CliError> {
    let mut out = io::stdout().lock();
    out.write_all(text.as_bytes())?;
    Ok(out.flush()?)
}

/// Writes a whole text to a file, or to standard output when no file or `-` is named.
pub(super) fn write_text(path: Option<&Path>, text: &str) -> Result<(), CliError> {
    match named_file(path) {
        Some(path) => write_bytes(path, text.as_bytes()),
        None => print(text),
    }
}

/// Makes a folder where it is missing.
pub(super) fn make_folder(folder: &Path, mend: &str) -> Result<(), CliError> {
    std::fs::create_dir_all(folder).map_err(|error| {
        let folder = folder.display();
        CliError::Input(format!("cannot make the folder {folder}: {error}; {mend}"))
    })
}

/// Writes a whole file.
pub(super) fn write_bytes(path: &Path, bytes: &[u8]) -> Result<(), CliError> {
    let staged = Staged::new(path);
    let mut out = created(&staged)?;
    out.write_all(bytes).map_err(|source| FileError::Write {
        path: path.to_owned(),
        source,
    })?;
    Ok(staged.finish(out)?)
}
