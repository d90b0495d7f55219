//! A recording on disk: a folder with a table that grows by a row a tick, and a page that says
//! what it is.
//!
//! Whatever interrupts the program leaves every row but the last half second; a row that is not
//! whole is left out on reading. Which recordings there are is not known here.

use std::fs;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use crate::bench::recording::rows::{COLUMNS, TICKS, read_rows};
use crate::bench::recording::{Felt, Recording, missing_before};
use selvedge_foundation::files::{self, FileError, Journal};
use selvedge_foundation::geometry::Point;
use selvedge_foundation::numerics::to_single;
use selvedge_render::scene::{ExplorationPath, Pose, TICKS_PER_S};
use selvedge_textile::tactile::Tuning;

/// The page.
const ABOUT: &str = "recording.toml";
/// The most points of an outline.
const OUTLINE: usize = 64;

/// A place in a recording that was noted.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) struct Marker {
    /// Its tick, from 0.
    pub(crate) tick: u64,
    /// What it is called, or the note.
    pub(crate) name: String,
}

/// What a recording is, beside its ticks.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub(crate) struct About {
    /// What people call it.
    pub(crate) name: String,
    /// When it began, RFC 3339.
    pub(crate) began: String,
    /// The name of the scene that was explored.
    pub(crate) scene: String,
    /// The file of that scene, if it had one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) scene_file: Option<PathBuf>,
    /// Ticks, and how many of them an armed device played; `None` until it is over.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) ticks: Option<[u64; 2]>,
    /// Its path in few points, mm.
    #[serde(default)]
    pub(crate) outline: Vec<[f32; 2]>,
    /// Gains and compression when it began.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) tuning: Option<Tuning>,
    /// The stylus that was felt in place of the array when it began.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) stylus: Option<String>,
    /// Places that were noted, in their order.
    #[serde(default, rename = "marker", skip_serializing_if = "Vec::is_empty")]
    pub(crate) markers: Vec<Marker>,
}

impl About {
    /// Reads the page of a recording's folder.
    pub(crate) fn read(folder: &Path) -> Result<Self, FileError> {
        let path = folder.join(ABOUT);
        files::keys_from_str(&files::read_text(&path)?, &path)
    }

    /// Writes it.
    pub(crate) fn write(&self, folder: &Path) -> Result<(), FileError> {
        let path = folder.join(ABOUT);
        files::write_atomic(&path, files::keys_to_string(self, &path)?.as_bytes())
    }
}

/// Whether a program is writing the recording in this folder now.
pub(crate) fn is_written(folder: &Path) -> bool {
    Journal::is_written(&folder.join(TICKS))
}

/// A path in few points, however long it is: every so manieth tick.
#[derive(Debug, Default)]
struct Outline {
    points: Vec<[f32; 2]>,
    n_seen: usize,
    halvings: u32,
}

impl Outline {
    fn add(&mut self, position: Point) {
        if self.n_seen.is_multiple_of(1 << self.halvings) {
            if self.points.len() == OUTLINE {
                let mut nth = 0;
                self.points.retain(|_| {
                    nth += 1;
                    nth % 2 == 1
                });
                self.halvings += 1;
            }
            self.points
                .push([to_single(position.x_mm), to_single(position.y_mm)]);
        }
        self.n_seen += 1;
    }
}

/// A tick as it is written.
#[derive(Debug, Clone, Copy)]
pub(crate) struct FeltTick<'a> {
    /// Of the engine.
    pub(crate) tick: u64,
    pub(crate) pose: Pose,
    /// Those of displays beside the first.
    pub(crate) others: &'a [Pose],
    /// The device's tick at which it was played; `None` when it was only shown.
    pub(crate) apply_tick: Option<u32>,
    /// [A40, A320] of every contactor, µm.
    pub(crate) amplitudes_um: &'a [[f32; 2]],
}

/// A recording that is being written.
#[derive(Debug)]
pub(crate) struct RecordingFile {
    folder: PathBuf,
    about: About,
    journal: Journal,
    outline: Outline,
    n_felt: u64,
}

