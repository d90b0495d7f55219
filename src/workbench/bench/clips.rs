//! The recording at hand on its way to a file for other programs: rendered over the scene as it is
//! felt now, on a thread of its own that shows how far it is and can be stopped.

use std::path::PathBuf;

use crate::bench::background::Task;
use selvedge_engine::{ClipKind, Written};

/// Every file that is offered, and what it is called.
pub(crate) const CLIPS: [(ClipKind, &str); 4] = [
    (ClipKind::FLOAT, "Waveform to play, 48 kHz…"),
    (ClipKind::ARCHIVE, "Waveform to keep, 8 kHz…"),
    (ClipKind::Hjif, "MPEG haptics…"),
    (ClipKind::Frames, "Frames as a table…"),
];

/// A file on its way.
#[derive(Debug, Default)]
pub(crate) struct Clips {
    pub(crate) task: Option<Task<Written>>,
    /// Where the last one went.
    pub(crate) last: Option<PathBuf>,
}

/// What the menu shows of it.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct ClipsView {
    /// Whether there is a recording to write.
    pub(crate) has_take: bool,
    /// How far a file is, 0…1; `None` while none is written.
    pub share: Option<f32>,
}

/// How the names of such files end, without the dot.
pub(crate) fn ending(kind: ClipKind) -> &'static str {
    match kind {
        ClipKind::Wav { .. } => "wav",
        ClipKind::Hjif => "hjif",
        ClipKind::Frames => "csv",
    }
}

/// What a user should know of files that are there.
pub(crate) fn said(written: &Written) -> String {
    let place = match &written.paths[..] {
        [first, .., last] => {
            let n_parts = written.paths.len();
            format!(
                "{} to {}, {n_parts} parts, are",
                first.display(),
                last.display()
            )
        }
        [only] => format!("{} is", only.display()),
        [] => "Nothing is".to_owned(),
    };
    match written.peak.filter(|peak| *peak > 1.0) {
        Some(peak) => format!("{place} written; it reaches {peak:.2} of full scale"),
        None => format!("{place} written"),
    }
}
