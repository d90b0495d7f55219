//! The study runs, and finds what is known of the window in closed form.

use super::*;
use crate::progress::{CancelFlag, Progress};
use crate::report::Effort;

fn run(effort: Effort) -> Findings {
    let mut report = |_: f64, _: &str| {};
    let mut progress = Progress::new(&mut report, CancelFlag::new());
    SpectralModelStudy
        .run(&mut Bench::new(effort, 7, &mut progress))
        .unwrap()
}

fn number(row: &Row, column: &str) -> f64 {
    let found = row.more.iter().find(|more| more.0 == column);
    found.and_then(|more| more.1.parse().ok()).unwrap()
}

#[test]
fn a_wave_of_2_5_mm_at_100_mm_per_s_keeps_0_92_of_its_amplitude() {
    let level_db = windows::low_at_40_hz_db(PRODUCT[0], 100.0);
    let factor = 10.0_f64.powf(level_db / 20.0);
    assert!((factor - 0.92).abs() < 0.01, "{factor}");
    let findings = run(Effort::Quick);
    let is_it =
        |row: &&Row| row.setting.starts_with("4.35") && row.case.starts_with("waves of 2.5");
    let row = findings.rows.iter().find(is_it).unwrap();
    assert!(
        (number(row, "a40_at_100_mm_per_s_db") - level_db).abs() < 0.1,
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
    let (first, second) = (run(Effort::Quick), run(Effort::Quick));
    // Four windows on three sums of waves and two textiles; two choices of points on two textiles.
    assert_eq!(first.rows.len(), 4 * 5 + 4);
    for (a, b) in first.rows.iter().zip(&second.rows) {
        assert_eq!(
            (a.error, a.error_p99, &a.more),
            (b.error, b.error_p99, &b.more)
        );
        assert!(
            a.error.is_some_and(f64::is_finite) && a.cost.is_some(),
            "{a:?}"
        );
    }
    assert_eq!((first.plots.len(), first.notes.len()), (1, 4));
}

#[test]
fn the_mean_over_points_crossed_is_closer_than_the_nearest_point() {
    let findings = run(Effort::Quick);
    let rms = |method: &str| -> f64 {
        let rows = findings.rows.iter().filter(|row| row.method == method);
        rows.map(|row| number(row, "rms_db")).sum()
    };
    let [nearest, mean] = [rms("nearest point"), rms("mean over points crossed")];
    assert!(mean < 0.7 * nearest, "{mean} and {nearest} dB");
}
