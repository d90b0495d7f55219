//! What a display is given on a cloth that hangs, against the same cloth lying flat.

use std::path::Path;

use crate::{Drape, DrapeError, DrapeScene, Felt, FeltTick, Hand, Integrator};
use selvedge_foundation::geometry::{Point, Velocity};
use selvedge_render::MaterialContact;
use selvedge_render::array::{Accuracy, ArrayRenderer, Method};
use selvedge_render::scene::Pose;
use selvedge_scratch::ScratchFolder;

/// One finger on a cloth in a frame that hardly gives way: stiffer than the twill itself, into
/// which a pad of 8 mN sinks so far that it slips 0.3 mm/s slower, and is felt 0.35 dB off.
const TAUT: &str = r#"
name = "Taut"
textile = "wool-twill"
size_mm = [100.0, 100.0]
grid = [26, 26]
pins = "frame"
air = false
integrator = "bdf2"
step_ms = 1.0
[measured]
weight_mg_per_cm2 = 20.0
emt_percent = 0.01
b_gf_cm2_per_cm = 1000.0
[[finger]]
start_mm = [30.0, 50.0, 0.0]
opening_mm = 20.0
"#;

fn taut() -> DrapeScene {
    DrapeScene::from_text(TAUT, Path::new("taut.drape.toml")).unwrap()
}

#[test]
fn a_finger_behind_feels_the_textile_of_the_back() {
    let folder = ScratchFolder::made("back");
    let path = folder.join("a.drape.toml");
    let both = TAUT.replace("[measured]", "back = \"denim\"\n[measured]")
        + "[[finger]]\nstart_mm = [30.0, 50.0, 0.0]\nopening_mm = 20.0\n";
    std::fs::write(&path, both).unwrap();
    let scene = DrapeScene::read(&path).unwrap();
    assert_eq!(
        scene.surfaces().collect::<Vec<_>>(),
        ["wool-twill", "denim"]
    );
    assert_eq!(scene.render_scene().unwrap().textiles.len(), 2);
    let mut drape = Drape::new(&scene, None, None).unwrap();
    assert_eq!([0, 1].map(|finger| drape.surface(finger)), [0, 1]);
    let (mut felt, mut touched) = (Felt::new(&scene).unwrap(), Vec::new());
    let mut before = drape.clone();
    let hands = before.start_hands();
    while before.t_s() < 0.03 {
        before.step(&hands).unwrap();
        let tell = |tick: FeltTick<'_>| {
            touched.push((tick.tick, tick.finger, tick.surface));
            Ok::<(), DrapeError>(())
        };
        felt.take(&mut before, tell).unwrap();
    }
    assert_eq!(touched[..2], [(1, 0, 0), (1, 1, 1)], "{touched:?}");
    // Past the edge to the other side, the first one comes from behind.
    for (x_mm, z_mm, expected) in [(-60.0, 10.0, 0), (-60.0, -10.0, 0), (30.0, -10.0, 1)] {
        let hand = Hand {
            centre_mm: [x_mm, 50.0, z_mm - 10.0],
            opening_mm: 20.0,
        };
        let away = Hand {
            centre_mm: [30.0, 50.0, -40.0],
            opening_mm: 20.0,
        };
        (0..200).for_each(|_| drape.step(&[hand, away]).unwrap());
        assert_eq!(drape.surface(0), expected, "{x_mm} {z_mm}");
    }
    assert_eq!(taut().surfaces().count(), 1);
    assert_eq!(Drape::new(&taut(), None, None).unwrap().surface(1), 0);
}

/// How a taut cloth is rubbed and stepped.
#[derive(Debug, Clone, Copy)]
struct Rub {
    velocity_mm_per_s: [f64; 2],
    integrator: Integrator,
    step_s: f64,
    n: usize,
    emt_percent: f64,
}

const WARP: Rub = Rub {
    velocity_mm_per_s: [40.0, 0.0],
    integrator: Integrator::Bdf2,
    step_s: 1e-3,
    n: 26,
    emt_percent: 0.01,
};

