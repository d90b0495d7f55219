//! Paths against the formulas of the design, and against bad files.

use proptest::prelude::*;

use super::*;

const PATH: &str = "stroke.csv";

fn read(text: &str) -> Result<ExplorationPath, SceneError> {
    ExplorationPath::from_csv(text, Path::new(PATH))
}

fn ticks(text: &str) -> Vec<Pose> {
    read(text).unwrap().ticks().map(|(_, pose)| pose).collect()
}

#[test]
fn ticks_lie_on_the_line_between_rows() {
    let poses = ticks("t_s,x_mm,y_mm\n1,0,10\n1.1,4,10\n");
    assert_eq!(poses.len(), 5);
    for (n, pose) in poses.iter().enumerate() {
        assert!((pose.position.x_mm - n as f64).abs() < 1e-12, "{pose:?}");
        assert!(
            (pose.t_s - (1.0 + n as f64 / 40.0)).abs() < 1e-15,
            "{pose:?}"
        );
        let expected = if n == 0 { 0.0 } else { 40.0 };
        assert!(
            (pose.velocity.x_mm_per_s - expected).abs() < 1e-9,
            "{pose:?}"
        );
    }
}

#[test]
fn a_tick_within_a_nanosecond_of_a_row_is_the_row() {
    let text = "t_s,x_mm,y_mm\n0,0,0\n0.0250000005,7,1\n0.0499999996,9,2\n";
    let poses = ticks(text);
    assert_eq!(poses[1].position, Point::new(7.0, 1.0));
    assert_eq!(poses[2].position, Point::new(9.0, 2.0));
    assert_eq!(
        poses.len(),
        3,
        "the last tick lies past the end only by rounding"
    );
}

#[test]
fn given_velocities_are_interpolated_and_angles_not_wrapped() {
    let text =
        "t_s,x_mm,y_mm,angle_deg,vx_mm_per_s,vy_mm_per_s\n0,0,0,350,10,0\n0.1,0,0,370,30,8\n";
    let poses = ticks(text);
    assert_eq!(poses[0].velocity, Velocity::new(10.0, 0.0));
    assert_eq!(poses[0].angular_rad_per_s, 0.0);
    assert!(
        (poses[2].velocity.x_mm_per_s - 20.0).abs() < 1e-12,
        "{:?}",
        poses[2]
    );
    assert!((poses[2].angle_deg - 360.0).abs() < 1e-12, "{:?}", poses[2]);
    let expected = 5.0_f64.to_radians() * 40.0;
    assert!(
        (poses[3].angular_rad_per_s - expected).abs() < 1e-12,
        "{:?}",
        poses[3]
    );
}

#[test]
fn one_row_is_one_tick_at_rest() {
    let poses = ticks("t_s,x_mm,y_mm\n5,1,2\n");
    assert_eq!(poses.len(), 1);
    assert_eq!(poses[0].velocity, Velocity::ZERO);
}

#[test]
fn going_to_a_tick_gives_the_pose_that_playing_through_gives() {
    for text in [
        "t_s,x_mm,y_mm\n5,1,2\n",
        "t_s,x_mm,y_mm\n0,0,0\n0.0250000005,7,1\n0.0499999996,9,2\n0.9,4,4\n",
        "t_s,x_mm,y_mm,angle_deg\n-1,0.1,0.2,3\n-0.99,1,1,7\n-0.985,2,3,9\n0,8,8,-40\n",
        "t_s,x_mm,y_mm,vx_mm_per_s,vy_mm_per_s\n0,0,0,1,2\n1,0,0,3,4\n",
    ] {
        let path = read(text).unwrap();
        let played: Vec<(u64, Pose)> = path.ticks().collect();
        let last = path.n_ticks() - 1;
        for tick in (0..=last).chain([last + 1, u64::MAX]) {
            let mut cursor = PathCursor::at(&path, tick);
            let from = usize::try_from(tick.min(last)).unwrap();
            for expected in &played[from..] {
                assert_eq!(cursor.step(&path), Some(*expected), "{text}");
            }
            assert_eq!(cursor.step(&path), None);
        }
    }
}

#[test]
fn a_path_survives_writing_and_reading() {
    for text in [
        "t_s,x_mm,y_mm\n0,0.1,0.2\n0.033333333333333,1e-9,-4\n",
        "t_s,x_mm,y_mm,angle_deg\n0,0.1,0.2,361\n",
        "t_s,x_mm,y_mm,vx_mm_per_s,vy_mm_per_s\n0,0,0,1,2\n1,0,0,3,4\n",
    ] {
        let path = read(text).unwrap();
        assert_eq!(read(&path.to_csv().unwrap()).unwrap(), path, "{text}");
    }
}

