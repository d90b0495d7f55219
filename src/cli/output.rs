//! Where results go: standard output, or a file that appears only when it is whole.

use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

use super::CliError;
use crate::files::{FileError, TableWriter};

/// What standard output is called in errors.
const STDOUT: &str = "standard output";

/// A file that is written beside its place and moved there when it is whole. What is no ordinary
/// file (a device, a pipe) is written directly.
#[derive(Debug)]
pub(super) struct Staged {
    path: PathBuf,
    staged: Option<PathBuf>,
}

impl Staged {
    /// A file that will be at `path`.
    pub(super) fn new(path: &Path) -> Self {
        let is_special = fs::metadata(path).is_ok_and(|meta| !meta.is_file() && !meta.is_dir());
        let mut name = path.file_name().unwrap_or_default().to_owned();
        name.push(format!(".{}.part", std::process::id()));
        let staged = (!is_special).then(|| path.with_file_name(name));
        Self {
            path: path.to_owned(),
            staged,
        }
    }

    /// Where to write.
    pub(super) fn place(&self) -> &Path {
        self.staged.as_deref().unwrap_or(&self.path)
    }

    /// Creates the file to write.
    ///
    /// # Errors
    /// The place is wrong: its folder is missing or closed to us. That is wrong input.
    pub(super) fn create(&self) -> Result<BufWriter<File>, CliError> {
        if self.path.is_dir() {
            let path = self.path.display();
            return Err(CliError::Input(format!(
                "{path} is a folder; name a file in it"
            )));
        }
        let wrong = |error: io::Error| {
            let path = self.path.display();
            CliError::Input(format!("cannot write {path}: {error}; check the folder"))
        };
        File::create(self.place())
            .map(BufWriter::new)
            .map_err(wrong)
    }

    /// The file is whole: puts it in its place.
    pub(super) fn finish(mut self) -> Result<(), CliError> {
        let Some(staged) = &self.staged else {
            return Ok(());
        };
        fs::rename(staged, &self.path).map_err(|source| FileError::Write {
            path: self.path.clone(),
            source,
        })?;
        self.staged = None;
        Ok(())
    }
}

impl Drop for Staged {
    /// What was not finished is of no use to anybody.
    fn drop(&mut self) {
        if let Some(staged) = &self.staged {
            drop(fs::remove_file(staged));
        }
    }
}

/// A table on its way to a file, or to standard output when no file or `-` is named.
pub(super) struct TableOut {
    table: TableWriter<Box<dyn Write>>,
    staged: Option<Staged>,
}

impl TableOut {
    /// A table with this header.
    pub(super) fn new(path: Option<&Path>, header: &[&str]) -> Result<Self, CliError> {
        let (out, staged, name): (Box<dyn Write>, _, _) = match named_file(path) {
            None => (
                Box::new(BufWriter::new(io::stdout())),
                None,
                Path::new(STDOUT),
            ),
            Some(path) => {
                let staged = Staged::new(path);
                (Box::new(staged.create()?), Some(staged), path)
            }
        };
        Ok(Self {
            table: TableWriter::new(out, name, header)?,
            staged,
        })
    }

    /// The table, to add cells and end rows.
    pub(super) fn rows(&mut self) -> &mut TableWriter<Box<dyn Write>> {
        &mut self.table
    }

    /// Writes what is buffered and puts the file in its place.
    pub(super) fn finish(self) -> Result<(), CliError> {
        self.table.finish()?;
        self.staged.map_or(Ok(()), Staged::finish)
    }
}

/// A file named on the command line; `-` is standard output.
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

/// Writes a whole file.
pub(super) fn write_bytes(path: &Path, bytes: &[u8]) -> Result<(), CliError> {
    let staged = Staged::new(path);
    let mut file = staged.create()?;
    let written = file.write_all(bytes).and_then(|()| file.flush());
    written.map_err(|source| FileError::Write {
        path: path.to_owned(),
        source,
    })?;
    staged.finish()
}
