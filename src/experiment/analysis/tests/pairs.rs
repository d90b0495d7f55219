//! Comparisons of two, odd ones out as distances, and maps by other distances.

use super::*;
use crate::Task;
use selvedge_statistics::detection::{Correction, Relation};
use selvedge_statistics::normal_quantile;

#[test]
fn conditions_compared_in_pairs_stand_as_far_apart_as_the_share_of_choices_says() {
    let design = pair_design();
    // The real one is taken for real in three of four pairs.
    let found: Vec<Found> = (0..4)
        .map(|nth| {
            let answer = |task: &Task, n: usize| judged(task, !(n + nth).is_multiple_of(4), 1);
            held(&design, (nth, 1), answer)
        })
        .collect();
    let analysis = analysed(&found);
    let scales = table(&analysis, "single-judgements-pairs", "conditions-scales");
    let lead = |column: &str| (value(scales, 0, column) - value(scales, 1, column)).abs();
    let (won, n) = (value(scales, 0, "preferred"), value(scales, 0, "compared"));
    let share = won.max(n - won) / n;
    assert!((share - 0.75).abs() < 1e-12, "{scales:?}");
    assert!(
        (lead("bradley_terry") - 3.0_f64.ln()).abs() < 1e-9,
        "{scales:?}"
    );
    let z = normal_quantile(0.75).unwrap();
    assert!((lead("thurstone") - z).abs() < 1e-9, "{scales:?}");
    assert!((lead("row_mean_z") - z).abs() < 1e-9, "{scales:?}");
    assert!(
        value(scales, 0, "bradley_terry_se_subjects") < 0.2,
        "subjects agree"
    );
}

#[test]
fn materials_that_no_pair_joins_are_named_and_have_no_scale() {
    let design = pair_design();
    let found: Vec<Found> = (0..3)
        .map(|nth| held(&design, (nth, 1), |task, n| judged(task, n % 2 == 0, 1)))
        .collect();
    let analysis = analysed(&found);
    let key = "single-judgements-pairs";
    let section = analysis.sections.iter().find(|s| s.key == key).unwrap();
    let described = section
        .notes
        .iter()
        .find(|n| n.contains("No scale of stimuli"));
    let described = described.unwrap_or_else(|| panic!("{:?}", section.notes));
    let is_named =
        described.contains("no chain of comparisons joins") && described.contains("jute-plain");
    assert!(is_named, "{described}");
    let scales = table(&analysis, key, "stimuli-scales");
    let never = |row: usize| matches!(scales.cell(row, "thurstone"), Some(Cell::Undefined(_)));
    assert!((0..scales.rows.len()).all(never), "{scales:?}");
}

/// Alternatives ranked by their number, whatever the target is.
fn by_number(task: &Task) -> Answer {
    let mut order: Vec<usize> = (0..4).collect();
    order.sort_by_key(|at| task.items[*at]);
    Answer::in_order(&order)
}

#[test]
fn an_order_without_exception_has_no_finite_scale_no_circle_and_much_agreement() {
    let mut design = Design::shipped("ranking-virtual-target").unwrap();
    // Textiles are not what is asked here.
    design.library = Some("nowhere".into());
    let found: Vec<Found> = (0..3)
        .map(|nth| held(&design, (nth, 1), |task, _| by_number(task)))
        .collect();
    let analysis = analysed(&found);
    let key = "ranking-virtual-target-pairs";
    let section = analysis.sections.iter().find(|s| s.key == key).unwrap();
    let described = section.notes.iter().find(|n| n.contains("No scale of"));
    assert!(
        described.is_some_and(|described| described.contains("over")),
        "{:?}",
        section.notes
    );
    let scales = table(&analysis, key, "alternatives-scales");
    // Each is compared twice with each other one by each of three subjects.
    assert_eq!(value(scales, 0, "compared"), 90.0);
    assert_eq!(
        (
            value(scales, 0, "preferred"),
            value(scales, 15, "preferred")
        ),
        (90.0, 0.0)
    );
    let circles = table(&analysis, key, "alternatives-consistency");
    for row in 0..4 {
        assert_eq!(
            (
                value(circles, row, "pairs"),
                value(circles, row, "circular")
            ),
            (120.0, 0.0)
        );
        assert_eq!(value(circles, row, "zeta"), 1.0);
    }
    let agreement = table(&analysis, "ranking-virtual-target-map", "agreement");
    let w = value(agreement, 0, "effect_value");
    assert!((0.6..=1.0).contains(&w), "one order, other companions: {w}");
}