#[test]
fn displays_beside_the_first_are_where_their_columns_say() {
    let text = "t_s,x_mm,y_mm,x_mm_1,y_mm_1,vx_mm_per_s_1,vy_mm_per_s_1\n\
                0,0,0,,,,\n0.05,2,0,9,5,10,0\n0.1,4,0,11,5,20,4\n0.125,5,0,11,5,,\n";
    let path = read(text).unwrap();
    assert_eq!(read(&path.to_csv().unwrap()).unwrap(), path);
    let mut poses = [Pose::default(); 3];
    let seen: Vec<[Pose; 3]> = path
        .ticks()
        .map(|(_, first)| {
            path.poses_into(&first, &mut poses);
            poses
        })
        .collect();
    for (nth, [first, own, third]) in seen.iter().enumerate() {
        assert_eq!(third, first, "tick {nth}: of it nothing is told");
        let (x_mm, speed) = [
            (first.position.x_mm, first.velocity.x_mm_per_s),
            (first.position.x_mm, first.velocity.x_mm_per_s),
            (9.0, 10.0),
            (10.0, 15.0),
            (11.0, 20.0),
            (11.0, 0.0),
        ][nth];
        let is_near = |a: f64, b: f64| (a - b).abs() < 1e-9;
        assert!(is_near(own.position.x_mm, x_mm), "tick {nth}: {own:?}");
        assert!(
            is_near(own.velocity.x_mm_per_s, speed),
            "tick {nth}: {own:?}"
        );
    }
    let together = path.clone().with_others(2, vec![[None; 4]; 8]).unwrap();
    assert_eq!(together.n_others(), 0, "nobody was apart");
    assert!(
        path.with_others(1, vec![[None; 4]; 3]).is_err(),
        "a row has none"
    );
}

#[test]
fn wrong_paths_name_the_line_and_the_mend() {
    for (text, expected) in [
        ("", "stroke.csv:1: no column t_s"),
        ("t_s,x_mm,y_mm\n", "stroke.csv:1: the path has no rows"),
        (
            "t_s,x_mm,y_mm\n0,0,0\n# aside\n0,1,1\n",
            "stroke.csv:4: t_s is 0 after 0",
        ),
        (
            "t_s,x_mm,y_mm\n0,0,0\n1,nan,1\n",
            "stroke.csv:3: x_mm is \"nan\"",
        ),
        (
            "t_s,x_m,y_m\n0,0,0\n",
            "stroke.csv:1: unknown column \"x_m\"",
        ),
        (
            "t_s,x_mm,y_mm,vx_mm_per_s\n0,0,0,1\n",
            "stroke.csv:1: one velocity column",
        ),
        (
            "t_s,x_mm,y_mm,x_mm_1,y_mm_1\n0,0,0,4,\n",
            "stroke.csv:2: a display beside the first is not whole",
        ),
        (
            "t_s,x_mm,y_mm,x_mm_1,y_mm_1\n0,0,0,4,inf\n",
            "stroke.csv:2: a display beside the first is not whole",
        ),
        (
            "t_s,x_mm,y_mm,x_mm_1,y_mm_1\n0,0,0,4,5\n1,0,0,4,b\n",
            "stroke.csv:3: y_mm_1 is \"b\"",
        ),
        (
            "t_s,x_mm,y_mm\n0,0,0\n1e300,1,1\n",
            "stroke.csv:3: t_s is 1",
        ),
    ] {
        let error = read(text).unwrap_err().to_string();
        assert!(
            error.starts_with(expected) && error.contains("; "),
            "{error}"
        );
        assert!(!error.contains('\n'), "{error}");
    }
}

#[test]
fn rows_that_are_made_are_checked_like_rows_that_are_read() {
    let row = |t_s| PathRow {
        t_s,
        ..PathRow::default()
    };
    assert!(ExplorationPath::new(vec![]).is_err());
    assert!(ExplorationPath::new(vec![row(f64::NAN)]).is_err());
    let error = ExplorationPath::new(vec![row(1.0), row(1.0)])
        .unwrap_err()
        .to_string();
    assert!(error.starts_with("row 2: t_s is 1 after 1; "), "{error}");
}

proptest! {
    #[test]
    fn no_text_makes_the_reader_panic(text in any::<String>(), rows in "[-0-9.,enaif\n]{0,60}") {
        drop(read(&text));
        if let Ok(path) = read(&format!("t_s,x_mm,y_mm\n{rows}")) {
            let first = path.ticks().take(100);
            let n_checked = first.filter(|(_, pose)| pose.position.is_finite()).count();
            prop_assert_eq!(n_checked as u64, path.n_ticks().min(100));
        }
    }

    #[test]
    fn ticks_are_forty_a_second_and_follow_the_rows(
        steps_s in prop::collection::vec(1e-4..0.3_f64, 1..40),
        start_s in -1e3..1e3_f64,
    ) {
        let mut t_s = start_s;
        let rows: Vec<PathRow> = std::iter::once(0.0).chain(steps_s).map(|step_s| {
            t_s += step_s;
            // A straight line, so that interpolation must give its own function of time.
            PathRow { t_s, position: Point::new(3.0 * t_s, -t_s), ..PathRow::default() }
        }).collect();
        let path = ExplorationPath::new(rows).unwrap();
        let poses: Vec<(u64, Pose)> = path.ticks().collect();
        prop_assert_eq!(poses.len() as u64, path.n_ticks());
        for (n, (tick, pose)) in poses.iter().enumerate() {
            prop_assert_eq!(*tick, n as u64);
            prop_assert_eq!(pose.t_s, path.rows()[0].t_s + n as f64 / 40.0);
            prop_assert!((pose.position.x_mm - 3.0 * pose.t_s).abs() < 1e-6, "{:?}", pose);
        }
    }
}