#[test]
fn a_taut_cloth_rubbed_at_a_constant_velocity_is_felt_as_a_flat_one() {
    let along = |velocity_mm_per_s: [f64; 2]| Rub {
        velocity_mm_per_s,
        ..WARP
    };
    // Ticks fall between these steps: as often after 24 ms as after 26.
    let slow = Rub {
        step_s: 2e-3,
        ..WARP
    };
    let explicit = Rub {
        integrator: Integrator::Explicit,
        step_s: 4.7e-6,
        n: 6,
        emt_percent: 0.03,
        ..WARP
    };
    for rub in [
        WARP,
        along([0.0, 40.0]),
        along([28.0, 28.0]),
        slow,
        explicit,
    ] {
        let worst_db = off_db(rub);
        assert!(worst_db < 0.05, "{rub:?}: {worst_db} dB");
    }
}

/// What is felt of a taut cloth against the same lying flat, in the worst case, dB.
fn off_db(rub: Rub) -> f64 {
    let (scene, mut drape) = taut_by(rub);
    let rendered = scene.render_scene().unwrap();
    let accuracy = Accuracy::default();
    let mut hung = ArrayRenderer::prepare(&rendered, Method::Reference, &accuracy).unwrap();
    let mut flat = ArrayRenderer::prepare(&rendered, Method::Reference, &accuracy).unwrap();
    let at = |t_s: f64| {
        let [x, y] = rub
            .velocity_mm_per_s
            .map(|speed| speed * (t_s - 0.4).max(0.0));
        Hand {
            centre_mm: [30.0 + x, 50.0 + y, 0.0],
            opening_mm: 20.0 - (100.0 * t_s).min(22.0),
        }
    };
    let mut contacts: [Option<MaterialContact>; 24] = [None; 24];
    let (mut worst_db, mut n_compared) = (0.0_f64, 0);
    for tick in 1..=40_u32 {
        let tick_s = f64::from(tick) / 40.0;
        while drape.t_s() < tick_s - 1e-9 {
            let hand = at(drape.t_s() + drape.step_s());
            drape.step(&[hand]).unwrap();
        }
        drape.tick_contacts((0, tick_s), &mut contacts);
        let moved = touched(&contacts).any(|(_, one)| one.velocity_mm_per_s != [0.0; 2]);
        // While it is pressed by steps that damp nothing it dances.
        let is_still = tick <= 16 && (tick > 10 || rub.integrator != Integrator::Explicit);
        assert!(!is_still || !moved, "{tick}: it presses, and nothing slips");
        let felt = hung.touch((0, 0), &contacts).unwrap().clone();
        if tick < 28 {
            continue;
        }
        // The flat display is where the pad is: its lag behind the hand is that of its coupling.
        let (contactor, contact) = touched(&contacts).next().expect("it touches");
        let offset = felt.contactor_position(contactor) - felt.position();
        let [x, y] = rub.velocity_mm_per_s;
        let pose = Pose {
            position: Point::new(contact.place_mm[0], contact.place_mm[1])
                + selvedge_foundation::geometry::Displacement::new(-offset.x_mm, -offset.y_mm),
            velocity: Velocity::new(x, y),
            ..Pose::default()
        };
        let expected = &flat.tick(&[pose])[0];
        for (contactor, _) in touched(&contacts) {
            let pair = [&felt, expected].map(|frame| frame.amplitude_um(contactor));
            for (a, b) in pair[0].into_iter().zip(pair[1]).filter(|(_, b)| *b > 1e-3) {
                worst_db = worst_db.max((20.0 * (a / b).log10()).abs());
                n_compared += 1;
            }
        }
    }
    assert!(n_compared > 200, "{n_compared}");
    worst_db
}

/// The contactors that touch, and what.
fn touched(contacts: &[Option<MaterialContact>]) -> impl Iterator<Item = (usize, MaterialContact)> {
    let all = contacts.iter().enumerate();
    all.filter_map(|(nth, one)| Some((nth, (*one)?)))
}

/// The hung cloth and its scene.
fn taut_by(rub: Rub) -> (DrapeScene, Drape) {
    let text = TAUT
        .replace("[26, 26]", &format!("[{}, {}]", rub.n, rub.n))
        .replace(
            "_percent = 0.01",
            &format!("_percent = {}", rub.emt_percent),
        );
    let scene = DrapeScene::from_text(&text, Path::new("taut.drape.toml")).unwrap();
    let drape = Drape::new(&scene, Some(rub.integrator), Some(rub.step_s)).unwrap();
    (scene, drape)
}
