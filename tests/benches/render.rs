//! What a tick costs by method and by number of contactors, and what preparing costs.
//!
//! Prints medians over several rounds that take turns, so that ratios are taken side by side.

#![expect(clippy::print_stdout, reason = "a bench prints its figures")]

use std::hint::black_box;
use std::sync::Arc;
use std::time::Instant;

use selvedge_foundation::geometry::{Displacement, Frame, Point, Rotation, Velocity};
use selvedge_foundation::numerics::{Grid, Random, median};
use selvedge_render::array::{Accuracy, ArrayRenderer, Method};
use selvedge_render::scene::Pose;
use selvedge_render::{ContactorArray, PlacedLevel, PlacedSurface, RenderScene};
use selvedge_textile::surface::{HeightMap, Probe, Profile, ProfileSet, Surface};

const ROUNDS: usize = 9;
const METHODS: [Method; 3] = [Method::Reference, Method::Banded, Method::Table];

fn main() {
    println!("preparing a scene of four textiles, 16 points in four directions, spectra given");
    let scene = scene(array(6, 4, 2.0));
    for method in METHODS {
        let mut times: Vec<f64> = (0..ROUNDS).map(|_| prepare_ms(&scene, method)).collect();
        println!("  {:<10} {:>9.2} ms", method.name(), median(&mut times));
    }
    let (aslant, turning) = (Velocity::new(80.0, 60.0), 2.0);
    report(
        "24 contactors, one velocity",
        array(6, 4, 2.0),
        (aslant, 0.0),
        2000,
    );
    report(
        "24 contactors, turning",
        array(6, 4, 2.0),
        (aslant, turning),
        1000,
    );
    report(
        "10000 contactors, one velocity",
        array(100, 100, 0.1),
        (aslant, 0.0),
        20,
    );
    report(
        "10000 contactors, turning",
        array(100, 100, 0.1),
        (aslant, turning),
        20,
    );
    areal();
}

/// Areal against economical: importing, preparing, first touch, and ticks side by side.
fn areal() {
    let map = height_map([1197, 940], 0.05);
    let mut import_s: Vec<f64> = (0..3)
        .map(|_| {
            let start = Instant::now();
            black_box(Surface::areal(&map, 0.0).is_ok());
            start.elapsed().as_secs_f64()
        })
        .collect();
    println!("a height map of 1197 × 940 points, 0.05 mm apart, to spectra at every mm");
    println!("  importing  {:>9.2} s", median(&mut import_s));
    let probe = Probe::contactor();
    let middle_mm = map.size_mm().map(|mm| 0.5 * mm);
    let profiles = map.strokes(&probe, middle_mm, &Random::new(1));
    let economical = profiles.and_then(|profiles| Surface::from_profiles(profiles, 0.0));
    let surfaces = [economical, Surface::areal(&map, 0.0)];
    let scenes: Vec<RenderScene> = surfaces
        .into_iter()
        .flatten()
        .map(|surface| {
            let mut scene = scene(array(6, 4, 2.0));
            let surface = Arc::new(surface);
            for placed in &mut scene.textiles {
                placed.surface = Arc::clone(&surface);
            }
            scene
        })
        .collect();
    let aslant = Velocity::new(80.0, 60.0);
    for (motion, what) in [((aslant, 0.0), "one velocity"), ((aslant, 2.0), "turning")] {
        for method in METHODS {
            compare_areal(&scenes, method, motion, what);
        }
    }
}

fn compare_areal(scenes: &[RenderScene], method: Method, motion: (Velocity, f64), what: &str) {
    let prepare = |scene| ArrayRenderer::prepare(scene, method, &Accuracy::default());
    let start = Instant::now();
    let mut renderers: Vec<ArrayRenderer> = scenes.iter().flat_map(prepare).collect();
    let prepared_ms = start.elapsed().as_secs_f64() * 1e3;
    // The first time round makes what is made on first touch.
    let first: Vec<f64> = renderers
        .iter_mut()
        .map(|renderer| tick_ns(renderer, motion, 40))
        .collect();
    let mut times = vec![Vec::new(); renderers.len()];
    for _ in 0..ROUNDS {
        for (renderer, times) in renderers.iter_mut().zip(&mut times) {
            times.push(tick_ns(renderer, motion, 400));
        }
    }
    let medians: Vec<f64> = times.iter_mut().map(|times| median(times)).collect();
    if let ([one, all], [_, touch], Some(areal)) = (&medians[..], &first[..], renderers.last()) {
        println!(
            "  {:<10} {what:<13} economical {one:>9.1} ns, areal {all:>9.1} ns a tick: {:.2}×; \
             at first touch {touch:>9.1} ns; both prepared in {prepared_ms:.1} ms; {:.1} MB",
            method.name(),
            all / one,
            areal.n_bytes() as f64 / 1e6
        );
    }
}

