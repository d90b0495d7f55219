//! Certificates in a folder: the user's own, which tell whether a device was certified.

use std::fs;
use std::path::{Path, PathBuf};

use super::report::Certificate;
use crate::array::DeviceUid;
use selvedge_foundation::files::{FileError, read_text, sha256_hex, write_atomic};

/// A folder of certificates, which need not be there yet.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct CertificateFolder {
    path: PathBuf,
}

impl CertificateFolder {
    /// The folder at `path`.
    pub fn new(path: &Path) -> Self {
        Self {
            path: path.to_owned(),
        }
    }

    /// Writes Markdown and JSON, in place of those of the same device and firmware, and makes the
    /// folder when need be. Gives the path of the Markdown.
    ///
    /// # Errors
    /// The folder or a file cannot be written.
    pub fn write(&self, certificate: &Certificate) -> Result<PathBuf, FileError> {
        fs::create_dir_all(&self.path).map_err(FileError::write(&self.path))?;
        let stem = certificate.file_stem();
        let json = self.path.join(format!("{stem}.json"));
        write_atomic(&json, certificate.to_json(&json)?.as_bytes())?;
        let markdown = self.path.join(format!("{stem}.md"));
        write_atomic(&markdown, certificate.to_markdown().as_bytes())?;
        Ok(markdown)
    }

    /// The certificate of a device with this firmware; `None` where none is, or none that can be
    /// read.
    pub fn find(&self, uid: DeviceUid, firmware: [u8; 3]) -> Option<Certificate> {
        let path = self.place(uid, firmware);
        Certificate::from_json(&read_text(&path).ok()?, &path).ok()
    }

    /// SHA-256 of that certificate's file; `None` where there is none.
    pub fn sha256(&self, uid: DeviceUid, firmware: [u8; 3]) -> Option<String> {
        let text = read_text(&self.place(uid, firmware)).ok()?;
        Some(sha256_hex([text.as_bytes()]))
    }

    fn place(&self, uid: DeviceUid, [major, minor, patch]: [u8; 3]) -> PathBuf {
        let name = format!("certificate-{uid}-{major}.{minor}.{patch}.json");
        self.path.join(name)
    }

    /// Whether a device with this firmware passed everything.
    pub fn covers(&self, uid: DeviceUid, firmware: [u8; 3]) -> bool {
        self.find(uid, firmware)
            .is_some_and(|certificate| certificate.covers(uid, firmware))
    }
}
