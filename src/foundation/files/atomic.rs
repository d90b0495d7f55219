//! Files written so that a crash leaves the old ones or the new ones.

use std::fs::{self, File};
use std::io::{self, Write as _};
use std::path::Path;

use super::FileError;
use super::staged::{Staged, Unfinished, move_all, unfinished};

/// Writes `bytes` to a new file beside `path` and then moves it there, on disk before it returns.
pub fn write_atomic(path: &Path, bytes: &[u8]) -> Result<(), FileError> {
    let staged = Staged::new(path);
    let write = || {
        let mut out = staged.create()?;
        out.write_all(bytes)?;
        Ok(out)
    };
    let out = write().map_err(FileError::write(path))?;
    staged.finish(out)
}

/// Writes files of one folder, by their names in it, so that all are there or none is.
///
/// A folder that is not there is filled beside its place and then moved to it; in one that is, all
/// files are on disk before the first takes its place, and the others follow in this order.
pub fn write_folder(folder: &Path, files: &[(&str, &[u8])]) -> Result<(), FileError> {
    let failed = FileError::write(folder);
    if !folder.exists() {
        let parent = folder.parent().unwrap_or(folder);
        fs::create_dir_all(parent).map_err(&failed)?;
        let whole = Unfinished::beside(folder);
        fs::create_dir(whole.path()).map_err(&failed)?;
        for (name, bytes) in files {
            write_synced(&whole.path().join(name), bytes)?;
        }
        return move_all(&[(whole, folder.to_owned())]);
    }
    let mut all = Vec::new();
    for (name, bytes) in files {
        let path = folder.join(name);
        let staged = Unfinished::beside(&path);
        write_synced(staged.path(), bytes)?;
        all.push((staged, path));
    }
    move_all(&all)
}

/// Writes a file of a folder that may not be there yet, to the disk.
fn write_synced(path: &Path, bytes: &[u8]) -> Result<(), FileError> {
    let write = || -> io::Result<()> {
        let _all = unfinished();
        if let Some(folder) = path.parent() {
            fs::create_dir_all(folder)?;
        }
        let mut file = File::create(path)?;
        file.write_all(bytes)?;
        file.sync_all()
    };
    write().map_err(FileError::write(path))
}

#[cfg(test)]
mod tests {
    use super::*;
    use selvedge_scratch::ScratchFolder;

    #[test]
    fn a_file_is_replaced_whole_and_nothing_is_left_beside_it() {
        let folder = ScratchFolder::made("atomic");
        let path = folder.join("a.txt");
        write_atomic(&path, b"one").unwrap();
        write_atomic(&path, b"two").unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"two");
        assert_eq!(fs::read_dir(&folder).unwrap().count(), 1);
    }

    #[test]
    fn all_files_of_a_folder_are_written_or_none_is() {
        let scratch = ScratchFolder::made("folder");
        let folder = scratch.join("new/cloth");
        // A file cannot hold another one: the second write fails.
        let wrong: [(&str, &[u8]); 2] = [("a", b"1"), ("a/b", b"2")];
        assert!(write_folder(&folder, &wrong).is_err());
        assert_eq!(fs::read_dir(scratch.join("new")).unwrap().count(), 0);
        write_folder(&folder, &[("a", b"1"), ("below/b", b"2")]).unwrap();
        assert_eq!(fs::read(folder.join("below/b")).unwrap(), b"2");
        assert_eq!(fs::read_dir(scratch.join("new")).unwrap().count(), 1);

        let wrong: [(&str, &[u8]); 2] = [("below/b", b"3"), ("a/b", b"4")];
        assert!(write_folder(&folder, &wrong).is_err());
        assert_eq!(fs::read(folder.join("below/b")).unwrap(), b"2", "as it was");
        write_folder(&folder, &[("a", b"5")]).unwrap();
        assert_eq!(fs::read(folder.join("a")).unwrap(), b"5");
        assert_eq!(fs::read_dir(&folder).unwrap().count(), 2, "nothing beside");
        assert_eq!(fs::read_dir(folder.join("below")).unwrap().count(), 1);
    }
}
