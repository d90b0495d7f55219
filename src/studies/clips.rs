//! The study of clips: what it costs to write an exploration for other programs, by its length.
//!
//! The cost of a second must not grow with what was written before it: the time for the ninety
//! seconds from 10 to 100 is set beside that for the nine from 1 to 10. The three lengths are
//! measured in turn, round by round, so that a machine that changes its pace changes it for all.

use std::cell::RefCell;
use std::path::{Path, PathBuf};

use super::{Bench, Findings, ReportError, Row, Study, Timing};
use selvedge_chart::{Axis, Chart, Series, Style};
use selvedge_device::ArrayProfile;
use selvedge_engine::{ClipKind, ClipWriter, EngineError};
use selvedge_foundation::numerics::{median, quantile};
use selvedge_foundation::progress::unheard;
use selvedge_foundation::quantity;

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
            let (rows, rounds) = measure(bench, file)?;
            let points = rows.iter().filter_map(|row| {
                let cost = row.cost?;
                Some([row.size?, cost.cpu_s])
            });
            let points = points.collect();
            findings.notes.push(note(file, &rounds));
            findings.rows.extend(rows);
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

/// CPU times of the three lengths, round by round, s.
type Rounds = [Vec<f64>; 3];

/// The cost of one file in all lengths, measured in turn.
fn measure(bench: &Bench<'_>, file: &File) -> Result<(Vec<Row>, Rounds), ReportError> {
    let place = file.place();
    let failed = RefCell::new(None);
    let work = |length_s| {
        let (place, failed) = (&place, &failed);
        move || {
            if let Err(error) = write(place, file.kind, length_s) {
                failed.borrow_mut().get_or_insert(error);
            }
        }
    };
    let rounds = (bench.effort.pick(1, 9), bench.effort.pick(0.01, 0.1));
    let timed = Bench::time_rounds(rounds, 1, LENGTHS_S.map(work).into());
    let mut rows = Vec::new();
    for (length_s, (cost, _)) in LENGTHS_S.into_iter().zip(&timed) {
        rows.push(measured(
            file,
            length_s,
            *cost,
            bytes_of(file, &place, length_s)?,
        ));
    }
    if let Some(error) = failed.into_inner() {
        return Err(error.into());
    }
    let mut times = timed.into_iter().map(|(_, cpu_s)| cpu_s);
    let rounds = LENGTHS_S.map(|_| times.next().unwrap_or_default());
    Ok((rows, rounds))
}

/// How large a file is; `None` where its bytes go nowhere.
fn bytes_of(file: &File, place: &Path, length_s: u32) -> Result<Option<u64>, ReportError> {
    if file.goes_nowhere {
        return Ok(None);
    }
    write(place, file.kind, length_s)?;
    let bytes = place.metadata().ok().map(|meta| meta.len());
    drop(std::fs::remove_file(place));
    Ok(bytes)
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

/// How much the later seconds cost beside the earlier ones: in the median over the rounds, and
/// between the quartiles.
fn note(file: &File, [first_s, middle_s, last_s]: &Rounds) -> String {
    let times = first_s.iter().zip(middle_s).zip(last_s);
    let (mut late, mut ratios) = (Vec::new(), Vec::new());
    for ((first_s, middle_s), last_s) in times {
        let early_s = (middle_s - first_s) / 9.0;
        let late_s = (last_s - middle_s) / 90.0;
        late.push(1e3 * late_s);
        ratios.push(late_s / early_s);
    }
    let quartiles = [0.25, 0.75].map(|q| quantity::fixed(quantile(&mut ratios, q), 2));
    format!(
        "{}: a second costs {} ms from 10 to 100 s, {} times that from 1 to 10 s ({} to {} in half \
         of the rounds).",
        file.name,
        quantity::fixed(median(&mut late), 3),
        quantity::fixed(median(&mut ratios), 2),
        quartiles[0],
        quartiles[1]
    )
}

fn plot(series: Vec<Series>) -> Chart {
    Chart {
        title: "Cost of writing a clip over its length".to_owned(),
        x: Axis::log("length, s"),
        y: Axis::log("CPU time, s"),
        series,
        footnote: String::new(),
        ..Chart::default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_note_sets_late_seconds_beside_early_ones() {
        // The second round is twice as slow all over.
        let rounds = [[0.5, 1.0], [5.0, 10.0], [95.0, 190.0]].map(Vec::from);
        let note = note(&FILES[0], &rounds);
        assert!(note.contains("1500.000 ms"), "{note}");
        assert!(
            note.contains(" 2.00 times") && note.contains("(2.00 to 2.00"),
            "{note}"
        );
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
