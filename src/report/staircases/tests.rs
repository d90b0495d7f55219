//! The study repeats, and says what is known of staircases.

use super::*;
use crate::progress::{CancelFlag, Progress};
use crate::report::Effort;

fn run() -> Findings {
    let mut report = |_: f64, _: &str| {};
    let mut progress = Progress::new(&mut report, CancelFlag::new());
    let mut bench = Bench::new(Effort::Quick, 3, &mut progress);
    StaircasesStudy.run(&mut bench).unwrap()
}

#[test]
fn the_study_repeats_and_errors_shrink_with_trials() {
    let (first, second) = (run(), run());
    for (a, b) in first.rows.iter().zip(&second.rows) {
        assert_eq!(a.error, b.error, "{a:?}");
        assert_eq!(a.more.first(), b.more.first(), "{a:?}");
    }
    let error = |method: &str, n_trials: f64| {
        let is_it = |row: &&Row| row.method == method && row.size == Some(n_trials);
        first.rows.iter().find(is_it).and_then(|row| row.error).unwrap()
    };
    for way in Way::ALL {
        let (few, many) = (error(way.name(), 20.0), error(way.name(), 80.0));
        assert!(many < few && many < 4.0, "{}: {few} {many}", way.name());
    }
    assert_eq!(first.plots.len(), 8);
}

#[test]
fn lapses_and_trials_without_a_threshold_are_counted() {
    let tally = Tally::of([Some(1.0), None, Some(-1.0), Some(3.0)].into_iter());
    assert_eq!((tally.n_runs, tally.n_undefined, tally.bias_db), (4, 1, 1.0));
    assert!((tally.rms_db - (11.0_f64 / 3.0).sqrt()).abs() < 1e-14, "{tally:?}");
}
