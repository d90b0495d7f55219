//! Replications: what is simulated is the same every time, and says what it is.

use super::ranking::crossing;
use super::*;
use crate::design::Design;
use selvedge_foundation::progress::Progress;

fn small() -> Options {
    Options {
        n_studies: 20,
        ..Options::default()
    }
}

/// The papers' designs with levels that stand on a grid, so that no textile has to be made.
fn papers() -> Papers {
    let laid = |name: &str| {
        let design = Design::shipped(name).unwrap();
        let stimuli = crate::observer::tests::stimuli(&design);
        DesignWithStimuli { design, stimuli }
    };
    Papers {
        real: laid("ranking-real-target"),
        virtually: laid("ranking-virtual-target"),
        triads: odd_one_out::GROUPS.map(laid),
        judged: laid("real-or-generated"),
    }
}

fn replicated_small() -> Replication {
    Progress::unheard(|progress| replicated(&papers(), &small(), progress)).unwrap()
}

fn found(quantity: &str, observer: &str, all: &Replication) -> Comparison {
    let is_it = |one: &&Comparison| one.quantity == quantity && one.observer == observer;
    all.comparisons.iter().find(is_it).unwrap().clone()
}

#[test]
fn a_falling_curve_is_crossed_between_its_points() {
    let curve = [[0.0, 50.0], [2.0, 46.0], [4.0, 40.0]];
    assert_eq!(crossing(&curve, 43.0), Ok(3.0));
    assert_eq!(crossing(&curve, 50.0), Ok(0.0));
    assert!(crossing(&curve, 30.0).is_err());
    assert!(crossing(&curve, 51.0).is_err());
}

#[test]
fn printed_and_obtained_stand_beside_each_other_and_come_again() {
    let all = replicated_small();
    assert_eq!(all, replicated_small());

    let first = "target ranked first, %";
    let chance = found("target ranked first by chance, %", "guesses", &all);
    let within = 4.0 * chance.obtained.se;
    assert!((chance.obtained.mean - 25.0).abs() < within, "{chance:?}");
    let levels = found(first, "levels, one look", &all);
    assert!(levels.obtained.mean > 40.0, "{levels:?}");
    assert!(levels.obtained.low <= levels.obtained.mean);
    assert_eq!(levels.printed, Some(64.1));
    let is_above = levels.obtained.low > 64.1;
    assert_eq!(
        levels.is_within(),
        Some(!is_above && levels.obtained.high >= 64.1)
    );

    let r1 = found("r of dimension 1 and A40", "levels, one look", &all);
    assert!(r1.obtained.mean > 0.5 && r1.obtained.high <= 1.0, "{r1:?}");
    let m2 = found(
        "m² of the map laid over the levels",
        "levels, one look",
        &all,
    );
    assert!(m2.obtained.mean < 0.2 && m2.obtained.low >= 0.0, "{m2:?}");
    let guesses = found("right answers, %", "guesses", &all);
    assert!(guesses.obtained.mean < 60.0, "{guesses:?}");
    let groups = ["real cloth, pen", "optical model", "Kawabata model"];
    for group in groups {
        let right = found("right answers, %", group, &all);
        assert!(right.obtained.low > 100.0 / 3.0, "{right:?}");
    }
    let signals = all
        .comparisons
        .iter()
        .filter(|one| one.quantity.starts_with("F(1, 11)"));
    assert_eq!(signals.count(), 4, "seen and unseen apart, two observers");
}

#[test]
fn every_table_has_a_key_of_its_own_and_no_number_that_is_none() {
    let all = replicated_small();
    let mut keys = Vec::new();
    for section in &all.analysis.sections {
        for table in &section.tables {
            keys.push(format!("{}-{}", section.key, table.key));
            assert!(!table.rows.is_empty(), "{}", table.title);
        }
        keys.extend(
            section
                .figures
                .iter()
                .map(|d| format!("{}-{}", section.key, d.key)),
        );
    }
    let n = keys.len();
    keys.sort();
    keys.dedup();
    assert_eq!(keys.len(), n);
}

#[test]
fn a_replication_can_be_stopped() {
    let cancel = selvedge_foundation::progress::CancelFlag::default();
    cancel.cancel();
    let mut silent = |_: f64, _: &str| ();
    let stopped = replicated(&papers(), &small(), &mut Progress::new(&mut silent, cancel));
    assert!(
        matches!(stopped, Err(ExperimentError::Cancelled(_))),
        "{stopped:?}"
    );
}

#[test]
fn what_chance_gives_is_known_for_every_number_of_dimensions() {
    let names: Vec<String> = (0..7).map(|at| format!("fabric-{at}")).collect();
    let mds = selvedge_statistics::mds::Mds::default();
    let chance =
        Progress::unheard(|progress| maps::chance(&names, &mds, (4, 40), progress)).unwrap();
    let means: Vec<f64> = chance
        .iter()
        .map(selvedge_statistics::mds::Null::mean)
        .collect();
    assert_eq!(means.len(), 4);
    assert!(means.windows(2).all(|pair| pair[0] > pair[1]), "{means:?}");
    // Seven objects of random ranks in the plane: about 0.11.
    assert!((0.07..0.15).contains(&means[1]), "{means:?}");
}
