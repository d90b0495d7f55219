//! A part of a recording: as a recording of its own, row for row, or as a path.

use std::fs;
use std::ops::Range;
use std::path::{Path, PathBuf};

use crate::bench::recording::About;
use crate::bench::recording::file::{Lines, TICKS, new_folder, push_cell};
use selvedge_foundation::files::{self, FileError, Journal};
use selvedge_render::scene::{ExplorationPath, PathCursor, PathRow, SceneError, TICKS_PER_S};

/// How much is written at once, bytes.
const CHUNK: usize = 1 << 20;

/// Makes a recording of the ticks of the one in `folder`, in a new folder of `root`: every row as
/// it is but for its time, which begins anew. Gives the new folder.
///
/// # Errors
/// The recording cannot be read, or the new one cannot be written.
pub(crate) fn cut(
    folder: &Path,
    root: &Path,
    about: &About,
    ticks: Range<u64>,
) -> Result<PathBuf, FileError> {
    let mut lines = Lines::open(folder)?;
    let header = lines.next()?.unwrap_or_default();
    fs::create_dir_all(root).map_err(FileError::write(root))?;
    let to = new_folder(root, &about.began)?;
    about.write(&to)?;
    let columns: Vec<&str> = header.split(',').collect();
    let mut journal = Journal::create(&to.join(TICKS), &columns)?;
    let mut text = String::new();
    let mut nth = 0;
    while let Some(line) = lines.next()?.filter(|_| nth < ticks.end) {
        if let Some(since) = u64::checked_sub(nth, ticks.start) {
            files::push_number(&mut text, since as f64 / TICKS_PER_S);
            if let Some((_, rest)) = line.split_once(',') {
                push_cell(&mut text, rest);
            }
            text.push('\n');
        }
        nth += 1;
        if text.len() > CHUNK {
            journal.append_lines(text.as_bytes())?;
            text.clear();
        }
    }
    journal.append_lines(text.as_bytes())?;
    Ok(to)
}

/// The path of some ticks, each a row with its velocity, the first at 0 s.
///
/// # Errors
/// There are no such ticks.
pub(crate) fn part_of(
    path: &ExplorationPath,
    ticks: Range<u64>,
) -> Result<ExplorationPath, SceneError> {
    let mut cursor = PathCursor::at(path, ticks.start);
    let row = |(tick, pose): (u64, selvedge_render::scene::Pose)| PathRow {
        t_s: (tick - ticks.start) as f64 / TICKS_PER_S,
        position: pose.position,
        angle_deg: pose.angle_deg,
        velocity: Some(pose.velocity),
    };
    let within = std::iter::from_fn(|| cursor.step(path));
    let within = within.take_while(|(tick, _)| *tick < ticks.end);
    ExplorationPath::new(within.map(row).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bench::recording::file::{RecordingFile, count, read};
    use crate::bench::recording::tests::{explored, page};
    use selvedge_scratch::ScratchFolder;

    #[test]
    fn a_part_holds_what_was_felt_in_it_and_begins_at_zero() {
        let root = ScratchFolder::made("excerpt");
        let made = explored(60);
        let mut file = RecordingFile::create(&root, page("Whole"), made.n_contactors()).unwrap();
        file.append(&made, 0).unwrap();
        let (folder, _) = file.finish().unwrap();
        let part = cut(&folder, &root, &page("Part"), 20..45).unwrap();
        assert_eq!(count(&part).unwrap().0, [25, 0]);
        let (whole, part) = (read(&folder).unwrap(), read(&part).unwrap());
        assert_eq!(part.name(), "Part");
        for nth in 0..25 {
            assert_eq!(part.amplitudes_um(nth), whole.amplitudes_um(20 + nth));
            let [was, is] = [(&whole, 20 + nth), (&part, nth)]
                .map(|(of, tick)| PathCursor::at(of.path(), tick).step(of.path()).unwrap().1);
            assert_eq!((was.position, was.velocity), (is.position, is.velocity));
        }
        let path = part_of(whole.path(), 20..45).unwrap();
        assert_eq!(path.rows()[0].t_s, 0.0);
        assert_eq!(path.rows(), part.path().rows());
    }

    #[test]
    fn a_line_without_an_end_is_refused() {
        let root = ScratchFolder::made("endless");
        root.write(TICKS, "t_s,".repeat(1 << 19));
        let error = cut(&root, &root, &page("Part"), 0..1).unwrap_err();
        assert!(
            error
                .to_string()
                .contains("ticks.csv:1: this line is too long")
        );
    }

    #[test]
    fn beyond_the_end_there_is_no_part() {
        let made = explored(10).to_path().unwrap();
        assert!(part_of(&made, 5..5).is_err());
        assert_eq!(part_of(&made, 5..500).unwrap().n_ticks(), 5);
    }
}
