//! A scene that is edited while it is felt.

use super::*;

/// The scene of these tests after its textile was dragged this far.
fn dragged(offsets: Vec<Displacement>, by_mm: f64) -> (RenderScene, Box<PreparedScene>) {
    let mut scene = render_scene(offsets);
    scene.textiles[0].workspace_from_textile.origin.x_mm += by_mm;
    let how = (Method::Table, &Accuracy::default());
    let start = Point::new(1.0, 1.0);
    let prepared = PreparedScene::from_parts(&scene, ArrayProfile::default(), start, how).unwrap();
    (scene, Box::new(prepared))
}

fn playing() -> Engine {
    let (mut engine, _) = engine(Method::Table);
    let source = InputSource::Replay(path());
    engine.send(Command::SetSource(source)).unwrap();
    engine.send(Command::Play).unwrap();
    engine
}

#[test]
fn a_recording_goes_on_through_edits_and_feels_them() {
    let mut engine = playing();
    let mut recording = engine.record().unwrap();
    engine.advance_ticks(10);
    let before = engine.snapshot().rendering.counters;
    let (scene, edited) = dragged(exeter(), 4.0);
    let serial = edited.serial();
    engine.send(Command::UpdateScene(edited)).unwrap();
    engine.advance_ticks(20);
    let snapshot = engine.snapshot();
    assert_eq!(snapshot.scene_serial, serial);
    assert_eq!(
        (snapshot.tick, snapshot.playback.tick),
        (30, 29),
        "the source goes on"
    );
    assert!(
        snapshot.rendering.counters.ticks > before.ticks + 19,
        "counters go on"
    );
    engine.send(Command::StopRecording).unwrap();
    engine.advance_ticks(1);
    recording.collect();
    assert_eq!(recording.ticks().len(), 30);
    let felt = offline(&path(), Method::Table);
    let mut renderer = ArrayRenderer::prepare(&scene, Method::Table, &Accuracy::default()).unwrap();
    let path = path();
    for ((n, pose), felt) in path.ticks().zip(&felt).take(30) {
        let felt_edited = renderer.tick(&[pose])[0].amplitudes_um();
        let index = usize::try_from(n).unwrap();
        let expected = if n < 10 { felt } else { felt_edited };
        assert_eq!(recording.amplitudes_um(index), expected, "tick {n}");
    }
}

#[test]
fn a_recording_ends_when_a_display_has_other_contactors() {
    let mut engine = playing();
    let mut recording = engine.record().unwrap();
    engine.advance_ticks(10);
    let (_, edited) = dragged(vec![Displacement::default(); 5], 0.0);
    engine.send(Command::UpdateScene(edited)).unwrap();
    engine.advance_ticks(1);
    assert_eq!(engine.snapshot().displays[0].contactors.len(), 5);
    assert!(!engine.snapshot().recording.is_recording);
    recording.collect();
    assert!(recording.has_ended() && recording.ticks().len() == 10);
}

#[test]
fn a_held_moment_and_a_pointer_at_rest_stay_where_they_are() {
    let mut engine = playing();
    engine.advance_ticks(10);
    engine.send(Command::Pause).unwrap();
    engine.advance_ticks(2);
    let pose = engine.snapshot().pose;
    let (scene, edited) = dragged(exeter(), 4.0);
    engine.send(Command::UpdateScene(edited)).unwrap();
    engine.advance_ticks(2);
    let mut renderer = ArrayRenderer::prepare(&scene, Method::Table, &Accuracy::default()).unwrap();
    assert_eq!(
        amplitudes(engine.snapshot()),
        renderer.tick(&[pose])[0].amplitudes_um()
    );

    let (mut engine, _) = super::engine(Method::Table);
    engine.advance_ticks(1);
    let (_, edited) = dragged(exeter(), 4.0);
    engine.send(Command::UpdateScene(edited)).unwrap();
    engine.advance_ticks(1);
    assert_eq!(
        engine.snapshot().pose.position,
        Point::new(30.0, 60.0),
        "not to the middle"
    );
}

#[test]
fn thirty_edits_a_second_are_all_taken_over() {
    let loaded = selvedge_render::scene::LoadedScene::shipped().unwrap();
    let accuracy = Accuracy::default();
    let scene = PreparedScene::prepare(&loaded, Method::Auto, &accuracy);
    let config = EngineConfig {
        scene: scene.unwrap(),
        on_news: None,
    };
    let mut engine = Engine::without_thread(config, Instant::now()).unwrap();
    for n in 0..60 {
        let mut scene = loaded.scene().clone();
        scene.textiles[1].origin_mm.x_mm += f64::from(n) * 0.3;
        let edited = loaded.with_scene(scene).unwrap();
        let edited = PreparedScene::prepare(&edited, Method::Auto, &accuracy).unwrap();
        let serial = edited.serial();
        engine.send(Command::UpdateScene(Box::new(edited))).unwrap();
        engine.advance_ticks(1);
        assert_eq!(engine.snapshot().scene_serial, serial);
    }
}