#[test]
fn bradley_and_terry_of_pairs_stands_beside_plackett_and_luce_with_errors_over_subjects() {
    let mut design = Design::shipped("ranking-virtual-target").unwrap();
    design.library = Some("nowhere".into());
    let mut random = selvedge_foundation::numerics::Random::new(4);
    let found: Vec<Found> = (0..4)
        .map(|nth| {
            held(&design, (nth, 1), |task, _| {
                let target = task.reference.unwrap();
                let far = |item: &usize| item.abs_diff(target) as f64 + 4.0 * random.normal();
                let far: Vec<f64> = task.items.iter().map(far).collect();
                let mut order: Vec<usize> = (0..4).collect();
                order.sort_by(|a, b| far[*a].total_cmp(&far[*b]));
                Answer::in_order(&order)
            })
        })
        .collect();
    let analysis = analysed(&found);
    let likeness = table(&analysis, "ranking-virtual-target-scale", "likeness");
    assert_eq!(likeness.rows.len(), 240);
    let mut signs = 0;
    for row in 0..240 {
        let both = [
            value(likeness, row, "log_worth"),
            value(likeness, row, "bradley_terry"),
        ];
        signs += i32::from(both[0] * both[1] > 0.0);
        assert!(value(likeness, row, "se_subjects") > 0.0, "{row}");
        assert!(
            value(likeness, row, "bradley_terry_se_subjects") > 0.0,
            "{row}"
        );
    }
    assert!(signs > 230, "{signs} of 240 on one side of the target");
}

#[test]
fn distances_after_craven_are_those_of_the_shares_of_pairs() {
    let design = Design::shipped("odd-one-out").unwrap();
    // The first two fabrics are told apart by three of four subjects, one is never, others always.
    let found: Vec<Found> = (0..4)
        .map(|nth| {
            held(&design, (nth, 1), |task, _| {
                let is_pair =
                    |a: usize, b: usize| task.items.contains(&a) && task.items.contains(&b);
                let is_right = !is_pair(0, 2) && (!is_pair(0, 1) || nth > 0);
                odd(task, is_right, Grade::Easy)
            })
        })
        .collect();
    let analysis = analysed(&found);
    let pairs = table(&analysis, "odd-one-out-craven", "pairs");
    assert_eq!(value(pairs, 0, "right"), 3.0);
    let expected = Relation::Triangle
        .choice(3, 4, Correction::Clip)
        .unwrap()
        .d_prime;
    assert!(
        (value(pairs, 0, "distance") - expected).abs() < 1e-9,
        "{pairs:?}"
    );
    assert_eq!(pairs.cell(0, "correction"), Some(&Cell::from("none")));
    assert_eq!(value(pairs, 1, "distance"), 0.0);
    assert_eq!(pairs.cell(1, "below_chance"), Some(&Cell::from("yes")));
    let ceiling = Relation::Triangle
        .choice(4, 4, Correction::LogLinear)
        .unwrap()
        .d_prime;
    assert!(
        (value(pairs, 2, "distance") - ceiling).abs() < 1e-9,
        "{pairs:?}"
    );
    assert_eq!(pairs.cell(2, "correction"), Some(&Cell::from("log-linear")));
    let matrix = table(&analysis, "odd-one-out-craven", "distances");
    let name = matrix.columns[2].name.clone();
    assert!(
        (value(matrix, 0, &name) - expected).abs() < 1e-9,
        "{matrix:?}"
    );
}

#[test]
fn weights_that_change_no_order_leave_nothing_over_and_others_something() {
    let design = Design::shipped("odd-one-out").unwrap();
    let by_place = |easy_from: usize| {
        move |task: &Task, _: usize| {
            let apart = apart(task);
            let grade = Grade::ALL[2 - (apart / easy_from).min(2)];
            odd(task, apart > 1, grade)
        }
    };
    let found: Vec<Found> = (0..5)
        .map(|nth| held(&design, (nth, 1), by_place(1 + nth % 3)))
        .collect();
    let analysis = analysed(&found);
    let variants = table(&analysis, "odd-one-out-variants", "variants");
    assert_eq!(variants.rows.len(), 4, "the design's, two others, Craven's");
    assert!(matches!(
        variants.cell(0, "m2_plane"),
        Some(Cell::Undefined(_))
    ));
    // All right answers count 1: few distances, and they are Craven's in another unit.
    for column in ["m2_line", "m2_plane", "spearman"] {
        let both = [value(variants, 2, column), value(variants, 3, column)];
        assert!((both[0] - both[1]).abs() < 1e-6, "{column}: {both:?}");
    }
    let m2 = value(variants, 1, "m2_plane");
    assert!((0.0..=1.0).contains(&m2), "{variants:?}");
    assert!(value(variants, 1, "m2_plane") < value(variants, 2, "m2_plane"));
    assert!((0.01..=1.0).contains(&value(variants, 1, "p_plane")));
    let places = table(&analysis, "odd-one-out-variants", "coordinates");
    assert_eq!(places.rows.len(), 4 * 7);
}