/// A rough map: waves of all lengths and noise.
fn height_map(n: [usize; 2], step_mm: f64) -> HeightMap {
    let mut random = Random::new(5);
    let wave: Vec<f64> = (0..n[0]).map(|_| 3.0 * random.normal()).collect();
    let height = |i: usize| {
        let (column, row) = (i % n[0], i / n[0]);
        let across = (0.7 * row as f64 * step_mm).sin() + 2.0;
        wave[column] * across + 2.0 * random.normal()
    };
    let heights = (0..n[0] * n[1]).map(height).collect();
    let grid = Grid::from_rows(n[0], heights).map(|grid| HeightMap::new(grid, [step_mm; 2]));
    match grid {
        Some(Ok(map)) => map,
        other => unreachable!("{other:?}"),
    }
}

fn report(what: &str, array: ContactorArray, motion: (Velocity, f64), n_ticks: usize) {
    let n_contactors = array.offsets.len();
    let scene = scene(array);
    let prepare = |method| ArrayRenderer::prepare(&scene, method, &Accuracy::default());
    let mut renderers: Vec<ArrayRenderer> = METHODS.into_iter().flat_map(prepare).collect();
    let mut times = vec![Vec::new(); METHODS.len()];
    for _ in 0..ROUNDS {
        for (renderer, times) in renderers.iter_mut().zip(&mut times) {
            let slow = if renderer.method() == Method::Table {
                1
            } else {
                20
            };
            times.push(tick_ns(renderer, motion, (n_ticks / slow).max(2)));
        }
    }
    println!("{what}");
    let medians: Vec<f64> = times.iter_mut().map(|times| median(times)).collect();
    for (method, ns) in METHODS.iter().zip(&medians) {
        let per_contactor = ns / n_contactors as f64;
        let ratio = medians[0] / ns;
        let name = method.name();
        println!(
            "  {name:<10} {ns:>12.1} ns a tick {per_contactor:>9.2} ns a contactor {ratio:>8.1}×"
        );
    }
}

fn prepare_ms(scene: &RenderScene, method: Method) -> f64 {
    let start = Instant::now();
    black_box(ArrayRenderer::prepare(scene, method, &Accuracy::default()).is_ok());
    start.elapsed().as_secs_f64() * 1e3
}

/// Mean time of a tick along a stroke that starts on the first textile.
fn tick_ns(renderer: &mut ArrayRenderer, motion: (Velocity, f64), n_ticks: usize) -> f64 {
    let pose = |tick: usize| {
        let along = (tick % 40) as f64 / 40.0;
        let angle_deg = if motion.1 == 0.0 { 0.0 } else { 50.0 * along };
        Pose {
            t_s: along,
            position: Point::new(30.0 + 80.0 * along, 30.0 + 60.0 * along),
            angle_deg,
            velocity: motion.0,
            angular_rad_per_s: motion.1,
        }
    };
    let poses: Vec<Pose> = (0..n_ticks).map(pose).collect();
    let start = Instant::now();
    for pose in &poses {
        black_box(renderer.tick(std::slice::from_ref(pose)));
    }
    start.elapsed().as_secs_f64() * 1e9 / n_ticks as f64
}

/// An array of rows × columns.
fn array(n_rows: usize, n_columns: usize, pitch_mm: f64) -> ContactorArray {
    let middle = |count: usize| (count as f64 - 1.0) / 2.0;
    let at = |row: usize, column: usize| {
        let x_mm = (column as f64 - middle(n_columns)) * pitch_mm;
        Displacement::new(x_mm, (middle(n_rows) - row as f64) * pitch_mm)
    };
    let offsets = (0..n_rows)
        .flat_map(|r| (0..n_columns).map(move |c| at(r, c)))
        .collect();
    ContactorArray {
        offsets,
        rotation_deg: 0.0,
    }
}

/// Four textiles of 120 × 120 mm side by side.
fn scene(array: ContactorArray) -> RenderScene {
    let place = |number: usize| {
        let (column, row) = ((number % 2) as f64, (number / 2) as f64);
        PlacedSurface {
            workspace_from_textile: Frame {
                origin: Point::new(10.0 + 125.0 * column, 10.0 + 125.0 * row),
                rotation: Rotation::NONE,
            },
            size_mm: [120.0, 120.0],
            manifest_gain_db: 0.0,
            scene_gain_db: 0.0,
            scene_band_gains_db: [0.0; 2],
            within_mm: None,
            level: PlacedLevel::Known(3.0),
            surface: Arc::new(surface(number as u64)),
        }
    };
    RenderScene {
        textiles: (0..4).map(place).collect(),
        displays: vec![array],
        ..RenderScene::default()
    }
}

/// A surface of four profiles: a weave's wave and noise that falls with the wavenumber.
fn surface(seed: u64) -> Surface {
    let mut random = Random::new(seed);
    let mut profile = || {
        let mut level = 0.0;
        let height = |i: u32| {
            level = 0.999 * level + 0.2 * random.normal();
            level + 4.0 * (f64::from(i) * 0.06).sin()
        };
        Profile::new(1.0 / 230.0, (0..4600).map(height).collect()).ok()
    };
    let profiles: ProfileSet = [profile(), profile(), profile(), profile()];
    match Surface::from_profiles(profiles, 0.0) {
        Ok(surface) => surface,
        Err((direction, error)) => unreachable!("{direction:?}: {error}"),
    }
}
