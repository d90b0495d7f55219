//! Files that are written as a stream and appear only when they are whole.
//!
//! What is written stands under another name beside its place, and is moved there at the end, on
//! disk; whatever fails before that leaves the old file, or none.

use std::fs::{self, File};
use std::io::{self, BufWriter, Write as _};
use std::path::{Path, PathBuf};

use super::FileError;
use super::atomic::staged_path;

/// A file that is written beside its place. What is no ordinary file (a device, a pipe) is written
/// directly.
#[derive(Debug)]
pub struct Staged {
    path: PathBuf,
    staged: Option<PathBuf>,
}

impl Staged {
    /// A file that will be at `path`.
    pub fn new(path: &Path) -> Self {
        let is_special = fs::metadata(path).is_ok_and(|meta| !meta.is_file() && !meta.is_dir());
        Self {
            path: path.to_owned(),
            staged: (!is_special).then(|| staged_path(path)),
        }
    }

    /// Where it will be.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Creates what is written to.
    ///
    /// # Errors
    /// What the system says: the folder is missing or closed, or `path` is a folder.
    pub fn create(&self) -> io::Result<BufWriter<File>> {
        if self.path.is_dir() {
            let what = "it is a folder; name a file in it";
            return Err(io::Error::new(io::ErrorKind::IsADirectory, what));
        }
        let place = self.staged.as_deref().unwrap_or(&self.path);
        let mut options = File::options();
        options.write(true).create(true).truncate(true);
        // Some formats go back to fill in what they know at the end.
        options.read(self.staged.is_some());
        options.open(place).map(BufWriter::new)
    }

    /// The file is whole: brings it to the disk and puts it in its place.
    pub fn finish(self, out: BufWriter<File>) -> Result<(), FileError> {
        let path = self.path.clone();
        self.finish_as(out, &path)
    }

    /// The same under another name in the same folder.
    pub fn finish_as(mut self, mut out: BufWriter<File>, path: &Path) -> Result<(), FileError> {
        let moved = out.flush().and_then(|()| match &self.staged {
            None => Ok(()),
            Some(staged) => {
                out.get_ref().sync_all()?;
                fs::rename(staged, path)
            }
        });
        moved.map_err(FileError::write(path))?;
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

#[cfg(test)]
mod tests {
    use super::*;
    use selvedge_scratch::ScratchFolder;

    #[test]
    fn half_a_file_is_gone_and_a_whole_one_is_in_its_place() {
        let folder = ScratchFolder::made("staged");
        let path = folder.join("a.bin");
        fs::write(&path, b"old").unwrap();
        let staged = Staged::new(&path);
        let mut out = staged.create().unwrap();
        out.write_all(b"half").unwrap();
        drop((out, staged));
        assert_eq!(fs::read(&path).unwrap(), b"old");
        let staged = Staged::new(&path);
        let mut out = staged.create().unwrap();
        out.write_all(b"whole").unwrap();
        staged.finish(out).unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"whole");
        assert_eq!(fs::read_dir(&folder).unwrap().count(), 1, "nothing beside");
        assert!(
            Staged::new(&folder).create().is_err(),
            "a folder is no file"
        );
    }
}
