//! A stylus that is felt in place of the array: it drives device, sound and recordings, before
//! gains and limits, and never brings what is no number.

use super::*;
use selvedge_device::{BridgeState, Coder, Target};
use selvedge_render::contact::{
    ContactLaw, FeltSurface, Relief, Sampling, Stepper, StylusSetup, Tip,
};
use selvedge_render::stylus::{StylusDrive, StylusSettings, StylusState};

/// Steps of a tick.
const N_STEPS: u64 = 25;
const STROKE: Stroke = Stroke::Circle {
    centre: Point::new(50.0, 70.0),
    radius_mm: 12.0,
    speed_mm_per_s: 60.0,
};

/// A setup on a surface: the usual one with a fine tip unless changed.
fn setup_on(
    surface: &Surface,
    change: impl FnOnce(&mut StylusSetup, &mut ContactLaw),
) -> StylusSetup {
    let felt = FeltSurface::rigid(Relief::of_surface(surface));
    let contact = felt.contact(Tip::stylus(0.05)).unwrap();
    let mut setup = StylusSettings::default().setup(contact);
    let mut law = *setup.contact.law();
    change(&mut setup, &mut law);
    setup.contact.set_law(law).unwrap();
    setup
}

/// Lets this scene be felt by a stylus whose setup is changed.
fn felt_on(scene: &RenderScene, change: impl FnOnce(&mut StylusSetup, &mut ContactLaw)) -> Command {
    let surface = &scene.textiles[0].surface;
    let textiles = vec![(Arc::clone(surface), Some(setup_on(surface, change)))];
    let drive = StylusDrive::prepare(textiles, (1000.0, 2000.0), &scene.filters);
    Command::SetStylus(Some(Box::new(drive.unwrap())))
}

/// An engine in told time whose stylus waits to be sent, the scene, and when it began.
fn waiting() -> (Engine, RenderScene, Instant) {
    let scene = render_scene(exeter());
    let how = (Method::Banded, &Accuracy::default());
    let start = Point::new(50.0, 60.0);
    let prepared = PreparedScene::from_parts(&scene, ArrayProfile::default(), start, how);
    let config = EngineConfig {
        scene: prepared.unwrap(),
        on_news: None,
    };
    let start = Instant::now();
    (Engine::without_thread(config, start).unwrap(), scene, start)
}

/// The same with the stylus felt along a stroke.
fn stroking() -> (Engine, RenderScene) {
    let (mut engine, scene, _) = waiting();
    let felt = felt_on(&scene, |_, _| {});
    for command in [
        felt,
        Command::SetSource(InputSource::Stroke(STROKE)),
        Command::Play,
    ] {
        engine.send(command).unwrap();
    }
    (engine, scene)
}

/// The amplitudes that all contactors share; fails if they differ.
fn shared(engine: &mut Engine) -> [f32; 2] {
    let all = amplitudes(engine.snapshot());
    assert!(all.iter().all(|one| *one == all[0]), "{all:?}");
    all[0]
}

#[test]
fn every_contactor_vibrates_as_the_stylus_does_and_gains_come_on_top() {
    let run = |gain_db| {
        let (mut engine, _) = stroking();
        let tuning = Tuning {
            gain_db,
            ..Tuning::default()
        };
        engine.send(Command::SetTuning(tuning)).unwrap();
        let mut felt = Vec::new();
        for _ in 0..60 {
            engine.advance_ticks(1);
            felt.push(shared(&mut engine));
        }
        assert_eq!(engine.snapshot().stylus, Some(StylusState::Led));
        felt
    };
    let [plain, louder] = [run(0.0), run(6.0)];
    assert_eq!(plain[0], [0.0; 2], "a run begins at rest");
    let is_felt = |um: &[f32; 2]| um[0] > 0.0 && um[1] > 0.0;
    assert!(plain[1..].iter().all(is_felt), "{plain:?}");
    for (plain, louder) in plain.iter().zip(&louder).skip(1) {
        for band in 0..2 {
            let db = 20.0 * f64::from(louder[band] / plain[band]).log10();
            assert!((db - 6.0).abs() < 1e-4, "{db}");
        }
    }
}

