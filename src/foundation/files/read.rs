//! Reading whole files, and never more of one than it may hold: a pipe without an end, a device or
//! the wrong file of many gigabytes ends in one line, not with the memory.

use std::fs::File;
use std::io::{self, Read as _};
use std::path::Path;

use super::{FileError, line_at};

/// Most bytes of a text, of a file in no known format, and of what does not say how long it is: a
/// pipe or a device.
const MAX_BYTES: u64 = 60_000_000;
/// Most bytes of an ordinary file in a format that its first bytes tell.
const MAX_KNOWN: u64 = 1_000_000_000;
/// Most bytes of a line of text.
const MAX_LINE: usize = 1_000_000;
/// How many bytes tell a format.
const HEAD: u64 = 4096;
/// Bytes that are read before lines are looked at: fewer than a line may have.
const CHUNK: u64 = 1 << 18;

/// The bytes of a file, at most 60 MB.
///
/// # Errors
/// It cannot be read, is empty or larger.
pub fn read(path: &Path) -> Result<Vec<u8>, FileError> {
    Reading::open(path)?.into_bytes(MAX_BYTES, usize::MAX)
}

/// The bytes of a file: at most 1 GB of an ordinary one whose first bytes `is_known` recognises.
/// Any other is bounded as a text is.
///
/// # Errors
/// It cannot be read, is empty or larger, or has a line above 1 MB.
pub fn read_known(path: &Path, is_known: impl Fn(&[u8]) -> bool) -> Result<Vec<u8>, FileError> {
    let mut reading = Reading::open(path)?;
    reading.read_part(HEAD)?;
    match (is_known(&reading.bytes), reading.size) {
        (true, Some(_)) => reading.into_bytes(MAX_KNOWN, usize::MAX),
        (true, None) => reading.into_bytes(MAX_BYTES, usize::MAX),
        (false, _) => reading.into_bytes(MAX_BYTES, MAX_LINE),
    }
}

/// The text of a file, without a byte-order mark: at most 60 MB in lines of at most 1 MB.
///
/// # Errors
/// It cannot be read, is empty, larger or not UTF-8.
pub fn read_text(path: &Path) -> Result<String, FileError> {
    let bytes = Reading::open(path)?.into_bytes(MAX_BYTES, MAX_LINE)?;
    let mut text = String::from_utf8(bytes).map_err(|error| {
        let line = line_at(error.as_bytes(), error.utf8_error().valid_up_to());
        let what = "this is not UTF-8 text";
        FileError::content(path, line, what, "save the file as UTF-8")
    })?;
    if text.starts_with('\u{feff}') {
        text.remove(0);
    }
    Ok(text)
}

/// A file, as far as it was read.
struct Reading<'a> {
    path: &'a Path,
    file: File,
    /// What an ordinary file says; those of the system say 0 and hold more.
    size: Option<u64>,
    bytes: Vec<u8>,
}

impl<'a> Reading<'a> {
    fn open(path: &'a Path) -> Result<Self, FileError> {
        let opened = || {
            let file = File::open(path)?;
            let about = file.metadata()?;
            if about.is_dir() {
                return Err(io::ErrorKind::IsADirectory.into());
            }
            Ok((file, about.is_file().then_some(about.len())))
        };
        let (file, size) = opened().map_err(FileError::read(path))?;
        Ok(Self {
            path,
            file,
            size,
            bytes: Vec::new(),
        })
    }

    /// Reads `n_bytes` more, fewer at the end; says whether there were any.
    fn read_part(&mut self, n_bytes: u64) -> Result<bool, FileError> {
        let read = (&mut self.file).take(n_bytes).read_to_end(&mut self.bytes);
        let n_read = read.map_err(FileError::read(self.path))?;
        Ok(n_read > 0)
    }

    fn into_bytes(mut self, max_bytes: u64, max_line: usize) -> Result<Vec<u8>, FileError> {
        let mut is_too_large = self.size.is_some_and(|size| size > max_bytes);
        let mut line = 0..0;
        while !is_too_large && self.read_part(CHUNK)? {
            let end = self.bytes[line.end..].iter().rposition(|&b| b == b'\n');
            line.start = end.map_or(line.start, |end| line.end + end + 1);
            line.end = self.bytes.len();
            if line.len() > max_line {
                let what = "this is no text, or has a line of more than 1 MB";
                let number = line_at(&self.bytes, line.start);
                let mend = "give another file, or break the line";
                return Err(FileError::content(self.path, number, what, mend));
            }
            is_too_large = self.bytes.len() as u64 > max_bytes;
        }
        if is_too_large {
            let what = format!("this file is larger than {} MB", max_bytes / 1_000_000);
            let mend = "give another file, or the part of it that you need";
            return Err(FileError::whole(self.path, what, mend));
        }
        if self.bytes.is_empty() {
            let mend = "give a file that holds something";
            return Err(FileError::whole(self.path, "this file is empty", mend));
        }
        Ok(self.bytes)
    }
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;
    use selvedge_scratch::ScratchFolder;

    /// The error of reading a file as text, which is told in one line with its name.
    fn refused(path: &Path) -> String {
        let line = read_text(path).unwrap_err().to_string();
        assert!(line.contains(path.to_str().unwrap()), "{line}");
        assert!(line.contains("; ") && !line.contains('\n'), "{line}");
        line
    }

    #[test]
    fn what_has_no_end_or_nothing_is_refused_in_a_line() {
        let folder = ScratchFolder::made("bounds");
        let path = folder.join("a.csv");
        assert!(refused(&path).contains("check the path"));
        assert!(refused(&folder).contains("name a file in it"));
        fs::write(&path, "").unwrap();
        assert!(refused(&path).contains("is empty"));
        fs::write(&path, b"a\n\xff").unwrap();
        assert!(refused(&path).contains(":2: this is not UTF-8"));
        fs::write(&path, vec![b'#'; 10 << 20]).unwrap();
        assert!(refused(&path).contains(":1: this is no text"));
        assert_eq!(read(&path).unwrap().len(), 10 << 20);
        File::options()
            .write(true)
            .open(&path)
            .and_then(|file| file.set_len(300 << 20))
            .unwrap();
        assert!(refused(&path).contains("larger than 60 MB"));
        let large = read(&path).unwrap_err().to_string();
        assert!(large.contains("larger than 60 MB"), "{large}");
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn a_device_without_an_end_is_refused_even_where_its_format_is_known() {
        let zero = Path::new("/dev/zero");
        assert!(refused(zero).contains("/dev/zero:1: this is no text"));
        for known in [false, true] {
            let error = read_known(zero, |_| known).unwrap_err().to_string();
            assert_eq!(error.contains("larger than 60 MB"), known, "{error}");
        }
        assert!(refused(Path::new("/dev/null")).contains("is empty"));
        assert!(!read_text(Path::new("/proc/cpuinfo")).unwrap().is_empty());
    }

    #[test]
    fn text_comes_without_its_byte_order_mark_and_long_files_have_long_lines() {
        let folder = ScratchFolder::made("text");
        let path = folder.join("a.csv");
        fs::write(&path, "\u{feff}two").unwrap();
        assert_eq!(read_text(&path).unwrap(), "two");
        let rows = "0.025,1,2\n".repeat(400_000);
        fs::write(&path, &rows).unwrap();
        assert_eq!(read_text(&path).unwrap(), rows);
        assert_eq!(read_known(&path, |_| false).unwrap(), rows.as_bytes());
    }
}
