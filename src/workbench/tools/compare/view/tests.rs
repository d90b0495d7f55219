//! What is said of a comparison.

use super::*;
use crate::tools::compare::view::controls::signed_db;
use selvedge_render::Largest;

fn tally(mean_db: Option<f64>, n_only: [u64; 2]) -> Tally {
    let mut tally = Tally::default();
    tally.n_only = n_only;
    if let Some(difference_db) = mean_db {
        tally = Tally::of_one(Largest {
            difference_db,
            tick: 80,
            contactor: 5,
        });
        tally.n_only = n_only;
    }
    tally
}

#[test]
fn a_band_is_summed_up_with_where_it_differs_most() {
    let words = summary(&tally(Some(-3.414), [0, 0]));
    assert_eq!(
        words,
        "mean −3.41 dB, largest −3.41 dB at tick 80, contactor 5"
    );
    assert!(summary(&tally(Some(0.0), [0, 0])).starts_with("no difference"));
    let words = summary(&tally(Some(1.0), [0, 3]));
    assert!(words.ends_with("contactor 5, B only in 75.0 %"), "{words}");
}

#[test]
fn where_one_is_silent_no_number_is_made_up() {
    let said = [[0, 0], [2, 0], [0, 2], [2, 2]].map(|n_only| summary(&tally(None, n_only)));
    assert_eq!(said[0], "silent in both");
    assert_eq!(said[1], "A only: B is silent");
    assert_eq!(said[2], "B only: A is silent");
    assert!(said[3].starts_with("never both at once"));
    for words in said {
        assert!(!words.contains('∞') && !words.contains("NaN"), "{words}");
    }
}

#[test]
fn the_scale_is_round_and_holds_the_largest() {
    assert_eq!(scale_db([0.4, -3.0].into_iter()), 5.0);
    assert_eq!(scale_db([0.0].into_iter()), 1.0);
    assert_eq!(scale_db(std::iter::empty()), 1.0);
    assert_eq!([0.0, 0.0123, -3.0].map(decimals_of), [2, 4, 2]);
    assert_eq!([0.05, 0.1].map(|db| unit_of(db).0), ["mdB", "dB"]);
    assert_eq!(signed_db(0.5, 1), "+0.5 dB");
    assert_eq!(signed_db(-0.5, 1), "−0.5 dB");
}

#[test]
fn the_parts_fit_side_by_side_or_one_above_the_other() {
    use eframe::egui::pos2;
    for size in [vec2(345.0, 130.0), vec2(700.0, 300.0), vec2(240.0, 500.0)] {
        let body = Rect::from_min_size(pos2(3.0, 4.0), size);
        let (maps, curve) = split(body, Some((6, 4)));
        assert!(body.contains_rect(maps) && body.contains_rect(curve));
        assert!(!maps.intersect(curve).is_positive(), "{size:?}");
    }
}
