//! Where results go: standard output, or a file that appears only when it is whole; and what is
//! read: a file, or standard input.
//!
//! A file is declared by its kind where options are: [`InFile`] is read, [`OutFile`] written.

use std::collections::BTreeMap;
use std::ffi::OsString;
use std::fmt;
use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::ops::Deref;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU32, Ordering};

use clap::Args;
use serde::Serialize;

use super::CliError;
use selvedge_foundation::files::{FileError, Staged, TableWriter, to_json_string};

/// What standard output is called in errors.
const STDOUT: &str = "standard output";
/// Where systems other than Windows have standard input among their files.
const STDIN: &str = "/dev/stdin";

/// A file that a command reads; `-` is standard input.
#[derive(Debug, Clone)]
pub(super) struct InFile(PathBuf);

/// A file or folder that a command writes; `-` is standard output.
#[derive(Debug, Clone)]
pub(super) struct OutFile(PathBuf);

/// A page that a command writes: its name without the ending of each of its files.
#[derive(Debug, Clone)]
pub(super) struct OutPage(PathBuf);

impl InFile {
    /// Whether it is standard input.
    pub(super) fn is_stream(&self) -> bool {
        self.0 == Path::new(STDIN)
    }

    /// The file as messages call it and as what it names is relative to: of standard input, to
    /// where the command was given.
    pub(super) fn place(&self) -> &Path {
        if self.is_stream() {
            Path::new("-")
        } else {
            &self.0
        }
    }
}

impl From<OsString> for InFile {
    fn from(word: OsString) -> Self {
        let is_stream = word == "-";
        Self(if is_stream { STDIN.into() } else { word.into() })
    }
}

impl From<OsString> for OutFile {
    fn from(word: OsString) -> Self {
        Self(word.into())
    }
}

impl From<OsString> for OutPage {
    fn from(word: OsString) -> Self {
        Self(word.into())
    }
}

impl OutPage {
    /// The endings of its files.
    pub(super) const ENDINGS: [&str; 3] = ["svg", "png", "txt"];

    /// The names of its files.
    pub(super) fn files(&self) -> [PathBuf; 3] {
        Self::ENDINGS.map(|ending| {
            let mut name = self.0.clone().into_os_string();
            name.push(".");
            name.push(ending);
            PathBuf::from(name)
        })
    }
}

impl Deref for InFile {
    type Target = Path;

    fn deref(&self) -> &Path {
        &self.0
    }
}

impl Deref for OutFile {
    type Target = Path;

    fn deref(&self) -> &Path {
        &self.0
    }
}

impl Deref for OutPage {
    type Target = Path;

    fn deref(&self) -> &Path {
        &self.0
    }
}

/// How a table is told.
#[derive(Debug, Args)]
pub(super) struct JsonArgs {
    /// As JSON, for other programs
    #[arg(long)]
    pub(super) json: bool,
}

/// A cell of a table.
#[derive(Debug, Clone, Serialize)]
#[serde(untagged)]
pub(super) enum Cell {
    /// Words.
    Text(String),
    /// A number; `None` where there is none.
    Number(Option<f64>),
}

impl Cell {
    /// Words.
    pub(super) fn text(words: impl Into<String>) -> Self {
        Self::Text(words.into())
    }

    /// A count.
    pub(super) fn count(n: usize) -> Self {
        Self::Number(Some(n as f64))
    }

    /// A number.
    pub(super) fn number(value: f64) -> Self {
        Self::Number(Some(value))
    }
}

impl fmt::Display for Cell {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Text(text) => f.pad(text),
            Self::Number(Some(number)) => f.pad(&number.to_string()),
            Self::Number(None) => f.pad(""),
        }
    }
}

/// Rows as a JSON list of objects, one a row. `place` names it in errors.
pub(super) fn rows_to_json<const N: usize>(
    columns: [&str; N],
    rows: &[[Cell; N]],
    place: &Path,
) -> Result<String, CliError> {
    let object = |cells: &[Cell; N]| -> BTreeMap<String, Cell> {
        let names = columns.iter().map(|name| (*name).to_owned());
        names.zip(cells.iter().cloned()).collect()
    };
    let objects: Vec<_> = rows.iter().map(object).collect();
    Ok(to_json_string(&objects, place)?)
}

