//! A table that only grows: each row is on disk before the next can be added.
//!
//! A row is one line, written at once and at its end. Whatever interrupts that leaves earlier rows
//! as they were and at most a piece of the last one, which is set aside in a file of its own when
//! the table is opened again. One process at a time writes a table.

use std::fs::{self, File, OpenOptions, TryLockError};
use std::io::{self, Write as _};
use std::path::{Path, PathBuf};

use super::{FileError, Table, TableWriter, line_at, read, write_atomic};

/// A table being written.
#[derive(Debug)]
pub struct Journal {
    file: File,
    path: PathBuf,
    /// Bytes that are complete rows.
    len: u64,
    n_columns: usize,
}

/// A table that was written before.
#[derive(Debug)]
pub struct Reopened {
    /// To be continued.
    pub journal: Journal,
    /// Its complete rows.
    pub table: Table,
    /// Where a piece of a row that was not complete was put, if there was one.
    pub set_aside: Option<PathBuf>,
}

impl Journal {
    /// A new table with these columns.
    ///
    /// # Errors
    /// There is a file of that name, or it cannot be written.
    pub fn create(path: &Path, columns: &[&str]) -> Result<Self, FileError> {
        if fs::symlink_metadata(path).is_ok() {
            return Err(FileError::Exists {
                path: path.to_owned(),
            });
        }
        let header = TableWriter::new(Vec::new(), path, columns)?.finish()?;
        write_atomic(path, &header)?;
        sync_folder(path).map_err(FileError::write(path))?;
        let file = locked(path)?;
        Ok(Self {
            len: header.len() as u64,
            file,
            path: path.to_owned(),
            n_columns: columns.len(),
        })
    }

    /// Opens a table to continue it. Its columns must be `columns`, in this order.
    ///
    /// # Errors
    /// It cannot be read or written, another process writes it, or its columns or rows are not
    /// these.
    pub fn reopen(path: &Path, columns: &[&str]) -> Result<Reopened, FileError> {
        let file = locked(path)?;
        let bytes = read(path)?;
        let end = bytes.iter().rposition(|&byte| byte == b'\n');
        let (complete, piece) = bytes.split_at(end.map_or(0, |end| end + 1));
        let text = std::str::from_utf8(complete).map_err(|error| {
            let line = line_at(complete, error.valid_up_to());
            FileError::content(path, line, "this is not UTF-8 text", "restore the file")
        })?;
        let table = Table::read(text, path, columns, &[])?;
        check_order(text, path, columns)?;
        let set_aside = if piece.is_empty() {
            None
        } else {
            let aside = free_name(path);
            write_atomic(&aside, piece)?;
            file.set_len(complete.len() as u64)
                .and_then(|()| file.sync_all())
                .map_err(FileError::write(path))?;
            Some(aside)
        };
        let journal = Self {
            file,
            path: path.to_owned(),
            len: complete.len() as u64,
            n_columns: columns.len(),
        };
        Ok(Reopened {
            journal,
            table,
            set_aside,
        })
    }

    /// Adds a row and waits until it is on disk. Line breaks in cells become blanks: a row is one
    /// line.
    ///
    /// # Errors
    /// It cannot be written, because the disk is full or gone: nothing of it is kept, and the same
    /// row can be added again.
    ///
    /// # Panics
    /// The number of cells is not that of the columns.
    pub fn append(&mut self, cells: &[&str]) -> Result<(), FileError> {
        assert_eq!(cells.len(), self.n_columns, "cells of a row");
        let line = Self::row_line(cells, &self.path)?;
        self.append_lines(&line)
    }

    /// Adds rows that are written out already, each with its line break, and waits until they are
    /// on disk.
    ///
    /// # Errors
    /// They cannot be written: none of them is kept, and the same rows can be added again.
    pub fn append_lines(&mut self, lines: &[u8]) -> Result<(), FileError> {
        let written = (self.file.write_all(lines)).and_then(|()| self.file.sync_data());
        if let Err(source) = written {
            // If this fails too, opening the table again sets the piece aside.
            drop(self.file.set_len(self.len));
            return Err(FileError::write(&self.path)(source));
        }
        self.len += lines.len() as u64;
        Ok(())
    }

