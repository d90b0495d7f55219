//! What the shipped networks promise: the score that is recorded of them, intervals that hold,
//! friction from any picture that has room for a finger's path.

use std::path::Path;
use std::sync::OnceLock;

use super::*;
use crate::example::{Example, all_taken};
use crate::score::Measure;
use crate::split::Split;
use selvedge_foundation::files::{EditedKeys, KeyValue};

/// What is recorded of the shipped weights.
fn provenance((table, key): (&str, &str)) -> KeyValue {
    let path = Path::new("assets/friction/provenance.toml");
    let text = include_str!("../../../assets/friction/provenance.toml");
    let keys = EditedKeys::parse(text, path).unwrap();
    keys.value((table, 0, key)).unwrap()
}

/// Windows that split A holds back, of 20 cloths of each family.
fn held_back() -> &'static [Example] {
    static EXAMPLES: OnceLock<Vec<Example>> = OnceLock::new();
    EXAMPLES.get_or_init(|| all_taken(&Split::Cloths.windows(80)[1], 2))
}

#[test]
fn the_shipped_networks_reach_the_score_that_is_recorded_of_them() {
    let predictor = Predictor::shipped().unwrap();
    let mut mean = [0.0; 2];
    let examples: Vec<_> = held_back().iter().step_by(4).collect();
    for example in &examples {
        let course = predictor.course(&example.looks);
        let found = score(&Prediction::of_course(&course), &example.trace);
        for (sum, measure) in mean
            .iter_mut()
            .zip([Measure::LogSpectral, Measure::LevelError])
        {
            *sum += measure.of(&found) / examples.len() as f64;
        }
    }
    for (found, measure) in mean
        .into_iter()
        .zip([Measure::LogSpectral, Measure::LevelError])
    {
        let KeyValue::Float(recorded) = provenance(("together", measure.column())) else {
            panic!("no {}", measure.column());
        };
        assert!((found - recorded).abs() < 1e-3, "{found}, not {recorded}");
    }
}

/// How far each log magnitude of a band is from what was felt, dB.
fn off_db(found: &PredictedFriction, felt: &Course, band: usize) -> Vec<f64> {
    let edges = band_edges();
    let bins = edges[band]..edges[band + 1];
    let frames = 0..felt.log_magnitudes.height();
    let places = frames.flat_map(|frame| bins.clone().map(move |bin| (frame, bin)));
    let off = |(frame, bin): (usize, usize)| {
        let both = [&felt.log_magnitudes, found.log_magnitudes()];
        let [a, b] = both.map(|grid| db(grid.row(frame)[bin]));
        (a - b).abs()
    };
    places.map(off).collect()
}

#[test]
fn what_is_said_to_hold_for_95_of_100_cloths_holds_for_90_to_99_of_them() {
    let recorded = ["level_share", "bands_db"].map(|key| provenance(("interval", key)));
    assert_eq!(recorded[0], KeyValue::Float(LEVEL_WITHIN));
    let bands_db = BANDS_DB.map(KeyValue::Float).to_vec();
    assert_eq!(recorded[1], KeyValue::Array(bands_db));
    let predictor = Predictor::shipped().unwrap();
    let mut n_levels = 0.0;
    let mut of_bands = [[0.0; 2]; N_BANDS];
    // What is said was found on every second: these are those between.
    let others: Vec<_> = held_back().iter().skip(1).step_by(2).collect();
    for example in &others {
        let found = together(&predictor.each(&example.looks));
        let felt = &example.course;
        let is_within = (found.level() - felt.level).abs() <= found.level_within;
        n_levels += f64::from(u8::from(is_within));
        for (band, [.., within_db]) in found.bands.iter().enumerate() {
            for db in off_db(&found, felt, band) {
                of_bands[band][0] += 1.0;
                of_bands[band][1] += f64::from(u8::from(db <= *within_db));
            }
        }
    }
    let share = n_levels / others.len() as f64;
    let shares = of_bands.map(|[n, n_within]| n_within / n);
    assert!((0.9..=0.99).contains(&share), "levels: {share}");
    assert!(
        shares.iter().all(|share| (0.9..=0.99).contains(share)),
        "bands: {shares:?}"
    );
}

#[test]
fn a_picture_gives_friction_with_how_far_it_may_be_off_and_a_small_one_is_refused() {
    let predictor = Predictor::shipped().unwrap();
    let strip = Split::Cloths.windows(4)[1][3].taken().strip;
    let found = predictor.of_picture(&strip, PER_MM).unwrap();
    assert_eq!(found.mu.len(), 1280);
    assert!(
        found.mu.iter().all(|mu| (0.1..1.0).contains(mu)),
        "{:?}",
        found.mu
    );
    assert!(
        (0.01..0.2).contains(&found.level_within),
        "{}",
        found.level_within
    );
    assert!(found.bands.iter().all(|[.., db]| (1.0..40.0).contains(db)));
    let small = strip.part([0, 0, 500, 128]).unwrap();
    let refused = predictor
        .of_picture(&small, PER_MM)
        .unwrap_err()
        .to_string();
    assert!(refused.contains("at least 40 mm x 10 mm"), "{refused}");
    for px_per_mm in [0.5, 0.0, f64::NAN] {
        let refused = Predictor::strip(&strip, px_per_mm).unwrap_err().to_string();
        assert!(refused.contains("its true scale"), "{refused}");
    }
    assert_eq!(Predictor::strip(&strip, PER_MM).unwrap(), strip);
}

#[test]
fn shades_are_a_picture_with_the_lowest_bin_at_the_bottom() {
    let log = Grid::from_fn(257, 3, |bin, frame| to_single((bin + 1000 * frame) as f64));
    let shades = PredictedFriction::shades(&log, 128, [0.0, 2000.0]);
    assert_eq!([shades.width(), shades.height()], [3, 128]);
    assert_eq!(shades.row(127), [0.0, 0.5, 1.0]);
    assert_eq!(shades.row(0)[0], 127.0 / 2000.0);
    let flat = PredictedFriction::shades(&Grid::filled(257, 1, 2.0), 999, [2.0, 2.0]);
    assert!(flat.height() == 257 && flat.values().iter().all(|shade| *shade == 0.0));
}

#[test]
fn black_white_plain_and_finer_pictures_are_pictures() {
    let predictor = Predictor::shipped().unwrap();
    for shade in [0.0, 0.5, 1.0] {
        let picture = Grid::filled(600, 200, shade);
        let found = predictor.of_picture(&picture, PER_MM).unwrap();
        assert!(
            found.mu.iter().all(|mu| mu.is_finite() && *mu >= 0.0),
            "{shade}"
        );
    }
    let fine = Grid::from_fn(2400, 600, |x, y| to_single(((x / 7 + y / 7) % 2) as f64));
    assert_eq!(predictor.of_picture(&fine, 40.0).unwrap().mu.len(), 768);
}

#[test]
fn a_cloth_between_two_pictures_is_both_at_the_ends() {
    let predictor = Predictor::shipped().unwrap();
    let [a, b] = [1, 6].map(|n| Split::Places.windows(1)[1][n].taken().strip);
    let pair = [(&a, PER_MM), (&b, PER_MM)];
    for (share, own) in [(0.0, &a), (1.0, &b)] {
        let found = predictor.between(pair, share).unwrap();
        assert_eq!(found, predictor.of_picture(own, PER_MM).unwrap());
    }
}
