//! The studies run, repeat, and find what is known.

use super::*;
use crate::Findings;
use crate::tests::{assert_keeps_promises, quick};
use selvedge_foundation::progress::thread_cpu_seconds;

fn error(findings: &Findings, method: &str, setting: &str, case: &str) -> f64 {
    let is_it = |row: &&crate::Row| {
        row.method == method && row.setting == setting && row.case.starts_with(case)
    };
    let found = findings.rows.iter().find(is_it).and_then(|row| row.error);
    found.unwrap_or_else(|| unreachable!("no row {method}, {setting}, {case}"))
}

#[test]
fn every_quick_study_repeats_and_keeps_its_promises() {
    let studies = [BROWNIAN, FOURIER, RESTORATION, DRAWN, PROBE];
    for study in studies {
        let start_s = thread_cpu_seconds();
        let (first, second) = (quick(&study, 3), quick(&study, 3));
        println!(
            "{}: {:.1} s CPU",
            study.name,
            0.5 * (thread_cpu_seconds() - start_s)
        );
        assert!(!first.rows.is_empty(), "{}", study.name);
        assert_eq!(first.n_broken(), 0, "{}: {:?}", study.name, first.rows);
        for (a, b) in first.rows.iter().zip(&second.rows) {
            assert_eq!((a.error, &a.more), (b.error, &b.more), "{}", study.name);
            assert!(a.error.is_some_and(f64::is_finite), "{}: {a:?}", study.name);
        }
    }
}

#[test]
fn resampling_by_the_transform_is_exact_and_lines_fall_with_the_square() {
    let findings = quick(&RESAMPLING, 3);
    assert_keeps_promises(&findings);
    let case = "waves down to 1.25 mm";
    assert!(
        error(&findings, "Fourier", "0.1 mm", case) < 1e-9,
        "{findings:?}"
    );
    let [coarse, fine] = ["0.1 mm", "0.02 mm"].map(|s| error(&findings, "straight lines", s, case));
    assert!(
        (coarse / fine / 25.0 - 1.0).abs() < 0.2,
        "{coarse} and {fine}"
    );
}

#[test]
fn all_of_its_own_coefficients_give_the_profile_back() {
    let findings = quick(&FOURIER, 3);
    assert!(
        error(&findings, "own coefficients", "100 harmonics", "denim") < 1e-9,
        "{findings:?}"
    );
    let few = error(&findings, "own coefficients", "5 harmonics", "denim");
    let more = error(&findings, "own coefficients", "20 harmonics", "denim");
    assert!(few > more && more > 1.0, "{few} and {more}");
    assert_eq!(findings.plots.len(), 1);
}

#[test]
fn the_parallel_curve_touches_crests_and_valleys_and_lies_above_between() {
    let wave = (10.0, 2.0);
    assert!(
        (probe::parallel_um(wave, 0.25, 0.0) - 10.0).abs() < 1e-9,
        "crest"
    );
    assert!(
        (probe::parallel_um(wave, 0.25, 0.25) + 10.0).abs() < 1e-9,
        "valley"
    );
    assert!(probe::parallel_um(wave, 0.25, 0.125) > 0.5, "flank");
}
