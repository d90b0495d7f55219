//! What a snapshot says of the amplitudes it shows: rendered at which pose, after which commands,
//! and what the ticks cost.

use super::*;

/// What a renderer makes of the pose that a snapshot says it was rendered at.
fn as_said(snapshot: &Snapshot, tuning: &Tuning) -> Vec<[f32; 2]> {
    let scene = render_scene(exeter());
    let how = (Method::Reference, Accuracy::default());
    let mut renderer = ArrayRenderer::prepare(&scene, how.0, &how.1).unwrap();
    renderer.set_tuning(tuning).unwrap();
    renderer.tick(&[snapshot.rendered])[0]
        .amplitudes_um()
        .to_vec()
}

#[test]
fn a_snapshot_that_shows_all_commands_was_rendered_at_its_pose_with_their_gains() {
    let (mut engine, _) = engine(Method::Reference);
    let loud = Tuning {
        gain_db: 6.0,
        ..Tuning::default()
    };
    let other = || Box::new(prepared(exeter(), Method::Reference));
    let replay = InputSource::Replay(path());
    let acts = [
        (Command::SetSource(replay), Tuning::default()),
        (Command::Play, Tuning::default()),
        (Command::SetTuning(loud), loud),
        (Command::TurnBy(3.0), loud),
        (Command::SetScene(other()), Tuning::default()),
        (Command::SetTuning(loud), loud),
        (Command::UpdateScene(other()), Tuning::default()),
        (Command::StopAll, Tuning::default()),
    ];
    for (command, tuning) in acts {
        engine.advance_ticks(5).unwrap();
        engine.send(command).unwrap();
        for n_ticks in 0..3 {
            let n_sent = engine.commands_sent();
            engine.advance_ticks(n_ticks).unwrap();
            let snapshot = engine.snapshot();
            if snapshot.counters.commands_obeyed == n_sent {
                assert_eq!(amplitudes(snapshot), as_said(snapshot, &tuning));
            } else {
                assert_eq!(n_ticks, 0, "a tick obeys");
            }
        }
    }
    assert!(
        is_silent(engine.snapshot()),
        "everything was off in the end"
    );
}

#[test]
fn ticks_cost_time_where_a_clock_runs_and_none_where_time_is_told() {
    let (mut described, _) = engine(Method::Auto);
    described.advance_ticks(5).unwrap();
    assert_eq!(
        described.snapshot().clock.costs,
        DurationHistogram::default()
    );
    let mut running = Engine::start(config(Method::Auto)).unwrap();
    while running.snapshot().clock.costs.n() < 3 {
        std::thread::sleep(Duration::from_millis(5));
    }
    let costs = running.snapshot().clock.costs;
    let spread = costs.spread();
    assert!(spread.median > Duration::ZERO && spread.p99 <= spread.max);
    let counted: u64 = costs.buckets().map(|bucket| u64::from(bucket.count)).sum();
    assert_eq!(counted, costs.n());
}
