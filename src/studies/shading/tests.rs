//! The study runs, repeats, and finds what is known.

use super::*;
use crate::tests::quick;
use selvedge_foundation::progress::thread_cpu_seconds;

#[test]
fn the_quick_study_repeats_keeps_its_promise_and_ranks_the_methods() {
    let start_s = thread_cpu_seconds();
    let (first, second) = (quick(&STUDY, 3), quick(&STUDY, 3));
    println!("{:.1} s CPU", 0.5 * (thread_cpu_seconds() - start_s));
    assert_eq!(first.n_broken(), 0, "{:?}", first.rows);
    assert_eq!((&first.notes, first.plots.len()), (&second.notes, 3));
    for (a, b) in first.rows.iter().zip(&second.rows) {
        assert_eq!((a.error, &a.more), (b.error, &b.more));
        assert!(a.error.is_none_or(f64::is_finite), "{a:?}");
    }
    for row in &first.rows {
        println!(
            "{:12} {:16} {:34} {:?} {:?}",
            row.method, row.setting, row.case, row.error, row.more
        );
    }
    println!("{}", first.notes.join("\n"));
    let error = |method: Method| {
        let is_it = |row: &&Row| row.method == method.label() && row.case == WEAVE.name();
        first
            .rows
            .iter()
            .find(is_it)
            .and_then(|row| row.error)
            .unwrap()
    };
    let [sketch, linear, best] = Method::OF_SHADING.map(error);
    assert!(
        best < linear && linear < sketch,
        "{best}, {linear}, {sketch}"
    );
    // Frontal light is refused, and told as such.
    let refused = first
        .rows
        .iter()
        .filter(|row| row.setting.ends_with("refused"));
    assert!(refused.count() >= 3);
}

#[test]
fn a_relief_of_its_own_is_exact_and_one_inside_out_is_nothing() {
    let truth = WEAVE.truth(16, 1).unwrap();
    let picture = truth.picture(LIGHT, 0.0, &mut Random::new(1));
    let mut shape = found(&picture, LIGHT, &options(Method::Linear, None)).unwrap();
    shape.height_px = truth.height_px.clone();
    let mean = shape.height_px.values().iter().sum::<f64>() / 256.0;
    shape
        .height_px
        .values_mut()
        .iter_mut()
        .for_each(|z| *z -= mean);
    let near = Near::of(&shape, &truth.height_px);
    assert!(near.error_percent() < 1e-5 && near.nrmse < 1e-9, "{near:?}");
    shape
        .height_px
        .values_mut()
        .iter_mut()
        .for_each(|z| *z *= -2.0);
    let near = Near::of(&shape, &truth.height_px);
    assert!((near.gain - 2.0).abs() < 1e-9 && near.correlation < -0.999);
    assert!((near.error_percent() - 100.0).abs() < 1e-9);
}