    /// Whether somebody writes a table now. Nothing of it is read. A lock that readers share is
    /// asked for and let go at once: who opens the table in that very moment is told that it is
    /// busy.
    pub fn is_written(path: &Path) -> bool {
        let is_taken = |file: File| matches!(file.try_lock_shared(), Err(TryLockError::WouldBlock));
        File::open(path).is_ok_and(is_taken)
    }

    /// The file.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// A row as its line, with its line break; line breaks in cells become blanks.
    ///
    /// # Errors
    /// None that a text in memory could have.
    pub fn row_line<T: AsRef<str>>(cells: &[T], path: &Path) -> Result<Vec<u8>, FileError> {
        let mut writer = TableWriter::continued(Vec::new(), path);
        for cell in cells {
            writer.text(&cell.as_ref().replace(['\n', '\r'], " "));
        }
        writer.end_row()?;
        writer.finish()
    }
}

/// Opens a file to add to it, for this process alone.
fn locked(path: &Path) -> Result<File, FileError> {
    let file = OpenOptions::new().append(true).open(path);
    let file = file.map_err(FileError::write(path))?;
    match file.try_lock() {
        Ok(()) => Ok(file),
        Err(TryLockError::WouldBlock) => Err(FileError::Busy {
            path: path.to_owned(),
        }),
        Err(TryLockError::Error(source)) => Err(FileError::write(path)(source)),
    }
}

/// The header as it was written: a table may have its columns in another order, a row not.
fn check_order(text: &str, path: &Path, columns: &[&str]) -> Result<(), FileError> {
    let header = TableWriter::new(Vec::new(), path, columns)?.finish()?;
    if text.as_bytes().starts_with(&header) {
        return Ok(());
    }
    let mend = format!("the header is {}", columns.join(","));
    Err(FileError::content(
        path,
        1,
        "columns in another order",
        mend,
    ))
}

/// `NAME.torn-1` or the first number that is free.
fn free_name(path: &Path) -> PathBuf {
    let name = |nth: u32| {
        let mut name = path.file_name().unwrap_or_default().to_owned();
        name.push(format!(".torn-{nth}"));
        path.with_file_name(name)
    };
    let is_free = |path: &PathBuf| fs::symlink_metadata(path).is_err();
    (1..u32::MAX)
        .map(name)
        .find(is_free)
        .unwrap_or_else(|| name(0))
}

