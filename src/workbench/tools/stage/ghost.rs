//! How the display strokes cloths by itself: over all of them while nobody is there, over one for
//! whoever uses keys.

use std::f64::consts::TAU;

use crate::tools::stage::open_visit::TOUR_S;
use selvedge_foundation::geometry::Point;
use selvedge_render::scene::{ExplorationPath, PathRow};

/// From one cloth to the next, s.
const PAUSE_S: f64 = 1.0;
/// A stroke to and fro, s, and how far it goes from the middle of a cloth, of half its width.
const STROKE_S: f64 = 3.0;
const REACH: f64 = 0.7;
/// Rows a second: one a tick.
const ROWS_PER_S: f64 = 40.0;

/// A cloth: its middle and half its width, mm.
pub(crate) type Ground = (Point, f64);

/// The course over these cloths, one after the other; `None` over none.
pub(crate) fn course(cloths: &[Ground]) -> Option<ExplorationPath> {
    let mut rows = Vec::new();
    let mut begin_s = 0.0;
    for (nth, &(middle, half_mm)) in cloths.iter().enumerate() {
        steps(TOUR_S, |t_s| {
            let along = half_mm * REACH * (TAU * t_s / STROKE_S).sin();
            let across = 0.25 * half_mm * (TAU * t_s / TOUR_S).sin();
            rows.push(row(
                begin_s + t_s,
                Point::new(middle.x_mm + along, middle.y_mm + across),
            ));
        });
        begin_s += TOUR_S;
        if cloths.len() > 1 {
            let (next, _) = cloths[(nth + 1) % cloths.len()];
            steps(PAUSE_S, |t_s| {
                let share = 0.5 - 0.5 * (0.5 * TAU * t_s / PAUSE_S).cos();
                let at = |from: f64, to: f64| from + share * (to - from);
                let place = Point::new(at(middle.x_mm, next.x_mm), at(middle.y_mm, next.y_mm));
                rows.push(row(begin_s + t_s, place));
            });
            begin_s += PAUSE_S;
        }
    }
    ExplorationPath::new(rows).ok()
}

fn steps(for_s: f64, mut each: impl FnMut(f64)) {
    let mut t_s = 0.0;
    while t_s < for_s - 0.5 / ROWS_PER_S {
        each(t_s);
        t_s += 1.0 / ROWS_PER_S;
    }
}

fn row(t_s: f64, position: Point) -> PathRow {
    PathRow {
        t_s,
        position,
        ..PathRow::default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_ghost_strokes_each_cloth_for_six_seconds_and_one_alone_without_a_pause() {
        let cloths = [(70.0, 190.0), (190.0, 190.0), (70.0, 70.0), (190.0, 70.0)]
            .map(|(x_mm, y_mm)| (Point::new(x_mm, y_mm), 50.0));
        let course_over_all = course(&cloths).unwrap();
        assert!((course_over_all.duration_s() - 28.0).abs() < 0.1);
        let on = |row: &PathRow| {
            cloths.iter().position(|(middle, half_mm)| {
                let off = row.position - *middle;
                off.x_mm.abs() <= *half_mm && off.y_mm.abs() <= *half_mm
            })
        };
        for row in course_over_all.rows() {
            let [cloth, within] = [(row.t_s / 7.0).floor(), row.t_s % 7.0];
            if within < 5.9 {
                assert_eq!(on(row).map(|nth| nth as f64), Some(cloth), "{row:?}");
            }
        }
        let alone = course(&cloths[2..3]).unwrap();
        assert!((alone.duration_s() - 6.0).abs() < 0.1);
        assert!(course(&[]).is_none());
    }
}
