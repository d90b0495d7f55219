//! The study runs, repeats and finds what is known.

use super::*;
use crate::tests::quick;

#[test]
fn the_study_repeats_and_keeps_its_promises() {
    let (first, second) = (quick(&STUDY, 3), quick(&STUDY, 3));
    assert_eq!(
        first.n_broken(),
        0,
        "{:?}",
        first.broken().collect::<Vec<_>>()
    );
    assert!(
        first.rows.iter().any(|row| row.promised.is_some()),
        "nothing promised"
    );
    for (a, b) in first.rows.iter().zip(&second.rows) {
        assert_eq!((a.error, &a.more), (b.error, &b.more), "{a:?}");
    }
    let error = |method: &str| {
        let row = first.rows.iter().find(|row| row.method == method);
        row.and_then(|row| row.error).unwrap()
    };
    assert!(error("Torgerson") > error("SMACOF"), "{:?}", first.rows);
}