#[test]
fn nothing_is_stepped_unless_a_stylus_is_felt_and_a_tick_has_so_many_steps() {
    let (mut engine, _) = stroking();
    engine.advance_ticks(11);
    assert_eq!(engine.snapshot().counters.stylus_steps, 10 * N_STEPS);
    engine.send(Command::SetStylus(None)).unwrap();
    engine.advance_ticks(10);
    let snapshot = engine.snapshot();
    assert_eq!(snapshot.counters.stylus_steps, 10 * N_STEPS);
    assert_eq!(snapshot.stylus, None);
    let array = amplitudes(snapshot);
    assert!(array.iter().any(|um| *um != array[0]), "the array is felt");
    assert_eq!(StylusDrive::rate_hz(1234.0), 1240.0);
    assert_eq!(StylusDrive::rate_hz(40_000.0), 10_000.0, "lowered");
}

#[test]
fn a_stylus_that_stands_is_silent_and_costs_nothing_until_it_moves_again() {
    let (mut engine, scene, start) = waiting();
    engine.send(felt_on(&scene, |_, _| {})).unwrap();
    explore(&mut engine, start, 40);
    assert!(shared(&mut engine)[0] > 0.0, "it moves");
    engine.advance_ticks(10);
    let n_steps = engine.snapshot().counters.stylus_steps;
    assert_eq!(shared(&mut engine), [0.0; 2]);
    assert_eq!(engine.snapshot().stylus, Some(StylusState::AtRest));
    engine.advance_ticks(40);
    assert_eq!(engine.snapshot().counters.stylus_steps, n_steps);
}

#[test]
fn frames_of_an_armed_device_carry_the_drive() {
    let (mut engine, _) = stroking();
    engine.step_emulators();
    engine.send(Command::Connect(Target::Emulator)).unwrap();
    engine.advance_ticks(20);
    engine.send(Command::Arm).unwrap();
    engine.advance_ticks(60);
    let link = engine.snapshot().link.unwrap();
    assert_eq!(link.state, BridgeState::Streaming);
    let mut coder = Coder::new(engine.profile(), 24);
    coder.set_link(link.scale);
    let (mut due, mut n_met) = (Vec::new(), 0);
    for _ in 0..60 {
        engine.advance_ticks(1);
        let codes = coder.encode(&amplitudes(engine.snapshot()), 1.0);
        due.push(
            codes
                .iter()
                .flatten()
                .map(|code| u32::from(*code))
                .sum::<u32>(),
        );
        let status = engine.snapshot().link.and_then(|link| link.status).unwrap();
        // A frame is played up to three ticks later.
        let latest = &due[due.len().saturating_sub(4)..];
        n_met += u32::from(status.amp_sum > 0 && latest.contains(&status.amp_sum));
    }
    assert!(n_met > 50, "{n_met} of 60, {due:?}");
    engine.stop_switch().press();
    engine.advance_ticks(5);
    let snapshot = engine.snapshot();
    assert!(is_silent(snapshot) && snapshot.is_stopped);
    assert_eq!(snapshot.link.unwrap().status.unwrap().amp_sum, 0);
}

