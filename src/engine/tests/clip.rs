//! Files of two displays that move apart: each display is in them as it would be alone.

use super::*;
use selvedge_foundation::progress::Progress;
use selvedge_render::Replay;
use selvedge_scratch::ScratchFolder;

/// A second along a line of its own.
fn line([x_mm, y_mm]: [f64; 2], speed_mm_per_s: f64) -> Vec<PathRow> {
    let row = |n: u32| PathRow {
        t_s: f64::from(n) / 40.0,
        position: Point::new(x_mm + speed_mm_per_s * f64::from(n) / 40.0, y_mm),
        velocity: Some(Velocity::new(speed_mm_per_s, 0.0)),
        ..PathRow::default()
    };
    (0..40).map(row).collect()
}

/// What a file says of every contactor of so many displays on a path.
fn contactors(kind: ClipKind, path: &ExplorationPath, n_displays: usize) -> Vec<String> {
    let folder = ScratchFolder::made("clip-two");
    let mut scene = render_scene(exeter());
    scene.displays = vec![scene.displays[0].clone(); n_displays];
    // Nothing is so loud that a file would be scaled as a whole.
    scene.tuning.gain_db = -20.0;
    let what = Replay {
        scene: &scene,
        method: Method::Reference,
        accuracy: Accuracy::default(),
        measures_error: false,
    };
    let (profile, n) = (ArrayProfile::default(), 24 * n_displays);
    let file = folder.join("two");
    let writer = ClipWriter::create(&file, kind, (&profile, n), "two").unwrap();
    Progress::unheard(|progress| write_clip(writer, &what, path, progress)).unwrap();
    match kind {
        ClipKind::Wav { .. } => {
            let mut wav = hound::WavReader::open(&file).unwrap();
            assert_eq!(usize::from(wav.spec().channels), n);
            let samples: Vec<i32> = wav.samples().map(Result::unwrap).collect();
            let of = |channel| samples.iter().skip(channel).step_by(n);
            let of = |channel| format!("{:?}", of(channel).collect::<Vec<_>>());
            (0..n).map(of).collect()
        }
        ClipKind::Hjif => {
            let text = folder.read("two");
            // What follows the last keyframe belongs to the file.
            let own = |line: &str| line.rsplit_once("frequency").map(|(own, _)| own.to_owned());
            let channels = text.split("\"gain\"").skip(1);
            channels.filter_map(own).collect()
        }
        ClipKind::Frames => {
            let text = folder.read("two");
            let rows: Vec<Vec<&str>> = (text.lines().filter(|line| !line.starts_with('#')))
                .map(|line| line.split(',').collect())
                .collect();
            let first = rows[0].iter().position(|name| *name == "code40_0").unwrap();
            let of = |at: usize| rows[1..].iter().map(move |row| row[at..at + 2].join(" "));
            let of = |contactor| of(first + 2 * contactor).collect::<Vec<_>>().join(",");
            (0..n).map(of).collect()
        }
    }
}

#[test]
fn each_of_two_displays_is_in_every_file_as_it_would_be_alone() {
    let lines = [line([30.0, 50.0], 30.0), line([70.0, 75.0], -25.0)];
    let [first, second] = lines.map(|rows| ExplorationPath::new(rows).unwrap());
    let cells = second.rows().iter().map(|row| {
        let (at, velocity) = (row.position, row.velocity.unwrap());
        [at.x_mm, at.y_mm, velocity.x_mm_per_s, velocity.y_mm_per_s].map(Some)
    });
    let both = first.clone().with_others(1, cells.collect()).unwrap();
    for kind in [ClipKind::ARCHIVE, ClipKind::Hjif, ClipKind::Frames] {
        let found = contactors(kind, &both, 2);
        let [one, other] = [&first, &second].map(|path| contactors(kind, path, 1));
        assert_eq!((one.len(), other.len()), (24, 24), "{kind:?}");
        assert!(one != other, "they are felt differently");
        assert!(found == [one, other].concat(), "{kind:?}");
    }
}
