//! Known configurations under noise: how much of the map is lost.

use super::{Bench, Dissimilarities, Findings, Mds, ReportError, Row, made};
use crate::chart::{chart, series};
use selvedge_chart::{Axis, Style};
use selvedge_foundation::numerics::{Random, median};
use selvedge_statistics::procrustes::Procrustes;

/// Noise on dissimilarities, as a standard deviation of their logarithm.
const NOISE: [f64; 5] = [0.0, 0.1, 0.2, 0.4, 0.8];

/// Adds what is lost of maps in the plane, by objects and noise.
pub(super) fn add(bench: &mut Bench<'_>, findings: &mut Findings) -> Result<(), ReportError> {
    let counts = bench.effort.pick(&[16][..], &[7, 16, 30][..]);
    let n_sets = bench.effort.pick(3, 15);
    let mut all = Vec::new();
    for (n_done, &n) in counts.iter().enumerate() {
        bench.step(0.6 + 0.4 * n_done as f64 / counts.len() as f64, "recovery")?;
        let mut points = Vec::new();
        for noise in NOISE {
            let (m2, stress) = lost(n, noise, n_sets, bench.seed);
            points.push([noise, m2]);
            let case = format!("{n} points of a plane");
            let row = Row::of("recovery", format!("noise {noise}"), case);
            findings
                .rows
                .push(row.number("m2", 5, m2).number("stress1", 5, stress));
        }
        all.push(series(format!("{n} objects"), Style::Dots, points));
    }
    let plot = chart(
        "Mds: what noise takes from a known map",
        Axis::linear("noise, standard deviation of the logarithm"),
        Axis::linear("m² left over after Procrustes"),
        all,
        "Medians over random configurations in a plane. Numbers: mds.csv.",
    );
    findings.plots.push(("mds-recovery".to_owned(), plot));
    Ok(())
}

/// Medians of m² and of stress-1 over sets of data.
pub(super) fn lost(n: usize, noise: f64, n_sets: usize, seed: u64) -> (f64, f64) {
    let mds = Mds {
        n_starts: 20,
        n_threads: 1,
        ..Mds::default()
    };
    let (mut m2, mut stress) = (Vec::new(), Vec::new());
    for set in 0..n_sets {
        let mut random = Random::new(seed).branch(&format!("recovery {n}, {set}"));
        let truth = thrown(n, 2, &mut random);
        let data = between(&truth, |distance| {
            distance * (noise * random.normal()).exp()
        });
        let map = made(&mds, &data, 2);
        let laid = map.as_ref().map(|map| Procrustes::of(&map.points, &truth));
        if let (Some(map), Some(Ok(laid))) = (&map, laid) {
            m2.push(laid.m2);
            stress.push(map.stress1);
        }
    }
    (median(&mut m2), median(&mut stress))
}

pub(super) fn thrown(n: usize, k: usize, random: &mut Random) -> Vec<Vec<f64>> {
    let point = |random: &mut Random| (0..k).map(|_| random.normal()).collect();
    (0..n).map(|_| point(random)).collect()
}

/// Dissimilarities of numbered objects at places, of what is made of their distances.
///
/// # Panics
/// They are no dissimilarities: those of this study are.
#[expect(clippy::expect_used, reason = "made here, whole and positive")]
pub(super) fn between(places: &[Vec<f64>], mut felt: impl FnMut(f64) -> f64) -> Dissimilarities {
    let n = places.len();
    let mut values = vec![None; n * n];
    for i in 0..n {
        for j in i + 1..n {
            let squares = places[i]
                .iter()
                .zip(&places[j])
                .map(|(p, q)| (p - q).powi(2));
            values[i * n + j] = Some(felt(squares.sum::<f64>().sqrt()));
        }
    }
    let names = (0..n).map(|i| format!("object {}", i + 1)).collect();
    Dissimilarities::new(names, &values).expect("whole and positive")
}
