//! A cloth that hangs, felt in place of the scene.

use super::fingers::{stroke, with_displays};
use super::*;
use selvedge_foundation::numerics::to_single;
use selvedge_foundation::quantity::factor_of_gain;

/// Both displays with a cloth in force, after this tuning.
fn hung() -> (Engine, PointerSender, Instant, ClothFeed) {
    let (mut engine, pointer, start) = with_displays(2);
    let (feed, drive) = ClothDrive::new();
    engine
        .send(Command::SetCloth(Some(Box::new(drive))))
        .unwrap();
    (engine, pointer, start, feed)
}

/// Each contactor its own.
fn given() -> ClothTick {
    let of = |display: usize, n: usize| [1.0 + n as f64, 0.5 + display as f64];
    [0, 1].map(|display| std::array::from_fn(|n| of(display, n)))
}

fn felt(engine: &mut Engine, display: usize) -> Vec<[f32; 2]> {
    let contactors = &engine.snapshot().displays[display].contactors;
    contactors.iter().map(|c| c.amplitude_um).collect()
}

fn is_still(engine: &mut Engine) -> bool {
    let both = [felt(engine, 0), felt(engine, 1)];
    both.iter().flatten().all(|um| *um == [0.0; 2])
}

#[test]
fn what_is_given_is_felt_by_both_displays_under_the_gains_of_the_bands() {
    let (mut engine, mut pointer, start, mut feed) = hung();
    let tuning = Tuning {
        gain_db: -6.0,
        gain_320_db: 3.0,
        ..Tuning::default()
    };
    engine.send(Command::SetTuning(tuning)).unwrap();
    let before = engine.snapshot().rendering.counters;
    for n in 0..8 {
        stroke(&mut pointer, (0, 0), start, n);
        feed.give(&given());
        engine.advance(start + TICK * (n + 1));
        for (display, given) in given().iter().enumerate() {
            let expected = given.map(|[low, high]| {
                [low * factor_of_gain(-6.0), high * factor_of_gain(-3.0)].map(to_single)
            });
            assert_eq!(felt(&mut engine, display), expected);
        }
    }
    assert!(engine.snapshot().rendering.is_cloth);
    let after = engine.snapshot().rendering.counters;
    assert_eq!(
        before.directions_evaluated, after.directions_evaluated,
        "the scene is not looked up"
    );
    engine.send(Command::SetCloth(None)).unwrap();
    stroke(&mut pointer, (0, 0), start, 8);
    engine.advance(start + TICK * 9);
    let expected = given()[0].map(|um| um.map(to_single));
    assert_ne!(felt(&mut engine, 0), expected);
    assert!(!is_still(&mut engine), "the scene is felt again");
}

#[test]
fn what_is_no_longer_given_falls_silent() {
    let (mut engine, _, start, mut feed) = hung();
    engine.advance(start + TICK);
    assert!(is_still(&mut engine), "nothing was given yet");
    feed.give(&given());
    let mut n_felt = 0;
    for n in 2..20 {
        engine.advance(start + TICK * n);
        n_felt += u32::from(!is_still(&mut engine));
    }
    assert_eq!(n_felt, 4);
}

#[test]
fn what_is_no_amplitude_is_silence_and_a_stop_is_heeded() {
    let (mut engine, _, start, mut feed) = hung();
    let mut nonsense = given();
    nonsense[0][0] = [f64::NAN, f64::INFINITY];
    nonsense[0][1] = [-1.0, 2.0];
    feed.give(&nonsense);
    engine.advance(start + TICK);
    let first = felt(&mut engine, 0);
    assert_eq!(first[..2], [[0.0, 0.0], [0.0, 2.0]]);
    engine.send(Command::StopAll).unwrap();
    feed.give(&given());
    engine.advance(start + TICK * 2);
    assert!(is_still(&mut engine));
}
