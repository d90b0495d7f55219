//! The study runs, and finds what is known of the window in closed form.

use super::*;
use crate::tests::{assert_complete_and_same, quick};

#[test]
fn a_wave_of_2_5_mm_at_100_mm_per_s_keeps_0_92_of_its_amplitude() {
    let level_db = windows::low_at_40_hz_db(PRODUCT[0], 100.0);
    let factor = 10.0_f64.powf(level_db / 20.0);
    assert!((factor - 0.92).abs() < 0.01, "{factor}");
    let findings = quick(&STUDY, 7);
    let is_it =
        |row: &&Row| row.setting.starts_with("4.35") && row.case.starts_with("waves of 2.5");
    let row = findings.rows.iter().find(is_it).unwrap();
    assert!(
        (row.further_number("a40_at_100_mm_per_s_db").unwrap() - level_db).abs() < 0.1,
        "{row:?}"
    );
}

#[test]
fn a_longer_window_costs_less_at_40_hz_and_a_short_one_more() {
    let [short, ours, long] = [2.0, PRODUCT[0], 16.0].map(|mm| windows::low_at_40_hz_db(mm, 100.0));
    assert!(
        short < ours - 0.5 && ours < long - 0.3,
        "{short}, {ours}, {long} dB"
    );
    assert!(long.abs() < 0.15, "{long} dB");
}

#[test]
fn a_quick_study_is_complete_and_repeats() {
    let (first, second) = (quick(&STUDY, 7), quick(&STUDY, 7));
    // Four windows on three sums of waves and two textiles; two choices of points on two textiles.
    assert_eq!(first.rows.len(), 4 * 5 + 4);
    assert_complete_and_same(&first, &second);
    assert_eq!((first.plots.len(), first.notes.len()), (1, 5));
}

#[test]
fn the_mean_over_points_crossed_is_closer_than_the_nearest_point() {
    let findings = quick(&STUDY, 7);
    let rms = |method: &str| -> f64 {
        let rows = findings.rows.iter().filter(|row| row.method == method);
        rows.map(|row| row.further_number("rms_db").unwrap()).sum()
    };
    let [nearest, mean] = [rms("nearest point"), rms("mean over points crossed")];
    assert!(mean < 0.7 * nearest, "{mean} and {nearest} dB");
}
