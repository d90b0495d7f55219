//! The study repeats, and its errors shrink as they should.

use super::*;
use crate::tests::quick;

#[test]
fn errors_shrink_with_trials_in_every_way() {
    let findings = quick(&STUDY, 3);
    let error = |method: &str, n_trials: f64| {
        let is_it = |row: &&Row| row.method == method && row.size == Some(n_trials);
        let row = findings.rows.iter().find(is_it);
        row.and_then(|row| row.error).unwrap()
    };
    for way in WAYS {
        let (few, many) = (error(way.name, 40.0), error(way.name, 80.0));
        assert!(many < few && many < 3.0, "{}: {few} {many}", way.name);
    }
    assert_eq!(findings.plots.len(), 8);
    assert_eq!(findings.n_broken(), 0);
}

#[test]
fn the_seed_alone_decides_on_any_thread() {
    for way in [WAYS[3], WAYS[5], WAYS[6]] {
        let observer = &Observer::all()[1];
        let run = |seed: u64| errors(way, observer, &[20, 40], 6, seed);
        assert_eq!(run(3), run(3), "{}", way.name);
        assert_ne!(run(3), run(4), "{}", way.name);
    }
}

#[test]
fn lapses_and_trials_without_a_threshold_are_counted() {
    let tally = Tally::of([Some(1.0), None, Some(-1.0), Some(3.0)].into_iter());
    assert_eq!(
        (tally.n_runs, tally.n_undefined, tally.bias_db),
        (4, 1, 1.0)
    );
    assert!(
        (tally.rms_db - (11.0_f64 / 3.0).sqrt()).abs() < 1e-14,
        "{tally:?}"
    );
}
