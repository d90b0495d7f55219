//! Files that are written as a stream and appear only when they are whole.
//!
//! What is written stands under another name beside its place, and is moved there at the end, on
//! disk; whatever fails before that leaves the old file, or none, and so does a signal that ends
//! the program.

use std::collections::BTreeSet;
use std::fs::{self, File};
use std::io::{self, BufWriter, Write as _};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};

use super::FileError;

/// What this process has begun to write.
static UNFINISHED: Mutex<BTreeSet<PathBuf>> = Mutex::new(BTreeSet::new());

/// Held while something new begins, which then does not while a signal ends the program.
pub(super) fn unfinished() -> MutexGuard<'static, BTreeSet<PathBuf>> {
    // A panic elsewhere leaves a set of names, which cannot be wrong.
    UNFINISHED.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Removes all that is not whole and then does `end`, before which nothing new begins: the program
/// is about to die.
pub(crate) fn abandon_unfinished(end: impl FnOnce()) {
    let all = unfinished();
    all.iter().for_each(|path| remove(path));
    end();
}

/// What is of no use to anybody goes; if it cannot, there is nobody left to tell.
fn remove(path: &Path) {
    drop(if path.is_dir() {
        fs::remove_dir_all(path)
    } else {
        fs::remove_file(path)
    });
}

/// A file or folder that is not whole and stands beside its place; gone when dropped, and when a
/// signal ends the program.
#[derive(Debug)]
pub(super) struct Unfinished(PathBuf);

impl Unfinished {
    /// What will be at `place`, not yet created.
    pub(super) fn beside(place: &Path) -> Self {
        let path = staged_path(place);
        unfinished().insert(path.clone());
        Self(path)
    }

    /// Where it is until then.
    pub(super) fn path(&self) -> &Path {
        &self.0
    }
}

impl Drop for Unfinished {
    fn drop(&mut self) {
        unfinished().remove(&self.0);
        // What was moved to its place is here no more.
        remove(&self.0);
    }
}

/// Moves what is whole to its places, in this order; a signal waits until all are there.
pub(super) fn move_all(whole: &[(Unfinished, PathBuf)]) -> Result<(), FileError> {
    let all = unfinished();
    let move_one = |(staged, place): &(Unfinished, PathBuf)| {
        fs::rename(staged.path(), place).map_err(FileError::write(place))
    };
    let moved = whole.iter().try_for_each(move_one);
    drop(all);
    moved
}

/// A name that no other process and no other thread of this one stages under.
fn staged_path(path: &Path) -> PathBuf {
    static STAGED: AtomicU64 = AtomicU64::new(0);
    let nth = STAGED.fetch_add(1, Ordering::Relaxed);
    let mut name = path.file_name().unwrap_or_default().to_owned();
    name.push(format!(".{}-{nth}.part", std::process::id()));
    path.with_file_name(name)
}

/// A file that is written beside its place. What is no ordinary file (a device, a pipe) is written
/// directly.
#[derive(Debug)]
pub struct Staged {
    path: PathBuf,
    staged: Option<Unfinished>,
}

impl Staged {
    /// A file that will be at `path`.
    pub fn new(path: &Path) -> Self {
        let is_special = fs::metadata(path).is_ok_and(|meta| !meta.is_file() && !meta.is_dir());
        Self {
            path: path.to_owned(),
            staged: (!is_special).then(|| Unfinished::beside(path)),
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
        let place = self.staged.as_ref().map_or(&*self.path, Unfinished::path);
        let mut options = File::options();
        options.write(true).create(true).truncate(true);
        // Some formats go back to fill in what they know at the end.
        options.read(self.staged.is_some());
        let _all = unfinished();
        options.open(place).map(BufWriter::new)
    }

    /// The file is whole: brings it to the disk and puts it in its place.
    pub fn finish(self, out: BufWriter<File>) -> Result<(), FileError> {
        let path = self.path.clone();
        self.finish_as(out, &path)
    }

    /// The same under another name in the same folder.
    pub fn finish_as(self, mut out: BufWriter<File>, path: &Path) -> Result<(), FileError> {
        let moved = out.flush().and_then(|()| match &self.staged {
            None => Ok(()),
            Some(staged) => {
                out.get_ref().sync_all()?;
                fs::rename(staged.path(), path)
            }
        });
        moved.map_err(FileError::write(path))
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
