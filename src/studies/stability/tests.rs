//! Every case comes out as promised, and one that does not is told.

use super::*;
use crate::Effort;
use crate::tests::{assert_keeps_promises, quick};
use selvedge_foundation::progress::Progress;

#[test]
fn every_extreme_case_comes_out_as_promised() {
    let findings = quick(&STUDY, 1);
    assert!(findings.rows.len() > 40, "{} cases", findings.rows.len());
    assert_keeps_promises(&findings);
}

#[test]
fn every_sweep_stays_within_its_bounds_and_names_its_worst() {
    let findings = quick(&SWEEPS, 1);
    assert_keeps_promises(&findings);
    let of_promise = |row: &&Row| row.promised.is_some();
    assert!(findings.rows.iter().filter(of_promise).count() > 50);
    assert_eq!((findings.plots.len(), findings.notes.len()), (8, 8));
    assert!(findings.notes.iter().all(|note| note.contains("at worst")));
    // Where it was looked for, it happens: a skin that opens and closes, and jumps at 1 kHz.
    let conditions = |case: &'static str| {
        let rows = findings.rows.iter().filter(move |row| row.case == case);
        rows.filter_map(|row| row.further_number("condition"))
    };
    assert!(conditions("preload").any(|share| 0.0 < share && share < 1.0));
    assert!(conditions("crossing").all(|jump| jump > 0.0));
}

#[test]
fn what_comes_out_otherwise_or_panics_is_broken_and_harms_no_other() {
    let cases = vec![
        Case::new("a", "wrong", "silent", || Err("4 µm".to_owned())),
        Case::new("a", "panics", "silent", || panic!("at {}", 7)),
        Case::new("a", "right", "silent", || Ok("0 µm".to_owned())),
    ];
    let run = |bench: &mut Bench<'_>| try_all(cases, PATIENCE, bench);
    let findings =
        Progress::unheard(|progress| run(&mut Bench::new(Effort::Quick, 1, progress))).unwrap();
    let kept: Vec<Option<bool>> = findings.rows.iter().map(Row::is_kept).collect();
    assert_eq!(kept, [Some(false), Some(false), Some(true)]);
    let described: Vec<&str> = findings
        .rows
        .iter()
        .map(|row| row.more[0].1.as_str())
        .collect();
    assert_eq!(described, ["4 µm", "it panicked: at 7", "0 µm"]);
    assert_eq!(findings.n_broken(), 2);
}

#[test]
fn what_hangs_is_given_up() {
    let (end, ended) = sync_channel::<()>(0);
    let hangs = move || {
        let is_over = ended.recv().is_err();
        Ok(format!("over: {is_over}"))
    };
    let described = alone(Box::new(hangs), Duration::from_millis(20)).unwrap_err();
    assert_eq!(described, "nothing came back within 20.00 ms");
    drop(end);
}
