//! What can go wrong on this floor, each in one line that says how to mend it.

use std::io;
use std::path::{Path, PathBuf};

use selvedge_foundation::files::FileError;
use selvedge_foundation::progress::Cancelled;
use thiserror::Error;

/// An error of the bridge.
#[derive(Debug, Error)]
pub enum BridgeError {
    /// A serial port could not be opened.
    #[error("{port}: {reason}")]
    Open {
        /// Name of the port.
        port: String,
        /// What is wrong and how to mend it.
        reason: String,
    },
    /// Another program, or an earlier link of this one, holds the port.
    #[error("{port}: in use by another program{}", busy_words(holder.as_deref()))]
    Busy {
        /// Name of the port.
        port: String,
        /// Which program, if that can be told.
        holder: Option<String>,
    },
    /// A file or link could not be written.
    #[error("cannot {action}: {source}: {}", path.display())]
    File {
        /// What was tried.
        action: &'static str,
        /// Where.
        path: PathBuf,
        /// Why not.
        source: io::Error,
    },
    /// The place of the emulator's link is taken.
    #[error("{}: exists and was not made by an emulator: choose another --link", .0.display())]
    LinkTaken(PathBuf),
    /// A running emulator has the link's name.
    #[error("{}: held by {holder}: end that one first, or choose another --link", link.display())]
    LinkHeld {
        /// The name.
        link: PathBuf,
        /// Whose it is.
        holder: String,
    },
    /// A pseudo-terminal could not be made.
    #[error("no pseudo-terminal: {0}")]
    Pty(String),
    /// A model of a contactor that cannot be.
    #[error("{0}")]
    Model(String),
    /// A link broke.
    #[error("{port}: {reason}")]
    Link {
        /// Name of the port.
        port: String,
        /// What happened.
        reason: String,
    },
    /// A thread could not be started.
    #[error("cannot start a thread: {0}")]
    Thread(io::Error),
    /// The list of ports could not be read.
    #[error("cannot list serial ports: {0}")]
    List(String),
    /// Lines of a session log were not written.
    #[error("the session log is not whole: {reason}: {}", path.display())]
    Log {
        /// The file.
        path: PathBuf,
        /// Why not.
        reason: String,
    },
    /// A session log cannot stand where it should.
    #[error(
        "cannot write the session log: {reason}; name a file in a folder that is there: {}",
        path.display()
    )]
    LogPlace {
        /// The file.
        path: PathBuf,
        /// What is wrong with the place.
        reason: String,
    },
    /// What should be a session log is none, or cannot be read.
    #[error("{}{}: {reason}", path.display(), line_words(*line))]
    LogContent {
        /// The file.
        path: PathBuf,
        /// The line, from 1; 0 for the file as a whole.
        line: u64,
        /// What is wrong and how to mend it.
        reason: String,
    },
    /// An array profile.
    #[error(transparent)]
    Profile(#[from] FileError),
    /// A WAV file has no room for more.
    #[error(
        "a WAV file holds less than 4 GiB: choose 16-bit samples, a lower rate or a shorter path"
    )]
    WavFull,
    /// Samples that do not fill whole frames.
    #[error("{n_samples} samples are not whole frames of {n_channels} channels")]
    WavFrame {
        /// Samples given.
        n_samples: usize,
        /// Channels of the file.
        n_channels: u16,
    },
    /// A WAV file without channels or without a rate.
    #[error("a WAV file needs channels and a rate: {n_channels} channels at {sample_rate_hz} Hz")]
    WavSpec {
        /// Channels asked for.
        n_channels: u16,
        /// Rate asked for in Hz.
        sample_rate_hz: u32,
    },
    /// Writing samples failed.
    #[error("cannot write the WAV file: {0}")]
    Wav(io::Error),
}

/// Where in a file, if it is somewhere.
fn line_words(line: u64) -> String {
    match line {
        0 => String::new(),
        line => format!(":{line}"),
    }
}

/// Who holds a port and how to get it.
fn busy_words(holder: Option<&str>) -> String {
    match holder {
        Some(name) if name.starts_with("ModemManager") => format!(
            " ({name}): wait until it has given up, and keep it away for good with the rule that \
             \"selvedge bridge list --udev-rule\" prints"
        ),
        Some(name) => format!(" ({name}): close that one first"),
        None => String::from(": close that one first"),
    }
}

impl BridgeError {
    /// The message without the port's name, for owners that know which port they asked for.
    pub(crate) fn without_port(&self) -> String {
        let text = self.to_string();
        let (Self::Open { port, .. } | Self::Busy { port, .. } | Self::Link { port, .. }) = self
        else {
            return text;
        };
        let bare = text
            .strip_prefix(port.as_str())
            .and_then(|rest| rest.strip_prefix(": "));
        bare.map(String::from).unwrap_or(text)
    }

    /// Wraps what a file operation on `path` said.
    pub(super) fn file(action: &'static str, path: &Path) -> impl FnOnce(io::Error) -> Self {
        let path = path.to_path_buf();
        move |source| Self::File {
            action,
            path,
            source,
        }
    }
}

/// Why a file was not written. Nothing of it is left.
#[derive(Debug, thiserror::Error)]
pub enum SinkError {
    /// Its place is wrong.
    #[error("cannot write {}: {source}; check the folder", path.display())]
    Place {
        /// Where.
        path: PathBuf,
        /// What the system said.
        source: io::Error,
    },
    /// It cannot be written on: the disk is full, for one.
    #[error(transparent)]
    File(#[from] FileError),
    /// What is to be written makes no such file.
    #[error(transparent)]
    Bridge(#[from] BridgeError),
    /// It was stopped before it was done.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

impl SinkError {
    /// Wraps what creating the file at `path` said.
    pub(super) fn place(path: &Path) -> impl FnOnce(io::Error) -> Self {
        let path = path.to_owned();
        move |source| Self::Place { path, source }
    }

    /// Wraps what writing the file at `path` said.
    pub(super) fn write(path: &Path) -> impl FnOnce(io::Error) -> Self {
        let path = path.to_owned();
        move |source| Self::File(FileError::Write { path, source })
    }
}
