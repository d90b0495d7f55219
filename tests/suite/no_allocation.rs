//! Proof that a tick allocates nothing: the suite's global allocator aborts inside a guard.

use std::sync::Arc;

use assert_no_alloc::assert_no_alloc;

use selvedge_device::{ActuatorModel, ContactorModel, Skin};
use selvedge_foundation::geometry::{Displacement, Frame, Point, Rotation, Velocity};
use selvedge_foundation::numerics::{Grid, Random};
use selvedge_render::array::{Accuracy, ArrayRenderer, DriveSynth, Method};
use selvedge_render::contact::{
    Contact, ContactLaw, DeviceSpec, Friction, Hand, Relief, Sampling, Stepper, StylusRun,
    StylusSetup, StylusStart, Tip,
};
use selvedge_render::scene::Pose;
use selvedge_render::{ContactorArray, PlacedLevel, PlacedSurface, RenderScene};
use selvedge_textile::surface::{HeightMap, Profile, ProfileSet, Surface};
use selvedge_textile::tactile::Tuning;

fn surface(seed: u64, n_samples: u32) -> Arc<Surface> {
    let mut random = Random::new(seed);
    let mut level = 0.0;
    let height = |_| {
        level = 0.99 * level + random.normal();
        level
    };
    let mut profiles = ProfileSet::default();
    profiles[0] = Some(Profile::new(1.0 / 230.0, (0..n_samples).map(height).collect()).unwrap());
    Arc::new(Surface::from_profiles(profiles, 0.0).unwrap())
}

/// A surface that is felt at every point of 9 × 8 mm.
fn areal() -> Arc<Surface> {
    let mut random = Random::new(3);
    let heights = (0..180 * 160).map(|_| 2.0 * random.normal()).collect();
    let grid = Grid::from_rows(180, heights).unwrap();
    let map = HeightMap::new(grid, [0.05; 2]).unwrap();
    Arc::new(Surface::areal(&map, 0.0).unwrap())
}

/// A short, a very long and an areal textile that overlap, two displays, one of them turned.
fn scene() -> RenderScene {
    let place = |(number, surface)| PlacedSurface {
        workspace_from_textile: Frame {
            origin: Point::new(40.0 * f64::from(number), 10.0),
            rotation: Rotation::from_degrees(30.0 * f64::from(number)),
        },
        size_mm: [80.0, 80.0],
        manifest_gain_db: 0.0,
        scene_gain_db: -2.0,
        scene_band_gains_db: [0.0; 2],
        within_mm: None,
        level: PlacedLevel::Pending,
        surface,
    };
    let offset = |i: u8| Displacement::new(f64::from(i % 4) * 2.0, f64::from(i / 4) * 2.0);
    let array = |rotation_deg| ContactorArray {
        offsets: (0..24).map(offset).collect(),
        rotation_deg,
    };
    RenderScene {
        textiles: [
            (0_u8, surface(1, 4600)),
            (1, surface(2, 40_000)),
            (2, areal()),
        ]
        .map(place)
        .into(),
        displays: vec![array(0.0), array(45.0)],
        ..RenderScene::default()
    }
}

/// Strokes over both textiles and beyond; still, fast, turning and broken poses.
fn poses(tick: u32) -> [Pose; 2] {
    let along = f64::from(tick);
    let stroke = Pose {
        t_s: along / 40.0,
        position: Point::new(along * 1.3 - 20.0, 30.0 + along * 0.2),
        angle_deg: if tick.is_multiple_of(3) { along } else { 0.0 },
        velocity: Velocity::new(52.0, 8.0 * (f64::from(tick % 7) - 3.0)),
        angular_rad_per_s: if tick.is_multiple_of(5) { 1.5 } else { 0.0 },
    };
    let odd_speed = [0.0, 5000.0, f64::NAN, 0.02][(tick % 4) as usize];
    let odd = Pose {
        velocity: Velocity::new(odd_speed, -30.0),
        ..stroke
    };
    [stroke, odd]
}

#[test]
fn a_tick_of_any_method_allocates_nothing() {
    let scene = scene();
    for method in Method::ALL {
        let mut renderer = ArrayRenderer::prepare(&scene, method, &Accuracy::default()).unwrap();
        let mut sounding = 0;
        for tick in 0..120 {
            let poses = poses(tick);
            assert_no_alloc(|| {
                let frames = renderer.tick(&poses);
                let heard = |a: &&[f32; 2]| a[0] > 0.0;
                sounding += frames[0].amplitudes_um().iter().filter(heard).count();
            });
        }
        assert!(sounding > 200, "{method:?} rendered something: {sounding}");
        let is_table = renderer.method() == Method::Table;
        let n_made = renderer.counters().nodes_made;
        assert_eq!(n_made > 0, is_table, "{method:?} made {n_made} nodes");
    }
}

