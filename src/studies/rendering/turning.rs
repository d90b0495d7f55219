//! The study of turning displays: what a tick costs where every contactor moves its own way, beside
//! one where all move alike.

use crate::textiles::{exeter, placed, scene_of, shipped};
use crate::{Bench, Findings, ReportError, Row, Study};
use selvedge_foundation::geometry::{Point, Velocity};
use selvedge_render::array::{Accuracy, ArrayRenderer, Method};
use selvedge_render::scene::{Pose, TICKS_PER_S};

/// What a turning tick of `table` costs at most, as a multiple of one that does not turn; and one
/// of `banded`, as a multiple of the reference's.
const MOST: [f64; 2] = [4.0, 1.0 / 3.0];
/// How fast it turns, rad/s.
const TURN_RAD_PER_S: f64 = 2.0;
const STRAIGHT: &str = "straight";
const TURNING: &str = "turning at 2 rad/s";

/// Straight and turning ticks, by method.
pub(crate) const STUDY: Study = Study {
    name: "turning",
    chapter: "amplitudes",
    question: "What does a tick cost where the display turns, so that every contactor moves its \
               own way?",
    reference: "Of table its own tick where the display does not turn; of banded the reference's \
                where it does.",
    error: ("multiple of the cost", ""),
    cost_of: "tick of 24 contactors",
    run,
};

fn run(bench: &mut Bench<'_>) -> Result<Findings, ReportError> {
    bench.step(0.0, "one textile")?;
    let scene = scene_of(vec![placed(&shipped("denim")?, Point::default())], exeter());
    let motions = [(STRAIGHT, poses(0.0)), (TURNING, poses(TURN_RAD_PER_S))];
    let mut rows = Vec::new();
    let mut works: Vec<Box<dyn FnMut()>> = Vec::new();
    for (setting, poses) in &motions {
        for method in [Method::Reference, Method::Banded, Method::Table] {
            let mut renderer = ArrayRenderer::prepare(&scene, method, &Accuracy::default())?;
            rows.push(Row::of(method.name(), *setting, "one textile"));
            works.push(Box::new(move || {
                for pose in poses {
                    renderer.tick(std::slice::from_ref(pose));
                }
            }));
        }
    }
    let timed = bench.time_in_turn(motions[0].1.len(), works);
    let rows = rows.into_iter().zip(timed);
    let rows = rows.map(|(row, (timing, _))| row.cost(timing));
    let [of_table, of_banded] = MOST;
    let notes = [
        format!(
            "A ratio is of ticks that were timed in turn, process by process; promised is the \
             smallest of the processes', so that a promise is broken only where none keeps it: \
             {of_table} of table (three were aimed at, 3.1 is what it takes), {of_banded:.3} of \
             banded."
        ),
        "Tables are made before: their nodes come with the first ticks.".to_owned(),
    ];
    Ok(Findings::new(rows.collect(), Vec::new(), notes).judged(judge))
}

/// A second over the textile.
fn poses(angular_rad_per_s: f64) -> Vec<Pose> {
    let pose = |n: u32| {
        let share = f64::from(n) / TICKS_PER_S;
        Pose {
            position: Point::new(20.0 + 80.0 * share, 20.0 + 60.0 * share),
            angle_deg: (angular_rad_per_s * share).to_degrees(),
            velocity: Velocity::new(80.0, 60.0),
            angular_rad_per_s,
            ..Pose::default()
        }
    };
    (0..40).map(pose).collect()
}

/// Ratios and verdicts, from the times of all processes.
fn judge(rows: &mut [Row]) {
    let known = rows.to_vec();
    let cost_of = |method: &str, setting: &str| {
        let is_it = |row: &&Row| row.method == method && row.setting == setting;
        known.iter().find(is_it).and_then(|row| row.cost)
    };
    for row in rows {
        let straight = cost_of(&row.method, STRAIGHT);
        let reference = cost_of(Method::Reference.name(), &row.setting);
        let (Some(own), Some(straight), Some(reference)) = (row.cost, straight, reference) else {
            continue;
        };
        let [of_straight, of_reference] = [straight, reference].map(|other| own.over(&other));
        row.set("times_straight", format!("{:.2}", of_straight.middle));
        row.set("times_reference", format!("{:.3}", of_reference.middle));
        let promised = match row.method.as_str() {
            _ if row.setting != TURNING => None,
            "table" => Some((of_straight, MOST[0])),
            "banded" => Some((of_reference, MOST[1])),
            _ => None,
        };
        row.error = promised.map(|(ratio, _)| ratio.smallest);
        row.promised = promised.map(|(_, most)| most);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Timing;
    use crate::tests::quick;

    #[test]
    fn turning_ticks_stand_beside_straight_ones_and_two_are_promised() {
        let findings = quick(&STUDY, 1);
        assert_eq!(findings.rows.len(), 6);
        for row in &findings.rows {
            assert!(row.further_number("times_straight") > Some(0.0), "{row:?}");
            let is_promised = row.setting == TURNING && row.method != "reference";
            assert_eq!(row.promised.is_some(), is_promised, "{row:?}");
            assert_eq!(row.error.is_some(), is_promised, "{row:?}");
        }
    }

    #[test]
    fn a_promise_is_broken_where_no_process_keeps_it() {
        let rows = |turning: [f64; 3]| {
            let timing = |all: [f64; 3]| {
                let others: Vec<_> = all[1..].iter().map(|s| (*s, *s, 2)).collect();
                Timing::of(&mut [all[0]], &mut [all[0]]).and(&others)
            };
            let row = |method: &str, setting: &str, all: [f64; 3]| {
                Row::of(method, setting, "one textile").cost(timing(all))
            };
            let mut rows = [
                row("reference", STRAIGHT, [100.0; 3]),
                row("table", STRAIGHT, [1.0, 2.0, 1.0]),
                row("reference", TURNING, [100.0; 3]),
                row("table", TURNING, turning),
            ];
            judge(&mut rows);
            rows[3].clone()
        };
        // The machine was at half its pace in the second process: ratios are of each alone.
        let kept = rows([5.0, 7.0, 5.0]);
        assert_eq!((kept.error, kept.is_kept()), (Some(3.5), Some(true)));
        assert_eq!(kept.further("times_straight"), "5.00");
        let broken = rows([5.0, 9.0, 5.0]);
        assert_eq!((broken.error, broken.is_kept()), (Some(4.5), Some(false)));
    }
}
