//! Files in the formats everybody shares: CSV, TOML, XML, ZIP, PNG, TIFF, NPY, hashes,
//! reading that never takes more than a file may hold, and writing that never leaves half of one
//! behind.
//!
//! Knows how a table or a key is spelt, not what it means. Every error is one line that says what
//! is wrong, where (path and line), and how to mend it.
//!
//! # Invariants
//! - the one home of `csv`, `toml`, `toml_edit`, `serde_json`, `quick-xml`, `zip`, `flate2`,
//!   `image`, `png`, `tiff`, `sha2` and `md-5`
//! - sizes are checked before anything of that size is held
//! - the path is given only to name it in errors: content comes in as bytes or text
//! - numbers are written with the shortest digits that read back the same

mod archive;
mod atomic;
mod bytes;
mod digits;
mod edited_keys;
mod flaw;
mod gray16;
mod hash;
mod inflate;
mod journal;
mod json;
mod keys;
mod matrix;
mod npy;
mod picture;
mod place;
mod read;
mod staged;
mod table;
mod xml;

pub use archive::Archive;
pub use atomic::{write_atomic, write_folder};
pub use bytes::{ByteReader, Number, decoded, latin1};
pub use digits::push_number;
pub use edited_keys::{EditedKeys, KeyPlace};
pub use flaw::{Flaw, Place};
pub use gray16::GrayImage;
pub use hash::{md5_hex, sha256_hex};
pub use inflate::{deflate, inflate};
pub use journal::{Journal, Reopened};
pub use json::{from_json_str, to_json_string};
pub use keys::{
    KeyValue, Keys, keys_from_str, keys_to_string, known_keys_from_str, lay_over, line_of_key,
    set_value, take_text, value_at,
};
pub use matrix::SquareTable;
pub use npy::NumberArray;
pub use picture::{PICTURE_ENDINGS, Rgb8Image, Rgb16Image, encode_png_rgba, is_picture};
pub use place::{free_bytes, is_accessible};
pub use read::{read, read_known, read_text};
pub use staged::Staged;
pub(crate) use staged::abandon_unfinished;
pub use table::{Table, TableWriter};
pub use xml::{visit_elements, xml_text};

use std::io::ErrorKind;
use std::path::{Path, PathBuf};

/// What can be wrong with a file.
#[derive(Debug, thiserror::Error)]
pub enum FileError {
    /// A file that would be written anew is there.
    #[error("{} exists and is not overwritten; give another name, or continue it", path.display())]
    Exists {
        /// The file.
        path: PathBuf,
    },
    /// Another process writes it.
    #[error("{} is being written by another session; end that first", path.display())]
    Busy {
        /// The file.
        path: PathBuf,
    },
    /// It cannot be read.
    #[error("cannot read {}: {source}; {}", path.display(), to_read(source))]
    Read {
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// It cannot be written.
    #[error("cannot write {}: {source}; check the folder", path.display())]
    Write {
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// Its content is wrong.
    #[error("{}:{line}: {what}; {mend}", path.display())]
    Content {
        /// The file.
        path: PathBuf,
        /// The line, from 1.
        line: usize,
        /// What is wrong.
        what: String,
        /// What to do about it.
        mend: String,
    },
    /// Its content is wrong, and it has no lines to name.
    #[error("{}: {what}; {mend}", path.display())]
    Whole {
        /// The file.
        path: PathBuf,
        /// What is wrong.
        what: String,
        /// What to do about it.
        mend: String,
    },
}

impl FileError {
    /// A file that could not be read, of what the system says.
    pub fn read(path: &Path) -> impl Fn(std::io::Error) -> Self + '_ {
        move |source| {
            let path = path.to_owned();
            Self::Read { path, source }
        }
    }

    /// A file or folder that could not be written, of what the system says.
    pub fn write(path: &Path) -> impl Fn(std::io::Error) -> Self + '_ {
        move |source| {
            let path = path.to_owned();
            Self::Write { path, source }
        }
    }

    /// Wrong content at a line (from 1) of a file.
    pub fn content(
        path: &Path,
        line: usize,
        what: impl Into<String>,
        mend: impl Into<String>,
    ) -> Self {
        Self::Content {
            path: path.to_owned(),
            line,
            what: in_a_line(what.into()),
            mend: mend.into(),
        }
    }

    /// Wrong content of a file that has no lines.
    pub fn whole(path: &Path, what: impl Into<String>, mend: impl Into<String>) -> Self {
        Self::Whole {
            path: path.to_owned(),
            what: in_a_line(what.into()),
            mend: mend.into(),
        }
    }
}

/// What is said of a content may quote it, and a cell may be a megabyte long and hold anything.
fn in_a_line(what: String) -> String {
    const LONGEST: usize = 300;
    let is_short = what.len() <= LONGEST;
    if is_short && !what.contains(char::is_control) {
        return what;
    }
    let line: String = what.chars().take(LONGEST).collect();
    let end = if is_short { "" } else { "…" };
    line.replace(char::is_control, " ") + end
}

/// What to do about a file that cannot be read.
fn to_read(source: &std::io::Error) -> &'static str {
    match source.kind() {
        ErrorKind::IsADirectory => "name a file in it",
        ErrorKind::PermissionDenied => "ask for the right to read it",
        _ => "check the path",
    }
}

/// The line, from 1, that holds the byte at `offset`.
fn line_at(bytes: &[u8], offset: usize) -> usize {
    bytes[..offset.min(bytes.len())]
        .split(|&byte| byte == b'\n')
        .count()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_quoted_of_a_file_stays_one_short_line() {
        let cell = "x\r\n\u{7}".repeat(100_000);
        let error = FileError::content(Path::new("a.csv"), 2, format!("id is {cell}"), "mend it");
        let line = error.to_string();
        assert!(line.starts_with("a.csv:2: id is x   x"), "{line}");
        assert!(line.ends_with("…; mend it") && line.len() < 400, "{line}");
        let plain = FileError::whole(Path::new("a"), "„µ“", "mend it").to_string();
        assert_eq!(plain, "a: „µ“; mend it");
    }
}