impl RecordingFile {
    /// A new folder in `root`, named after when it began, with a table of no rows yet.
    pub(crate) fn create(
        root: &Path,
        about: About,
        [n_others, n_contactors]: [usize; 2],
    ) -> Result<Self, FileError> {
        fs::create_dir_all(root).map_err(FileError::write(root))?;
        let folder = new_folder(root, &about.began)?;
        about.write(&folder)?;
        let bands = |nth: usize| [format!("a40_um_{nth}"), format!("a320_um_{nth}")];
        let others = (1..=n_others).flat_map(ExplorationPath::columns_of_other);
        let more: Vec<String> = others.chain((0..n_contactors).flat_map(bands)).collect();
        let columns = COLUMNS.into_iter();
        let columns: Vec<&str> = columns.chain(more.iter().map(String::as_str)).collect();
        Ok(Self {
            journal: Journal::create(&folder.join(TICKS), &columns)?,
            folder,
            about,
            outline: Outline::default(),
            n_felt: 0,
        })
    }

    /// Adds the ticks of a recording from `n_written` on, and waits until they are on disk.
    pub(crate) fn append(
        &mut self,
        recording: &selvedge_engine::Recording,
        n_written: usize,
    ) -> Result<(), FileError> {
        let new = recording.ticks().iter().enumerate().skip(n_written);
        self.append_ticks(new.map(|(nth, tick)| FeltTick {
            tick: tick.tick,
            pose: tick.pose,
            others: recording.others(nth),
            apply_tick: tick.sent.map(|sent| sent.apply_tick),
            amplitudes_um: recording.amplitudes_um(nth),
        }))
    }

    /// Adds ticks, and waits until they are on disk.
    pub(crate) fn append_ticks<'a>(
        &mut self,
        ticks: impl Iterator<Item = FeltTick<'a>> + Clone,
    ) -> Result<(), FileError> {
        let mut lines = String::new();
        for (nth, tick) in (self.outline.n_seen..).zip(ticks.clone()) {
            let pose = tick.pose;
            let numbers = [
                pose.position.x_mm,
                pose.position.y_mm,
                pose.angle_deg,
                pose.velocity.x_mm_per_s,
                pose.velocity.y_mm_per_s,
            ];
            files::push_number(&mut lines, nth as f64 / TICKS_PER_S);
            push_cell(&mut lines, tick.tick);
            for number in numbers {
                push_cell(&mut lines, number);
            }
            lines.push(',');
            if let Some(apply_tick) = tick.apply_tick {
                files::push_number(&mut lines, apply_tick);
            }
            for cell in tick.others.iter().flat_map(|own| own.beside(&pose)) {
                lines.push(',');
                if let Some(number) = cell {
                    files::push_number(&mut lines, number);
                }
            }
            for um in tick.amplitudes_um.as_flattened() {
                push_cell(&mut lines, um);
            }
            lines.push('\n');
        }
        self.journal.append_lines(lines.as_bytes())?;
        for tick in ticks {
            self.outline.add(tick.pose.position);
            self.n_felt += u64::from(tick.apply_tick.is_some());
        }
        Ok(())
    }

    /// It is over: says so on its page. Gives its folder and that page.
    pub(crate) fn finish(mut self) -> Result<(PathBuf, About), FileError> {
        self.about.ticks = Some([self.outline.n_seen as u64, self.n_felt]);
        // It may have been renamed meanwhile.
        if let Ok(page) = About::read(&self.folder) {
            self.about.name = page.name;
        }
        self.about.outline = self.outline.points;
        self.about.write(&self.folder)?;
        Ok((self.folder, self.about))
    }
}

pub(super) fn push_cell(line: &mut String, value: impl std::fmt::Display) {
    line.push(',');
    files::push_number(line, value);
}

/// Makes `2026-11-23T08-30-12Z`, or the same with the first number that is free.
pub(super) fn new_folder(root: &Path, began: &str) -> Result<PathBuf, FileError> {
    let mut name: String = began.replace(':', "-");
    let stem = name.len();
    for nth in 2..1000 {
        let folder = root.join(&name);
        match fs::create_dir(&folder) {
            Ok(()) => return Ok(folder),
            Err(error) if error.kind() == std::io::ErrorKind::AlreadyExists => {}
            Err(error) => return Err(FileError::write(&folder)(error)),
        }
        name.truncate(stem);
        name.push('-');
        files::push_number(&mut name, nth);
    }
    Err(FileError::Exists {
        path: root.join(name),
    })
}

/// Counts the ticks of a recording that was broken off, and finds its outline.
pub(crate) fn count(folder: &Path) -> Result<([u64; 2], Vec<[f32; 2]>), FileError> {
    let (mut outline, mut n_felt) = (Outline::default(), 0);
    read_rows(folder, |row| {
        outline.add(row.path.position);
        n_felt += u64::from(row.device_tick.is_some());
    })?;
    Ok(([outline.n_seen as u64, n_felt], outline.points))
}

