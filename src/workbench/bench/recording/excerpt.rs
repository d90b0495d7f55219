//! A part of a recording: as a recording of its own, row for row, or as a path.

use std::fs;
use std::ops::Range;
use std::path::{Path, PathBuf};

use crate::bench::recording::About;
use crate::bench::recording::file::{new_folder, push_cell};
use crate::bench::recording::rows::{Lines, TICKS};
use selvedge_foundation::files::{self, FileError, Journal};
use selvedge_render::scene::{ExplorationPath, PathCursor, PathRow, Pose, SceneError, TICKS_PER_S};

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
    let mut poses = vec![Pose::default(); 1 + path.n_others()];
    let mut others = Vec::new();
    let row = |(tick, pose): (u64, Pose)| {
        path.poses_into(&pose, &mut poses);
        others.extend(poses[1..].iter().map(|own| own.beside(&pose)));
        PathRow {
            t_s: (tick - ticks.start) as f64 / TICKS_PER_S,
            position: pose.position,
            angle_deg: pose.angle_deg,
            velocity: Some(pose.velocity),
        }
    };
    let within = std::iter::from_fn(|| cursor.step(path));
    let within = within.take_while(|(tick, _)| *tick < ticks.end);
    let part = ExplorationPath::new(within.map(row).collect())?;
    part.with_others(path.n_others(), others)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bench::recording::file::{FeltTick, RecordingFile, count, read};
    use crate::bench::recording::tests::{explored, page};
    use selvedge_foundation::geometry::{Point, Velocity};
    use selvedge_scratch::ScratchFolder;

    #[test]
    fn a_part_holds_what_was_felt_in_it_and_begins_at_zero() {
        let root = ScratchFolder::made("excerpt");
        let made = explored(60);
        let mut file =
            RecordingFile::create(&root, page("Whole"), [0, made.n_contactors()]).unwrap();
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
    fn two_displays_apart_read_back_as_they_were_and_a_part_of_them_too() {
        let root = ScratchFolder::made("apart");
        let pose = |x_mm, speed| Pose {
            position: Point::new(x_mm, 0.1),
            velocity: Velocity::new(speed, 0.0),
            ..Pose::default()
        };
        // With the first, held elsewhere, let go of there, and held at rest.
        let others = [
            pose(1.0, 9.0),
            pose(7.3, -4.5),
            pose(7.3, 0.0),
            pose(8.0, 1e-9),
        ];
        let ticks = others.iter().zip(0..).map(|(other, tick)| FeltTick {
            tick,
            pose: pose(1.0, 9.0),
            others: std::slice::from_ref(other),
            apply_tick: None,
            amplitudes_um: &[[1.0, 2.0]; 2],
        });
        let mut file = RecordingFile::create(&root, page("Apart"), [1, 2]).unwrap();
        file.append_ticks(ticks).unwrap();
        let (folder, _) = file.finish().unwrap();
        let part = cut(&folder, &root, &page("Part"), 1..4).unwrap();
        let [whole, part] = [folder, part].map(|folder| read(&folder).unwrap());
        assert_eq!(whole.amplitudes_um(3), Some(&[[1.0, 2.0]; 2][..]));
        let beside = |path: &ExplorationPath| {
            let poses = path.ticks().map(|(_, first)| {
                let mut poses = [Pose::default(); 2];
                path.poses_into(&first, &mut poses);
                (poses[1].position, poses[1].velocity)
            });
            poses.collect::<Vec<_>>()
        };
        let expected = others.map(|other| (other.position, other.velocity));
        assert_eq!(beside(whole.path()), expected);
        assert_eq!(beside(part.path()), expected[1..]);
        let of_path = part_of(whole.path(), 1..4).unwrap();
        assert_eq!(&of_path, &**part.path());
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
