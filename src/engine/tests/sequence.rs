//! Steady vibrations and single textiles in place of a whole scene.

use super::*;

fn step(amplitude_um: [f32; 2], n_ticks: u32) -> SequenceStep {
    SequenceStep {
        played: Played::Vibration(amplitude_um),
        n_ticks,
    }
}

fn uncovering(textile: usize, n_ticks: u32) -> SequenceStep {
    SequenceStep {
        played: Played::Textile(textile),
        n_ticks,
    }
}

fn two_intervals() -> Vec<SequenceStep> {
    vec![step([0.5, 0.0], 3), step([0.0; 2], 2), step([0.0, 0.25], 3)]
}

#[test]
fn every_contactor_vibrates_alike_whatever_the_finger_does() {
    let (mut engine, _) = engine(Method::Auto);
    let source = InputSource::Replay(path());
    engine.send(Command::SetSource(source)).unwrap();
    engine.send(Command::Play).unwrap();
    engine.advance_ticks(3);
    let tuning = Tuning {
        gain_db: 20.0,
        ..Tuning::default()
    };
    engine.send(Command::SetTuning(tuning)).unwrap();
    engine.send(Command::PlaySequence(two_intervals())).unwrap();
    let mut played = Vec::new();
    for _ in 0..8 {
        engine.advance_ticks(1);
        let snapshot = engine.snapshot();
        let all = amplitudes(snapshot);
        assert!(all.iter().all(|one| *one == all[0]), "{all:?}");
        played.push((snapshot.sequence_step, all[0]));
    }
    let expected = [(0, [0.5, 0.0], 3), (1, [0.0; 2], 2), (2, [0.0, 0.25], 3)];
    let expected: Vec<_> = expected
        .into_iter()
        .flat_map(|(step, um, n)| vec![(Some(step), um); n])
        .collect();
    assert_eq!(played, expected);
    engine.advance_ticks(1);
    let snapshot = engine.snapshot();
    assert_eq!(snapshot.sequence_step, None);
    assert!(!is_silent(snapshot), "the scene is felt again");
}

#[test]
fn limits_show_and_masked_contactors_stay_silent() {
    let (mut engine, _) = engine(Method::Auto);
    engine
        .send(Command::SetContactorMask(vec![true, false]))
        .unwrap();
    engine
        .send(Command::PlaySequence(vec![step([1e6, 0.0], 4)]))
        .unwrap();
    engine.advance_ticks(1);
    let snapshot = engine.snapshot();
    let contactors = &snapshot.displays[0].contactors;
    assert_eq!(contactors[1].amplitude_um, [0.0; 2]);
    assert_ne!(
        contactors[0].limiter,
        selvedge_device::LimiterState::default()
    );
}

#[test]
fn all_off_ends_a_sequence_and_lets_none_begin() {
    let (mut engine, _) = engine(Method::Auto);
    engine.send(Command::PlaySequence(two_intervals())).unwrap();
    engine.advance_ticks(1);
    engine.send(Command::StopAll).unwrap();
    engine.advance_ticks(1);
    assert!(is_silent(engine.snapshot()));
    assert_eq!(engine.snapshot().sequence_step, None);
    engine.send(Command::PlaySequence(two_intervals())).unwrap();
    engine.advance_ticks(1);
    assert!(is_silent(engine.snapshot()), "everything is off");
    let refused = std::iter::from_fn(|| engine.next_notice())
        .any(|notice| matches!(notice, Notice::Refused(words) if words.contains("arm")));
    assert!(refused);
}

#[test]
fn a_vibration_that_is_no_number_is_refused() {
    let (mut engine, _) = engine(Method::Auto);
    for um in [f32::NAN, f32::INFINITY, -1.0] {
        engine
            .send(Command::PlaySequence(vec![step([um, 0.0], 4)]))
            .unwrap();
        engine.advance_ticks(1);
        assert!(is_silent(engine.snapshot()), "{um}");
        assert!(matches!(engine.next_notice(), Some(Notice::Refused(_))));
    }
}

/// Three textiles upon each other, each of another strength and turned another way.
fn stack() -> RenderScene {
    let mut scene = render_scene(exeter());
    let surface = scene.textiles[0].clone();
    scene.textiles = [-6.0, 0.0, 3.0]
        .map(|gain_db| {
            let mut placed = surface.clone();
            placed.scene_gain_db = gain_db;
            placed.workspace_from_textile.rotation = Rotation::from_degrees(30.0 + gain_db);
            placed
        })
        .to_vec();
    scene
}

fn prepared_of(scene: &RenderScene, method: Method) -> PreparedScene {
    let profile = ArrayProfile::default();
    let (at, accuracy) = (Point::new(30.0, 60.0), Accuracy::default());
    PreparedScene::from_parts(scene, profile, at, (method, &accuracy)).unwrap()
}

/// Ticks before a sequence begins: a path begins at rest.
const BEFORE: usize = 3;

