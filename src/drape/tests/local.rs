//! What is felt at 1 kHz between longer steps, against the same scene stepped at 1 kHz.

use crate::mesh::Vector;
use crate::{Drape, DrapeScene, Hand, Integrator};
use selvedge_scratch::ScratchFolder;

const SCENE: &str = r#"
name = "Pinched"
textile = "denim"
size_mm = [150.0, 150.0]
grid = [16, 16]
[[finger]]
start_mm = [75.0, 60.0, 0.0]
opening_mm = 10.0
[[finger]]
start_mm = [75.0, 60.0, 0.0]
opening_mm = 10.0
"#;

fn drape(step_s: f64) -> Drape {
    let folder = ScratchFolder::made("local");
    let path = folder.join("a.drape.toml");
    std::fs::write(&path, SCENE).unwrap();
    let scene = DrapeScene::read(&path).unwrap();
    Drape::new(&scene, Some(Integrator::Bdf2), Some(step_s)).unwrap()
}

/// Both fingers close within 0.2 s, then push the cloth to and fro at 2 Hz and rub it.
fn hands(t_s: f64) -> [Hand; 2] {
    let swung = (std::f64::consts::TAU * 2.0 * (t_s - 0.25).max(0.0)).sin();
    let hand = |side: f64| Hand {
        centre_mm: [75.0 + 3.0 * side * swung, 60.0 + 2.0 * swung, 4.0 * swung],
        opening_mm: 10.0 - 60.0 * t_s.min(0.2),
    };
    [hand(1.0), hand(-1.0)]
}

/// Forces on the first hand at every millisecond from 0.1 s on.
fn forces(step_s: f64, between: impl Fn(&mut Drape, f64) -> [f64; 3]) -> Vec<[f64; 3]> {
    let mut drape = drape(step_s);
    drape.place(&hands(0.0));
    let mut found = Vec::new();
    for tick in 1..=800_u32 {
        let t_s = 1e-3 * f64::from(tick);
        let force = between(&mut drape, t_s);
        while drape.t_s() + step_s < t_s + 1e-9 {
            let to_s = drape.t_s() + step_s;
            drape.step(&hands(to_s)).unwrap();
        }
        if tick > 100 {
            found.push(force);
        }
    }
    found
}

fn rms(a: &[[f64; 3]], b: &[[f64; 3]]) -> f64 {
    let square =
        |(a, b): (&[f64; 3], &[f64; 3])| (Vector::from(*a) - Vector::from(*b)).norm_squared();
    (a.iter().zip(b).map(square).sum::<f64>() / a.len() as f64).sqrt()
}

#[test]
fn forces_between_long_steps_are_those_of_short_ones() {
    let exact = forces(1e-3, |drape, t_s| {
        // Where it will be after the step that comes.
        let mut ahead = drape.clone();
        ahead.step(&hands(t_s)).unwrap();
        ahead.finger(0).force_n
    });
    let zeros = vec![[0.0; 3]; exact.len()];
    let whole = rms(&exact, &zeros);
    for step_s in [4e-3, 8e-3] {
        let felt = forces(step_s, |drape, t_s| {
            let mut forces_n = [[0.0; 3]; 2];
            drape.feel(&hands(t_s), &mut forces_n);
            forces_n[0]
        });
        let held = forces(step_s, |drape, _| drape.finger(0).force_n);
        let [off, waiting] = [felt, held].map(|found| rms(&found, &exact) / whole);
        assert!(off < 0.04, "{step_s}: {off} of {whole} N");
        assert!(off < 0.25 * waiting, "{step_s}: {off} {waiting}");
    }
}

#[test]
fn a_cloth_that_is_not_heard_of_pushes_as_it_last_did() {
    let mut drape = drape(8e-3);
    drape.place(&hands(0.0));
    while drape.t_s() < 0.3 {
        let to_s = drape.t_s() + 8e-3;
        drape.step(&hands(to_s)).unwrap();
    }
    let mut forces_n = [[0.0; 3]; 2];
    let still = hands(0.3);
    (0..400).for_each(|_| drape.feel(&still, &mut forces_n));
    let settled = forces_n;
    (0..100).for_each(|_| drape.feel(&still, &mut forces_n));
    for (before, after) in settled.iter().zip(&forces_n) {
        assert!(rms(&[*before], &[*after]) < 1e-6, "{before:?} {after:?}");
    }
    assert!(settled[0][2] > 0.05 && settled[1][2] < -0.05, "{settled:?}");
}