/// Prints rows: for programs as JSON, for people in words.
pub(super) fn print_rows<const N: usize>(
    how: &JsonArgs,
    columns: [&str; N],
    rows: &[[Cell; N]],
    words: impl FnOnce() -> String,
) -> Result<(), CliError> {
    if how.json {
        return print(&rows_to_json(columns, rows, Path::new(STDOUT))?);
    }
    print(&words())
}

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

/// A file named on the command line; `-` is standard output.
pub(super) fn named_file(path: Option<&Path>) -> Option<&Path> {
    path.filter(|path| *path != Path::new("-"))
}

/// Writes text to standard output.
pub(super) fn print(text: &str) -> Result<(), CliError> {
    print_bytes(text.as_bytes())
}

fn print_bytes(bytes: &[u8]) -> Result<(), CliError> {
    let mut out = io::stdout().lock();
    out.write_all(bytes)?;
    Ok(out.flush()?)
}

/// Writes a whole text to a file, or to standard output when no file or `-` is named.
pub(super) fn write_text(path: Option<&Path>, text: &str) -> Result<(), CliError> {
    match path {
        Some(path) => write_bytes(path, text.as_bytes()),
        None => print(text),
    }
}

/// Makes a folder where it is missing.
pub(super) fn make_folder(folder: &Path, mend: &str) -> Result<(), CliError> {
    fs::create_dir_all(folder).map_err(|error| {
        let folder = folder.display();
        CliError::Input(format!("cannot make the folder {folder}: {error}; {mend}"))
    })
}

/// Writes a whole file, or to standard output when `-` is named.
pub(super) fn write_bytes(path: &Path, bytes: &[u8]) -> Result<(), CliError> {
    let Some(path) = named_file(Some(path)) else {
        return print_bytes(bytes);
    };
    let staged = Staged::new(path);
    let mut out = created(&staged)?;
    out.write_all(bytes).map_err(|source| FileError::Write {
        path: path.to_owned(),
        source,
    })?;
    Ok(staged.finish(out)?)
}

/// Writes files of one folder by their names in it, all or none.
pub(super) fn write_folder(folder: &Path, files: &[(&str, &[u8])]) -> Result<(), CliError> {
    let mut places = files.iter().map(|(name, _)| folder.join(name));
    if let Some(taken) = places.find(|place| place.is_dir()) {
        let what = format!("{} is a folder; choose another name", taken.display());
        return Err(CliError::Input(what));
    }
    Ok(selvedge_foundation::files::write_folder(folder, files)?)
}

/// A file that is written by its path, by what goes back in it: where standard output is meant it
/// stands aside, and is printed when it is whole.
#[derive(Debug)]
pub(super) struct Spool {
    path: PathBuf,
    aside: Option<PathBuf>,
}

impl Spool {
    /// The file at a path; `-` is standard output.
    pub(super) fn of(path: &Path) -> Result<Self, CliError> {
        static NUMBER: AtomicU32 = AtomicU32::new(0);
        if let Some(path) = named_file(Some(path)) {
            let path = path.to_owned();
            return Ok(Self { path, aside: None });
        }
        let (own, nth) = (std::process::id(), NUMBER.fetch_add(1, Ordering::Relaxed));
        let aside = std::env::temp_dir().join(format!("selvedge-{own}-{nth}"));
        fs::create_dir(&aside).map_err(|error| {
            let what = format!("cannot make {}: {error}", aside.display());
            CliError::Failed(format!("{what}; name a file in place of -"))
        })?;
        Ok(Self {
            path: aside.join("out"),
            aside: Some(aside),
        })
    }

    /// Where it is written.
    pub(super) fn path(&self) -> &Path {
        &self.path
    }

    /// It is whole, in these files.
    pub(super) fn finish(&self, files: &[PathBuf]) -> Result<(), CliError> {
        if self.aside.is_none() {
            return Ok(());
        }
        let [file] = files else {
            let what = format!("it takes {} files, and standard output is one", files.len());
            return Err(CliError::Failed(format!("{what}; name a file")));
        };
        let mut file = File::open(file).map_err(FileError::read(file))?;
        io::copy(&mut file, &mut io::stdout().lock())?;
        Ok(())
    }
}

impl Drop for Spool {
    fn drop(&mut self) {
        if let Some(aside) = &self.aside {
            drop(fs::remove_dir_all(aside));
        }
    }
}