#[test]
fn it_is_heard_as_it_is_felt() {
    let (mut engine, scene) = stroking();
    let (feed, mut sonifier, _) = sonification();
    engine
        .send(Command::SetSound(Some(Box::new(feed))))
        .unwrap();
    let mut block = vec![[0.0; 2]; 1200];
    let mut loudest = |engine: &mut Engine, n_ticks| {
        let mut loudest = 0.0_f32;
        for _ in 0..n_ticks {
            engine.advance_ticks(1);
            sonifier.fill(&mut block);
            loudest = block
                .iter()
                .flatten()
                .fold(0.0, |most, x| most.max(x.abs()));
        }
        loudest
    };
    assert!(loudest(&mut engine, 10) > 1e-3);
    // A drive of 0 µm/N is silent on a stroke along which the array sounds.
    let surface = Arc::clone(&scene.textiles[0].surface);
    let setup = setup_on(&surface, |_, _| {});
    let drive = (1000.0, 0.0);
    let mute = StylusDrive::prepare(vec![(surface, Some(setup))], drive, &scene.filters);
    let mute = Some(Box::new(mute.unwrap()));
    engine.send(Command::SetStylus(mute)).unwrap();
    assert_eq!(loudest(&mut engine, 5), 0.0);
    engine.send(Command::SetStylus(None)).unwrap();
    assert!(loudest(&mut engine, 5) > 1e-3);
}

#[test]
fn what_it_recorded_replays_bit_for_bit() {
    let (mut engine, scene, start) = waiting();
    engine.send(felt_on(&scene, |_, _| {})).unwrap();
    engine.advance(start);
    // In the middle of a run, with a pause in it.
    let mut pointer = engine.take_pointer().unwrap();
    let place = |t_s: f64| Point::new(50.0 + 15.0 * (3.0 * t_s).sin(), 60.0 + 14.0 * t_s);
    let mut recording = None;
    for n in 1..=160_u32 {
        let now = start + TICK * n;
        if !(60..80).contains(&n) {
            let position = place(f64::from(n) / 40.0);
            pointer.push(PointerSample {
                stamp: now,
                position,
            });
        }
        if n == 30 {
            recording = Some(engine.record().unwrap());
        }
        engine.advance(now);
    }
    engine.send(Command::StopRecording).unwrap();
    engine.advance_ticks(1);
    let mut recording = recording.unwrap();
    recording.collect();
    let csv = recording.to_path().unwrap().to_csv().unwrap();
    let path = ExplorationPath::from_csv(&csv, std::path::Path::new("stylus.csv")).unwrap();

    let replay = InputSource::Replay(Arc::new(path));
    engine.send(Command::SetSource(replay)).unwrap();
    engine.send(Command::SetLoop(true)).unwrap();
    engine.send(Command::Play).unwrap();
    let n_ticks = recording.ticks().len();
    let mut n_felt = 0;
    for n in (0..n_ticks).chain(0..n_ticks) {
        engine.advance_ticks(1);
        let replayed = amplitudes(engine.snapshot());
        assert_eq!(recording.amplitudes_um(n), replayed, "tick {n}");
        n_felt += u32::from(replayed[0][0] > 0.0);
    }
    assert!(n_felt > 180, "{n_felt}");
}

#[test]
fn a_moment_that_is_gone_to_is_felt_as_one_of_a_run() {
    let (mut engine, scene, _) = waiting();
    let path = path();
    for command in [
        felt_on(&scene, |_, _| {}),
        Command::SetSource(InputSource::Replay(Arc::clone(&path))),
        Command::Play,
    ] {
        engine.send(command).unwrap();
    }
    let mut played = Vec::new();
    for _ in 0..path.n_ticks() {
        engine.advance_ticks(1);
        played.push(shared(&mut engine));
    }
    engine.send(Command::Pause).unwrap();
    engine.advance_ticks(1);
    let before = engine.snapshot().counters.stylus_steps;
    for tick in [70_u32, 45, 45, 79] {
        engine.send(Command::Seek(u64::from(tick))).unwrap();
        engine.advance_ticks(3);
        let sought = shared(&mut engine);
        let whole = played[usize::try_from(tick).unwrap()];
        for band in 0..2 {
            let off = f64::from(sought[band] / whole[band]) - 1.0;
            assert!(
                off.abs() < 1e-3,
                "tick {tick}: {sought:?}, played {whole:?}"
            );
        }
    }
    // The tick itself, and a second before it at most.
    let made = engine.snapshot().counters.stylus_steps - before;
    assert_eq!(made, 4 * 40 * N_STEPS);
}

