//! The file of a log: lines are added at its end, and never changed.
//!
//! A bounded one makes way for the next when it is full: `log.csv` becomes `log-1.csv`, that
//! becomes `log-2.csv`, the last goes.

use std::fs::{self, File, OpenOptions};
use std::io::{self, Read as _, Seek as _, SeekFrom, Write as _};
use std::path::{Path, PathBuf};

use super::events::CUT;
use super::line::header;
use crate::BridgeError;

/// How much a log may take of the disk.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LogBound {
    /// Bytes to a file: the next one is begun where it holds as many.
    pub bytes: u64,
    /// Older files that are kept beside the one that is written.
    pub n_older: u8,
}

/// A log being written.
#[derive(Debug)]
pub(super) struct LogFile {
    file: File,
    path: PathBuf,
    n_bytes: u64,
    bound: Option<LogBound>,
}

impl LogFile {
    /// Opens the file at its end. Its folder must be there.
    pub(super) fn open(path: &Path, bound: Option<LogBound>) -> Result<Self, BridgeError> {
        let folder = path.parent().filter(|folder| *folder != Path::new(""));
        if let Some(folder) = folder.filter(|folder| !folder.is_dir()) {
            return Err(BridgeError::LogPlace {
                path: path.to_path_buf(),
                reason: format!("there is no folder {}", folder.display()),
            });
        }
        if path.is_dir() {
            return Err(BridgeError::LogPlace {
                path: path.to_path_buf(),
                reason: String::from("it is a folder"),
            });
        }
        let action = "write the session log";
        let (file, n_bytes) = open(path).map_err(BridgeError::file(action, path))?;
        Ok(Self {
            file,
            path: path.to_path_buf(),
            n_bytes,
            bound,
        })
    }

    /// Adds whole lines. They are the system's at once, so that they stay when the program is
    /// killed.
    pub(super) fn add(&mut self, lines: &str) -> io::Result<()> {
        self.file.write_all(lines.as_bytes())?;
        self.n_bytes += lines.len() as u64;
        Ok(())
    }

    /// Whether the next lines belong into another file.
    pub(super) fn is_full(&self) -> bool {
        self.bound.is_some_and(|bound| self.n_bytes >= bound.bytes)
    }

    /// Begins another file where this one is full.
    pub(super) fn make_way(&mut self) -> io::Result<()> {
        let Some(bound) = self.bound else {
            return Ok(());
        };
        for number in (0..bound.n_older).rev() {
            let (from, to) = (self.older(number), self.older(number + 1));
            match fs::rename(from, to) {
                Err(error) if error.kind() != io::ErrorKind::NotFound => return Err(error),
                _ => {}
            }
        }
        if bound.n_older == 0 {
            fs::remove_file(&self.path)?;
        }
        (self.file, self.n_bytes) = open(&self.path)?;
        Ok(())
    }

    /// The file's name for the `number`th older one; 0 is the file itself.
    fn older(&self, number: u8) -> PathBuf {
        if number == 0 {
            return self.path.clone();
        }
        let part = |part: Option<&std::ffi::OsStr>| {
            part.map_or_else(String::new, |text| text.to_string_lossy().into_owned())
        };
        let (stem, ending) = (part(self.path.file_stem()), part(self.path.extension()));
        self.path
            .with_file_name(format!("{stem}-{number}.{ending}"))
    }
}

/// Opens a file at its end, with the header if it is new. A line that was cut is ended and marked.
fn open(path: &Path) -> io::Result<(File, u64)> {
    let mut file = OpenOptions::new()
        .create(true)
        .read(true)
        .append(true)
        .open(path)?;
    let n_bytes = file.metadata()?.len();
    let missing = if n_bytes == 0 {
        header()
    } else if ends_a_line(&mut file)? {
        String::new()
    } else {
        format!("{CUT}\n")
    };
    file.write_all(missing.as_bytes())?;
    Ok((file, n_bytes + missing.len() as u64))
}

/// Whether a file that is not empty ends with a whole line. What cannot be looked at has no lines.
fn ends_a_line(file: &mut File) -> io::Result<bool> {
    let mut last = [0];
    if file.seek(SeekFrom::End(-1)).is_err() {
        return Ok(true);
    }
    file.read_exact(&mut last)?;
    Ok(last == *b"\n")
}
