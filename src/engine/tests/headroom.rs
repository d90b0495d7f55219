//! Headroom: at the tuning that a new scene begins with, no textile of the program's library comes
//! near an output limit, wherever, in whatever direction and however fast a hand moves over it.

use std::path::Path;

use super::*;
use selvedge_device::Coder;
use selvedge_foundation::quantity::factor_of_gain;
use selvedge_render::array::ContactInspector;
use selvedge_render::scene::LoadedScene;

/// The fastest that hands explore at, mm/s.
const FASTEST_MM_PER_S: f64 = 120.0;
/// What is left before a limit bites, at least: speeds and directions between those tried, dB.
const HEADROOM_DB: f64 = 1.0;
/// Speeds and directions that are tried: amplitudes change little from one to the next.
const N_SPEEDS: u32 = 24;
const N_DIRECTIONS: u32 = 12;

/// The library's sixteen textiles, felt with the tuning that new scenes begin with.
fn all_sixteen() -> LoadedScene {
    let text = include_str!("../../../assets/scenes/all-sixteen.scene.toml");
    LoadedScene::from_toml(text, Path::new("all-sixteen.scene.toml")).unwrap()
}

/// The amplitudes [A40, A320] that add up to the most at every velocity, µm.
fn strongest(inspector: &ContactInspector, textile: usize) -> Vec<[f32; 2]> {
    let mut found = Vec::new();
    let response = inspector.response(textile).unwrap();
    for nth in 1..=N_SPEEDS {
        let speed = FASTEST_MM_PER_S * f64::from(nth) / f64::from(N_SPEEDS);
        for direction in 0..N_DIRECTIONS {
            let degrees = 360.0 * f64::from(direction) / f64::from(N_DIRECTIONS);
            let along_x = Velocity::new(speed, 0.0);
            let velocity = Rotation::from_degrees(degrees).turn_velocity(along_x);
            let map = response.map(velocity);
            let [n_warp, n_weft] = map.n_points();
            let points = (0..n_weft).flat_map(|j| (0..n_warp).map(move |i| [i, j]));
            let all = points.map(|point| map.at_points_um(point));
            let loudest = all.max_by(|a, b| (a[0] + a[1]).total_cmp(&(b[0] + b[1])));
            #[expect(clippy::cast_possible_truncation, reason = "as renderers hand it on")]
            let louder = |um: f64| (um * factor_of_gain(HEADROOM_DB)) as f32;
            found.extend(loudest.map(|pair| pair.map(louder)));
        }
    }
    found
}

#[test]
fn no_textile_of_the_library_meets_a_limit_at_the_tuning_of_new_scenes() {
    let loaded = all_sixteen();
    let inspector = ContactInspector::new(&RenderScene::of(&loaded));
    let mut faults = Vec::new();
    let mut most = 0.0_f32;
    for (index, placed) in loaded.scene().textiles.iter().enumerate() {
        let amplitudes_um = strongest(&inspector, index);
        let mut coder = Coder::new(&ArrayProfile::default(), amplitudes_um.len());
        coder.encode(&amplitudes_um, 1.0);
        let n_limited = coder.limited().iter().filter(|one| one.any()).count();
        let sum = amplitudes_um.iter().map(|pair| pair[0] + pair[1]);
        let loudest_um = sum.fold(0.0, f32::max);
        most = most.max(loudest_um);
        if n_limited > 0 {
            let n = amplitudes_um.len();
            faults.push(format!(
                "{}: {n_limited} of {n}, up to {loudest_um} µm",
                placed.id
            ));
        }
    }
    assert!(faults.is_empty(), "limits bite:\n{}", faults.join("\n"));
    assert!(most > 25.0, "half of full drive is used: {most} µm");
}
