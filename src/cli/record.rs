//! The session log of a command that talks to a device: where it is written, and what is in it.

use std::path::Path;

use clap::Args;

use super::CliError;
use super::output::OutFile;
use selvedge_device::{ArrayProfile, LogFeed, SessionLog};
use selvedge_foundation::files::{read, sha256_hex};

/// What is recorded of a link.
#[derive(Debug, Args)]
pub(super) struct RecordArgs {
    /// Every packet both ways, every setting, stop, fault and refusal of the link, as CSV; added to
    /// a file that is there
    #[arg(long, value_name = "F.csv")]
    session_log: Option<OutFile>,
    /// Keep hashes of frames in the session log, not the frames
    #[arg(long, requires = "session_log")]
    no_record_frames: bool,
}

impl RecordArgs {
    /// Opens the log, if one is asked for.
    pub(super) fn open(&self) -> Result<Option<SessionLog>, CliError> {
        let Some(path) = &self.session_log else {
            return Ok(None);
        };
        let log = SessionLog::append(path, None)?;
        Ok(Some(if self.no_record_frames {
            log.without_frames()
        } else {
            log
        }))
    }
}

/// Writes down which files are played on which array. A file that was read once and is gone says
/// nothing.
pub(super) fn say_what(feed: &mut LogFeed, profile: &ArrayProfile, files: &[(&str, &Path)]) {
    feed.about_array(profile);
    for (name, path) in files {
        if let Ok(bytes) = read(path) {
            let hash = sha256_hex([bytes.as_slice()]);
            feed.about(&format!("{name}_sha256"), &hash);
        }
    }
}
