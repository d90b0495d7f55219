//! What was built once is not built again: a bounded folder of built textiles.
//!
//! An entry is one file, named by a hash of everything that the textile follows from, with a hash
//! of its content in front. It may be deleted at any time, by anybody; an entry that is damaged,
//! missing or cannot be written is built again. Entries are moved into place whole, so several
//! programs may share the folder. Nothing in the folder but entries is ever removed.

use std::fs;
use std::path::{Path, PathBuf};
use std::time::{Duration, SystemTime};

use crate::build::BuiltFile;
use selvedge_foundation::files::{read_known, sha256_hex, write_atomic};

/// How large the folder may grow, bytes.
const LIMIT_BYTES: u64 = 256 << 20;
/// How an entry's name ends.
const EXTENSION: &str = "textile";
/// The first line of an entry.
const HEAD: &str = "selvedge textile 1";
/// A staged file that is older was left behind by a program that was killed.
const STALE: Duration = Duration::from_hours(1);

/// A folder of built textiles. Those not used for longest make room for new ones.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct BuildCache {
    folder: PathBuf,
    limit_bytes: u64,
}

impl BuildCache {
    /// The cache in a folder, which need not be there yet: at most 256 MiB.
    pub fn in_folder(folder: &Path) -> Self {
        Self::bounded(folder, LIMIT_BYTES)
    }

    /// The same with another bound, bytes.
    pub(crate) fn bounded(folder: &Path, limit_bytes: u64) -> Self {
        Self {
            folder: folder.to_owned(),
            limit_bytes,
        }
    }

    /// The files of an entry; `None` if there is none or it is damaged.
    pub fn get(&self, key: &str) -> Option<Vec<BuiltFile>> {
        let path = self.path(key);
        let bytes = read_known(&path, |head| head.starts_with(HEAD.as_bytes())).ok()?;
        let files = decode(&bytes);
        if files.is_some()
            && let Ok(file) = fs::File::options().append(true).open(&path)
        {
            // When it was used last; if that cannot be noted, it goes a little early.
            drop(file.set_modified(SystemTime::now()));
        }
        files
    }

    /// Keeps the files of an entry and makes room. What cannot be kept is built again next time,
    /// so a folder that is full or read-only is no error.
    pub fn put(&self, key: &str, files: &[BuiltFile]) {
        let bytes = encode(files);
        let fits = u64::try_from(bytes.len()).is_ok_and(|n| n <= self.limit_bytes);
        if fits
            && fs::create_dir_all(&self.folder).is_ok()
            && write_atomic(&self.path(key), &bytes).is_ok()
        {
            self.make_room();
        }
    }

    fn path(&self, key: &str) -> PathBuf {
        self.folder.join(format!("{key}.{EXTENSION}"))
    }

    /// Removes entries, those used longest ago first, until the rest is within the bound.
    fn make_room(&self) {
        let mut entries = self.entries();
        entries.sort();
        let mut total: u64 = entries.iter().map(|(_, _, bytes)| bytes).sum();
        for (_, path, bytes) in entries {
            if total <= self.limit_bytes {
                break;
            }
            // Another program may have removed it already: it takes no room either way.
            drop(fs::remove_file(path));
            total = total.saturating_sub(bytes);
        }
    }

    /// When each entry was used last, where it is and how large; stale staged files are removed.
    fn entries(&self) -> Vec<(SystemTime, PathBuf, u64)> {
        let now = SystemTime::now();
        let mut entries = Vec::new();
        for entry in fs::read_dir(&self.folder).into_iter().flatten().flatten() {
            let path = entry.path();
            let Ok(metadata) = entry.metadata() else {
                continue;
            };
            let used = metadata.modified().unwrap_or(SystemTime::UNIX_EPOCH);
            let ends_in = |end: &str| path.extension().is_some_and(|found| found == end);
            if ends_in(EXTENSION) {
                entries.push((used, path, metadata.len()));
            } else if is_staged(&path) && now.duration_since(used).is_ok_and(|age| age > STALE) {
                drop(fs::remove_file(path));
            }
        }
        entries
    }
}

/// Whether a file is an entry that was being written.
fn is_staged(path: &Path) -> bool {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    name.ends_with(".part") && name.contains(&format!(".{EXTENSION}."))
}

/// Head, hash of what follows; then for each file its name and length in a line, and its bytes.
fn encode(files: &[BuiltFile]) -> Vec<u8> {
    let mut body = Vec::new();
    for file in files {
        body.extend_from_slice(format!("{} {}\n", file.name, file.bytes.len()).as_bytes());
        body.extend_from_slice(&file.bytes);
    }
    let hash = sha256_hex([body.as_slice()]);
    let mut bytes = format!("{HEAD}\n{hash}\n").into_bytes();
    bytes.append(&mut body);
    bytes
}

