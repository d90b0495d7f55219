//! The file of a log: lines are added at its end, and never changed.
//!
//! A bounded one makes way for the next when it is full: `log.csv` becomes `log-1.csv`, that
//! becomes `log-2.csv`, the last goes.

use std::fs::{self, File, OpenOptions};
use std::io::{self, Write as _};
use std::path::{Path, PathBuf};

use super::line::HEADER;
use crate::BridgeError;

/// How much a log may take of the disk.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LogBound {
    /// Bytes to a file.
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
    /// Opens the file at its end; folders that are not there yet are made.
    pub(super) fn open(path: &Path, bound: Option<LogBound>) -> Result<Self, BridgeError> {
        let action = "write the session log";
        if let Some(folder) = path.parent() {
            fs::create_dir_all(folder).map_err(BridgeError::file(action, path))?;
        }
        let (file, n_bytes) = open(path).map_err(BridgeError::file(action, path))?;
        Ok(Self {
            file,
            path: path.to_path_buf(),
            n_bytes,
            bound,
        })
    }

    /// Adds whole lines.
    pub(super) fn add(&mut self, lines: &str) -> io::Result<()> {
        let is_full = |bound: LogBound| self.n_bytes + lines.len() as u64 > bound.bytes;
        if let Some(bound) = self.bound.filter(|bound| is_full(*bound)) {
            self.make_way(bound)?;
        }
        self.file.write_all(lines.as_bytes())?;
        self.n_bytes += lines.len() as u64;
        Ok(())
    }

    fn make_way(&mut self, bound: LogBound) -> io::Result<()> {
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

/// Opens a file at its end, with the header if it is new.
fn open(path: &Path) -> io::Result<(File, u64)> {
    let mut file = OpenOptions::new().create(true).append(true).open(path)?;
    let n_bytes = file.metadata()?.len();
    if n_bytes > 0 {
        return Ok((file, n_bytes));
    }
    file.write_all(HEADER.as_bytes())?;
    Ok((file, HEADER.len() as u64))
}
