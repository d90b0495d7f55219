//! ZIP archives: named members in and out, with a limit on what a member may inflate to.

use std::io::{Cursor, Read as _, Write as _};
use std::path::{Path, PathBuf};

use zip::result::ZipError;
use zip::write::SimpleFileOptions;
use zip::{ZipArchive, ZipWriter};

use super::FileError;

/// A ZIP archive held in memory.
#[derive(Debug)]
pub struct Archive<'a> {
    zip: ZipArchive<Cursor<&'a [u8]>>,
    path: PathBuf,
}

impl<'a> Archive<'a> {
    /// Opens an archive. `path` only names it in errors.
    ///
    /// # Errors
    /// It is no ZIP archive, or is cut short.
    pub fn open(bytes: &'a [u8], path: &Path) -> Result<Self, FileError> {
        let zip = ZipArchive::new(Cursor::new(bytes)).map_err(|error| wrong(path, &error))?;
        Ok(Self {
            zip,
            path: path.to_owned(),
        })
    }

    /// The file, as errors name it.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// The name of the first member whose path ends in `end` after a whole folder name; members of
    /// `__MACOSX` do not count.
    pub fn find(&self, end: &str) -> Option<String> {
        let is_it = |name: &String| {
            let before = name.strip_suffix(end);
            before.is_some_and(|before| before.is_empty() || before.ends_with('/'))
                && !name.starts_with("__MACOSX/")
        };
        let names = self.zip.file_names().filter_map(Result::ok);
        names.map(std::borrow::Cow::into_owned).find(is_it)
    }

    /// The bytes of a member, inflated to `max_bytes` at most.
    ///
    /// # Errors
    /// No such member, a damaged one, or one that is larger.
    pub fn member(&mut self, name: &str, max_bytes: usize) -> Result<Vec<u8>, FileError> {
        let member = self.zip.by_name(name);
        let member = member.map_err(|error| wrong(&self.path, &error))?;
        let limit = u64::try_from(max_bytes).unwrap_or(u64::MAX);
        let mut bytes = Vec::new();
        let read = member
            .take(limit.saturating_add(1))
            .read_to_end(&mut bytes)
            .map_err(|error| {
                let what = format!("{name} is damaged: {error}");
                FileError::whole(&self.path, what, "get an intact copy")
            })?;
        if read > max_bytes {
            let what = format!("{name} inflates to more than {max_bytes} bytes");
            let mend = "its header promises less; get an intact copy";
            return Err(FileError::whole(&self.path, what, mend));
        }
        Ok(bytes)
    }
}

impl Archive<'_> {
    /// Packs members into an archive, deflated, all dated 1980: the same members, the same bytes.
    ///
    /// # Errors
    /// More than a ZIP archive can hold.
    pub fn pack(members: &[(&str, &[u8])], path: &Path) -> Result<Vec<u8>, FileError> {
        let mut zip = ZipWriter::new(Cursor::new(Vec::new()));
        let options = SimpleFileOptions::default()
            .compression_method(zip::CompressionMethod::Deflated)
            .last_modified_time(zip::DateTime::default());
        for (name, bytes) in members {
            let started = zip.start_file(*name, options);
            started.map_err(|error| wrong(path, &error))?;
            let written = zip.write_all(bytes);
            written.map_err(|error| wrong(path, &ZipError::Io(error)))?;
        }
        let packed = zip.finish().map_err(|error| wrong(path, &error))?;
        Ok(packed.into_inner())
    }
}

fn wrong(path: &Path, error: &ZipError) -> FileError {
    let what = format!("the ZIP archive is damaged: {error}");
    FileError::whole(path, what, "get an intact copy")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn members_come_back_and_a_bomb_is_stopped() {
        let zeros = vec![0_u8; 1 << 20];
        let path = Path::new("a.zip");
        let packed =
            Archive::pack(&[("sub/main.xml", b"<a/>"), ("data.bin", &zeros)], path).unwrap();
        assert!(packed.len() < 4096, "{}", packed.len());
        assert_eq!(
            packed,
            Archive::pack(&[("sub/main.xml", b"<a/>"), ("data.bin", &zeros)], path).unwrap()
        );
        let mut archive = Archive::open(&packed, path).unwrap();
        assert_eq!(archive.find("main.xml").unwrap(), "sub/main.xml");
        assert!(archive.find("ain.xml").is_none());
        assert_eq!(archive.member("data.bin", 1 << 20).unwrap(), zeros);
        let error = archive.member("data.bin", 1000).unwrap_err().to_string();
        assert!(error.contains("more than 1000 bytes"), "{error}");
        assert!(Archive::open(&packed[..packed.len() / 2], path).is_err());
    }
}
