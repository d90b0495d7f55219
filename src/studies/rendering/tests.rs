//! The study of rendering: complete, and wrong methods show up as wrong.

use super::study_table::{Nodes, Reading, StudyTable};
use super::*;
use crate::tests::quick;

#[test]
fn every_method_is_tried_on_every_textile_and_wrong_ones_show() {
    let findings = quick(&STUDY, 7);
    let of = |method: &str, setting: &str| -> Vec<&Row> {
        let is_it = |row: &&Row| row.method == method && row.setting == setting;
        findings.rows.iter().filter(is_it).collect()
    };
    // Reference, floors, budgets; densities, each linear and cubic with both digits; one uncut.
    let n_methods = 1 + FLOORS.len() + BUDGETS_DB.len() + 3 * 4 + 1;
    assert_eq!(findings.rows.len(), 5 * n_methods);
    for row in &findings.rows {
        assert!(row.error.is_some() && row.error_p99 <= row.error, "{row:?}");
        assert!(row.cost.is_some() && row.bytes > Some(1000), "{row:?}");
        assert_ne!(row.is_kept(), Some(false), "{row:?}");
    }
    let errors_db = |method: &str, setting: &str| -> Vec<f64> {
        let rows = of(method, setting);
        assert_eq!(rows.len(), 5, "{method} {setting}");
        rows.iter().filter_map(|row| row.error).collect()
    };
    // Against itself it has none; against what is known otherwise, that of rounding.
    let of_reference = errors_db("reference", "");
    assert_eq!(of_reference[..4], [0.0; 4]);
    assert!((0.0..1e-11).contains(&of_reference[4]), "{of_reference:?}");
    let largest = |errors: &[f64]| errors.iter().fold(0.0_f64, |most, e| most.max(*e));
    let promised = errors_db("table", "within 0.05 dB");
    assert!(largest(&promised) <= PROMISED_DB, "{promised:?}");
    let good = errors_db("linear f64", "48 nodes an octave");
    assert!(largest(&good) <= 0.01, "{good:?}");
    // Deliberately wrong ones.
    let coarse = errors_db("linear f32", "2 nodes an octave");
    assert!(coarse.iter().any(|e| *e > PROMISED_DB), "{coarse:?}");
    let uncut = errors_db("cubic f64, uncut", "48 nodes an octave");
    assert!(largest(&uncut) > 10.0 * PROMISED_DB, "{uncut:?}");
}

#[test]
fn a_study_table_reads_its_own_nodes_exactly() {
    let mut random = Random::new(3);
    let surface = textiles::noise(3).unwrap();
    let poses = poses_between([100.0, 400.0], 1, &mut random);
    let case = Case::new("noise".to_owned(), scene_with(&surface), vec![poses]).unwrap();
    let mut reference =
        ArrayRenderer::prepare(&case.scene, Method::Reference, &Accuracy::default()).unwrap();
    // At the speed where the 21st bin reaches 1 kHz, 20 sound; a hair below, 21.
    let at_1_khz = 1000.0 / (0.23 * 21.0);
    let table = StudyTable::new(&case.scene, Nodes::new(6, true), Reading::Cubic);
    for speed in [at_1_khz * (1.0 - 1e-9), at_1_khz * (1.0 + 1e-9)] {
        let mut pose = case.poses[0][0];
        pose.velocity = selvedge_foundation::geometry::Velocity::new(-speed, 0.0);
        let mut found = vec![[0.0; 2]; 24];
        table.tick(&pose, &mut found);
        for (found, exact) in found.iter().zip(amplitudes_um(&mut reference, &[pose])) {
            for b in 0..2 {
                assert!(
                    (found[b] / exact[b] - 1.0).abs() < 1e-6,
                    "{found:?} {exact:?}"
                );
            }
        }
    }
}
