//! The study of clips: what it costs to write an exploration for other programs, by its length.
//!
//! The cost of a second must not grow with what was written before it: the time for the ninety
//! seconds from 10 to 100 is set beside that for the nine from 1 to 10.

use std::path::{Path, PathBuf};

use super::{Bench, Effort, Findings, ReportError, Row, Study, Timing};
use crate::bridge::ArrayProfile;
use crate::engine::{ClipKind, ClipWriter, EngineError};
use crate::figure::{Axis, Plot, Scale, Series, Style};
use crate::progress::unheard;
use crate::quantity;

/// Contactors of the array.
const N_CONTACTORS: usize = 24;
/// Lengths of clips, s.
const LENGTHS_S: [u32; 3] = [1, 10, 100];
const TICKS_PER_S: u32 = 40;

/// Cost of a clip over its length.
#[derive(Debug, Clone, Copy, Default)]
pub struct ClipsStudy;

impl Study for ClipsStudy {
    fn name(&self) -> &'static str {
        "clips"
    }

    fn question(&self) -> &'static str {
        "What does it cost to write an exploration of 1 to 100 s for other programs?"
    }

    fn reference(&self) -> &'static str {
        "None: only cost is asked about."
    }

    fn error_measure(&self) -> (&'static str, &'static str) {
        ("error", "none")
    }

    fn cost_of(&self) -> &'static str {
        "clip"
    }

    fn run(&self, bench: &mut Bench<'_>) -> Result<Findings, ReportError> {
        let mut findings = Findings::default();
        let mut series = Vec::new();
        for (number, file) in FILES.iter().enumerate() {
            bench.step(number as f64 / FILES.len() as f64, file.name)?;
            let mut points = Vec::new();
            for length_s in LENGTHS_S {
                let row = row(bench, file, length_s)?;
                points.extend(row.cost.map(|cost| [f64::from(length_s), cost.cpu_s]));
                findings.rows.push(row);
            }
            findings.notes.extend(note(file, &points));
            series.push(Series {
                name: file.name.to_owned(),
                points,
                style: Style::LineAndDots,
                ..Series::default()
            });
        }
        findings
            .plots
            .push(("clips-length".to_owned(), plot(series)));
        Ok(findings)
    }
}

/// A kind of file that is written.
struct File {
    name: &'static str,
    kind: ClipKind,
    /// Whether its bytes go nowhere: half a gigabyte is no business of a report's disk.
    goes_nowhere: bool,
}

const FILES: [File; 4] = [
    File {
        name: "WAV, 8 kHz i16",
        kind: ClipKind::ARCHIVE,
        goes_nowhere: false,
    },
    File {
        name: "WAV, 48 kHz f32",
        kind: ClipKind::FLOAT,
        goes_nowhere: cfg!(unix),
    },
    File {
        name: "MPEG haptics",
        kind: ClipKind::Hjif,
        goes_nowhere: false,
    },
    File {
        name: "frames as CSV",
        kind: ClipKind::Frames,
        goes_nowhere: false,
    },
];

impl File {
    fn place(&self) -> PathBuf {
        if self.goes_nowhere {
            return PathBuf::from("/dev/null");
        }
        std::env::temp_dir().join(format!("selvedge-clip-{}.part", std::process::id()))
    }
}

/// The cost of one file of one length.
fn row(bench: &mut Bench<'_>, file: &File, length_s: u32) -> Result<Row, ReportError> {
    let place = file.place();
    let mut outcome = Ok(());
    let n_repeats = match (bench.effort, length_s) {
        (_, 100) => 1,
        (Effort::Quick, _) => 3,
        (Effort::Full, 10) => 5,
        (Effort::Full, _) => 15,
    };
    let cost = bench.time_repeated(n_repeats, 1, || {
        if let Err(error) = write(&place, file.kind, length_s) {
            outcome = Err(error);
        }
    });
    let bytes = place.metadata().ok().filter(|_| !file.goes_nowhere);
    let bytes = bytes.map(|meta| meta.len());
    if !file.goes_nowhere {
        drop(std::fs::remove_file(&place));
    }
    outcome?;
    Ok(measured(file, length_s, cost, bytes))
}

fn measured(file: &File, length_s: u32, cost: Timing, bytes: Option<u64>) -> Row {
    let per_second_ms = 1e3 * cost.cpu_s / f64::from(length_s);
    Row {
        method: file.name.to_owned(),
        setting: format!("{N_CONTACTORS} contactors"),
        case: "a clip".to_owned(),
        size: Some(f64::from(length_s)),
        cost: Some(cost),
        bytes,
        more: vec![("ms_per_second", format!("{per_second_ms:.4}"))],
        ..Row::default()
    }
}

/// Writes a clip in which every contactor sounds and no tick is like the one before.
fn write(place: &Path, kind: ClipKind, length_s: u32) -> Result<(), EngineError> {
    let profile = ArrayProfile::default();
    let mut clip = ClipWriter::create(place, kind, (&profile, N_CONTACTORS), "clip")?;
    let mut amplitudes_um = [[0.0_f32; 2]; N_CONTACTORS];
    for tick in 0..u64::from(length_s * TICKS_PER_S) {
        for (contactor, [low_um, high_um]) in amplitudes_um.iter_mut().enumerate() {
            let turn = (tick % 4099) as f32 * 0.37 + contactor as f32;
            *low_um = 12.5 + 12.0 * turn.sin();
            *high_um = 12.5 + 12.0 * turn.cos();
        }
        clip.take(tick, &amplitudes_um)?;
    }
    unheard(|progress| clip.finish(progress))?;
    Ok(())
}

/// How much the later seconds cost beside the earlier ones.
fn note(file: &File, points: &[[f64; 2]]) -> Option<String> {
    let &[[_, first_s], [_, middle_s], [_, last_s]] = points else {
        return None;
    };
    let early_s = (middle_s - first_s) / 9.0;
    let late_s = (last_s - middle_s) / 90.0;
    Some(format!(
        "{}: a second costs {} ms from 10 to 100 s, {} times that from 1 to 10 s.",
        file.name,
        quantity::fixed(1e3 * late_s, 3),
        quantity::fixed(late_s / early_s, 2)
    ))
}

fn plot(series: Vec<Series>) -> Plot {
    let axis = |label: &str| Axis {
        label: label.to_owned(),
        scale: Scale::Log,
        range: None,
    };
    Plot {
        title: "Cost of writing a clip over its length".to_owned(),
        x: axis("length, s"),
        y: axis("CPU time, s"),
        series,
        footnote: String::new(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_note_sets_late_seconds_beside_early_ones() {
        let note = note(&FILES[0], &[[1.0, 0.5], [10.0, 5.0], [100.0, 95.0]]).unwrap();
        assert!(
            note.contains("1000.000 ms") && note.contains(" 2.00 times"),
            "{note}"
        );
        assert_eq!(super::note(&FILES[0], &[]), None);
    }

    #[test]
    fn a_clip_of_every_kind_has_bytes_and_leaves_none_behind() {
        for file in &FILES {
            let place = file.place();
            write(&place, file.kind, 1).unwrap();
            if !file.goes_nowhere {
                assert!(place.metadata().unwrap().len() > 1000, "{}", file.name);
                std::fs::remove_file(&place).unwrap();
            }
        }
    }
}