fn decode(bytes: &[u8]) -> Option<Vec<BuiltFile>> {
    let (head, rest) = line(bytes)?;
    let (hash, mut rest) = line(rest)?;
    if head != HEAD || hash != sha256_hex([rest]) {
        return None;
    }
    let mut files = Vec::new();
    while !rest.is_empty() {
        let (about, after) = line(rest)?;
        let (name, length) = about.rsplit_once(' ')?;
        let (bytes, after) = after.split_at_checked(length.parse().ok()?)?;
        files.push(BuiltFile::new(name, bytes));
        rest = after;
    }
    Some(files)
}

fn line(bytes: &[u8]) -> Option<(&str, &[u8])> {
    let end = bytes.iter().position(|&byte| byte == b'\n')?;
    let text = std::str::from_utf8(&bytes[..end]).ok()?;
    Some((text, &bytes[end + 1..]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use selvedge_scratch::ScratchFolder;

    fn entries(folder: &Path) -> Vec<String> {
        let mut names: Vec<String> = (fs::read_dir(folder).into_iter().flatten().flatten())
            .map(|entry| entry.file_name().into_string().unwrap())
            .collect();
        names.sort();
        names
    }

    fn files(fill: u8, n: usize) -> Vec<BuiltFile> {
        ["a.csv", "two words.png"]
            .map(|name| BuiltFile {
                name: name.to_owned(),
                bytes: vec![fill; n],
            })
            .to_vec()
    }

    #[test]
    fn what_is_kept_comes_back_and_what_is_damaged_does_not() {
        let scratch = ScratchFolder::new("damage");
        let cache = BuildCache::in_folder(&scratch);
        assert_eq!(cache.get("k"), None, "nothing yet");
        cache.put("k", &files(b'\n', 100));
        assert_eq!(cache.get("k"), Some(files(b'\n', 100)));
        let path = scratch.join("k.textile");
        let whole = fs::read(&path).unwrap();
        for at in [0, 30, 90, 120, whole.len() - 1] {
            let mut bytes = whole.clone();
            bytes[at] ^= 1;
            fs::write(&path, &bytes).unwrap();
            assert_eq!(cache.get("k"), None, "byte {at} is damaged");
        }
        for length in [0, 10, 85, whole.len() - 1] {
            fs::write(&path, &whole[..length]).unwrap();
            assert_eq!(cache.get("k"), None, "cut to {length} bytes");
        }
        cache.put("k", &files(1, 5));
        assert_eq!(cache.get("k"), Some(files(1, 5)), "built again");
    }

    #[test]
    fn what_was_not_used_for_longest_makes_room() {
        let scratch = ScratchFolder::new("room");
        let cache = BuildCache::bounded(&scratch, 3500);
        fs::create_dir_all(&scratch).unwrap();
        fs::write(scratch.join("notes.txt"), [0; 9000]).unwrap();
        let minutes_ago = |key: &str, minutes: u64| {
            let file = fs::File::options().append(true).open(cache.path(key));
            let when = SystemTime::now() - Duration::from_mins(minutes);
            file.unwrap().set_modified(when).unwrap();
        };
        for (key, minutes) in [("a", 3), ("b", 2), ("c", 1)] {
            cache.put(key, &files(0, 500));
            minutes_ago(key, minutes);
        }
        assert!(cache.get("a").is_some(), "now it was used last");
        cache.put("d", &files(0, 500));
        assert_eq!(
            entries(&scratch),
            ["a.textile", "c.textile", "d.textile", "notes.txt"]
        );
        cache.put("e", &files(0, 5000));
        assert_eq!(cache.get("e"), None, "larger than the bound");
        fs::remove_dir_all(&scratch).unwrap();
        assert_eq!(cache.get("d"), None, "deleted by somebody");
        cache.put("d", &files(0, 5));
        assert!(cache.get("d").is_some(), "and there again");
    }

    #[test]
    fn a_folder_that_cannot_be_made_is_no_error() {
        let scratch = ScratchFolder::new("file");
        fs::write(&scratch, "no folder").unwrap();
        let cache = BuildCache::in_folder(&scratch);
        cache.put("k", &files(0, 5));
        assert_eq!(cache.get("k"), None);
        fs::remove_file(&scratch).unwrap();
    }

    #[test]
    fn many_writers_leave_whole_entries_and_nothing_else() {
        let scratch = ScratchFolder::new("writers");
        let cache = BuildCache::in_folder(&scratch);
        std::thread::scope(|scope| {
            for _ in 0..4 {
                let named = std::thread::Builder::new().name("selvedge-test".to_owned());
                let write = || {
                    for _ in 0..10 {
                        cache.put("k", &files(7, 2000));
                        assert!(cache.get("k").is_none_or(|found| found == files(7, 2000)));
                    }
                };
                named.spawn_scoped(scope, write).unwrap();
            }
        });
        assert_eq!(entries(&scratch), ["k.textile"]);
        assert_eq!(cache.get("k"), Some(files(7, 2000)));
    }
}