/// Makes sure that a new name is on disk, where that can be asked for.
fn sync_folder(path: &Path) -> io::Result<()> {
    if cfg!(unix) {
        let folder = path
            .parent()
            .filter(|folder| !folder.as_os_str().is_empty());
        File::open(folder.unwrap_or_else(|| Path::new(".")))?.sync_all()?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use selvedge_scratch::ScratchFolder;

    const COLUMNS: [&str; 3] = ["trial", "answer", "note"];
    const ROWS: [[&str; 3]; 3] = [
        ["1", "satin", "felt „smooth“, he said"],
        ["2", "jute", "\"rough\"\nand two lines"],
        ["3", "wool", ""],
    ];

    fn written(path: &Path) -> Vec<u8> {
        let mut journal = Journal::create(path, &COLUMNS).unwrap();
        for row in &ROWS {
            journal.append(row).unwrap();
        }
        fs::read(path).unwrap()
    }

    #[test]
    fn killed_at_any_byte_at_most_the_last_row_is_lost_and_kept_aside() {
        let folder = ScratchFolder::made("kill");
        let path = folder.join("log.csv");
        let bytes = written(&path);
        let header = bytes.iter().position(|&b| b == b'\n').unwrap() + 1;
        for cut in header..=bytes.len() {
            fs::write(&path, &bytes[..cut]).unwrap();
            let n_complete = bytes[header..cut].split(|&b| b == b'\n').count() - 1;
            let mut reopened = Journal::reopen(&path, &COLUMNS).unwrap();
            assert_eq!(reopened.table.n_rows(), n_complete, "cut at {cut}");
            let kept = fs::read(&path).unwrap();
            assert!(bytes.starts_with(&kept), "earlier rows are as they were");
            match &reopened.set_aside {
                None => assert_eq!(kept.len(), cut),
                Some(aside) => {
                    let piece = fs::read(aside).unwrap();
                    assert_eq!([kept, piece].concat(), bytes[..cut], "nothing is lost");
                    fs::remove_file(aside).unwrap();
                }
            }
            for row in &ROWS[n_complete..] {
                reopened.journal.append(row).unwrap();
            }
            assert_eq!(
                fs::read(&path).unwrap(),
                bytes,
                "resumed as never broken off"
            );
        }
    }

    #[test]
    fn whether_a_table_is_written_is_seen_without_touching_it() {
        let folder = ScratchFolder::made("seen");
        let path = folder.join("log.csv");
        assert!(!Journal::is_written(&path), "there is none");
        let mut journal = Journal::create(&path, &COLUMNS).unwrap();
        assert!(Journal::is_written(&path));
        journal.append(&ROWS[0]).unwrap();
        let bytes = fs::read(&path).unwrap();
        drop(journal);
        assert!(!Journal::is_written(&path), "nobody does any more");
        assert_eq!(fs::read(&path).unwrap(), bytes);
    }

    #[test]
    fn a_table_is_not_overwritten_and_has_one_writer() {
        let folder = ScratchFolder::made("lock");
        let path = folder.join("log.csv");
        let first = Journal::create(&path, &COLUMNS).unwrap();
        let again = Journal::create(&path, &COLUMNS).unwrap_err();
        assert!(matches!(again, FileError::Exists { .. }), "{again}");
        let second = Journal::reopen(&path, &COLUMNS).unwrap_err();
        assert!(matches!(second, FileError::Busy { .. }), "{second}");
        drop(first);
        assert!(Journal::reopen(&path, &COLUMNS).is_ok());
    }

    #[test]
    fn other_columns_are_refused_and_so_are_rows_that_are_none() {
        let folder = ScratchFolder::made("columns");
        let path = folder.join("log.csv");
        drop(written(&path));
        let turned = Journal::reopen(&path, &["answer", "trial", "note"]).unwrap_err();
        assert!(turned.to_string().contains("another order"), "{turned}");
        let fewer = Journal::reopen(&path, &["trial", "answer"]).unwrap_err();
        assert!(fewer.to_string().contains("note"), "{fewer}");
        fs::write(&path, b"trial,answer,note\n1,2\n").unwrap();
        let short = Journal::reopen(&path, &COLUMNS).unwrap_err();
        assert!(short.to_string().contains("2 cells"), "{short}");
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn a_full_disk_is_an_error_and_the_row_can_be_added_again() {
        let folder = ScratchFolder::made("full");
        let path = folder.join("log.csv");
        let bytes = written(&path);
        let mut journal = Journal::reopen(&path, &COLUMNS).unwrap().journal;
        let disk = std::mem::replace(
            &mut journal.file,
            OpenOptions::new().append(true).open("/dev/full").unwrap(),
        );
        let full = journal.append(&ROWS[0]).unwrap_err();
        assert!(matches!(full, FileError::Write { .. }), "{full}");
        journal.file = disk;
        journal.append(&ROWS[0]).unwrap();
        let first = &bytes[18..];
        let row = &first[..=first.iter().position(|&b| b == b'\n').unwrap()];
        assert_eq!(fs::read(&path).unwrap(), [&bytes, row].concat());
    }
}