#[test]
fn a_step_of_a_stylus_allocates_nothing() {
    let mut random = Random::new(4);
    let heights = (0..64 * 64).map(|_| 20.0 * random.normal()).collect();
    let map = HeightMap::new(Grid::from_rows(64, heights).unwrap(), [0.05; 2]).unwrap();
    let relief = Relief::of_map(&map.periodic());
    let offsets = [0.0, 2.0, 4.0].map(|x_mm| Displacement::new(x_mm, 1.0));
    for (method, is_sampled) in Stepper::ALL
        .into_iter()
        .zip([false, true].into_iter().cycle())
    {
        let tip = Tip::array(&offsets, 0.1);
        let friction = Friction::coulomb(0.3);
        let setup = StylusSetup {
            contact: Contact::new(&relief, tip, ContactLaw::default(), friction).unwrap(),
            device: DeviceSpec {
                damping_n_s_per_m: 5.0,
                ..DeviceSpec::default()
            },
            hand: Hand {
                press_n: 1.0,
                leads: is_sampled.then_some([500.0, 1.0]),
            },
            method,
            rate_hz: 4000.0,
            sampling: is_sampled.then_some(Sampling::default()),
        };
        let mut run = StylusRun::new(setup, [0.0; 2], StylusStart::Resting).unwrap();
        let mut force_n = 0.0;
        for nth in 0..500 {
            assert_no_alloc(|| {
                let row = run.step([0.02 * f64::from(nth), 0.0]);
                force_n = row.map_or(f64::NAN, |row| row.force_n);
            });
        }
        assert_no_alloc(|| {
            assert!(!run.advance([f64::NAN; 2]), "nowhere is refused");
            assert!(run.begin([0.0; 2], StylusStart::Resting));
            assert!(run.advance([0.01, 0.0]));
        });
        assert!(force_n > 0.1, "{method:?} pressed: {force_n}");
    }
}

#[test]
fn live_gains_and_levels_allocate_nothing() {
    let mut renderer =
        ArrayRenderer::prepare(&scene(), Method::Table, &Accuracy::default()).unwrap();
    let tuning = Tuning {
        gain_db: -3.0,
        compression: 0.7,
        ..Tuning::default()
    };
    let refused = Tuning {
        gain_db: f64::NAN,
        ..tuning
    };
    let levels = [2.0, 5.0, 4.0].map(PlacedLevel::Known);
    assert_no_alloc(|| {
        assert!(renderer.set_tuning(&tuning).is_ok());
        assert!(renderer.compression_is_pending());
        assert!(renderer.set_levels(&levels).is_ok());
        assert!(renderer.set_tuning(&refused).is_err());
        renderer.reset();
    });
    assert_eq!(renderer.tuning(), &tuning);
}

#[test]
fn the_drive_waveform_allocates_nothing() {
    let mut synth = DriveSynth::prepare(44_100, 24, 50.0).unwrap();
    let mut block = vec![0.0; 24 * 48];
    let amplitudes = [[3.0, 1.0]; 24];
    assert_no_alloc(|| {
        for _ in 0..100 {
            synth.set_amplitudes(&amplitudes);
            synth.fill(&mut block);
        }
    });
    assert_eq!(synth.next_sample(), 4800);
}

#[test]
fn contactors_that_lift_off_and_slew_allocate_nothing() {
    let mut model = ContactorModel {
        skin: Skin {
            preload_um: Some(5.0),
            ..Skin::bonded(500.0, 0.2)
        },
        ..ContactorModel::default()
    };
    model.amplifier.slew_v_per_us = 0.05;
    let mut plant = ActuatorModel::new(&model, 24).unwrap();
    let codes = [[40_000, 25_000]; 24];
    assert_no_alloc(|| {
        for _ in 0..4 {
            plant.tick(&codes, 60.0);
        }
    });
    let last = plant.reading().contactors[23];
    assert!(
        last.lost_share > 0.0 && last.saturated_share > 0.0,
        "{last:?}"
    );
}