/// Reads a whole recording: an hour takes about a second.
pub(crate) fn read(folder: &Path) -> Result<Recording, String> {
    let about = About::read(folder).map_err(|error| error.to_string())?;
    let (mut rows, mut device_ticks, mut felt) = (Vec::new(), Vec::new(), Felt::default());
    let (mut engine_ticks, mut others, mut n_others) = (Vec::new(), Vec::new(), 0);
    let read = read_rows(folder, |row| {
        rows.push(row.path);
        device_ticks.push(row.device_tick);
        engine_ticks.push(row.engine_tick);
        n_others = row.others.len();
        others.extend_from_slice(row.others);
        felt.n_contactors = row.amplitudes_um.len() / 2;
        let bands = row.amplitudes_um.as_chunks().0;
        felt.amplitudes_um.extend_from_slice(bands);
    });
    read.map_err(|error| error.to_string())?;
    let path = ExplorationPath::new(rows).and_then(|path| path.with_others(n_others, others));
    let path = path.map_err(|error| format!("{}: {error}", folder.join(TICKS).display()))?;
    let mut recording = Recording::felt(about, path, &device_ticks, felt);
    recording.missing = missing_before(engine_ticks.into_iter());
    recording.folder = Some(folder.to_owned());
    Ok(recording)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bench::recording::tests::{explored, page};
    use selvedge_scratch::ScratchFolder;

    #[test]
    fn a_recording_reads_back_as_it_was_made() {
        let root = ScratchFolder::made("recording");
        let made = explored(60);
        let mut file = RecordingFile::create(&root, page("One"), [0, made.n_contactors()]).unwrap();
        file.append(&made, 0).unwrap();
        let (folder, about) = file.finish().unwrap();
        assert_eq!(about.ticks, Some([60, 0]), "no device was armed");
        let read = read(&folder).unwrap();
        assert_eq!(read.name(), "One");
        assert_eq!(**read.path(), made.to_path().unwrap());
        for nth in [0, 31, 59] {
            let felt = read.amplitudes_um(nth).unwrap();
            assert_eq!(felt, made.amplitudes_um(usize::try_from(nth).unwrap()));
        }
        assert!(read.amplitudes_um(60).is_none());
    }

    #[test]
    fn cut_at_any_byte_a_recording_has_every_whole_row() {
        let root = ScratchFolder::made("torn");
        let made = explored(5);
        let mut file =
            RecordingFile::create(&root, page("Torn"), [0, made.n_contactors()]).unwrap();
        file.append(&made, 0).unwrap();
        let folder = file.folder.clone();
        assert!(
            is_written(&folder),
            "nobody else may take it for broken off"
        );
        drop(file);
        assert!(!is_written(&folder));
        let bytes = fs::read(folder.join(TICKS)).unwrap();
        let header = bytes.iter().position(|byte| *byte == b'\n').unwrap() + 1;
        for cut in header..=bytes.len() {
            fs::write(folder.join(TICKS), &bytes[..cut]).unwrap();
            let n_whole = bytes[header..cut].split(|b| *b == b'\n').count() - 1;
            assert_eq!(
                count(&folder).unwrap().0,
                [n_whole as u64, 0],
                "cut at {cut}"
            );
        }
    }

    #[test]
    fn a_table_of_something_else_is_refused_with_its_line() {
        let root = ScratchFolder::made("other");
        for (text, expected) in [
            ("a,b\n", ":1: this is no header"),
            (
                "t_s,tick,x_mm,y_mm,angle_deg,vx_mm_per_s,vy_mm_per_s,device_tick\n1,2\n",
                ":2: this is no row",
            ),
        ] {
            fs::write(root.join(TICKS), text).unwrap();
            let error = count(&root).unwrap_err().to_string();
            assert!(error.contains(expected) && !error.contains('\n'), "{error}");
        }
    }

    #[test]
    fn an_outline_has_few_points_of_the_whole_way() {
        let mut outline = Outline::default();
        for n in 0..10_000 {
            outline.add(Point::new(f64::from(n), 0.0));
        }
        assert!((OUTLINE / 2..=OUTLINE).contains(&outline.points.len()));
        assert!(outline.points.last().unwrap()[0] > 9_600.0);
    }

    #[test]
    fn two_that_begin_in_the_same_second_have_a_folder_each() {
        let root = ScratchFolder::made("second");
        let files = [0, 1].map(|_| RecordingFile::create(&root, page("Same"), [0, 1]).unwrap());
        assert_ne!(files[0].folder, files[1].folder);
    }
}
