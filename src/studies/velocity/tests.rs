//! The study runs, and finds what is known of the estimators.

use std::path::{Path, PathBuf};

use super::*;
use crate::tests::{assert_complete_and_same, quick};
use selvedge_engine::VelocityMethod;
use selvedge_foundation::geometry::{Displacement, Point, Velocity};

fn error_of(findings: &Findings, method: &str, case_end: &str) -> f64 {
    let row = findings
        .rows
        .iter()
        .find(|row| row.method == method && row.case.ends_with(case_end));
    row.and_then(|row| row.error).unwrap()
}

#[test]
fn a_quick_study_has_every_method_and_numbers_that_repeat() {
    let (first, second) = (quick(&STUDY, 7), quick(&STUDY, 7));
    // Two pointers, two methods, four strokes and all of them.
    assert!(first.rows.len() >= 2 * 2 * 5, "{}", first.rows.len());
    assert_complete_and_same(&first, &second);
    assert_eq!(first.plots.len(), 3);
    assert!(first.plots[0].1.series.len() == 2, "a series a method");
    assert!(first.notes.len() > 5, "{:?}", first.notes);
}

#[test]
fn smoothing_helps_a_steady_stroke_and_a_mouse_at_rest_is_at_rest() {
    let findings = quick(&STUDY, 7);
    let raw = error_of(&findings, "finite difference", "constant 100 mm/s");
    let smooth = error_of(&findings, "Kalman", "constant 100 mm/s");
    assert!(smooth < 0.75 * raw, "{smooth} of {raw} mm/s");
    let at_rest = |row: &&Row| row.case == "mouse, 125 Hz, 0.1 mm; rest";
    assert!(
        findings
            .rows
            .iter()
            .filter(at_rest)
            .all(|row| row.error == Some(0.0)),
        "rest"
    );
}

/// A recorded stroke: a robot's velocities over time, joined by straight lines.
struct Recorded {
    rows: Vec<(f64, Velocity, Point)>,
}

impl Recorded {
    fn read(path: &Path) -> Self {
        let text = std::fs::read_to_string(path).unwrap();
        let numbers = |line: &str| -> Vec<f64> {
            line.split(',')
                .take(3)
                .map(|n| n.parse().unwrap())
                .collect()
        };
        let mut rows: Vec<(f64, Velocity, Point)> = Vec::new();
        let mut first_s = None;
        for line in text.lines().skip(1) {
            let [stamp_s, x, y] = numbers(line)[..] else {
                continue;
            };
            let t_s = stamp_s - *first_s.get_or_insert(stamp_s);
            let velocity = Velocity::new(1e3 * x, 1e3 * y);
            let place = rows
                .last()
                .map_or_else(Point::default, |&(before_s, before, place)| {
                    let half_s = 0.5 * (t_s - before_s);
                    let x_mm = half_s * (before.x_mm_per_s + velocity.x_mm_per_s);
                    let y_mm = half_s * (before.y_mm_per_s + velocity.y_mm_per_s);
                    place + Displacement::new(x_mm, y_mm)
                });
            rows.push((t_s, velocity, place));
        }
        Self { rows }
    }

    fn at(&self, t_s: f64) -> (Point, Velocity) {
        let after = self
            .rows
            .partition_point(|row| row.0 <= t_s)
            .clamp(1, self.rows.len() - 1);
        let (a, b) = (self.rows[after - 1], self.rows[after]);
        let since_s = (t_s - a.0).clamp(0.0, b.0 - a.0);
        let share = since_s / (b.0 - a.0);
        let mix = |a: f64, b: f64| a + (b - a) * share;
        let velocity = Velocity::new(
            mix(a.1.x_mm_per_s, b.1.x_mm_per_s),
            mix(a.1.y_mm_per_s, b.1.y_mm_per_s),
        );
        let moved = Displacement::new(
            0.5 * since_s * (a.1.x_mm_per_s + velocity.x_mm_per_s),
            0.5 * since_s * (a.1.y_mm_per_s + velocity.y_mm_per_s),
        );
        (a.2 + moved, velocity)
    }
}

#[test]
fn the_default_beats_the_bare_difference_on_recorded_strokes() {
    let Some(folder) = std::env::var_os("SELVEDGE_TEST_DATA").map(PathBuf::from) else {
        println!("skipped: SELVEDGE_TEST_DATA names no folder");
        return;
    };
    for name in ["mat1_1_cv.csv", "mat2_1_cv.csv", "mat6_1_cv.csv"] {
        let recorded = Recorded::read(&folder.join("tactile/biotac").join(name));
        let motion = |t_s: f64| recorded.at(t_s);
        let duration_s = recorded.rows.last().unwrap().0;
        // At 1 kHz a robot's sudden start is followed best by what smooths nothing.
        for pointer in [POINTERS[0], POINTERS[2], POINTERS[3]] {
            let samples = pointer.samples(&motion, duration_s, &mut Random::new(3));
            let rms = |method| {
                let mut estimator = VelocityEstimator::new(method);
                let estimates = estimates(&mut estimator, &samples, duration_s);
                Tally::of(&estimates, &motion, false).rms_mm_per_s()
            };
            let bare = rms(VelocityMethod::FiniteDifference);
            let chosen = rms(VelocityMethod::default());
            println!("{name}, {}: {bare:.2} and {chosen:.2} mm/s", pointer.label);
            assert!(
                chosen < bare,
                "{name}, {}: {chosen} of {bare}",
                pointer.label
            );
        }
    }
}
