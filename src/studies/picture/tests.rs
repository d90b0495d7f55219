//! The studies run, repeat, and find what is known.

use super::lattice::{ESTIMATES, Estimate, of_estimates};
use super::*;
use crate::{Bench, Effort, Findings, Row, Study};
use selvedge_foundation::progress::{Progress, thread_cpu_seconds};

fn with_bench<T>(work: impl FnOnce(&mut Bench<'_>) -> T) -> T {
    Progress::unheard(|progress| work(&mut Bench::new(Effort::Quick, 3, progress)))
}

/// What a study finds in quick mode.
pub(super) fn quick(study: &Study) -> Findings {
    let start_s = thread_cpu_seconds();
    let findings = crate::tests::quick(study, 3);
    println!(
        "{}: {:.1} s CPU",
        study.name,
        thread_cpu_seconds() - start_s
    );
    for row in &findings.rows {
        println!(
            "{:24} {:20} {:30} {:?} {:?}",
            row.method, row.setting, row.case, row.error, row.more
        );
    }
    println!("{}", findings.notes.join("\n"));
    assert_eq!(findings.n_broken(), 0);
    findings
}

/// How many points its first plot shows.
pub(super) fn n_drawn(findings: &Findings) -> usize {
    let (_, plot) = &findings.plots[0];
    plot.series.iter().map(|series| series.points.len()).sum()
}

fn cell(row: &Row, name: &str) -> f64 {
    row.further_number(name).unwrap_or(f64::NAN)
}

fn agree(first: &Findings, second: &Findings) {
    assert_eq!(first.rows.len(), second.rows.len());
    for (a, b) in first.rows.iter().zip(&second.rows) {
        assert_eq!(
            (a.error, &a.more),
            (b.error, &b.more),
            "{}: {}",
            a.method,
            a.case
        );
        assert!(a.error.is_none_or(f64::is_finite), "{a:?}");
    }
}

#[test]
fn the_pipeline_finds_lattices_and_an_estimate_that_is_turned_shows_up_as_wrong() {
    let turned: Estimate = ("turned by 20°", |analysis| {
        let basis = (ESTIMATES[0].1)(analysis)?;
        let (s, c) = 20.0_f64.to_radians().sin_cos();
        let turn = |[x, y]: [f64; 2]| [c * x - s * y, s * x + c * y];
        Some(Basis::new(turn(basis.p1), turn(basis.p2)))
    });
    let estimates = [ESTIMATES[0], turned];
    let findings = with_bench(|bench| of_estimates(&estimates, bench)).unwrap();
    let usual = |name: &str| {
        let mut rows = findings.rows.iter();
        rows.find(|row| row.method == name && row.case == "usual")
            .unwrap()
    };
    let (right, wrong) = (usual("whole pipeline"), usual(turned.0));
    assert!(cell(right, "right_percent") > 99.0, "{right:?}");
    assert!(cell(wrong, "right_percent") < 1.0, "{wrong:?}");
    assert!(right.error.unwrap() < 0.2 && wrong.error.unwrap() > 1.0);
    // What plots show is in the table.
    for (name, plot) in &findings.plots {
        let sweep = name.trim_start_matches("by-");
        for series in &plot.series {
            let rows = findings.rows.iter().filter(|row| {
                row.method == series.name && row.case.starts_with(&format!("{sweep} "))
            });
            let cells: Vec<[f64; 2]> = rows
                .map(|row| [cell(row, "value"), cell(row, "right_percent")])
                .collect();
            assert_eq!(cells, series.points, "{name}");
        }
    }
}

#[test]
fn the_quick_lattice_study_repeats_itself() {
    agree(
        &quick(&LATTICE),
        &with_bench(|bench| (LATTICE.run)(bench)).unwrap(),
    );
}

#[test]
fn pictures_are_right_while_threads_are_resolved_and_have_no_lattice_when_not() {
    let findings = quick(&SCALE);
    for row in &findings.rows {
        let (period_px, share) = (cell(row, "period_px"), cell(row, "right_percent"));
        if period_px > 9.0 {
            assert!(share > 99.0, "{row:?}");
        }
        if period_px < 1.9 {
            assert!(
                share < 1.0 && row.error.is_some_and(|error| error > 50.0),
                "{row:?}"
            );
        }
    }
    assert_eq!(n_drawn(&findings), findings.rows.len());
}

#[test]
fn every_route_is_measured_on_every_cloth() {
    let findings = quick(&ROUTE);
    for name in ["KES strokes", "KES, restored"] {
        let rows: Vec<&Row> = findings
            .rows
            .iter()
            .filter(|row| row.method == name)
            .collect();
        assert_eq!(rows.len(), 4, "three cloths and all together");
        assert!(rows.iter().all(|row| row.error.is_some()), "{rows:?}");
    }
    assert_eq!(findings.plots.len(), 3);
    let dots: usize = findings.plots[0]
        .1
        .series
        .iter()
        .map(|s| s.points.len())
        .sum();
    // Plots are of the first way to take pictures.
    let settings = findings.rows.iter().map(|row| row.setting.as_str());
    let first = settings.into_iter().find(|setting| !setting.is_empty());
    let with_levels = findings.rows.iter().filter(|row| {
        let is_drawn = row.setting.is_empty() || Some(row.setting.as_str()) == first;
        is_drawn && cell(row, "a40_db").is_finite()
    });
    assert_eq!(
        dots,
        with_levels.count() + 2,
        "a dot a row, and two ends of a line"
    );
}

#[test]
fn what_is_stated_of_a_lattice_holds_for_other_pictures() {
    let findings = quick(&WEAVES);
    let kept = |row: &&Row| row.method == "confidence";
    let rows: Vec<&Row> = findings.rows.iter().filter(kept).collect();
    assert!(!rows.is_empty());
    assert!(
        rows.iter().all(|row| row.is_kept() == Some(true)),
        "{rows:?}"
    );
}
