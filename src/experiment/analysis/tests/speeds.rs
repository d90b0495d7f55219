//! Measures at the speeds that subjects moved at.

use super::*;
use crate::session::path_file;
use selvedge_foundation::geometry::Point;
use selvedge_foundation::quantity::level_db;
use selvedge_render::scene::{ExplorationPath, PathRow};
use selvedge_scratch::ScratchFolder as Scratch;
use selvedge_statistics::pearson_r;
use selvedge_textile::Library;
use selvedge_textile::tactile::{Filters, Levels};

/// Seven steps of a tenth below and above 100 mm/s.
const SLOW_MM_PER_S: f64 = 51.315_811_823_070_7;
const FAST_MM_PER_S: f64 = 194.871_71;

/// Easier the further apart two fabrics stand in the design.
fn by_place(task: &Task) -> Answer {
    let apart = apart(task);
    let grade = Grade::ALL[2 - apart.min(4) / 2];
    odd(task, apart > 0, grade)
}

/// Moves through the trials of a session: for so many seconds at such a speed each, then rests.
fn moved(found: &mut Found, folder: &Scratch, parts: &[(f64, f64)]) {
    found.log = folder.0.join(found.log.file_name().unwrap());
    for record in &found.records {
        let (mut t_s, mut x_mm) = (0.0, 0.0);
        let mut rows = vec![PathRow::default()];
        for (for_s, speed) in parts.iter().chain(&[(5.0, 0.0)]) {
            t_s += for_s;
            x_mm += for_s * speed;
            rows.push(PathRow {
                t_s,
                position: Point::new(x_mm, 0.0),
                ..PathRow::default()
            });
        }
        let file = path_file(&found.log, &record.trial, record.attempt);
        std::fs::create_dir_all(file.parent().unwrap()).unwrap();
        let path = ExplorationPath::new(rows).unwrap();
        path.write(&file).unwrap();
    }
}

fn held_at_speeds(folder: &Scratch) -> Vec<Found> {
    let design = Design::shipped("odd-one-out").unwrap();
    let mut all: Vec<Found> = (0..3)
        .map(|nth| held(&design, (nth, 1), |task, _| by_place(task)))
        .collect();
    moved(
        &mut all[0],
        folder,
        &[(1.0, SLOW_MM_PER_S), (3.0, FAST_MM_PER_S)],
    );
    moved(&mut all[1], folder, &[(2.0, SLOW_MM_PER_S)]);
    all
}

#[test]
fn measures_at_own_speeds_are_means_over_the_time_of_movement_and_then_over_subjects() {
    let folder = Scratch::new("speeds");
    let all = held_at_speeds(&folder);
    let analysis = analysed(&all);
    let speeds = table(&analysis, "odd-one-out-map", "own-speeds");
    let rows: Vec<&Cell> = speeds.rows.iter().map(|row| &row[0]).collect();
    assert_eq!(rows[2..], ["p01", "p02", "p03"].map(Cell::from).each_ref());
    assert_eq!(
        (value(speeds, 2, "paths"), value(speeds, 2, "trials")),
        (21.0, 21.0)
    );
    assert_eq!(value(speeds, 2, "moving_s"), 84.0, "21 trials of 4 s");
    assert!((value(speeds, 2, "median_mm_per_s") - FAST_MM_PER_S).abs() < 1e-6);
    let slow = value(speeds, 2, "slow_mm_per_s");
    assert!((slow - SLOW_MM_PER_S).abs() < 1e-6, "{slow}");
    assert!((value(speeds, 3, "median_mm_per_s") - SLOW_MM_PER_S).abs() < 1e-6);
    let library = Library::shipped().unwrap();
    let design = &all[0].design;
    let at = |speed: f64| -> Vec<Levels> {
        let ids = design.stimuli.iter().map(|s| s.id.as_str());
        let of = |id| {
            Levels::at(
                speed,
                library.load(id).unwrap().surface(),
                &Filters::default(),
            )
        };
        ids.map(of).collect()
    };
    let (slow, fast, reference) = (at(SLOW_MM_PER_S), at(FAST_MM_PER_S), at(100.0));
    let a40 = |levels: &Levels| levels.mean_um[0];
    let first = |i: usize| 0.25 * a40(&slow[i]) + 0.75 * a40(&fast[i]);
    let measures = table(&analysis, "odd-one-out-map", "measures");
    for (i, slow) in slow.iter().enumerate() {
        let expected = 0.5 * (level_db(first(i)) + level_db(a40(slow)));
        let found = value(measures, i, "a40_db_own_speed");
        assert!(
            (found - expected).abs() < 1e-6,
            "{i}: {found} and {expected}"
        );
    }
    let db = |of: &dyn Fn(usize) -> f64| (0..7).map(|i| level_db(of(i))).collect::<Vec<f64>>();
    let r = pearson_r(&db(&first), &db(&|i| a40(&reference[i]))).unwrap();
    assert!((value(speeds, 2, "r40") - r).abs() < 1e-6, "{speeds:?}");
    let turns = table(&analysis, "odd-one-out-map", "turns");
    assert!((value(speeds, 0, "r1") - value(turns, 0, "r1")).abs() < 1e-9);
    assert_ne!(
        value(speeds, 2, "r1"),
        value(speeds, 3, "r1"),
        "speed matters"
    );
}

#[test]
fn a_subject_without_paths_is_said_to_have_none_and_so_is_a_study() {
    let folder = Scratch::new("no-speeds");
    let analysis = analysed(&held_at_speeds(&folder));
    let speeds = table(&analysis, "odd-one-out-map", "own-speeds");
    let why = speeds.cell(4, "median_mm_per_s");
    assert_eq!(why, Some(&Cell::none("no recorded path that moves")));
    assert_eq!(value(speeds, 4, "paths"), 0.0);
    let design = Design::shipped("odd-one-out").unwrap();
    let none: Vec<Found> = (0..2)
        .map(|nth| held(&design, (nth, 1), |task, _| by_place(task)))
        .collect();
    let analysis = analysed(&none);
    let map = analysis
        .sections
        .iter()
        .find(|s| s.key == "odd-one-out-map");
    let map = map.unwrap();
    assert!(map.tables.iter().all(|table| table.key != "own-speeds"));
    assert!(
        map.notes
            .iter()
            .any(|note| note.contains("No recorded paths"))
    );
}
