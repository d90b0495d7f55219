//! What is promised of intervals and tests holds in seeded studies.

use super::*;
use crate::Effort;
use selvedge_foundation::progress::{CancelFlag, Progress};

#[test]
fn promised_intervals_hold_the_truth_and_promised_tests_find_nothing_where_nothing_is() {
    let mut report = |_: f64, _: &str| {};
    let mut progress = Progress::new(&mut report, CancelFlag::new());
    let mut bench = Bench::new(Effort::Quick, 1, &mut progress);
    let findings = CoverageStudy.run(&mut bench).unwrap();
    let broken: Vec<_> = findings.broken().collect();
    assert!(broken.is_empty(), "{broken:#?}");
    let n_promised = findings
        .rows
        .iter()
        .filter(|row| row.promised.is_some())
        .count();
    assert!(n_promised >= 28, "{n_promised}");
    for row in findings
        .rows
        .iter()
        .filter(|row| row.case == "95 % interval")
    {
        let number = |place: usize| row.more[place].1.parse::<f64>().unwrap();
        let (came_out, n_studies) = (number(0), number(2));
        let is_inside = (90.0..=98.0).contains(&came_out);
        let is_asked = row.promised.is_some() && n_studies >= 200.0;
        assert!(is_inside || !is_asked, "{row:?}");
    }
}

#[test]
fn four_thousand_studies_without_an_effect_keep_to_their_level_without_slack() {
    for trial in nulls::ALL.iter().filter(|trial| trial.is_promised) {
        let found = tally(trial, 4000, 2);
        let [least, most] = FALSE_POSITIVE_BAND;
        let (name, setting) = (trial.name, trial.setting);
        assert!(
            (least..=most).contains(&found.percent()),
            "{name}, {setting}: {found:?}"
        );
    }
}

#[test]
fn a_tally_repeats_and_counts_what_is_undefined() {
    let trial = Trial {
        name: "coin",
        setting: "",
        n_studies: [1, 1],
        is_promised: true,
        study: |random| match random.uniform() {
            x if x < 0.5 => Ok(true),
            x if x < 0.75 => Ok(false),
            _ => Err(selvedge_statistics::Undefined::because("on its edge")),
        },
    };
    let found = tally(&trial, 4000, 7);
    assert_eq!(found, tally(&trial, 4000, 7));
    assert!((900..1100).contains(&found.undefined), "{found:?}");
    assert!((found.percent() - 66.7).abs() < 3.0, "{found:?}");
    let row = found.row(&trial, "", 95.0, COVERAGE_BAND);
    assert_eq!(row.is_kept(), Some(false));
}
