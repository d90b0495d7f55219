//! The name of an emulator's terminal: a symbolic link that removes itself, and the lock beside it.
//!
//! `PATH.lock` is locked by the running emulator and holds one line: which process, which terminal.
//! The system lets go of the lock when the process ends, however it ends, so that a link left by a
//! killed emulator is known as such although another program may have its terminal by now.

use std::fs::{self, File, OpenOptions, TryLockError};
use std::io::{Read as _, Write as _};
use std::os::unix::fs::{MetadataExt as _, symlink};
use std::path::{Path, PathBuf};

use crate::BridgeError;

/// How the line in the lock's file begins.
const MARK: &str = "selvedge bridge emulate, process ";
/// More than that is no lock of ours, bytes.
const LONGEST_LINE: u64 = 4096;
/// How often a lock is tried whose file its last owner removes meanwhile.
const N_TRIES: usize = 100;

/// A symbolic link that removes itself.
#[derive(Debug)]
pub(super) struct NamedLink {
    path: PathBuf,
    target: PathBuf,
    // Let go of after the link is gone.
    _lock: NameLock,
}

impl NamedLink {
    /// Links `path` to the terminal `target`. A link that a dead emulator left is replaced; one of
    /// a running emulator, one to anything else, and any other file are refused.
    pub(super) fn new(path: &Path, target: &Path) -> Result<Self, BridgeError> {
        refuse_files(path)?;
        let mut lock = NameLock::take(path)?;
        if let Ok(found) = fs::read_link(path) {
            if !lock.left_behind(&found) && !is_gone_terminal(&found) {
                return Err(BridgeError::LinkTaken(path.to_path_buf()));
            }
            fs::remove_file(path).map_err(BridgeError::file("replace the link", path))?;
        }
        lock.write(target)?;
        symlink(target, path).map_err(BridgeError::file("make the link", path))?;
        Ok(Self {
            path: path.to_path_buf(),
            target: target.to_path_buf(),
            _lock: lock,
        })
    }
}

impl Drop for NamedLink {
    fn drop(&mut self) {
        // Somebody may have put another link there by hand.
        if fs::read_link(&self.path).is_ok_and(|target| target == self.target) {
            drop(fs::remove_file(&self.path));
        }
    }
}

/// Refuses a place where something else than a link is, before anything is made beside it.
fn refuse_files(path: &Path) -> Result<(), BridgeError> {
    match fs::symlink_metadata(path) {
        Ok(found) if !found.is_symlink() => Err(BridgeError::LinkTaken(path.to_path_buf())),
        _ => Ok(()),
    }
}

/// Whether it names a pseudo-terminal that does not exist any more: such a link helps nobody.
fn is_gone_terminal(target: &Path) -> bool {
    target.starts_with("/dev/pts/") && !target.exists()
}

/// The right to a name, for as long as this lives.
#[derive(Debug)]
struct NameLock {
    file: File,
    path: PathBuf,
    /// The line of its owner before, if there was one.
    before: String,
}

impl NameLock {
    fn take(link: &Path) -> Result<Self, BridgeError> {
        let mut path = link.as_os_str().to_os_string();
        path.push(".lock");
        let path = PathBuf::from(path);
        for _ in 0..N_TRIES {
            refuse_links(&path)?;
            let opened = OpenOptions::new()
                .read(true)
                .write(true)
                .create(true)
                .truncate(false)
                .open(&path);
            let mut file = opened.map_err(BridgeError::file("make the link's lock", &path))?;
            let mut before = String::new();
            match file.try_lock() {
                Ok(()) => {}
                Err(TryLockError::WouldBlock) => return Err(held(link, &mut file)),
                Err(TryLockError::Error(error)) => {
                    return Err(BridgeError::file("lock the link's name", &path)(error));
                }
            }
            // The owner before may have removed the file between opening and locking it.
            if !is_at(&file, &path) {
                continue;
            }
            let read = (&file).take(LONGEST_LINE).read_to_string(&mut before);
            if read.is_err() || !(before.is_empty() || before.starts_with(MARK)) {
                return Err(BridgeError::LinkTaken(path));
            }
            return Ok(Self { file, path, before });
        }
        Err(BridgeError::LinkHeld {
            link: link.to_path_buf(),
            holder: String::from("another program"),
        })
    }

    /// Whether the owner before made a link to this terminal and could not remove it.
    fn left_behind(&self, target: &Path) -> bool {
        let words = self.before.trim_end().split_once(" on ");
        words.is_some_and(|(_, terminal)| Path::new(terminal) == target)
    }

    fn write(&mut self, target: &Path) -> Result<(), BridgeError> {
        let line = format!("{MARK}{} on {}\n", std::process::id(), target.display());
        let file = &mut self.file;
        let emptied = file.set_len(0);
        let written = emptied.and_then(|()| {
            std::io::Seek::rewind(file)?;
            file.write_all(line.as_bytes())
        });
        written.map_err(BridgeError::file("write the link's lock", &self.path))
    }
}

impl Drop for NameLock {
    fn drop(&mut self) {
        // Removed while it is locked, so that whoever waits for it sees that it is another file.
        if is_at(&self.file, &self.path) {
            drop(fs::remove_file(&self.path));
        }
    }
}

fn refuse_links(path: &Path) -> Result<(), BridgeError> {
    match fs::symlink_metadata(path) {
        Ok(found) if !found.is_file() => Err(BridgeError::LinkTaken(path.to_path_buf())),
        _ => Ok(()),
    }
}

/// Whether an open file is the one that stands at `path`.
fn is_at(file: &File, path: &Path) -> bool {
    let same = |open: fs::Metadata, there: fs::Metadata| {
        (open.dev(), open.ino()) == (there.dev(), there.ino())
    };
    let both = file.metadata().ok().zip(fs::symlink_metadata(path).ok());
    both.is_some_and(|(open, there)| same(open, there))
}

/// Who holds a name, as the lock's file says.
fn held(link: &Path, file: &mut File) -> BridgeError {
    let mut line = String::new();
    drop(file.take(LONGEST_LINE).read_to_string(&mut line));
    let words = line.trim_end().strip_prefix(MARK);
    let id = words.and_then(|words| words.split_once(" on "));
    let holder = id.map_or_else(
        || String::from("another program"),
        |(id, terminal)| format!("another emulator, process {id} on {terminal}"),
    );
    BridgeError::LinkHeld {
        link: link.to_path_buf(),
        holder,
    }
}
