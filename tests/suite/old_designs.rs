//! Logs of earlier versions, whose designs said in one table what was asked: they lead to the
//! trials, rows and analysis of the designs that are shipped now.

use std::path::Path;

use selvedge_experiment::analysis::{Analysis, Options};
use selvedge_experiment::design::Design;
use selvedge_experiment::session::Found;
use selvedge_experiment::{Course, Step};
use selvedge_foundation::progress::Progress;

const FOLDER: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/suite/old_logs");

/// A shipped design as it was when its log was written: the levels of `jnd-40` were 3 dB higher.
fn shipped_then(name: &str) -> Design {
    let text = Design::shipped_text(name).unwrap();
    let then = text
        .replace("reference = 21.0", "reference = 24.0")
        .replace("range = [21.25, 33.25]", "range = [24.25, 36.25]");
    assert_eq!(then != text, name == "jnd-40", "{name}");
    Design::from_toml(&then, Path::new(name)).unwrap()
}

#[test]
fn old_logs_are_read_by_the_compositions_that_their_tables_were() {
    let (found, unread) = Found::in_folder(Path::new(FOLDER)).unwrap();
    assert!(unread.is_empty(), "{unread:?}");
    let names = [
        "real-or-generated",
        "odd-one-out",
        "gain-matching",
        "jnd-40",
    ];
    assert_eq!(found.len(), names.len());
    for (session, name) in found.iter().zip(names) {
        let shipped = shipped_then(name);
        assert_ne!(session.design.hash, shipped.hash, "the texts differ");
        assert_eq!(session.design.composition, shipped.composition, "{name}");
        // What the shipped design asks now is what was asked then, and all was answered.
        let course = Course::resume(&shipped, &session.subject, &session.records);
        let mut course = course.unwrap_or_else(|error| panic!("{name}: {error}"));
        assert_eq!(course.progress().0, session.records.len(), "{name}");
        while matches!(
            course.step(),
            Step::Instructions(_) | Step::Familiarisation(_)
        ) {
            course.pass();
        }
        assert_eq!(course.step(), Step::Finished, "{name}");
    }
}

#[test]
fn old_logs_are_analysed_as_what_they_were() {
    let options = Options {
        n_random_data: 0,
        n_permutations: 9,
        n_resamples: 20,
        ..Options::default()
    };
    let analysis =
        Progress::unheard(|progress| Analysis::of_folder(Path::new(FOLDER), &options, progress));
    let analysis = analysis.unwrap();
    let keys: Vec<&str> = analysis.sections.iter().map(|s| s.key.as_str()).collect();
    for expected in [
        "jnd-40-thresholds",
        "odd-one-out-accuracy",
        "gain-matching-gain-db",
        "single-judgements-sensitivity",
    ] {
        assert!(keys.contains(&expected), "{expected} among {keys:?}");
    }
}