#[test]
fn another_scene_ends_it_an_edit_does_not_and_another_list_silences_it() {
    let (mut engine, mut scene) = stroking();
    let update = |scene: &RenderScene| {
        let how = (Method::Banded, &Accuracy::default());
        let start = Point::new(50.0, 60.0);
        let prepared = PreparedScene::from_parts(scene, ArrayProfile::default(), start, how);
        Box::new(prepared.unwrap())
    };
    engine.advance_ticks(20);
    scene.textiles[0].workspace_from_textile.origin = Point::new(9.0, 10.0);
    engine.send(Command::UpdateScene(update(&scene))).unwrap();
    engine.advance_ticks(1);
    assert_eq!(engine.snapshot().stylus, Some(StylusState::Led), "moved");
    let other = render_scene(exeter());
    engine.send(Command::UpdateScene(update(&other))).unwrap();
    engine.advance_ticks(2);
    assert!(is_silent(engine.snapshot()), "it waits for the next stylus");
    engine.send(Command::SetScene(update(&other))).unwrap();
    engine.advance_ticks(2);
    assert!(engine.snapshot().stylus.is_none() && !is_silent(engine.snapshot()));
}

#[test]
fn a_sequence_goes_before_it() {
    let (mut engine, _) = stroking();
    engine.advance_ticks(10);
    let steps = vec![SequenceStep {
        played: Played::Vibration([3.0, 1.0]),
        n_ticks: 4,
    }];
    engine.send(Command::PlaySequence(steps)).unwrap();
    engine.advance_ticks(2);
    assert_eq!(shared(&mut engine), [3.0, 1.0]);
    engine.advance_ticks(10);
    assert_ne!(shared(&mut engine), [3.0, 1.0]);
}

#[test]
fn whatever_the_setting_amplitudes_are_numbers() {
    type Change = fn(&mut StylusSetup, &mut ContactLaw);
    let stiff: Change = |_, law| law.stiffness_n_per_m = 1e9;
    let explicit: Change = |setup, law| {
        law.stiffness_n_per_m = 1e9;
        setup.method = Stepper::ExplicitEuler;
    };
    let sampled: Change = |setup, law| {
        law.stiffness_n_per_m = 1e6;
        setup.sampling = Some(Sampling::default());
    };
    let broken: Change = |setup, _| {
        let spiked = (0..5000).map(|i| if i % 50 == 0 { 1e12 } else { 0.0 });
        let profile = Profile::new(1.0 / 230.0, spiked.collect()).unwrap();
        let mut profiles = ProfileSet::default();
        profiles[0] = Some(profile.clone());
        profiles[2] = Some(profile);
        let surface = Surface::from_profiles(profiles, 0.0).unwrap();
        let felt = FeltSurface::rigid(Relief::of_surface(&surface));
        setup.contact = felt.contact(Tip::stylus(0.0)).unwrap();
    };
    let mut n_broken_off = 0;
    for change in [stiff, explicit, sampled, broken] {
        let (mut engine, scene, _) = waiting();
        let felt = felt_on(&scene, change);
        for command in [
            felt,
            Command::SetSource(InputSource::Stroke(STROKE)),
            Command::Play,
        ] {
            engine.send(command).unwrap();
        }
        for _ in 0..80 {
            engine.advance_ticks(1);
            let is_broken = engine.snapshot().stylus == Some(StylusState::BrokenOff);
            n_broken_off += u32::from(is_broken);
            let um = shared(&mut engine);
            assert!(um.iter().all(|um| um.is_finite() && *um >= 0.0), "{um:?}");
            assert!(!is_broken || um == [0.0; 2], "broken off is silent");
        }
    }
    assert!(
        n_broken_off > 100,
        "two of them grow without end: {n_broken_off}"
    );
    let scene = render_scene(exeter());
    for um_per_n in [f64::NAN, -1.0, f64::INFINITY] {
        let refused = StylusDrive::prepare(Vec::new(), (1000.0, um_per_n), &scene.filters);
        assert!(refused.is_err(), "{um_per_n}");
    }
}