/// An engine that feels the stack along a path, on its way.
fn engine_on_stack(method: Method) -> Engine {
    let config = EngineConfig {
        scene: prepared_of(&stack(), method),
        on_news: None,
    };
    let mut engine = Engine::without_thread(config, Instant::now()).unwrap();
    let source = InputSource::Replay(path());
    engine.send(Command::SetSource(source)).unwrap();
    engine.send(Command::Play).unwrap();
    for _ in 0..BEFORE {
        engine.advance_ticks(1);
    }
    engine
}

/// Bits of what every contactor does from the first tick of a sequence on, where one textile of
/// the stack lies alone.
fn alone(textile: usize, method: Method) -> Vec<Vec<[u32; 2]>> {
    let mut scene = stack();
    scene.textiles = vec![scene.textiles[textile].clone()];
    let mut renderer = ArrayRenderer::prepare(&scene, method, &Accuracy::default()).unwrap();
    let mut tick = |pose| {
        let all = renderer.tick(&[pose])[0].amplitudes_um();
        all.iter().map(|um| um.map(f32::to_bits)).collect()
    };
    let all = path()
        .ticks()
        .map(|(_, pose)| tick(pose))
        .collect::<Vec<_>>();
    all[BEFORE..].to_vec()
}

#[test]
fn each_textile_is_felt_at_its_ticks_as_if_it_lay_alone() {
    let steps = [
        (None, 2),
        (Some(0), 5),
        (None, 3),
        (Some(2), 4),
        (Some(1), 1),
        (None, SequenceStep::UNTIL_NEXT),
    ];
    for method in [Method::Reference, Method::Banded, Method::Table] {
        let mut engine = engine_on_stack(method);
        let sequence = steps.map(|(textile, n_ticks)| match textile {
            Some(textile) => uncovering(textile, n_ticks),
            None => SequenceStep::silence(n_ticks),
        });
        engine
            .send(Command::PlaySequence(sequence.to_vec()))
            .unwrap();
        let alone = [0, 1, 2].map(|textile| alone(textile, method));
        let expected = (0_u16..).zip(steps).flat_map(|(nth, (textile, n_ticks))| {
            (0..n_ticks.min(20)).map(move |_| (nth, textile))
        });
        for (tick, (nth, textile)) in expected.enumerate() {
            engine.advance_ticks(1);
            let snapshot = engine.snapshot();
            assert_eq!(snapshot.sequence_step, Some(nth), "tick {tick}");
            let bits: Vec<_> = amplitudes(snapshot)
                .into_iter()
                .map(|um| um.map(f32::to_bits))
                .collect();
            let lone = textile.map(|textile| &alone[textile][tick]);
            let silence = vec![[0; 2]; bits.len()];
            assert_eq!(&bits, lone.unwrap_or(&silence), "{method:?}, tick {tick}");
            assert!(textile.is_none() || bits != silence, "tick {tick}");
        }
    }
}

#[test]
fn what_lies_on_top_is_felt_only_once_a_sequence_is_over() {
    let top = alone(2, Method::Reference);
    let felt = |engine: &mut Engine| {
        engine.advance_ticks(1);
        let all = amplitudes(engine.snapshot()).into_iter();
        all.map(|um| um.map(f32::to_bits)).collect::<Vec<_>>()
    };
    let mut engine = engine_on_stack(Method::Reference);
    let sequence = vec![uncovering(0, 1), SequenceStep::silence(2)];
    engine.send(Command::PlaySequence(sequence)).unwrap();
    assert_ne!(felt(&mut engine), top[0]);
    // An edited scene that comes in a pause is not heard before the next tick either.
    let edited = Box::new(prepared_of(&stack(), Method::Reference));
    engine.send(Command::UpdateScene(edited)).unwrap();
    for _ in 0..2 {
        assert!(felt(&mut engine).iter().all(|bits| *bits == [0; 2]));
    }
    assert_eq!(felt(&mut engine), top[3], "it is over");
    let none = vec![uncovering(3, 1)];
    engine.send(Command::PlaySequence(none)).unwrap();
    assert!(felt(&mut engine).iter().all(|bits| *bits == [0; 2]));
    assert_eq!(felt(&mut engine), top[5], "there is no fourth");
}

#[test]
fn silence_may_be_told_while_everything_is_off() {
    let mut engine = engine_on_stack(Method::Reference);
    engine.send(Command::StopAll).unwrap();
    engine.advance_ticks(1);
    while engine.next_notice().is_some() {}
    let silence = vec![SequenceStep::silence(SequenceStep::UNTIL_NEXT)];
    engine.send(Command::PlaySequence(silence)).unwrap();
    engine.advance_ticks(1);
    assert!(engine.next_notice().is_none(), "nothing is refused");
    engine
        .send(Command::PlaySequence(vec![uncovering(0, 1)]))
        .unwrap();
    engine.advance_ticks(1);
    assert!(matches!(engine.next_notice(), Some(Notice::Refused(_))));
}
